"""Starts of nonlinear programmes: the list of plans, random ends, and revolutions about the origin."""
