"""Collocation: two-point boundary value problems from a cold start, exact Jacobians, error estimates, bounds."""
