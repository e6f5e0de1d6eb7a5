"""Competitors close by: other switching times, with a short arc put in or not."""

from __future__ import annotations

import random
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array, distinct
from satsym.instance import Instance
from satsym.solution import Competitors, Kind, Solution
from satsym.solvers.collocation.scaling import final_argument
from satsym.solvers.failures import FAILURES
from satsym.solvers.iteration import Limits
from satsym.solvers.simulation.extrapolation import integrate

PLANS = 8
EVALUATIONS = 200_000

SHORT = (0.01, 0.04)
"""Shares of the duration that an arc which is put in lasts."""

CORRECTIONS = 12
MISSED = 1e-11
"""Relative miss of the end up to which a competitor counts as feasible."""

TOLERANCE = 1e-13


@dataclass(frozen=True, eq=False)
class Plan:
    """A control that is constant between given times: starts of its pieces, and its values there, shape (k, m)."""

    starts: Array
    values: Array

    def with_needle(self, control: int, value: float, begin: float, end: float) -> Plan:
        """With one control at another value for a while."""
        starts = distinct(np.concatenate([self.starts, [begin, end]]))
        values = self.values[np.searchsorted(self.starts, starts, side="right") - 1].copy()
        values[(starts >= begin) & (starts < end), control] = value
        return Plan(starts, values)

    def moved(self, times: Array, by: Array, end: float) -> Plan:
        """With some of the starts moved; pieces that vanish are dropped."""
        starts = self.starts.copy()
        for old, shift in zip(times, by, strict=True):
            starts[np.argmin(np.abs(self.starts - old))] += shift
        order = np.maximum.accumulate(np.clip(starts, self.starts[0], end))
        return Plan(order, self.values)


def needles(solution: Solution, within: Limits) -> Competitors | None:
    """Other switching times, with a short arc put in or not; ``None`` along singular arcs."""
    if _singular(solution):
        return None
    near = _Near.of(solution, replace(within, work=within.meter.spent + EVALUATIONS))
    own = near.simulated(near.base, near.end)
    count = len(near.switches) + near.free
    if own is None or (count == 0 and len(near.wanted)):
        return Competitors(Kind.NEIGHBOURS, 0, 0, float("nan"))
    rng = random.Random("needles")
    still, loose, costs = np.zeros(count), count > len(near.wanted), []
    for _ in range(PLANS):
        plans = [(near.with_needle(rng), still)]
        if loose:  # the end does not fix all times
            shift = [rng.choice((-1.0, 1.0)) * rng.uniform(*SHORT) * near.lasting for _ in still]
            plans.append((near.base, np.array(shift)))
        costs += [near.corrected(plan, shift) for plan, shift in plans if plan is not None]
    found = [cost + (solution.objective - own[0]) for cost in costs if np.isfinite(cost)]
    return Competitors(Kind.NEIGHBOURS, len(costs), len(found), min(found, default=float("nan")))


@dataclass(frozen=True, eq=False)
class _Near:
    """The neighbourhood of a bang-bang solution."""

    solution: Solution
    base: Plan
    """What is compared, and its control."""
    switches: Array
    """Its switching times, shape (K,)."""
    sizes: Array
    """Of states, shape (n,)."""
    wanted: NDArray[np.intp]
    """The states whose end is to be that of the solution."""
    limits: Limits
    """Spent by evaluations."""

    @classmethod
    def of(cls, solution: Solution, limits: Limits) -> _Near:
        switches = distinct([t for times in solution.switching_times for t in times])
        sizes = np.maximum(np.abs(solution.x).max(axis=1), 1e-300)
        wanted = np.arange(len(sizes)) if solution.instance.model.spec.multipliers else _fixed(solution.instance)
        return cls(solution, _plan(solution, switches), switches, sizes, wanted, limits)

    @property
    def free(self) -> bool:
        """Whether the final time is free."""
        return self.solution.instance.tf is None

    @property
    def end(self) -> float:
        return float(self.solution.times[-1])

    @property
    def lasting(self) -> float:
        return float(self.solution.times[-1] - self.solution.times[0])

    def simulated(self, plan: Plan, end: float) -> tuple[float, Array] | None:
        """The cost of a plan, and by how much it misses the end; ``None`` where it cannot be simulated."""
        instance = self.solution.instance
        try:
            x, cost = self._integrated(plan, end)
            cost += float(instance.model.terminal_cost(end, tuple(x.tolist()), instance.parameters))
        except FAILURES:
            return None
        return cost, ((x - self.solution.x[:, -1]) / self.sizes)[self.wanted]

    def corrected(self, plan: Plan, shift: Array) -> float:
        """The cost once the end is as given, by moving the switching times further; infinite where that fails."""

        def at(shift: Array) -> tuple[float, Array] | None:
            end = self.end + (float(shift[-1]) if self.free else 0.0)
            return self.simulated(plan.moved(self.switches, shift[: len(self.switches)], end), end)

        found = at(shift)
        for _ in range(CORRECTIONS):
            if found is None:
                return float("inf")
            cost, gap = found
            if float(np.abs(gap).max(initial=0.0)) <= MISSED:
                return float(cost)
            nudge = 1e-6 * self.lasting
            columns = []
            for k in range(len(shift)):
                there = at(shift + nudge * np.eye(len(shift))[k])
                if there is None:
                    return float("inf")
                columns.append((there[1] - gap) / nudge)
            step = -np.linalg.lstsq(np.stack(columns, axis=1), gap, rcond=1e-9)[0]
            largest = float(np.abs(step).max(initial=0.0))
            shift = shift + step * min(1.0, 0.1 * self.lasting / max(largest, 1e-300))
            found = at(shift)
        return float("inf")

    def with_needle(self, rng: random.Random) -> Plan | None:
        """A short arc of one control at another of its levels, away from the switches."""
        allowed, switches, lasting = self.solution.instance.control_set, self.switches, self.lasting
        start, base = float(self.solution.times[0]), self.base
        for _ in range(20):
            control = rng.randrange(len(allowed.lower))
            length = rng.uniform(*SHORT) * lasting
            begin = rng.uniform(start, self.end - length)
            if len(switches) and np.abs(switches - begin - length / 2.0).min() < 0.75 * length + 0.01 * lasting:
                continue
            present = base.values[np.searchsorted(base.starts, begin, side="right") - 1, control]
            levels = allowed.lower[control], allowed.upper[control], allowed.rest[control]
            choices = [v for v in levels if v != present]
            if choices:
                return base.with_needle(control, rng.choice(choices), begin, begin + length)
        return None

    def _integrated(self, plan: Plan, end: float) -> tuple[Array, float]:
        """Where a plan leads, and its running cost; an error where that takes too long."""
        instance, limits = self.solution.instance, self.limits
        model, p, n = instance.model, instance.parameters, len(instance.initial)
        y = np.append(np.array(instance.initial), 0.0)
        scale = np.append(self.sizes, 1.0)
        ends = np.append(plan.starts[1:], end)
        for begin, until, u in zip(plan.starts.tolist(), ends.tolist(), map(tuple, plan.values.tolist()), strict=True):
            if until <= begin:
                continue

            def rates(t: float, y: Array, u: tuple[float, ...] = u) -> Array:
                limits.spend(1)
                if limits.expired:
                    raise ArithmeticError("no more evaluations")
                x = y[:n].tolist()
                return np.array([*model.dynamics(t, x, u, p), model.running_cost(t, x, u, p)])

            y = integrate(rates, np.array([begin, until]), y, TOLERANCE, scale)[0].end
        return y[:n], float(y[n])


def _plan(solution: Solution, switches: Array) -> Plan:
    """The control of a bang-bang solution."""
    starts = np.concatenate([[float(solution.times[0])], switches])
    ends = np.append(switches, float(solution.times[-1]))
    middle = (starts + ends) / 2.0
    where = np.searchsorted(solution.times, middle, side="right") - 1
    return Plan(starts, solution.u[:, where].T.copy())


def _fixed(instance: Instance) -> NDArray[np.intp]:
    final = np.array(final_argument(instance)).reshape(3, -1)
    return np.flatnonzero(final[:2].any(axis=0))


def _singular(solution: Solution) -> bool:
    """Whether the control is anything but constant between switches."""
    instance = solution.instance
    low, high = instance.control_set.box
    levels = np.stack(np.broadcast_arrays(low, high, np.clip(0.0, low, high)))[:, :, :1]
    off = np.abs(solution.u[None] - levels).min(axis=0)
    return bool((off > 1e-12 * (high - low)).any())
