"""Printed programs: they are parsed, measured and interpreted, but never executed by Python."""
