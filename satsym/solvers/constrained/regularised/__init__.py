"""Regularised paths: the problem as a nonlinear program, its starts, and an interior-point method that solves it."""
