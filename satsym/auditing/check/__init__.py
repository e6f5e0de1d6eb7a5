"""Checks of one printed formula against everything that the derivation of a model establishes.

The result is whether the formula is right and, if not, what is wrong with it.
"""
