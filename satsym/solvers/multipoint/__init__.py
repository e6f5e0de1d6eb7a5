"""Extremals in arcs, each with a law of its own, joined where functions vanish: one boundary value problem."""
