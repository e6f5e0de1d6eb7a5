"""What exact arcs are compared with, kind by kind, and what comes of it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from satsym.instance import Instance
from satsym.solution import Check, Competitors, Kind, Solution
from satsym.solvers.certificate.competitors.comparison import COST_MARGIN, UNCOMPARED, margin
from satsym.solvers.certificate.competitors.searched import kinds, searched
from satsym.solvers.certificate.switching.needles import needles
from satsym.solvers.certificate.switching.shorter import shorter
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.linear.linear_motion import linear_motion

COARSE = {Kind.NEIGHBOURS: 1e-11, Kind.DURATIONS: 1e-6}
"""Relative difference of costs that is none: where it is not ``COST_MARGIN``."""


@dataclass(frozen=True)
class Comparison:
    """What competitors came to."""

    checks: tuple[Check, ...] = ()
    """One for each kind, by how much the cheapest undercuts the solution; and one for each kind for which time was
    up."""
    competitors: tuple[Competitors, ...] = ()
    not_checked: tuple[Kind, ...] = ()
    """As in :class:`satsym.solution.Certificate`."""
    better: Solution | None = None
    """The cheapest extremal that costs less, where that is known."""


def allowed(instance: Instance) -> list[Kind]:
    """Kinds of competitors that a problem has; neighbours are varied without path constraints only."""
    spec = instance.model.spec
    return kinds(instance) if spec.throttled or spec.in_arcs else [Kind.NEIGHBOURS, *kinds(instance)]


def compared(solution: Solution, limits: Limits, seed: int = 0) -> Comparison:
    """Compare a solution with all kinds; what the clock ends is not checked."""
    by_search = searched(solution, limits, seed)
    sources: list[Callable[[], Iterable[Competitors | None]]] = [lambda: by_search.competitors]
    if Kind.NEIGHBOURS in allowed(solution.instance):
        sources += [lambda: [needles(solution, limits)], lambda: [shorter(solution, limits)]]
    found: dict[Kind, Competitors] = {}
    with np.errstate(all="ignore"):
        for source in sources:
            for one in () if limits.late else source():
                if one is not None and not limits.late:
                    found[one.kind] = _both(found[one.kind], one) if one.kind in found else one
    possible = allowed(solution.instance)
    missing = tuple(kind for kind in possible if kind not in found)
    checks = [_check(solution, one) for one in found.values()]
    if limits.late:
        checks += [Check(f"time was up before: {kind.value}", 1.0, 0.0) for kind in missing]
    competitors = tuple(found[kind] for kind in possible if kind in found)
    unsolved = _unsolved(solution.instance, competitors)
    if unsolved and len(unsolved) == len(competitors):
        checks.append(Check(UNCOMPARED, 1.0, 0.0))
    return Comparison(tuple(checks), competitors, missing + unsolved, by_search.better)


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
