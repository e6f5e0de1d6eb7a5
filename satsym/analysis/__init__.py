"""Numeric analysis of models near their reference or an equilibrium: structure, stability, linear feedback.

Nothing here is specific to a model, and nothing is symbolic; :mod:`satsym.symbolic.analysis` has the exact side.
"""
