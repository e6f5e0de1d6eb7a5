"""Linear motions: the global optimum from the convex reachable set, or the reason why the end cannot be reached."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.attempt import Exact, attempt
from satsym.solvers.switching.cold_start.recognition import Sample, guess
from satsym.solvers.switching.linear.linear_motion import LinearMotion, linear_motion
from satsym.solvers.switching.linear.reach import THERE, Priced, Reach, cheapest, given_rows, goal, steps
from satsym.solvers.switching.linear.separation import Plane, plane, separates
from satsym.solvers.switching.structure import Guess

LATER = 1e-2
"""Relative delay of an exact arrival after the lower bound up to which it counts as the first."""

STEP, MOST_DURATIONS = 1.1, 120
"""Ratio of successive durations at which costs are compared, and maximum number of such durations."""

TRIED = 4
"""Maximum number of local minima of the cost over the duration that are tried, the cheapest first."""

HALVINGS = 12
"""Number of bisections between two durations, to find the one for which H vanishes at the final time."""

FINER = (1, 5)
"""Factors of the number of steps with which a structure is looked for, one after the other."""

PLANES = 200
"""Maximum number of separating planes until an arrival is found."""

HORIZON = 2**17
"""Maximum number of steps for which a plane is followed. If it still separates the end from the reachable set, it is
assumed to do so for ever."""

BEFORE = (3e-3, 3e-4, 3e-2)
"""Fractions of the minimum time by which durations are shorter than it, to find its final costates. At the minimum time
itself the distance from the reachable set vanishes, so that it does not show the costates."""

PRECISE = 1e-8
"""Relative error of the distance between the separating hyperplane and the reachable set. The relative error of the
hyperplane's direction is the square root of it."""

BEYOND_ARRIVAL, FARTHER, TIRED = 1e-3, 1.5, 16
"""First fraction of an arrival time by which the search goes beyond it if no exact arcs are found; factor by which this
fraction grows at each repetition; maximum number of repetitions."""

UNDECIDED = 2e-3
"""Deviation of a switching function from its switching value, relative to its magnitude, below which the control counts
as undetermined along the whole motion."""

RANK = 1e-7
"""Relative singular value below which undetermined controls count as having no effect."""


def optimum(instance: Instance, limits: Limits) -> Exact | None:
    """Return exact arcs of minimum cost; ``None`` if the motion is not linear or its cost not time plus effort."""
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
    """Return why no control brings a linear motion to its end in the given time; ``None`` if one may exist.

    The evidence is a plane that separates the end from the reachable set.
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
        f"no control within its bounds reaches the given final state in {instance.tf - instance.t0:.10g}: the nearest "
        f"control misses {misses}, and {separated_by(instance, costate)}"
    )


def separated_by(instance: Instance, costate: Array) -> str:
    """Return a text on the costates that separate an end from the reachable set."""
    names, largest = instance.model.spec.state_names, np.abs(costate).max()
    each = ", ".join(f"{names[i]}: {costate[i] / largest:.3g}" for i in given_rows(instance))
    return f"the final costates ({each}) separate this final state from the reachable set"


def separating(instance: Instance) -> Plane | None:
    """Return a plane that separates the end of a linear motion from its reachable set, or ``None`` if there is none."""
    motion = linear_motion(instance)
    if motion is None or instance.tf is None:
        return None
    distance, costate = Reach(instance, motion, instance.tf - instance.t0).separation()
    return plane(instance, costate) if distance > THERE else None


def _soonest(instance: Instance, motion: LinearMotion, limits: Limits) -> Exact | None:
    """Return exact arcs of the first arrival at the end, or of a later one if the first does not lead to any."""
    best: Exact | None = None
    for arrival in _arrivals(instance, motion, limits):
        if best is not None and arrival.duration >= _duration(instance, best):
            break
        for costate in arrival.costates:
            reach = Reach(instance, motion, arrival.duration)
            first = _guessed(instance, reach, costate * _factor(motion, reach, costate))
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
    """Return the factor that scales costates such that H vanishes at the final time."""
    falling = motion.rate - reach.rate(costate)
    return motion.rate / abs(falling) if falling else 1.0


def _durations(instance: Instance, motion: LinearMotion, limits: Limits) -> list[tuple[Reach, Priced | None]]:
    """Return durations of about minimum cost, the cheapest first: local minima of the cost over the duration."""
    first = next(_arrivals(instance, motion, limits), None)
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
    """Return the duration near a given one for which H vanishes at the final time, and its costates.

    If costates jump between two durations, as they do where a control becomes undetermined, the interpolated costates
    for which H vanishes are those of the extremal.
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
    """Return exact arcs of minimum cost in a given time, found with more steps if necessary; otherwise ``None``."""
    for finer in FINER:
        exact = _cheapest(instance, limits, [(Reach(instance, motion, duration, finer), None)])
        if exact is not None or limits.expired:
            return exact
    return None


def _cheapest(instance: Instance, limits: Limits, tried: list[tuple[Reach, Priced | None]]) -> Exact | None:
    """Return the cheapest of the exact arcs to which several durations lead, or ``None``."""
    found = [exact for first in _guesses(instance, limits, tried) if (exact := attempt(instance, first, limits))]
    return min(found, key=lambda exact: exact.trajectory.cost(instance), default=None)


def _guesses(instance: Instance, limits: Limits, tried: list[tuple[Reach, Priced | None]]) -> Iterator[Guess]:
    for reach, known in tried:
        limits.spend(reach.count)
        priced = known or (reach.minimum_cost() if reach.separation()[0] <= THERE else None)
        if priced is not None:
            yield _guessed(instance, reach, priced.costate)


@dataclass(frozen=True)
class Arrival:
    """A time in which the end may first be reached, and its final costates."""

    duration: float
    """Duration from the start; nothing arrives in less than the first such duration."""
    costates: tuple[Array, ...]
    """Final costates of all states, shape (n,), up to a factor, for several times shortly before the arrival."""


def _arrivals(instance: Instance, motion: LinearMotion, limits: Limits) -> Iterator[Arrival]:
    """Yield durations in which a linear motion may first reach its end, the shortest first, none of them omitted.

    A final costate defines a hyperplane. As long as the reachable set lies on one side of it and the given end on the
    other, the duration is too short. From such a duration to the first one at which the plane no longer separates them,
    the end cannot be reached; there another plane is determined (Neustadt, Synthesizing time optimal control systems,
    Journal of Mathematical Analysis and Applications 1, 1960; Eaton, An iterative solution to time-optimal control,
    ibid. 5, 1962). Nothing is yielded if no duration is found.
    """
    rows, n = given_rows(instance), len(instance.initial)
    apart = np.array(instance.initial)[rows] - goal(instance, rows, instance.t0)
    size = np.maximum(np.abs(np.array(instance.initial)[rows]), np.abs(goal(instance, rows, instance.t0)))
    costate: Array = np.zeros(n)
    costate[rows] = apart / np.where(size > 0.0, size, 1.0) ** 2
    duration = _beyond(instance, motion, costate, 0.0, _scale(instance, motion))
    further, tired = BEYOND_ARRIVAL, 0
    for _ in range(PLANES):
        if duration is None or limits.expired or tired > TIRED:
            return
        reach = Reach(instance, motion, duration)
        limits.spend(reach.count)
        distance, costate = reach.separation()
        later = _beyond(instance, motion, costate, duration, duration) if distance > THERE else duration
        if later is not None and later <= duration * (1.0 + THERE):
            before = (Reach(instance, motion, duration * (1.0 - fraction)).separation(PRECISE) for fraction in BEFORE)
            yield Arrival(duration, tuple(costate for distance, costate in before if distance > 0.0))
            later, further, tired = duration * (1.0 + further), further * FARTHER, tired + 1
        duration = later


def _scale(instance: Instance, motion: LinearMotion) -> float:
    """Return an initial duration, in which full controls change the state by as much as required."""
    rates = motion.states @ np.array(instance.initial) + motion.drift
    rates = np.abs(rates) + np.abs(motion.controls) @ np.maximum(np.abs(instance.lower), np.abs(instance.upper))
    rows = given_rows(instance)
    apart = np.abs(np.array(instance.initial)[rows] - goal(instance, rows, instance.t0))
    found = [float(a / b) for a, b in zip(apart, rates[rows], strict=True) if a > 0.0 and b > 0.0]
    quickest = float(np.abs(np.linalg.eigvals(motion.states)).max(initial=0.0))
    return max(found, default=1.0 / quickest if quickest > 0.0 else 1.0)


def _beyond(instance: Instance, motion: LinearMotion, costate: Array, after: float, scale: float) -> float | None:
    """Return the first duration after a given one at which a plane does not separate the end, or ``None``.

    The plane separates the end from the reachable set at shorter durations.
    """
    length = scale / steps(motion, scale)
    rows = given_rows(instance)
    low, high = np.array(instance.lower), np.array(instance.upper)
    count = max(2 * int(np.ceil(after / length)), 512)
    first = int(np.round(after / length))
    while count <= HORIZON:
        _, acting, drift = motion.step(length)
        sides = costate @ motion.powers(length, count)
        pushed = sides[:-1] @ acting
        gained = sides[:-1] @ drift + np.minimum(pushed * low, pushed * high).sum(axis=1)
        values = sides @ np.array(instance.initial) + np.append(0.0, np.cumsum(gained))
        if "reference" in instance.final.values():
            goals = np.array([goal(instance, rows, instance.t0 + length * k) for k in range(first, count + 1)])
            values[first:] -= goals @ costate[rows]
        else:
            values -= float(costate[rows] @ goal(instance, rows, instance.t0))
        past = np.flatnonzero(~(values[first:] > 0.0))
        if len(past):
            k = first + int(past[0])
            if not np.isfinite(values[k]):
                return None
            if k == first:
                return after
            fraction = values[k - 1] / (values[k - 1] - values[k])
            found = length * (k - 1 + float(fraction))
            if k < 20 and after == 0.0 and found < scale:
                return _beyond(instance, motion, costate, 0.0, found)
            return found
        first, count = count, 2 * count
    return None


def _guessed(instance: Instance, reach: Reach, costate: Array) -> Guess:
    """Return the structure that minimises H for given final costates, shape (n,).

    A control whose switching function stays at its switching value along the whole motion is undetermined. It is given
    arcs that bring the motion to its end with minimum effort, weighted such that few arcs suffice.
    """
    open_ = undecided(reach, costate)
    if open_.any():
        costate = _exactly(reach, costate, open_)
    sigma, weight = reach.switching(costate)
    if open_.any():
        sigma, weight = _with_least_effort(reach, sigma, weight, open_)
    times = np.linspace(instance.t0, instance.t0 + reach.duration, reach.count + 1)
    z = np.repeat(np.concatenate([instance.initial, reach.powers[-1].T @ costate])[:, None], len(times), axis=1)
    return guess(instance, Sample(times, z, np.zeros_like(sigma), sigma, weight))


def undecided(reach: Reach, costate: Array) -> NDArray[np.bool_]:
    """Return the controls whose switching functions stay at their switching values, shape (m,)."""
    sigma, weight = reach.switching(costate)
    room = np.array(reach.instance.upper) - np.array(reach.instance.lower)
    acting = (np.abs(sigma) + weight).max(axis=1) * room
    off = np.abs(np.abs(sigma) - weight).max(axis=1) * room
    size = np.where(weight[:, 0] > 0.0, acting, acting.max(initial=0.0))
    return np.asarray((off <= UNDECIDED * size) & (room > 0.0))


def _exactly(reach: Reach, costate: Array, open_: NDArray[np.bool_]) -> Array:
    """Return costates near the given ones for which undetermined controls are exactly undetermined."""
    sigma, weight = reach.switching(costate)
    by_costate = (reach.powers[::-1] @ reach.motion.controls)[:, reach.rows][:, :, open_].transpose(2, 0, 1)
    missing = (np.sign(sigma) * weight - sigma)[open_].ravel()
    found = costate.copy()
    found[reach.rows] += np.linalg.lstsq(by_costate.reshape(len(missing), -1), missing, rcond=RANK)[0]
    return found


def _with_least_effort(reach: Reach, sigma: Array, weight: Array, open_: NDArray[np.bool_]) -> tuple[Array, Array]:
    """Return switching functions and weights of |u| changed such that undetermined controls have minimum effort."""
    m, count = len(sigma), reach.count
    levels = reach.levels.reshape(3, m, count)
    middle = (sigma[:, 1:] + sigma[:, :-1]) / 2.0
    values = np.array([middle * u + weight[:, :1] * np.abs(u) for u in levels])
    decided = np.where(open_[:, None], 0.0, np.take_along_axis(levels, values.argmin(axis=0)[None], 0)[0])
    towards, effects, base = reach.round
    base = base + effects @ decided.ravel()
    own = effects.reshape(-1, m, count)[:, open_].reshape(len(base), -1)
    axes, sizes, _ = np.linalg.svd(own, full_matrices=False)
    axes = axes[:, sizes > RANK * sizes[0]]
    side = np.where(weight[:, 0] > 0.0, np.sign(middle[:, 0]), 0.0)  # |u| may not cost more on the other side
    choices = levels.copy()
    choices[0, side < 0.0], choices[2, side > 0.0] = levels[1, side < 0.0], levels[1, side > 0.0]
    offered = choices[:, open_].reshape(3, -1)
    effort = np.exp(np.linspace(0.0, 1.0, 2 * count + 1))
    prices = np.tile(effort[1::2], int(open_.sum())) * np.abs(offered) * (reach.duration / count)
    found = cheapest(axes.T @ own, axes.T @ base, offered, prices)
    if found is None:
        return sigma, weight
    pushing, side = reach.pushing(reach.in_full(towards.T @ (axes @ found[1]))), side[:, None]
    pushing = np.where(side < 0.0, np.minimum(pushing, 0.0), np.where(side > 0.0, np.maximum(pushing, 0.0), pushing))
    return np.where(open_[:, None], pushing, sigma), np.where(open_[:, None], effort[::2], weight)
