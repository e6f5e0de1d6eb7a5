"""Scales of a programme's unknowns, from the motion with controls at rest, its distance from the end, and the cost."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.instance.unknowns import Place
from satsym.solvers.failures import tried
from satsym.solvers.search.controls import Controls, rates
from satsym.solvers.search.points import Points
from satsym.solvers.search.transcription import Sizes

STEPS = 200
"""Number of steps of the motion with controls at rest."""

FAR_STATE = 30.0
"""Magnitude, as a multiple of the largest given number, at which the motion at rest is cut off."""

ROUNDING = 1e-12
"""Rate of a state, relative to the largest rate, that counts as rounding."""

TELLING = 1e-4
"""Magnitude of a state in the motion at rest, relative to an estimate from its effect on other states, below which the
estimate is used as the state's scale instead."""

LEVEL = 0.3
"""Magnitude of the controls, relative to their scales, at which the cost is evaluated."""


def wanted(instance: Instance, end: float) -> Array:
    """Return the given final states, for ranges the value closest to the initial state; NaN elsewhere."""
    found = np.full(len(instance.initial), np.nan)
    for i, name in enumerate(instance.model.spec.state_names):
        value = instance.final.get(name)
        if isinstance(value, float | int):
            found[i] = value
        elif value == "reference":
            found[i] = instance.model.reference(end, instance.parameters)[i]
        elif name in instance.ranges:
            low, high = instance.ranges[name]
            found[i] = min(max(instance.initial[i], low), high)
    return found


def resting(controls: Controls) -> Array:
    """Return control variables that are small and strictly within their bounds if possible."""
    low, high = controls.lower, controls.upper
    v = np.clip(np.zeros(controls.count), low, high)
    bounded = np.isfinite(low) & np.isfinite(high)
    at_bound = bounded & ((v <= low) | (v >= high)) & (low < high)
    v = np.where(at_bound, v + 0.02 * (high - low) * np.where(v <= low, 1.0, -1.0), v)
    for norm in controls.norms:
        outer = norm.outer if np.isfinite(norm.outer) else 1.0
        length = max(0.1 * outer, norm.inner)
        v[list(norm.places)] = length / np.sqrt(len(norm.places))
        if norm.spot is not None:
            v[norm.spot] = max(0.2 * outer, norm.inner)
    return v


@dataclass(frozen=True, eq=False)
class Rest:
    """The motion with controls at rest."""

    controls: Array
    states: Array
    """States, one row for each time, up to the time at which they become too large."""
    whole: bool
    """Whether the states cover the whole duration."""


def sizes_of(instance: Instance, controls: Controls, duration: float) -> Sizes:
    """Return the scales of an instance's unknowns for a duration, which is an initial guess if it is free."""
    rest = _rest(instance, controls, duration)
    states = _of_states(instance, controls, duration, rest)
    variables, cost = _of_controls(instance, controls, duration, rest)
    free = [one.of(instance) for one in instance.free if one.place is Place.PARAMETER]
    return Sizes(states, variables, duration, cost, np.array([abs(value) or 1.0 for value in free]))


def flow(instance: Instance, controls: Controls, t: float, x: Array, v: Array) -> Array:
    """Return the rates (n + 1,) of states and cost at one point."""
    return flows(instance, controls, np.array([t]), x[:, None], v[:, None])[:, 0]


def flows(instance: Instance, controls: Controls, t: Array, x: Array, v: Array) -> Array:
    """Return rates (n + 1, M) of states and cost at times (M,), states (n, M) and variables (k, M)."""
    found = [weight * rates(instance, t, x, u, instance.parameters) for u, weight in controls.nodes(v)]
    return np.asarray(np.sum(found, axis=0))


def followed(instance: Instance, controls: Controls, times: Array, x: Array, v: Array, far: float) -> Array:
    """Return states by RK4 steps with constant controls, one row for each time, until they become too large."""
    u = np.repeat(controls.controls(v[:, None]), len(times), 1)
    start = tuple(x.tolist())
    found = tried(lambda: instance.model.forward(times, start, u, u[:, 1:], instance.parameters)[0].T)
    if found is None:
        return x[None]
    away = ~np.isfinite(found).all(axis=1) | (np.abs(found).max(axis=1) > far)
    away[0] = False
    return np.asarray(found[: int(np.argmax(away)) if away.any() else len(found)])


def _rest(instance: Instance, controls: Controls, duration: float) -> Rest:
    low, high = controls.lower, controls.upper
    bounded = np.isfinite(low) & np.isfinite(high)
    v = np.zeros(controls.count)
    v[bounded] = 0.5 * (low[bounded] + high[bounded])
    start, end = np.array(instance.initial), wanted(instance, instance.t0 + duration)
    times = instance.t0 + duration * np.linspace(0.0, 1.0, STEPS + 1)
    states = followed(instance, controls, times, start, v, _far(start, end))
    return Rest(v, states, len(states) == STEPS + 1)


def _far(start: Array, end: Array) -> float:
    return float(FAR_STATE * max(1.0, np.abs(start).max(), np.nanmax(np.abs(end), initial=0.0)))


def ranges(instance: Instance, controls: Controls, duration: float) -> Array:
    """Return the largest ranges (n,) of states in the motions at rest from the start and backwards from the end.

    Free final states of the motion from the end are those in which the motion from the start ends.
    """
    rest = _rest(instance, controls, duration)
    start, end = np.array(instance.initial), wanted(instance, instance.t0 + duration)
    times = instance.t0 + duration * np.linspace(1.0, 0.0, STEPS + 1)
    last = np.where(np.isnan(end), rest.states[-1], end)
    back = followed(instance, controls, times, last, rest.controls, _far(start, end))
    return np.asarray(np.maximum(np.ptp(rest.states, axis=0), np.ptp(back, axis=0)))


def _of_states(instance: Instance, controls: Controls, duration: float, rest: Rest) -> Array:
    start, end = np.array(instance.initial), wanted(instance, instance.t0 + duration)
    typical = [one.typical for one in instance.model.spec.states]
    span = np.array([one[1] - one[0] if one else 0.0 for one in typical])
    between = np.where(np.isnan(end), 0.0, np.abs(end - start))
    size = np.maximum(np.abs(start), np.nan_to_num(np.abs(end)))
    size = np.where(span > 0.0, np.maximum(span, between), size)
    moved = np.ptp(rest.states, axis=0)
    told = (size > 0.0) | (moved <= ROUNDING * duration * _largest(instance, controls, start))
    both = np.where(told, size, moved)
    if not (size > 0.0).all():
        others = _through_others(instance, controls, duration, size, rest)
        both = np.where((both > TELLING * others) | (others == 0.0), both, others)
        if not (both > 0.0).all():
            both = _through_others(instance, controls, duration, both, rest)
    return _balanced(instance, controls, np.where(both > 0.0, both, 1.0))


def _balanced(instance: Instance, controls: Controls, size: Array) -> Array:
    """Raise the scales of states that a linear terminal condition sets against one state with a larger effect on it."""
    n, size = len(size), size.copy()
    points = Points(instance, controls, (), size)
    y = np.zeros((points.local, 2))
    y[:n], y[-1] = np.array(instance.initial)[:, None] + size[:, None] * np.arange(2), instance.t0
    here, beside = np.abs(points.slopes(points.ends, y)[:, :n]).transpose(2, 0, 1)
    for row in here[np.isclose(here, beside).all(axis=1)]:
        pair = np.flatnonzero(row)
        if len(pair) == 2:
            size[pair] = np.maximum(size[pair], (row * size).max() / row[pair])
    return size


def _largest(instance: Instance, controls: Controls, x: Array) -> Array:
    """Return the largest rates (n,) of states at any node of the controls, the scale of rounding for rates at rest."""
    nodes = [u for u, _ in controls.nodes(np.zeros((controls.count, 1)))]
    found = [rates(instance, np.array([instance.t0]), x[:, None], u, instance.parameters)[:-1, 0] for u in nodes]
    return np.asarray(np.abs(found).max(axis=0))


def _through_others(instance: Instance, controls: Controls, duration: float, size: Array, rest: Rest) -> Array:
    """Return scales of states without given values, by their effects on states whose scales are known."""
    n, size = len(size), size.copy()
    v = rest.controls + 0.1 * reaches(controls)
    x = np.array(instance.initial) + 1e-3 * size
    slopes = np.zeros((n, n))
    for j in range(n):
        moved = x.astype(complex)
        moved[j] += 1e-30j
        slopes[:, j] = np.abs(np.imag(flow(instance, controls, instance.t0, moved, v)[:-1])) / 1e-30
    slopes = np.nan_to_num(slopes)
    for _ in range(n):
        for i in np.flatnonzero(size == 0.0):
            through = size[slopes[:, i] > 0.0] / (slopes[slopes[:, i] > 0.0, i] * duration)
            through = through[through > 0.0]
            if len(through):
                size[i] = through.min()
    return size


def reaches(controls: Controls) -> Array:
    """Return the largest magnitudes of variables with two bounds; 1 for other variables."""
    bounded = np.isfinite(controls.lower) & np.isfinite(controls.upper)
    largest = np.maximum(np.abs(controls.lower), np.abs(controls.upper))
    return np.where(bounded & (largest > 0.0), np.where(bounded, largest, 1.0), 1.0)


def _of_controls(instance: Instance, controls: Controls, duration: float, rest: Rest) -> tuple[Array, float]:
    """Return the scales of the variables and of the cost.

    The scale of an unbounded control is the value that corrects the distance of the motion at rest from the end.
    """
    start, end = np.array(instance.initial), wanted(instance, instance.t0 + duration)
    given = ~np.isnan(end)
    last = rest.states[-1] if rest.whole else start
    goal = np.where(given, end, last)
    missed = np.where(given, np.abs(goal - last), 0.0)
    bounded = np.isfinite(controls.lower) & np.isfinite(controls.upper)
    size = reaches(controls)
    need = _needed(instance, controls, duration, 0.5 * (start + goal), missed)
    size = np.where(bounded, size, np.where(need > 0.0, need, 1.0))
    path = rest.states[:: STEPS // 5] if rest.whole else start + (goal - start) * np.linspace(0.0, 1.0, 6)[:, None]
    times = instance.t0 + duration * np.linspace(0.0, 1.0, len(path))
    level = np.where(bounded, LEVEL * size, size) if given.any() else rest.controls

    def cost(v: Array) -> float:
        running = [abs(flow(instance, controls, t, x, v)[-1]) for t, x in zip(times.tolist(), path, strict=True)]
        at = goal if given.any() else last
        spec = instance.model.spec
        final = (
            instance.model.terminal_cost(instance.t0 + duration, tuple(at), instance.parameters)
            if spec.has_terminal_cost
            else 0.0
        )
        return float(duration * np.mean(running) + abs(final))

    whole = cost(level)
    whole = whole if np.isfinite(whole) and whole > 1e-30 else 1.0
    if not bounded.all() and not (need > 0.0).any():  # nothing is missed: controls that cost about as much
        scales = 10.0 ** np.arange(-12.0, 7.0)
        costs = np.array([abs(cost(np.where(bounded, 0.0, k)) - cost(np.zeros(controls.count))) for k in scales])
        fitting = scales[(costs > 0.0) & (costs <= whole)]
        size = np.where(bounded, size, fitting[-1] if len(fitting) else 1.0)
    return size, whole


def _needed(instance: Instance, controls: Controls, duration: float, x: Array, missed: Array) -> Array:
    """Return the smallest value of each variable alone that corrects some deviation from the end; 0 if none does."""
    found = np.zeros(controls.count)
    for k in range(controls.count):
        moved = np.full(controls.count, 0.1 + 0.0j)
        moved[k] += 1e-30j
        slopes = np.abs(np.imag(flow(instance, controls, instance.t0, x.astype(complex), moved)[:-1])) / 1e-30
        able = (slopes > 0.0) & (missed > 0.0) & np.isfinite(slopes)
        if able.any():
            found[k] = (missed[able] / (slopes[able] * duration)).min()
    return found
