"""Competitors whose structure of boundary arcs is near that of an answer."""

from __future__ import annotations

from satsym.solution import Kind, Solution
from satsym.solvers.certificate.competitors.comparison import Comparison, summed
from satsym.solvers.certificate.constrained.variants import near


def compared(solution: Solution, deadline: float) -> Comparison:
    """Compare a solution with the extremals of structures near its own.

    Parameters
    ----------
    deadline
        On the clock of :func:`~satsym.solvers.iteration.computed`.
    """
    count, costs, late = near(solution, deadline)
    found = summed(solution, Kind.ARCS, count, costs, late)
    return Comparison((found,), () if count and not late else (Kind.ARCS,))
