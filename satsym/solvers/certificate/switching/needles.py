"""Competitors close by: other switching times, with a short arc put in or not."""

from __future__ import annotations

import random
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
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
        starts = np.unique(np.concatenate([self.starts, [begin, end]]))
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
    instance = solution.instance
    free = instance.tf is None
    switches = np.unique([t for times in solution.switching_times for t in times])
    if _singular(solution):
        return None
    base, lasting = _plan(solution), float(solution.times[-1] - solution.times[0])
    sizes = np.maximum(np.abs(solution.x).max(axis=1), 1e-300)
    wanted = _fixed(instance)
    if instance.model.spec.multipliers:
        wanted = np.arange(len(sizes))
    goal = solution.x[:, -1]
    rng, limits = random.Random("needles"), replace(within, work=within.meter.spent + EVALUATIONS)
    count = len(switches) + free

    def flown(plan: Plan, end: float) -> tuple[float, Array] | None:
        try:
            x, cost = _fly(instance, plan, end, sizes, limits)
            cost += float(instance.model.terminal_cost(end, tuple(x.tolist()), instance.parameters))
        except FAILURES:
            return None
        return cost, ((x - goal) / sizes)[wanted]

    own = flown(base, float(solution.times[-1]))
    if own is None or (count == 0 and len(wanted)):
        return Competitors(Kind.NEIGHBOURS, 0, 0, float("nan"))
    still, loose, costs = np.zeros(count), count > len(wanted), []
    for _ in range(PLANS):
        plans = [(_needle(solution, base, switches, rng, lasting), still)]
        if loose:  # the end does not fix all times
            plans.append((base, np.array([rng.choice((-1.0, 1.0)) * rng.uniform(*SHORT) * lasting for _ in still])))
        for plan, shift in plans:
            if plan is not None:
                costs.append(_corrected(plan, switches, shift, float(solution.times[-1]), lasting, free, flown))
    found = [cost + (solution.objective - own[0]) for cost in costs if np.isfinite(cost)]
    return Competitors(Kind.NEIGHBOURS, len(costs), len(found), min(found, default=float("nan")))


def _corrected(plan: Plan, switches: Array, shift: Array, end: float, lasting: float, free: bool, flown: Any) -> float:
    """The cost once the end is as given, by moving the switching times further; infinite where that fails."""

    def at(shift: Array) -> Any:
        moved = plan.moved(switches, shift[: len(switches)], end + (float(shift[-1]) if free else 0.0))
        return flown(moved, end + (float(shift[-1]) if free else 0.0))

    found = at(shift)
    for _ in range(CORRECTIONS):
        if found is None:
            return float("inf")
        cost, gap = found
        if float(np.abs(gap).max(initial=0.0)) <= MISSED:
            return float(cost)
        nudge = 1e-6 * lasting
        columns = []
        for k in range(len(shift)):
            there = at(shift + nudge * np.eye(len(shift))[k])
            if there is None:
                return float("inf")
            columns.append((there[1] - gap) / nudge)
        step = -np.linalg.lstsq(np.stack(columns, axis=1), gap, rcond=1e-9)[0]
        largest = float(np.abs(step).max(initial=0.0))
        shift = shift + step * min(1.0, 0.1 * lasting / max(largest, 1e-300))
        found = at(shift)
    return float("inf")


def _needle(solution: Solution, base: Plan, switches: Array, rng: random.Random, lasting: float) -> Plan | None:
    """A short arc of one control at another of its levels, away from the switches."""
    instance = solution.instance
    start, end = float(solution.times[0]), float(solution.times[-1])
    for _ in range(20):
        control = rng.randrange(len(instance.lower))
        length = rng.uniform(*SHORT) * lasting
        begin = rng.uniform(start, end - length)
        if len(switches) and np.abs(switches - begin - length / 2.0).min() < 0.75 * length + 0.01 * lasting:
            continue
        low, high = instance.lower[control], instance.upper[control]
        present = base.values[np.searchsorted(base.starts, begin, side="right") - 1, control]
        choices = [v for v in (low, high, min(max(0.0, low), high)) if v != present]
        if choices:
            return base.with_needle(control, rng.choice(choices), begin, begin + length)
    return None


def _plan(solution: Solution) -> Plan:
    """The control of a bang-bang solution."""
    switches = np.unique([t for times in solution.switching_times for t in times])
    starts = np.concatenate([[float(solution.times[0])], switches])
    ends = np.append(switches, float(solution.times[-1]))
    middle = (starts + ends) / 2.0
    where = np.searchsorted(solution.times, middle, side="right") - 1
    return Plan(starts, solution.u[:, where].T.copy())


def _fly(instance: Instance, plan: Plan, end: float, sizes: Array, limits: Limits) -> tuple[Array, float]:
    """Where a plan leads, and its running cost; an error where that takes too long."""
    model, p, n = instance.model, instance.parameters, len(instance.initial)
    y = np.append(np.array(instance.initial), 0.0)
    scale = np.append(sizes, 1.0)
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
