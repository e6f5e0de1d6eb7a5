"""Extremals found by a direct method: a programme of all states and controls, solved from a few fixed starts.

:mod:`~satsym.solvers.search.order` tells what is tried after what.
"""
