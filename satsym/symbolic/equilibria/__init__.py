"""Equilibrium attitudes of a body in orbit: all of them, counted exactly, classified, and followed over a parameter."""
