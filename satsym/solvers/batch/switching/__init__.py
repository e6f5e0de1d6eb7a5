"""Extremals of saturated controls, many at once."""
