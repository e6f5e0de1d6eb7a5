"""Extremals found by a direct method: a nonlinear programme of all states and controls, solved from several starts.

:mod:`~satsym.solvers.search.order` describes the order in which starts are tried.
"""
