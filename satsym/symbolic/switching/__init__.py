"""Hamiltonians that are linear in the controls: switching functions, singular arcs, the switching curve."""
