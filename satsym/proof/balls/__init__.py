"""Balls, which are numbers with error bounds: arithmetic, derivatives, exact numbers, and validated integration."""
