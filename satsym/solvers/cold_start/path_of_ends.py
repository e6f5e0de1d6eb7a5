"""Cold starts from easier problems: a shorter duration that is lengthened, or angles that end where they like."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from satsym.solvers.cold_start.origin import Origin
from satsym.solvers.collocation.arclength import followed
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.scaling import final_argument, straight
from satsym.solvers.collocation.sqp import descended
from satsym.solvers.iteration import Limits


def along_ends(problem: TwoPoint, limits: Limits, solve: Callable[[TwoPoint], Attempt]) -> Attempt | None:
    """Minimise with the final angles free, and move these to where they should be; ``None`` where all are free.

    Parameters
    ----------
    problem
        Without bounds, with a given final time.
    solve
        How the problem with free angles is minimised from a cold start.
    """
    spec, final = problem.instance.model.spec, problem.instance.final
    angles = [i for i, state in enumerate(spec.states) if state.kind == "angle" and state.symbol in final]
    if problem.free_time or not angles:
        return None
    names = [spec.state_names[i] for i in angles]
    free = solve(ending(problem, dict.fromkeys(names)))
    if not free.minimum:
        return free
    ends = free.curve.nodes[angles, -1] * problem.scale.state[angles]
    wanted = straight(problem)[angles, 1] * problem.scale.state[angles]

    def at(fraction: float) -> TwoPoint:
        if fraction == 1.0:
            return problem
        between = ends + (wanted - ends) * fraction
        return ending(problem, dict(zip(names, between.tolist(), strict=True)))

    found = followed(at, free.curve, limits, Origin.ENDS.value)
    return replace(found, iterations=free.iterations + found.iterations)


def ending(problem: TwoPoint, ends: dict[str, float | None]) -> TwoPoint:
    """The same problem in the same units with other final values.

    Parameters
    ----------
    ends
        New final values by name; ``None``: free.
    """
    changed = {**problem.instance.final, **ends}
    final = {name: value for name, value in changed.items() if value is not None}
    instance = replace(problem.instance, final=final)
    return replace(problem, instance=instance, final=final_argument(instance))


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
    solve
        How the shorter problem is minimised from a cold start.
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
