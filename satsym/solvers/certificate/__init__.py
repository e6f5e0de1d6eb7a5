"""Proof that a solution is an optimum, independent of the solver: anyone can recompute it from the initial costates.

The canonical equations are integrated again from the initial state and costates alone. The certificate then measures:
the boundary conditions at the final time, the distance from the solver's trajectory, stationarity, constancy of H, the
Legendre-Clebsch condition, absence of conjugate times (Jacobi), and that no competitor (another motion of the same
problem) of the kinds listed is cheaper.
"""

from __future__ import annotations

from satsym.solvers.certificate.verdict import certify

__all__ = ["certify"]
