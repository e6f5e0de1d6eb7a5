"""Inequalities on the state along the way: structures of contacts with boundaries, and exact arcs."""
