"""Conditions between the ends: inequalities on states and controls, and points that are passed at free times."""
