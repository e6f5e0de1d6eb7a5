"""Extremals from costates that are drawn: motions that obey the minimum principle and come near to the end in time.

Where weak controls move something by many swings, no motion of least effort and no smoothed one shows when to switch,
and switching times that are drawn seldom arrive. Costates push at the right times by themselves; many are followed at
once, and further ones are drawn about those that come nearest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers.iteration import Limits
from satsym.solvers.spare_time import longest
from satsym.solvers.switching.attempt import Exact, attempt, given
from satsym.solvers.switching.cold_start.minimum_effort import first_duration
from satsym.solvers.switching.cold_start.recognition import Sample, guess
from satsym.solvers.switching.cold_start.scouts import Target
from satsym.solvers.switching.magnitudes import resting
from satsym.solvers.switching.throttled import signs

SEED = 11
"""Of what is drawn where nothing is known."""

DRAWN, CHILDREN, ROUNDS = 1024, 1024, (0.1, 0.02, 4e-3)
"""Costates that are drawn at first, how many about the nearest later, and relative changes by which these differ."""

LONGEST, STEPS = 60.0, 1200
"""Times the motion's own scale for which they are followed, and Runge-Kutta steps."""

PARENTS, LOOKED, LAYERS, LONGER = 6, 100, 24, 1.25
"""Nearest ones of each layer of durations, of how many, layers, and the ratio of durations of one to the one before."""

WITHIN, FURTHER = 240, 2.4
"""Steps where an extremal is known, and so many times its duration at most that others may last."""

CLOSE, TRIED = 0.1, 12
"""Largest miss, relative to the sizes of states, of what is made exact, and how many are at most: the soonest first."""

NEAR, MANY = 0.2, 24
"""The same where an extremal is known: others may be so unstable that none of those that are drawn comes close.
"""

ROUGHLY, SAME = 50, 0.02
"""Parts of the longest duration within which the closest is first; difference of directions, and relative one of
arrivals, of extremals that are one."""

CLEARLY, LATE = 0.9, 2
"""Share of the known duration before which what arrives is another extremal, and how many are tried that arrive later:
most of these lead to the known one.
"""


@dataclass(frozen=True, eq=False)
class _Drawn:
    """Costates at the start, how near to the end each comes in each layer of durations, and when."""

    costates: Array
    """Shape (n, S)."""
    miss: Array
    arrival: NDArray[np.int64]
    """Shapes (LAYERS, S): the least miss, and the step after which it is."""

    def joined(self, other: _Drawn) -> _Drawn:
        """With others."""
        pairs = ((getattr(self, name), getattr(other, name)) for name in ("costates", "miss", "arrival"))
        return _Drawn(*(np.concatenate(pair, axis=1) for pair in pairs))

    def nearest(self, sizes: Array, apart: float) -> Array:
        """Costates of the nearest of each layer whose directions are that far from each other's, shape (n, P)."""
        scaled = _units(self.costates, sizes)
        kept = []
        for layer in self.miss:
            own: list[int] = []
            for k in np.argsort(layer)[:LOOKED].tolist():
                if all(np.linalg.norm(scaled[:, k] - scaled[:, one]) > apart for one in own):
                    own.append(k)
                if len(own) == PARENTS:
                    break
            kept += own
        return np.asarray(self.costates[:, np.unique(np.array(kept, dtype=int))])


def soonest(instance: Instance, limits: Limits) -> Exact | None:
    """The cheapest extremal of a free duration that is found so; ``None`` where none is.

    Only where no magnitude of a control costs anything, and something else does from the start: costates are then known
    but for their direction.
    """
    if not _applies(instance):
        return None
    h = LONGEST * first_duration(instance) / STEPS
    return _exact(_Search(_target(instance), h, STEPS, limits), np.random.default_rng(SEED))


def sooner(solution: Solution, seed: int, limits: Limits) -> Exact | None:
    """The cheapest extremal beside a known one whose duration is free; ``None`` where none is found.

    Parameters
    ----------
    seed
        Of what is drawn.
    """
    instance = solution.instance
    if not _applies(instance) or not instance.model.spec.autonomous:
        return None
    lasting = float(solution.times[-1]) - instance.t0
    h = min(longest(solution), FURTHER * lasting) / WITHIN
    return _exact(_Search(_target(instance), h, WITHIN, limits, NEAR, MANY, lasting / h), np.random.default_rng(seed))


def _applies(instance: Instance) -> bool:
    spec = instance.model.spec
    return instance.tf is None and bool(instance.final) and not spec.multipliers and not any(resting(instance))


def _target(instance: Instance) -> Target:
    sizes = given(instance)
    sizes = np.where(sizes > 0.0, sizes, max(float(sizes.max()), 1e-300))
    return Target(instance, sizes, np.full(1, np.nan))


@dataclass(frozen=True, eq=False)
class _Search:
    """What is followed for how long."""

    target: Target
    h: float
    steps: int
    limits: Limits
    close: float = CLOSE
    tries: int = TRIED
    known: float = float("inf")
    """Steps that an extremal lasts which is no news."""

    def drawn(self, rng: np.random.Generator) -> _Drawn | None:
        """Extremals, and further ones about those that come nearest; ``None`` where nothing comes of it."""
        sizes = self.target.sizes
        found = _followed(self, rng.standard_normal((len(sizes), DRAWN)) / sizes[:, None])
        for change in ROUNDS:
            parents = found.nearest(sizes, change / 2.0)
            if self.limits.expired or not parents.size:
                return None
            own = parents[:, rng.integers(parents.shape[1], size=CHILDREN)]
            length = np.linalg.norm(own * sizes[:, None], axis=0)
            more = own + change * length * rng.standard_normal(own.shape) / sizes[:, None]
            found = found.joined(_followed(self, more))
        return found


def _exact(search: _Search, rng: np.random.Generator) -> Exact | None:
    """The cheapest of what the closest lead to, those that arrive soonest first, roughly."""
    found = search.drawn(rng)
    if found is None:
        return None
    target, h, limits = search.target, search.h, search.limits
    instance, best, count, late = target.instance, None, 0, 0
    layers, columns = np.nonzero(found.miss <= search.close)
    units = _units(found.costates, target.sizes)
    seen: list[tuple[Array, float]] = []
    keys = found.miss[layers, columns], found.arrival[layers, columns] // max(1, search.steps // ROUGHLY)
    for k in np.lexsort(keys).tolist():
        column, steps = int(columns[k]), int(found.arrival[layers[k], columns[k]])
        if limits.expired or count == search.tries:
            break
        known = any(np.linalg.norm(units[:, column] - u) < SAME and abs(steps - n) < SAME * n for u, n in seen)
        if known or (best is not None and instance.t0 + steps * h > best.refined.at.end):
            continue
        late += steps > CLEARLY * search.known
        if late > LATE:
            break
        seen.append((units[:, column], steps))
        count += 1
        first = guess(instance, _sample(instance, found.costates[:, column], steps, h))
        exact = attempt(instance, first, limits)
        if exact is not None and (best is None or exact.trajectory.cost(instance) < best.trajectory.cost(instance)):
            best = exact
    return best


def _units(costates: Array, sizes: Array) -> Array:
    """Directions of costates, in units of states."""
    found = costates * sizes[:, None]
    return np.asarray(found / np.linalg.norm(found, axis=0))


def _followed(search: _Search, directions: Array) -> _Drawn:
    """Where costates of these directions lead, in layers of durations; those with which H cannot vanish are no part."""
    target, h = search.target, search.h
    instance = target.instance
    costates = _vanishing(instance, directions)
    n, many = costates.shape
    z = np.concatenate([np.repeat(np.array(instance.initial)[:, None], many, axis=1), costates])
    miss, arrival = np.full((LAYERS, many), np.inf), np.zeros((LAYERS, many), dtype=np.int64)
    for step in range(1, search.steps + 1):
        z = _stepped(instance, instance.t0 + (step - 1) * h, z, h)
        layer = max(0, LAYERS - 1 - int(np.log(search.steps / step) / np.log(LONGER)))
        found = np.abs(target.gap(np.full(many, instance.t0 + step * h), z[:n])).max(axis=0)
        nearer = found < miss[layer]
        miss[layer, nearer], arrival[layer, nearer] = found[nearer], step
        if step % 50 == 0:
            search.limits.spend(50 * many)
    return _Drawn(costates, miss, arrival)


def _vanishing(instance: Instance, directions: Array) -> Array:
    """Costates of these directions with which H vanishes at the start, shape (n, S)."""
    model, p, n = instance.model, instance.parameters, len(directions)
    x = np.repeat(np.array(instance.initial)[:, None], directions.shape[1], axis=1)
    t = np.full(directions.shape[1], instance.t0)
    rates = _rates(instance, t, np.concatenate([x, directions]))
    u = _control(instance, t, x, directions)
    factor = -np.broadcast_to(model.running_cost_batch(t, x, u, p), t.shape) / (directions * rates[:n]).sum(axis=0)
    fit = np.isfinite(factor) & (factor > 0.0)
    return np.asarray(directions[:, fit] * factor[fit])


def _control(instance: Instance, t: Array, x: Array, lam: Array) -> Array:
    """The one of least H, at bounds."""
    low, high = instance.control_set.box
    return np.asarray(np.where(signs(instance, t, x, lam)[0] > 0.0, low, high))


def _rates(instance: Instance, t: Array, z: Array) -> Array:
    model, p, n = instance.model, instance.parameters, len(z) // 2
    x, lam = z[:n], z[n:]
    u = _control(instance, t, x, lam)
    pair = model.dynamics_batch(t, x, u, p), model.costate_rate_batch(t, x, u, lam, p)
    return np.concatenate([np.broadcast_to(one, x.shape) for one in pair])


def _stepped(instance: Instance, time: float, z: Array, h: float) -> Array:
    """After one step of the classical Runge-Kutta method."""
    t = np.full(z.shape[1], time)
    f1 = _rates(instance, t, z)
    f2 = _rates(instance, t + h / 2.0, z + h / 2.0 * f1)
    f3 = _rates(instance, t + h / 2.0, z + h / 2.0 * f2)
    return np.asarray(z + h / 6.0 * (f1 + 2.0 * (f2 + f3) + _rates(instance, t + h, z + h * f3)))


def _sample(instance: Instance, costates: Array, steps: int, h: float) -> Sample:
    """The extremal up to where it arrives."""
    n, column = len(costates), np.append(instance.initial, costates)[:, None]
    columns = [column]
    for step in range(steps):
        columns.append(_stepped(instance, instance.t0 + step * h, columns[-1], h))
    times, z = instance.t0 + h * np.arange(steps + 1), np.concatenate(columns, axis=1)
    sigma, weight = signs(instance, times, z[:n], z[n:])
    return Sample(times, z, _control(instance, times, z[:n], z[n:]), sigma, weight)
