"""Collocation of two-point boundary value problems: cold start, exact Jacobians, error estimates and control bounds."""
