"""Consequences of a motion: its reference, conserved quantities and outputs, and steps for central forces."""
