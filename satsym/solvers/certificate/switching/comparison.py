"""What exact arcs are compared with, kind by kind, and what comes of it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

import numpy as np

from satsym.instance import Instance
from satsym.methods import BOUNDARY_ARCS
from satsym.solution import Check, Competitors, Kind, Solution
from satsym.solvers.certificate.comparison import COST_MARGIN, UNCOMPARED, going_round, margin
from satsym.solvers.certificate.switching import competitors as switching_competitors
from satsym.solvers.certificate.switching.needles import needles
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.linear.linear_motion import linear_motion

COARSE = {Kind.NEIGHBOURS: 1e-11, Kind.DURATIONS: 1e-6}
"""Relative difference of costs that is none: where it is not ``COST_MARGIN``."""

DRAWN, BESIDE = 20012, (0.75, 1.3)
"""Seed of other starts where vectors are throttled, and other durations as shares of the solution's."""

FURTHER = 8
"""Starts besides where vectors are throttled, as long as none leads to an extremal."""

MEETING = 20013
"""Seed of costates that are drawn."""

WORK = 400_000
"""Columns that smoothing may take."""


@dataclass(frozen=True)
class Comparison:
    """What competitors came to."""

    checks: tuple[Check, ...] = ()
    """One for each kind, by how much the cheapest undercuts the solution; and one for each kind for which time was
    up."""
    competitors: tuple[Competitors, ...] = ()
    not_checked: tuple[Kind, ...] = ()
    """As in :class:`satsym.solution.Certificate`."""


def allowed(instance: Instance, bounded: bool = False) -> list[Kind]:
    """Kinds of competitors that a problem has; where path constraints decided, with those of these."""
    durations, around = [Kind.DURATIONS] if instance.tf is None else [], going_round(instance)
    if instance.model.spec.throttled:
        return [*(durations or [Kind.STARTS]), *around]
    if bounded:
        return [Kind.NEIGHBOURS, Kind.SIGNS, Kind.ARCS, *durations, *around]
    return [Kind.NEIGHBOURS, Kind.SIGNS, *durations, Kind.STARTS, *around]


def compared(solution: Solution, limits: Limits, seed: int = 0) -> Comparison:
    """Compare a solution with all kinds; what the clock ends is not checked."""
    sources: tuple[Callable[[], Iterable[Competitors | None]], ...] = (
        lambda: [needles(solution, limits)],
        lambda: switching_competitors.compared(solution, limits),
        lambda: [_smoothed(solution, limits)],
        lambda: [_meeting(solution, limits)],
    )
    bounded = solution.method == BOUNDARY_ARCS
    if bounded:  # others know nothing of path constraints
        sources = (lambda: [_other_boundaries(solution, limits, seed)],)
    if solution.instance.model.spec.throttled:
        sources = (lambda: [_drawn(solution, limits)], lambda: [_around(solution, limits)])
    found: dict[Kind, Competitors] = {}
    with np.errstate(all="ignore"):
        for source in sources:
            for one in () if limits.late else source():
                if one is not None and not limits.late:
                    found[one.kind] = _both(found[one.kind], one) if one.kind in found else one
    kinds = allowed(solution.instance, bounded)
    missing = tuple(kind for kind in kinds if kind not in found)
    checks = [_check(solution, one) for one in found.values()]
    if limits.late:
        checks += [Check(f"time was up before: {kind.value}", 1.0, 0.0) for kind in missing]
    competitors = tuple(found[kind] for kind in kinds if kind in found)
    unsolved = _unsolved(solution.instance, competitors)
    if unsolved and len(unsolved) == len(competitors):
        checks.append(Check(UNCOMPARED, 1.0, 0.0))
    return Comparison(tuple(checks), competitors, missing + unsolved)


def _unsolved(instance: Instance, competitors: Iterable[Competitors]) -> tuple[Kind, ...]:
    """Kinds of which nothing arrived: of a linear motion nothing does then, of others something else may."""
    none = tuple(one.kind for one in competitors if not one.solved)
    return none if none and linear_motion(instance) is None else ()


def _check(solution: Solution, one: Competitors) -> Check:
    excess = margin(one.cheapest, solution.objective, coarse=COARSE.get(one.kind, COST_MARGIN)) if one.solved else 0.0
    return Check(f"cheaper by: {one.kind.value}", max(0.0, -excess), COST_MARGIN)


def _both(one: Competitors, other: Competitors) -> Competitors:
    """Two sets of a kind as one."""
    cheapest = [each.cheapest for each in (one, other) if each.solved]
    return Competitors(
        one.kind, one.tried + other.tried, one.solved + other.solved, min(cheapest, default=float("nan"))
    )


def _drawn(solution: Solution, limits: Limits) -> Competitors:
    """Extremals with throttled vectors from other starts, or in other durations; more of these where none is found."""
    from satsym.solvers.switching.cold_start import by_throttle

    instance, rng = solution.instance, np.random.default_rng(DRAWN)
    found = list(by_throttle.others(instance, float(solution.times[-1]) - instance.t0, limits, rng, BESIDE, FURTHER))
    costs = [exact.trajectory.cost(instance) for exact in found if exact is not None]
    return Competitors(allowed(instance)[0], len(found), len(costs), min(costs, default=float("nan")))


def _around(solution: Solution, limits: Limits) -> Competitors | None:
    """Extremals with throttled vectors that go round more or less often; ``None`` where it is not known how."""
    from satsym.solvers.switching.cold_start.by_turns import other_turns

    found = list(other_turns(solution.instance, solution.x, limits))
    costs = [exact.trajectory.cost(solution.instance) for exact in found if exact is not None]
    return Competitors(Kind.REVOLUTIONS, len(found), len(costs), min(costs, default=float("nan"))) if found else None


def _meeting(solution: Solution, limits: Limits) -> Competitors | None:
    """Extremals to which those lead that are drawn from both ends; ``None`` where none may cost less."""
    from satsym.solvers.switching.by_meetings import meetings

    found = list(meetings(solution, MEETING, limits))
    costs = [one.trajectory.cost(solution.instance) for one in found if one is not None]
    return Competitors(Kind.STARTS, len(found), len(costs), min(costs, default=float("nan"))) if found else None


def _other_boundaries(solution: Solution, limits: Limits, seed: int) -> Competitors | None:
    """Extremals to which paths within path constraints lead that are drawn; ``None`` where time is up before."""
    from satsym.solvers.constrained.levels.solving import others

    tried, costs, interrupted = others(solution, seed + 1, limits.deadline)
    return None if interrupted or not costs else Competitors(Kind.ARCS, tried, len(costs), min(costs))


def _smoothed(solution: Solution, limits: Limits) -> Competitors | None:
    """Extremals that smoothing leads to, and controls saturated at a corner, where nothing is given at the end."""
    from satsym.solvers.switching.solving import others

    instance = solution.instance
    moderate = replace(limits, work=limits.meter.spent + WORK)
    found = others(instance, float(solution.times[-1]) - instance.t0, moderate)
    if not found:
        return None
    costs = [float(exact.trajectory.cost(instance)) for exact in found]
    return Competitors(Kind.STARTS, len(costs), len(costs), min(costs))
