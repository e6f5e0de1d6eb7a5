"""From the solution of a programme to arcs and junctions, which Newton's method then makes exact.

Norms that switch are read from their means over the intervals of the programme, corners of other controls at its
points.
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
from satsym.solvers.multipoint.equations import Problem, begun, between
from satsym.solvers.multipoint.laws import Junction, Law, Parameters, derived
from satsym.solvers.multipoint.newton import Extremal, solved
from satsym.solvers.search.motion import Motion
from satsym.solvers.search.reading import corners
from satsym.solvers.search.transcription import DEGREE

FEWEST, DENSITY = 4, 1.0
"""Intervals of an arc, at least, and how many there are for each of the programme's."""

LOOKED = 50
"""Places on an arc at which signs are looked at."""

ROUNDS = 3
"""How often corners are read anew."""

SMALLEST_NORM = 1e-100
"""Norm in place of none, of which laws have no direction."""

SMALL_SIZE = 1e-3
"""Share of the largest size that the size of a state or a costate is, at least."""


Arcs = tuple[tuple[Law, ...], tuple[Junction, ...], Array]
"""Laws, the junctions between them, and where arcs begin and end."""


def exact(instance: Instance, at: Motion, limits: Limits) -> Extremal | None:
    """The extremal that a motion is near; ``None`` where its arcs are of a kind that is not read, or none is near."""
    with np.errstate(all="ignore"):
        if not instance.model.spec.throttled:
            return _with_corners(instance, at, limits)
        arcs = _throttled(at)
        found = None if arcs is None else _solved(instance, at, arcs, limits)
        return found if found is not None and _minimises(found) else None


def _with_corners(instance: Instance, at: Motion, limits: Limits) -> Extremal | None:
    """The extremal with one law that a motion is near, whose corners are junctions.

    The corners of what is found may be others than those that the motion had; then it begins anew with these.
    """
    bounds, law = corners.bounds_of(instance), derived(instance, instance.control_set.arguments)
    z = np.concatenate([at.x, at.lam])

    def along(times: Array) -> Array:
        return np.array([np.interp(times, at.times, row) for row in z])

    seen = corners.read(bounds, along, at.times, at.instance.parameters)
    for _ in range(ROUNDS):
        if seen is None:
            return None
        edges = np.concatenate([at.times[:1], seen.times, at.times[-1:]])
        junctions = tuple(bounds[number] for number in seen.which)
        found = _solved(instance, at, ((law,) * (len(junctions) + 1), junctions, edges), limits)
        if found is None or corners.jumps_along(found):
            return None
        again = corners.read_again(bounds, found)
        if again is not None and again.which == seen.which:
            return found
        seen = again
    return None


def _solved(instance: Instance, at: Motion, arcs: Arcs, limits: Limits) -> Extremal | None:
    """What Newton's method finds from a motion and its arcs."""
    laws, junctions, edges = arcs
    span = float(edges[-1] - edges[0])
    density = DENSITY * (len(at.times) - 1) / 3.0
    intervals = tuple(max(FEWEST, int(np.ceil(density * (b - a) / span))) for a, b in pairwise(edges.tolist()))
    z = np.concatenate([at.x, at.lam])
    size = np.abs(z).max(axis=1)
    n = len(at.x)
    for half in (size[:n], size[n:]):
        half[:] = np.maximum(half, SMALL_SIZE * half.max() or 1.0)
    own = replace(instance, initial=at.instance.initial, parameters=at.instance.parameters, t0=at.instance.t0)
    free = np.array([one.of(own) for one in own.free if one.place.value == "parameters"])
    problem = Problem(own, laws, junctions, intervals, (size, span, np.abs(free)))
    multipliers = np.zeros(len(instance.model.spec.multipliers))
    return solved(problem, begun(problem, at.times, z, edges, multipliers, free), limits)


def _minimises(found: Extremal) -> bool:
    """Whether norms are at the bounds at which H is least, all along: slopes of H by them have their signs."""
    problem, v = found.problem, found.unknown
    p, n = problem.given(v), problem.n
    shares = np.linspace(0.0, 1.0, LOOKED + 2)[1:-1]
    for arc, law in enumerate(problem.laws):
        z, (a, b) = between(problem, v, arc, shares), found.times[arc : arc + 2]
        slope = problem.instance.model.throttle_slope_batch(a + (b - a) * shares, z[:n], z[n:], p, law.bounds)
        row = np.asarray(slope).reshape(1, -1)[0]
        if not ((row < 0.0) if law.name == "+" else (row > 0.0)).all():
            return False
    return True


def _runs(labels: list[int]) -> list[tuple[int, int, int]]:
    found: list[tuple[int, int, int]] = []
    for k, label in enumerate(labels):
        if found and found[-1][0] == label:
            found[-1] = (label, found[-1][1], k)
        else:
            found.append((label, k, k))
    return found


def read_norm(at: Motion) -> tuple[list[int], Array] | None:
    """Whether a norm, or a control that switches, is at its upper bound on each arc, and where arcs begin and end.

    A programme's control may jump from point to point within an interval, so that its mean over each interval is read;
    arcs last as long as they must to do what these means do. ``None`` where several parts switch.
    """
    parts = [(places, part) for places, part in at.instance.control_set.parts if part.throttled]
    if len(parts) != 1:
        return None
    places, part = parts[0]
    low, high = part.levels
    rows = at.u[list(places)]
    length = rows[0] if part.kind == "box" else np.linalg.norm(rows, axis=0)
    share = np.clip((length - low) / (high - low if high > low else 1.0), 0.0, 1.0)
    steps = at.steps.reshape(-1, DEGREE)
    widths = steps.sum(axis=1)
    mean = (share.reshape(-1, DEGREE) * steps).sum(axis=1) / widths
    found = _runs([int(one > 0.5) for one in mean])
    missing = np.abs(np.round(mean) - mean) * widths  # of an interval's time at the level of its arc
    ends, sign = at.times[0] + np.cumsum(widths), [1.0 if label else -1.0 for label, *_ in found]
    inner = [ends[last] + sign[k] * (missing[last + 1] - missing[last]) for k, (*_, last) in enumerate(found[:-1])]
    edges = np.array([at.times[0], *inner, at.times[-1]])
    return [label for label, *_ in found], np.maximum.accumulate(np.clip(edges, at.times[0], at.times[-1]))


def _throttled(at: Motion) -> Arcs | None:
    """Arcs of the largest and the least norm of a vector, or of a single control that switches."""
    instance, seen = at.instance, read_norm(at)
    if seen is None:
        return None
    labels, edges = seen
    (places, part), *_ = [one for one in instance.control_set.parts if one[1].throttled]
    low, high = part.levels
    laws = tuple(_kept(instance, high if label else low, label) for label in labels)
    junctions = tuple(Junction(_slope(instance, law.bounds), tuple(places)) for law in laws[:-1])
    return laws, junctions, edges


def _kept(instance: Instance, norm: float, label: int) -> Law:
    within: ControlSet = instance.control_set.saturated((norm or SMALLEST_NORM,))
    law = derived(instance, within.arguments, "+" if label else "0")
    if norm:
        return law

    def none(t: Array, z: Array, p: Parameters) -> Array:
        u = law.control(t, z, p)
        return np.where(np.abs(u) <= SMALLEST_NORM, 0.0, u)

    return replace(law, control=none)


def _slope(instance: Instance, bounds: tuple[float, ...]) -> Callable[[Array, Array, Parameters], Array]:
    n = len(instance.initial)

    def vanishing(t: Array, z: Array, p: Parameters) -> Array:
        found = instance.model.throttle_slope_batch(t, z[:n], z[n:], p, bounds)
        return np.asarray(found).reshape(1, -1)[0]

    return vanishing
