"""A cold start for long durations: solve a shorter problem, then let it take longer and longer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.descent import descended
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.iteration import Limits

SHORTER, HALVINGS = 0.5, 6
"""Shares of the duration that are tried for a start."""

FIRST, SMALLEST = 1.3, 1.002
"""Ratios of neighbouring durations: at first, and where it is given up."""


def along_durations(
    problem: TwoPoint, stages: int, limits: Limits, solve: Callable[[TwoPoint], Attempt]
) -> Attempt | None:
    """Minimise with a shorter duration, and lengthen it step by step.

    Parameters
    ----------
    problem
        With a given final time.
    stages
        Of the scheme.
    limits
        When to stop.
    solve
        How the shorter problem is minimised from nothing.
    """
    if problem.free_time:
        return None
    duration, steps = problem.duration, 0
    for _ in range(HALVINGS):
        duration *= SHORTER
        found = solve(_lasting(problem, duration))
        steps += found.iterations
        if found.minimum:
            break
        if limits.expired:
            return None
    else:
        return None
    curve, ratio = found.curve, FIRST
    while duration < problem.duration and ratio > SMALLEST and not limits.expired:
        longer = min(duration * ratio, problem.duration)
        last = longer == problem.duration
        there = _lasting(problem, longer)
        found = descended(there, curve, stages, 1e-7 if last else 1e-3, limits)
        steps += max(found.iterations, 1)
        if found.minimum:
            curve, duration = found.curve, longer
            ratio = min(FIRST, ratio**1.5)
        else:
            ratio **= 0.4
    if duration < problem.duration:
        facts = (duration, problem.duration)
        return Attempt(curve, Reason.DURATION_ENDS, steps, float("inf"), facts=facts)
    return replace(found, iterations=steps, hard=True)


def _lasting(problem: TwoPoint, duration: float) -> TwoPoint:
    """The same problem in the same units with another final time."""
    tf = problem.instance.t0 + duration
    return replace(problem, instance=replace(problem.instance, tf=tf), duration=duration)
