"""A cold start for angles that are hard to arrive at: leave them free, then move them to where they should end."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from satsym.solvers.cold_start.origin import Origin
from satsym.solvers.collocation.arclength import followed
from satsym.solvers.collocation.attempt import Attempt
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.scaling import final_argument, straight
from satsym.solvers.iteration import Limits


def along_ends(problem: TwoPoint, limits: Limits, solve: Callable[[TwoPoint], Attempt]) -> Attempt | None:
    """Minimise with the final angles free, and move these to where they should be; ``None`` where all are free.

    Parameters
    ----------
    problem
        Without bounds, with a given final time.
    limits
        When to stop.
    solve
        How the problem with free angles is minimised from nothing.
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

    def at(share: float) -> TwoPoint:
        if share == 1.0:
            return problem
        between = ends + (wanted - ends) * share
        return ending(problem, dict(zip(names, between.tolist(), strict=True)))

    found = followed(at, free.curve, limits, Origin.ENDS.value)
    return replace(found, iterations=free.iterations + found.iterations)


def ending(problem: TwoPoint, ends: dict[str, float | None]) -> TwoPoint:
    """The same problem in the same units with other final values.

    Parameters
    ----------
    problem
        The problem.
    ends
        New final values by name; ``None``: free.
    """
    changed = {**problem.instance.final, **ends}
    final = {name: value for name, value in changed.items() if value is not None}
    instance = replace(problem.instance, final=final)
    return replace(problem, instance=instance, final=final_argument(instance))
