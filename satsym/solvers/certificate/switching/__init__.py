"""Certificates of bang-bang and singular arcs: competitors of other structures, needles, the second variation."""
