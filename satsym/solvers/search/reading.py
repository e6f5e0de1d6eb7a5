"""From the solution of a programme to arcs and junctions, which Newton's method then makes exact.

Controls are read at the points of the programme: at a bound, or between. A run of points with the same reading is an
arc; runs of a single point belong to a junction.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np

from satsym.arrays import Array
from satsym.control_set import ControlSet
from satsym.instance import Instance
from satsym.solvers.iteration import Limits
from satsym.solvers.multipoint.equations import Problem, begun
from satsym.solvers.multipoint.laws import Junction, Law, Parameters, derived
from satsym.solvers.multipoint.newton import Extremal, solved
from satsym.solvers.search.motion import Motion

FEWEST, DENSITY = 4, 1.0
"""Intervals of an arc, at least, and how many there are for each of the programme's."""

SHORT = 2
"""Points of an arc."""

SMALL = 1e-3
"""Share of the largest size that the size of a state or a costate is, at least."""


def exact(instance: Instance, at: Motion, limits: Limits) -> Extremal | None:
    """The extremal that a motion is near; ``None`` where its arcs are of a kind that is not read, or none is near."""
    read = _throttled if instance.model.spec.throttled else _regular
    arcs = read(at)
    if arcs is None:
        return None
    laws, junctions, edges = arcs
    span = float(edges[-1] - edges[0])
    density = DENSITY * (len(at.times) - 1) / 3.0
    intervals = tuple(max(FEWEST, int(np.ceil(density * (b - a) / span))) for a, b in pairwise(edges.tolist()))
    z = np.concatenate([at.x, at.lam])
    size = np.abs(z).max(axis=1)
    n = len(at.x)
    for half in (size[:n], size[n:]):
        half[:] = np.maximum(half, SMALL * half.max() or 1.0)
    own = replace(instance, initial=at.instance.initial, parameters=at.instance.parameters, t0=at.instance.t0)
    free = np.array([one.of(own) for one in own.free if one.place.value == "parameters"])
    problem = Problem(own, laws, junctions, intervals, (size, span, np.abs(free)))
    multipliers = np.zeros(len(instance.model.spec.multipliers))
    with np.errstate(all="ignore"):
        return solved(problem, begun(problem, at.times, z, edges, multipliers, free), limits)


def runs(labels: list[int], least: int = SHORT) -> list[tuple[int, int, int]]:
    """Runs of equal labels as (label, first, last); those that are too short belong to the longer neighbour."""
    found = _runs(labels)
    while len(found) > 1:
        short = next((k for k, (_, a, b) in enumerate(found) if b - a + 1 < least), None)
        if short is None:
            break
        beside = [k for k in (short - 1, short + 1) if 0 <= k < len(found)]
        to = max(beside, key=lambda k: found[k][2] - found[k][1])
        _, a, b = found[short]
        labels = [*labels[:a], *[found[to][0]] * (b - a + 1), *labels[b + 1 :]]
        found = _runs(labels)
    return found


def _runs(labels: list[int]) -> list[tuple[int, int, int]]:
    found: list[tuple[int, int, int]] = []
    for k, label in enumerate(labels):
        if found and found[-1][0] == label:
            found[-1] = (label, found[-1][1], k)
        else:
            found.append((label, k, k))
    return found


def _edges(at: Motion, found: list[tuple[int, int, int]]) -> Array:
    """Where arcs begin and end: between the last point of one and the first of the next."""
    times = at.times[1:]
    inner = [0.5 * (times[a[2]] + times[b[1]]) for a, b in pairwise(found)]
    return np.array([at.times[0], *inner, at.times[-1]])


Arcs = tuple[tuple[Law, ...], tuple[Junction, ...], Array]


def _regular(at: Motion) -> Arcs:
    """One arc whose law minimises H."""
    instance = at.instance
    return (derived(instance, instance.control_set.arguments),), (), at.times[[0, -1]]


def _throttled(at: Motion) -> Arcs | None:
    """Arcs of the largest and the least norm of a vector, or of a single control that switches."""
    instance = at.instance
    parts = [(places, part) for places, part in instance.control_set.parts if part.throttled]
    if len(parts) != 1:
        return None
    places, part = parts[0]
    low, high = part.levels
    rows = at.u[list(places)]
    length = rows[0] if part.kind == "box" else np.linalg.norm(rows, axis=0)
    found = runs([int(value > 0.5 * (low + high)) for value in length])
    laws = tuple(_kept(instance, high if label else low, label) for label, _, _ in found)
    junctions = tuple(Junction(_slope(instance, law.bounds), places[0]) for law in laws[:-1])
    return laws, junctions, _edges(at, found)


def _kept(instance: Instance, norm: float, label: int) -> Law:
    within: ControlSet = instance.control_set.saturated((norm or 1e-100,))
    return derived(instance, within.arguments, "+" if label else "0")


def _slope(instance: Instance, bounds: tuple[float, ...]) -> Callable[[Array, Array, Parameters], Array]:
    n = len(instance.initial)

    def vanishing(t: Array, z: Array, p: Parameters) -> Array:
        found = instance.model.throttle_slope_batch(t, z[:n], z[n:], p, bounds)
        return np.asarray(found).reshape(1, -1)[0]

    return vanishing
