"""Multiple shooting: the canonical equations integrated arc by arc, until the arcs meet and the right end is met.

The second route to what collocation finds, and independent of it: an explicit Runge-Kutta method of order 8 in
place of polynomials, generated variational equations in place of collocation equations. From collocation it takes
only where to start (Stoer and Bulirsch, Introduction to Numerical Analysis, 7.3.5).
"""

from __future__ import annotations

from satsym.solvers.shooting.solving import solve

__all__ = ["solve"]
