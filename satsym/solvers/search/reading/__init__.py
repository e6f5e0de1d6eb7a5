"""Conversion of the solution of a nonlinear programme into arcs and junctions, which Newton's method makes exact."""
