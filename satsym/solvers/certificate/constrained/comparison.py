"""Competitors with other boundary arcs, or other times of points on the way: variants, and to what paths lead."""

from __future__ import annotations

from dataclasses import replace

from satsym.solution import Kind, Solution
from satsym.solvers.certificate.comparison import Comparison, summed
from satsym.solvers.certificate.constrained.variants import near
from satsym.solvers.constrained.convexity import convex
from satsym.solvers.constrained.solving import others


def compared(solution: Solution, deadline: float, seed: int) -> Comparison:
    """Compare a solution with extremals to which paths lead that are drawn.

    Parameters
    ----------
    deadline
        On the clock of :func:`~satsym.solvers.iteration.computed`.
    seed
        Of the paths.
    """
    if convex(solution.instance):  # there are no others
        return Comparison((), ())
    instance = solution.instance
    if instance.model.spec.interior:
        from satsym.solvers.interior.solving import others as at_other_times

        tried, costs, interrupted = at_other_times(solution, seed + 1, deadline)
        found = summed(solution, Kind.TIMES, tried, costs, interrupted)
        return Comparison((found,), () if costs and not interrupted else (Kind.TIMES,))
    if instance.tf is None:  # paths last as long as the solution does
        instance = replace(instance, tf_guess=float(solution.times[-1]))
    tried, costs, interrupted = others(instance, solution, seed + 1, deadline)
    count, more, late = (0, list[float](), True) if interrupted else near(solution, deadline)
    found = summed(solution, Kind.ARCS, tried + count, [*costs, *more], late)
    return Comparison((found,), () if (costs or count) and not late else (Kind.ARCS,))
