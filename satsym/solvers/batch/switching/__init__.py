"""Time-optimal extremals with saturated controls, for many instances at once."""
