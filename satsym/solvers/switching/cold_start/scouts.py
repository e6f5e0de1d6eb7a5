"""Motions under controls that switch at seeded times, made to arrive as cheaply as their arcs allow: many at once.

No costates are involved: what arrives is an admissible motion, whether it is an extremal or not. Steps of fixed length
show roughly what one costs; which of them are worth exact arcs is decided by that.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.collocation.scaling import final_argument
from satsym.solvers.iteration import Limits
from satsym.solvers.simulation.extrapolation import integrate
from satsym.solvers.switching.cold_start.plans import Plans, Scout
from satsym.solvers.switching.structure import LOWER, UPPER

FEWEST, MOST, QUICK = 6, 24, 2.5
"""Runge-Kutta steps of an arc, and how many for each unit of the motion's quickest rate times its length."""

ROUNDS, LAST = 24, 7
"""Corrections of the lengths of arcs, the last of which only make the motion arrive."""

BOLD, CALMER = 0.3, 0.9
"""Largest change for the sake of the cost, as a share of the duration, and how it shrinks from one to the next."""

LARGEST = 0.5
"""Share of the duration by which an arc may change at once so that the motion arrives."""

GROWN, BACK, FORTH = 1.5, 0.3, 1.6
"""A miss that is so many times larger after a change is none to go on from: the change is taken back but for a share,
and the next ones are smaller, and larger again where that goes well."""

NUDGE = 1e-6
"""Difference that derivatives are taken over, as a share of the duration."""

ARRIVED = 1e-4
"""Largest miss of the end, relative to the sizes of states."""

POLISHED, THERE = 6, 1e-10
"""Corrections that make an arrival exact, and the largest miss that it then has."""

TOLERANCE = 1e-13
"""Error of a step of its integration, relative to sizes."""

RANK = 1e-9

NOISE = 1e-4
"""Share of a slope below which what is left of it is the error of a difference."""


@dataclass(frozen=True, eq=False)
class Target:
    """Where motions are to arrive."""

    instance: Instance
    """Of a switching problem."""
    sizes: Array
    """Of states, shape (n,)."""
    ends: Array
    """The final time of each plan, where it is given or to be kept, NaN where it is free; shape (M,)."""

    @cached_property
    def _final(self) -> Array:
        """What is given at the end: whether by numbers, whether on the reference, and the numbers; shape (3, n)."""
        return np.array(final_argument(self.instance)).reshape(3, -1)

    def of(self, plans: list[int]) -> Target:
        """That of some plans."""
        return replace(self, ends=self.ends[plans])

    def gap(self, times: Array, x: Array) -> Array:
        """By how much it is missed, shape (c, N), for one motion or several of each plan in turn.

        States that are given are relative to their sizes; a final time that is follows them.
        """
        given, on_reference, target = self._final[:, :, None]
        goal = given * target
        if on_reference.any():
            curve = np.array([self.instance.model.reference(t, self.instance.parameters) for t in times.tolist()]).T
            goal = goal + on_reference * curve
        rows = np.flatnonzero(self._final[:2].any(axis=0))
        missed = ((x - goal) / self.sizes[:, None])[rows]
        ends = np.repeat(self.ends, len(times) // len(self.ends))
        late = np.where(np.isfinite(ends), (times - ends) / (ends - self.instance.t0), 0.0)
        return np.concatenate([missed, late[None]])


def scouted(target: Target, plans: Plans, limits: Limits, rounds: int = ROUNDS) -> list[Scout]:
    """What of these plans arrives, the cheapest first.

    Parameters
    ----------
    target
        With as many ends as there are plans.
    limits
        Spent by the points at which a motion is looked at.
    rounds
        Corrections of the lengths of arcs.
    """
    steps = _Steps.of(target.instance, limits)
    lengths = plans.lengths.copy()
    span = lengths.sum(axis=0)
    before, missed, trust = lengths, np.full(lengths.shape[1], np.inf), np.full(lengths.shape[1], LARGEST)
    for round_ in range(rounds):
        if limits.expired:
            return []
        found = _linearised(target, replace(plans, lengths=lengths), NUDGE * span, steps)
        miss = found.worst
        worse = ~(miss <= np.maximum(GROWN * missed, ARRIVED)) & (round_ > 0)
        trust = np.where(worse, trust * BACK, np.minimum(trust * FORTH, LARGEST))
        lengths = np.where(worse, before + BACK * (lengths - before), lengths)  # and look there again
        before, missed = np.where(worse, before, lengths), np.where(worse, missed, miss)
        bold = BOLD * CALMER**round_ if round_ < rounds - LAST else 0.0
        moved = np.maximum(lengths + found.step(lengths, trust * span, bold / LARGEST), 0.0)
        lengths = np.where(worse, lengths, moved)
        span = np.maximum(lengths.sum(axis=0), 1e-9 * span)
    return _arrived(target, replace(plans, lengths=lengths), steps, ARRIVED)


def exactly(target: Target, scouts: list[Scout], limits: Limits) -> list[Scout]:
    """Those of some scouts that arrive to the last digits, the cheapest first; their numbers are as they were.

    Parameters
    ----------
    target
        With as many ends as there are scouts.
    """
    if not scouts:
        return []
    plans = Plans(np.stack([one.levels for one in scouts], axis=2), np.stack([one.lengths for one in scouts], axis=1))
    steps = _Steps(float("nan"), limits)
    for _ in range(POLISHED):
        if limits.expired:
            return []
        span = plans.lengths.sum(axis=0)
        found = _linearised(target, plans, NUDGE * span, steps)
        if float(found.worst.max(initial=0.0)) <= THERE / 10.0:
            break
        plans = replace(plans, lengths=np.maximum(plans.lengths + found.step(plans.lengths, LARGEST * span, 0.0), 0.0))
    arrived = _arrived(target, plans, steps, THERE)
    return [replace(one, number=scouts[one.number].number) for one in arrived]


def _arrived(target: Target, plans: Plans, steps: _Steps, closely: float) -> list[Scout]:
    """The plans that arrive, the cheapest first."""
    instance, lengths = target.instance, plans.lengths
    x, costs = _simulated(instance, plans, steps)
    missed = np.abs(target.gap(instance.t0 + lengths.sum(axis=0), x)).max(axis=0, initial=0.0)
    arrived = (missed <= closely) & np.isfinite(costs) & np.isfinite(x).all(axis=0)
    order = [k for k in np.argsort(costs).tolist() if arrived[k]]
    return [Scout(k, plans.levels[:, :, k], lengths[:, k], float(costs[k])) for k in order]


@dataclass(frozen=True)
class _Steps:
    """How arcs are integrated, and who counts what that takes."""

    quickest: float
    """Rate of the motion, by which the number of steps of fixed length is chosen; NaN for steps as long as errors
    allow."""
    limits: Limits

    @classmethod
    def of(cls, instance: Instance, limits: Limits) -> _Steps:
        """Of fixed length, as the motion at its start asks for."""
        n, u = len(instance.initial), instance.control_set.rest
        slopes = np.array(instance.model.jacobian_x(instance.t0, instance.initial, u, instance.parameters))
        return cls(float(np.abs(np.linalg.eigvals(slopes.reshape(n, n))).max(initial=0.0)), limits)

    def along(self, rates: Callable[[Array, Array], Array], t: Array, y: Array, length: Array) -> Array:
        """Values at the ends of arcs that begin at times t, shape (N,), with values y, shape (d, N)."""
        if np.isfinite(self.quickest):
            return self._fixed(rates, t, y, length)
        size = np.maximum(np.abs(y).max(axis=1, keepdims=True), 1e-300) + 0.0 * y

        def within(fraction: float, flat: Array) -> Array:
            self.limits.spend(len(t))
            return np.asarray((length * rates(t + fraction * length, flat.reshape(y.shape))).ravel())

        end = integrate(within, np.array([0.0, 1.0]), y.ravel(), TOLERANCE, size.ravel(), 1.0)[0].end
        return end.reshape(y.shape)

    def _fixed(self, rates: Callable[[Array, Array], Array], t: Array, y: Array, length: Array) -> Array:
        longest = float(np.max(length, initial=0.0, where=np.isfinite(length)))
        count = int(min(max(FEWEST, np.ceil(QUICK * self.quickest * longest)), MOST))
        self.limits.spend(count * len(length))
        h = length / count
        for _ in range(count):
            f1 = rates(t, y)
            f2 = rates(t + h / 2.0, y + h / 2.0 * f1)
            f3 = rates(t + h / 2.0, y + h / 2.0 * f2)
            f4 = rates(t + h, y + h * f3)
            y, t = y + h / 6.0 * (f1 + 2.0 * (f2 + f3) + f4), t + h
        return y


@dataclass(frozen=True, eq=False)
class _Linearised:
    """How plans miss the end, and how that and their costs change with the lengths of arcs."""

    miss: Array
    """Shape (c, M)."""
    slopes: Array
    gradient: Array
    """Of misses and costs, shapes (M, c, K) and (M, K)."""

    @property
    def worst(self) -> Array:
        """The largest miss of each plan, shape (M,)."""
        return np.asarray(np.abs(self.miss).max(axis=0, initial=0.0))

    def step(self, lengths: Array, largest: Array, bold: float) -> Array:
        """How lengths of arcs change, shape (K, M): towards the end, and downhill along what leaves it where it is."""
        parts = (self.slopes, (1, 2)), (self.gradient, 1), (self.miss, 0)
        usable = np.logical_and.reduce([np.isfinite(part).all(axis=axes) for part, axes in parts])
        slopes, gradient = (
            np.where(usable.reshape(-1, *[1] * (part.ndim - 1)), part, 0.0) for part in (self.slopes, self.gradient)
        )
        miss = np.where(usable, self.miss, 0.0)
        free = np.ones(gradient.shape, bool)
        step = np.zeros_like(gradient)
        for _ in range(2):  # arcs of no length that would shrink stay as they are
            table = slopes * free[:, None]
            inverse = np.linalg.pinv(table, rcond=RANK)
            towards = -np.einsum("mkc,cm->mk", inverse, miss)
            towards *= np.minimum(1.0, largest / np.maximum(np.abs(towards).max(axis=1), 1e-300))[:, None]
            downhill = np.where(free, -gradient, 0.0)
            steepest = np.abs(downhill).max(axis=1)
            downhill = downhill - np.einsum("mkc,mcl,ml->mk", inverse, table, downhill)
            size = np.abs(downhill).max(axis=1)
            downhill *= np.where(size > NOISE * steepest, bold * largest / np.maximum(size, 1e-300), 0.0)[:, None]
            step = towards + downhill
            free &= ~((lengths.T <= 0.0) & (step < 0.0))
        return np.asarray(np.where(free, step, 0.0).T)


def _linearised(target: Target, plans: Plans, nudge: Array, steps: _Steps) -> _Linearised:
    """Misses, and by differences how these and costs change, of all plans at once."""
    count, many = plans.lengths.shape
    moved = np.repeat(plans.lengths[:, :, None], count + 1, axis=2)
    for k in range(count):
        moved[k, :, k + 1] += nudge
    levels = np.repeat(plans.levels[..., None], count + 1, axis=3)
    x, cost = _simulated(target.instance, Plans(levels, moved), steps)
    times = target.instance.t0 + moved.sum(axis=0).ravel()
    gaps = target.gap(times, x).reshape(-1, many, count + 1)
    costs = cost.reshape(many, count + 1)
    slopes = (gaps[:, :, 1:] - gaps[:, :, :1]) / nudge[:, None]
    gradient = (costs[:, 1:] - costs[:, :1]) / nudge[:, None]
    return _Linearised(gaps[:, :, 0], slopes.transpose(1, 0, 2), gradient)


def _simulated(instance: Instance, plans: Plans, steps: _Steps) -> tuple[Array, Array]:
    """Where plans lead, shape (n, N), and at what cost, (N,): infinite beyond the domain."""
    levels, lengths = plans.levels, plans.lengths
    model, p, n = instance.model, instance.parameters, len(instance.initial)
    many = int(np.prod(lengths.shape[1:]))
    low, high = instance.control_set.box
    rest = np.clip(0.0, low, high)
    positive = [k for k, state in enumerate(model.spec.states) if state.positive]
    y, t = np.repeat(np.append(instance.initial, 0.0)[:, None], many, axis=1), np.full(many, instance.t0)
    for arc, length in zip(levels.reshape(len(levels), -1, many), lengths.reshape(len(lengths), many), strict=True):
        u = np.where(arc == LOWER, low, np.where(arc == UPPER, high, rest))

        def rates(t: Array, y: Array, u: Array = u) -> Array:
            cost = np.broadcast_to(model.running_cost_batch(t, y[:n], u, p), t.shape)
            return np.concatenate([model.dynamics_batch(t, y[:n], u, p), cost[None]])

        y = steps.along(rates, t, y, length)
        y[n] += np.where((y[positive] > 0.0).all(axis=0), 0.0, np.inf)
        t = t + length
    x, cost = y[:n], y[n]
    if model.spec.has_terminal_cost:
        cost = cost + model.terminal_cost_batch(t, x, p)
    return x, cost
