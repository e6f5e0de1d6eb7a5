"""Multiple shooting: the canonical equations are integrated arc by arc, until arcs and boundary conditions match.

Shooting is independent of collocation: it uses an explicit Runge-Kutta method of order 8 instead of polynomials, and
generated variational equations instead of collocation equations. Only the initial guess comes from collocation (Stoer
and Bulirsch, Introduction to Numerical Analysis, 7.3.5).
"""

from __future__ import annotations

from satsym.solvers.shooting.solving import solve

__all__ = ["solve"]
