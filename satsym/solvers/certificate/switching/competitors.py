"""Competitors of exact arcs: motions that arrive with other structures, in other durations, from other starts.

None of them is where a solver starts from: what is seeded here is drawn anew, and of a linear motion's durations those
are looked at that lie on the way to the solution's.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

import numpy as np

from satsym.arrays import Array
from satsym.solution import Competitors, Kind, Solution
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.cold_start import scouts
from satsym.solvers.switching.cold_start.plans import Plans, Scout, seeded, together
from satsym.solvers.switching.cold_start.scouts import Target
from satsym.solvers.switching.linear.linear_motion import LinearMotion, linear_motion
from satsym.solvers.switching.linear.reach import THERE, Reach, given_rows

SEED = 20011
"""Of what is drawn."""

MORE = 2
"""Switches that another structure may have more than the solution's."""

STRUCTURES, ARRIVALS, STARTS = 10, 6, 6
"""Plans of each kind that are drawn at most, and no fewer than two."""

WORK = 250_000
"""Columns that all plans together may take, as far as can be told beforehand."""

ROUNDS = 18
"""Corrections of their arcs."""

SHORTER = 12
"""Shorter durations at which it is looked at what a linear motion reaches."""

POLISHED = 2
"""Of each kind."""


def compared(solution: Solution, limits: Limits) -> list[Competitors]:
    """What other structures, durations and starts come to.

    Parameters
    ----------
    limits
        Work is spent there; nothing is given for what the clock ends.
    """
    instance = solution.instance
    if instance.model.spec.multipliers:
        return []
    found = _drawn(solution, limits)
    motion = linear_motion(instance)
    if instance.tf is None and motion is not None and motion.priced and motion.rate > 0.0 and len(given_rows(instance)):
        found = [one for one in found if one.kind is not Kind.DURATIONS]
        found.append(_shorter(solution, motion, limits))
    return found


def _drawn(solution: Solution, limits: Limits) -> list[Competitors]:
    """Plans that are drawn, all at once."""
    instance, rng = solution.instance, np.random.default_rng(SEED)
    lasting = float(solution.times[-1]) - instance.t0
    switches = [len(own) + MORE for own in solution.switching_times]
    fraction = min(1.0, WORK / _work(switches))
    counts = [max(2, int(fraction * most)) for most in (STRUCTURES, ARRIVALS if instance.tf is None else 0, STARTS)]
    parts: list[tuple[Kind, Plans, Array]] = []
    free = instance.tf is None
    for kind, count, low, high in zip(
        (Kind.SIGNS, Kind.DURATIONS, Kind.STARTS), counts, (0.3, 0.2, 0.05), (1.2, 0.97, 2.0), strict=True
    ):
        if kind is Kind.DURATIONS and not free:
            continue
        durations = lasting * (rng.uniform(low, high, count) if free else np.ones(count))
        ends = np.full(count, np.nan) if free and kind is not Kind.DURATIONS else instance.t0 + durations
        most = switches if kind is not Kind.STARTS else [max(switches) + 1] * len(switches)
        parts.append((kind, seeded(instance, most, durations, rng, opposite=kind is Kind.STARTS), ends))
    kinds = np.concatenate([[kind.value] * len(ends) for kind, _, ends in parts])
    ends = np.concatenate([ends for *_, ends in parts])
    sizes = np.maximum(np.abs(solution.x).max(axis=1), 1e-300)
    target = scouts.Target(instance, sizes, ends)
    found = scouts.scouted(target, together(*(plans for _, plans, _ in parts)), limits, ROUNDS)
    by_kind = {kind: [one for one in found if kinds[one.number] == kind.value] for kind, *_ in parts}
    exact = _exact(solution.objective, by_kind.values(), target, limits)
    return [Competitors(kind, len(own), *_cheapest(solution, by_kind[kind], exact)) for kind, _, own in parts]


def _work(switches: list[int]) -> float:
    """Columns that all plans take, roughly."""
    arcs = sum(switches) + 1
    return float((STRUCTURES + ARRIVALS + STARTS) * arcs * (arcs + 1) * scouts.FEWEST * ROUNDS)


def _exact(cost: float, found: Iterable[list[Scout]], target: Target, limits: Limits) -> dict[int, float]:
    """Exact costs by the number of the plan: of the cheapest of each kind that seem to undercut the solution."""
    chosen = [one for own in found for one in [scout for scout in own if scout.cost < cost][:POLISHED]]
    costs = {one.number: float("nan") for one in chosen}
    for one in chosen:
        for exact in tried(partial(scouts.exactly, target.of([one.number]), [one], limits)) or []:
            costs[exact.number] = exact.cost
    return costs


def _cheapest(solution: Solution, found: list[Scout], exact: dict[int, float]) -> tuple[int, float]:
    """How many arrive, and the least of their costs, exact where that matters.

    One that seemed to undercut the solution and did not arrive when looked at closely is none.
    """
    costs = [exact.get(one.number, one.cost if one.cost >= solution.objective else float("nan")) for one in found]
    arrived = [cost for cost in costs if np.isfinite(cost)]
    return len(arrived), min(arrived, default=float("nan"))


def _shorter(solution: Solution, motion: LinearMotion, limits: Limits) -> Competitors:
    """Shorter durations of a linear motion, from which nothing is left out that is reached in them."""
    instance, rng = solution.instance, np.random.default_rng(SEED + 1)
    lasting = float(solution.times[-1]) - instance.t0
    edges = np.linspace(0.0, 1.0, SHORTER + 1)
    fractions = np.append(rng.uniform(edges[:-1], edges[1:])[:-1], 1.0 - 10.0 ** rng.uniform(-3.0, -2.0))
    costs = []
    for fraction in fractions.tolist():
        reach = Reach(instance, motion, fraction * lasting)
        limits.spend(reach.count)
        if reach.separation()[0] > THERE:
            continue
        priced = reach.minimum_cost() if motion.weight.any() or motion.slope.any() else None
        costs.append(motion.rate * reach.duration + (priced.cost if priced is not None else 0.0))
    return Competitors(Kind.DURATIONS, len(fractions), len(costs), min(costs, default=float("nan")))
