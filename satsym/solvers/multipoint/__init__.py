"""Extremals in arcs with a control law on each arc and a condition at each junction: one boundary value problem."""
