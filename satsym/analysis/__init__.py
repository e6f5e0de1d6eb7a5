"""Numeric analysis of models near their reference or an equilibrium: structure, stability, linear feedback; orbits.

No module here is about a particular model, except :mod:`satsym.analysis.orbits`, which is about Kepler motion; and none
is symbolic: :mod:`satsym.symbolic.analysis` is the exact counterpart.
"""
