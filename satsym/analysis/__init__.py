"""Numeric analysis of models near their reference or an equilibrium: structure, stability, linear feedback; orbits.

Nothing here is specific to a model, save :mod:`satsym.analysis.orbits`, which is about Kepler's motion; and nothing is
symbolic: :mod:`satsym.symbolic.analysis` has the exact side.
"""
