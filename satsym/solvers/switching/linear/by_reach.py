"""Linear motions: the optimum of all, from the convex set of ends that are reached, or why there is none."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.attempt import Exact, attempt
from satsym.solvers.switching.linear.first_arrival import arrivals
from satsym.solvers.switching.linear.from_costates import guessed
from satsym.solvers.switching.linear.linear_motion import LinearMotion, linear_motion
from satsym.solvers.switching.linear.reach import THERE, Priced, Reach, given_rows
from satsym.solvers.switching.linear.separation import Plane, plane, separates
from satsym.solvers.switching.structure import Guess

LATER = 1e-2
"""Share of a bound from below by which an exact arrival may be later and still be the first."""

STEP, MOST_DURATIONS = 1.1, 120
"""Ratio of durations of which one is chosen, and how many are looked at."""

TRIED = 4
"""Local minima of the cost over the duration that are tried, the cheapest first."""

HALVINGS = 12
"""Halvings of the time between two durations, until that with the least cost is known well enough."""

FINER = (1, 5)
"""How many times more steps than usual show a structure, one after the other."""


def optimum(instance: Instance, limits: Limits) -> Exact | None:
    """Exact arcs of least cost; ``None`` where the motion is not linear, or its cost no sum of time and effort."""
    motion = linear_motion(instance)
    if motion is None or not motion.priced or not len(given_rows(instance)):
        return None
    if instance.tf is not None:
        return _given(instance, motion, instance.tf - instance.t0, limits)
    if motion.rate <= 0.0:
        return None
    if motion.slope.any() or motion.weight.any():
        return _cheapest(instance, limits, _durations(instance, motion, limits))
    return _soonest(instance, motion, limits)


def unreachable(instance: Instance, limits: Limits) -> str | None:
    """Why no control brings a linear motion to its end in the given time; ``None`` where one may.

    Evidence is a plane with the end on one side and everything that is reached on the other.
    """
    motion, rows = linear_motion(instance), given_rows(instance)
    if motion is None or instance.tf is None or not len(rows):
        return None
    reach = Reach(instance, motion, instance.tf - instance.t0)
    limits.spend(reach.count)
    distance, costate = reach.separation()
    if distance <= THERE or not separates(instance, costate):
        return None
    names = instance.model.spec.state_names
    missed = reach.nearest_miss()
    misses = ", ".join(f"{names[i]} by {abs(value):.3g}" for i, value in zip(rows, missed, strict=True))
    return (
        f"no control within its bounds reaches the given end in {instance.tf - instance.t0:.10g}: the nearest "
        f"control misses {misses}, and {separated_by(instance, costate)}"
    )


def separated_by(instance: Instance, costate: Array) -> str:
    """What separates an end, in words."""
    names, largest = instance.model.spec.state_names, np.abs(costate).max()
    each = ", ".join(f"{names[i]}: {costate[i] / largest:.3g}" for i in given_rows(instance))
    return f"the final costates ({each}) separate this end from the reachable set"


def separating(instance: Instance) -> Plane | None:
    """A plane with the end of a linear motion on one side and everything that is reached on the other, if any."""
    motion = linear_motion(instance)
    if motion is None or instance.tf is None:
        return None
    distance, costate = Reach(instance, motion, instance.tf - instance.t0).separation()
    return plane(instance, costate) if distance > THERE else None


def _soonest(instance: Instance, motion: LinearMotion, limits: Limits) -> Exact | None:
    """The first arrival; a later one where nothing exact comes of that."""
    best: Exact | None = None
    for arrival in arrivals(instance, motion, limits):
        if best is not None and arrival.duration >= _duration(instance, best):
            break
        for costate in arrival.costates:
            reach = Reach(instance, motion, arrival.duration)
            first = guessed(instance, reach, costate * _factor(motion, reach, costate))
            exact = attempt(instance, first, limits)
            if exact is None:
                continue
            if best is None or _duration(instance, exact) < _duration(instance, best):
                best = exact
            if _duration(instance, best) <= arrival.duration * (1.0 + LATER):
                return best
    return best


def _duration(instance: Instance, exact: Exact) -> float:
    return exact.refined.at.end - instance.t0


def _factor(motion: LinearMotion, reach: Reach, costate: Array) -> float:
    """What makes costates those for which H vanishes at the end."""
    falling = motion.rate - reach.rate(costate)
    return motion.rate / abs(falling) if falling else 1.0


def _durations(instance: Instance, motion: LinearMotion, limits: Limits) -> list[tuple[Reach, Priced | None]]:
    """Durations of about the least cost, the cheapest first: local minima of what ends in them cost at least."""
    first = next(arrivals(instance, motion, limits), None)
    if first is None:
        return []
    found: list[tuple[float, Reach, Priced | None]] = []
    duration, cheapest = first.duration * (1.0 + LATER), float("inf")
    while motion.rate * duration < cheapest and len(found) < MOST_DURATIONS and not limits.expired:
        reach = Reach(instance, motion, duration)
        limits.spend(reach.count)
        priced = reach.minimum_cost() if reach.separation()[0] <= THERE else None
        cost = float("inf") if priced is None else priced.cost + motion.rate * duration
        found.append((cost, reach, priced))
        cheapest, duration = min(cheapest, cost), duration * STEP
    costs = [float("inf"), *(cost for cost, *_ in found), float("inf")]
    lowest = [k for k in range(len(found)) if costs[k] >= costs[k + 1] <= costs[k + 2] and np.isfinite(costs[k + 1])]
    ranked = sorted(lowest, key=lambda k: costs[k + 1])[:TRIED]
    return [
        _between(instance, motion, found[k - 1][1].duration if k else first.duration, *found[k][1:]) for k in ranked
    ]


def _between(
    instance: Instance, motion: LinearMotion, shorter: float, reach: Reach, priced: Priced | None
) -> tuple[Reach, Priced | None]:
    """The duration about one at which H vanishes at the end, and the costates there.

    Where costates jump between two durations, as they do where a control comes to decide on nothing, those between
    for which H vanishes are the extremal's.
    """
    assert priced is not None
    known = [(reach, priced, reach.rate(priced.costate))]
    low, high = (shorter, reach.duration) if known[0][2] > 0.0 else (reach.duration, reach.duration * STEP)
    for _ in range(HALVINGS):
        middle = Reach(instance, motion, (low + high) / 2.0)
        found = middle.minimum_cost() if middle.separation()[0] <= THERE else None
        if found is not None:
            known.append((middle, found, middle.rate(found.costate)))
        low, high = (middle.duration, high) if found is None or known[-1][2] < 0.0 else (low, middle.duration)
    falling, rising = ([one for one in known if (one[2] < 0.0) is sign] for sign in (True, False))
    if not falling or not rising:
        return known[-1][:2]
    before, after = max(falling, key=lambda one: one[0].duration), min(rising, key=lambda one: one[0].duration)
    fraction = before[2] / (before[2] - after[2])
    costate = before[1].costate + fraction * (after[1].costate - before[1].costate)
    return after[0], replace(after[1], costate=costate)


def _given(instance: Instance, motion: LinearMotion, duration: float, limits: Limits) -> Exact | None:
    """The least cost in a given time, with more steps where exact arcs do not come of fewer."""
    for finer in FINER:
        exact = _cheapest(instance, limits, [(Reach(instance, motion, duration, finer), None)])
        if exact is not None or limits.expired:
            return exact
    return None


def _cheapest(instance: Instance, limits: Limits, tried: list[tuple[Reach, Priced | None]]) -> Exact | None:
    """The cheapest of the exact arcs that these lead to."""
    found = [exact for first in _guesses(instance, limits, tried) if (exact := attempt(instance, first, limits))]
    return min(found, key=lambda exact: exact.trajectory.cost(instance), default=None)


def _guesses(instance: Instance, limits: Limits, tried: list[tuple[Reach, Priced | None]]) -> Iterator[Guess]:
    for reach, known in tried:
        limits.spend(reach.count)
        priced = known or (reach.minimum_cost() if reach.separation()[0] <= THERE else None)
        if priced is not None:
            yield guessed(instance, reach, priced.costate)
