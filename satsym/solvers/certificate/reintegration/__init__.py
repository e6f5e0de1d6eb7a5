"""Repeated integration of a solution, from the initial state or, where errors grow, segment by segment; its defects."""
