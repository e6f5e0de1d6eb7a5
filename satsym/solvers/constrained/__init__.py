"""Inequalities on the state along the way: a regularised path, the structure that it shows, and exact arcs."""
