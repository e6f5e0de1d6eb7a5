"""Printed formulas as data: the safe language that they are read from, trees, and exact values in a prime field."""
