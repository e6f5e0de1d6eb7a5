"""Printed programs: parsed, measured and followed, never executed."""
