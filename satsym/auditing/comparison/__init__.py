"""Comparison of printed with derived formulas: resolution of names and addresses, and plans of comparison.

A plan states when a printed formula agrees with the derived one.
"""
