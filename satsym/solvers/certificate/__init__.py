"""Proof of an optimum, by means other than the solver's own: anyone can recompute it from the initial costates.

The canonical equations are integrated again from the initial state and costates alone. What must hold is then
measured: the right end, the distance from the solver's trajectory, stationarity, constancy of H, the
Legendre-Clebsch condition, absence of conjugate times (Jacobi), and that no competitor of the kinds listed is
cheaper.
"""

from __future__ import annotations

from satsym.solvers.certificate.verdict import certify

__all__ = ["certify"]
