"""Conversion of the solution of a programme into arcs and junctions, which Newton's method makes exact.

Norms that switch are read from their means over the intervals of the programme, corners of other controls at its
points. The control law is continuous where a bound becomes active, but has a corner there. Each corner is a junction,
where a function vanishes: the derivative of H with respect to a control at its bound in a box, or the excess of the
norm of the unbounded control vector over its limit.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

import numpy as np

from satsym.arrays import Array
from satsym.control_set import ControlSet
from satsym.instance import Instance
from satsym.solvers.control.corners import beyond, zeros
from satsym.solvers.control.jumps import jumps
from satsym.solvers.iteration import Limits
from satsym.solvers.multipoint.equations import Problem, begun, between
from satsym.solvers.multipoint.laws import Junction, Law, Parameters, Vanishing, derived
from satsym.solvers.multipoint.newton import Extremal, solved
from satsym.solvers.search.motion import Motion
from satsym.solvers.search.transcription import DEGREE

FEWEST, DENSITY = 4, 1.0
"""Minimum number of intervals of an arc, and number of intervals for each interval of the programme."""

LOOKED = 50
"""Number of points of an arc at which signs are checked."""

ROUNDS = 3
"""Maximum number of times that the corners of the control law are determined again."""

SMALLEST_NORM = 1e-100
"""Norm that replaces a zero norm, for which control laws have no direction."""

SMALL_SIZE = 1e-3
"""Minimum scale of a state or a costate, relative to the largest scale."""

Arcs = tuple[tuple[Law, ...], tuple[Junction, ...], Array]
"""Control laws of arcs, junctions between the arcs, and times at which arcs begin and end."""

MOST_CORNERS = 40
"""Maximum number of corners of an extremal. A larger number is the noise of a control that stays near a bound."""

SAMPLES, INSIDE = 200, 1e-6
"""Number of points on an arc between which corners are searched for, and fraction of the arc at each end that is left
out."""

MET = 1e-2
"""Largest distance of a control law from a bound at a corner, relative to the bound or to 1, whichever is larger."""

JUMPED = 1e-3
"""Change of a control law, relative to the largest control, that counts as a jump between minimisers."""


def exact(instance: Instance, at: Motion, limits: Limits) -> Extremal | None:
    """Return the extremal near a motion; ``None`` if its arcs are of an unsupported kind, or none is near."""
    with np.errstate(all="ignore"):
        if not instance.model.spec.throttled:
            return _with_corners(instance, at, limits)
        arcs = _throttled(at)
        found = None if arcs is None else _solved(instance, at, arcs, limits)
        return found if found is not None and _minimises(found) else None


def _with_corners(instance: Instance, at: Motion, limits: Limits) -> Extremal | None:
    """Return the extremal near a motion, with a single control law whose corners are junctions.

    If the extremal has other corners than the motion, the iteration restarts with these.
    """
    bounds, law = _bounds_of(instance), derived(instance, instance.control_set.arguments)
    z = np.concatenate([at.x, at.lam])

    def along(times: Array) -> Array:
        return np.array([np.interp(times, at.times, row) for row in z])

    seen = _read_corners(bounds, along, at.times, at.instance.parameters)
    for _ in range(ROUNDS):
        if seen is None:
            return None
        edges = np.concatenate([at.times[:1], seen.times, at.times[-1:]])
        junctions = tuple(bounds[number] for number in seen.which)
        found = _solved(instance, at, ((law,) * (len(junctions) + 1), junctions, edges), limits)
        if found is None or _jumps_along(found):
            return None
        again = _read_again(bounds, found)
        if again is not None and again.which == seen.which:
            return found
        seen = again
    return None


def _solved(instance: Instance, at: Motion, arcs: Arcs, limits: Limits) -> Extremal | None:
    """Return the extremal that Newton's method finds from a motion and its arcs, or ``None``."""
    laws, junctions, edges = arcs
    span = float(edges[-1] - edges[0])
    meshes = tuple(_mesh(at, a, b) for a, b in pairwise(edges.tolist()))
    z = np.concatenate([at.x, at.lam])
    size = np.abs(z).max(axis=1)
    n = len(at.x)
    for half in (size[:n], size[n:]):
        half[:] = np.maximum(half, SMALL_SIZE * half.max() or 1.0)
    own = replace(instance, initial=at.instance.initial, parameters=at.instance.parameters, t0=at.instance.t0)
    free = np.array([one.of(own) for one in own.free if one.place.value == "parameters"])
    problem = Problem(own, laws, junctions, meshes, (size, span, np.abs(free)))
    multipliers = np.zeros(len(instance.model.spec.multipliers))
    return solved(problem, begun(problem, at.times, z, edges, multipliers, free), limits)


def _mesh(at: Motion, begin: float, end: float) -> Array:
    """Return edges from 0 to 1 of the intervals of an arc, as dense as the mesh of the programme."""
    edges = at.times[::DEGREE]
    count = np.arange(len(edges)) * DENSITY
    first, last = np.interp((begin, end), edges, count)
    intervals = max(FEWEST, int(np.ceil(last - first)))
    inner = np.interp(np.linspace(first, last, intervals + 1), count, edges)
    return np.asarray((inner - inner[0]) / (inner[-1] - inner[0]))


def _minimises(found: Extremal) -> bool:
    """Return whether all norms are at bounds that minimise H, by the signs of the derivatives of H."""
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
    """Return whether a norm or switching control is at its upper bound on each arc, and the times of the arcs' ends.

    The control of a programme may jump between points within an interval, so its mean over each interval is used; arcs
    have the lengths that reproduce these means. ``None`` if several control sets switch.
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
    """Return arcs of the largest and smallest norm of a vector or of a switching control, or ``None``."""
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
    law = derived(instance, within.arguments, "+" if label else "-" if norm else "0")
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


@dataclass(frozen=True, eq=False)
class _Corner(Junction):
    """A junction at a bound of a control in a box.

    The derivative of H with respect to an angle at its bound also vanishes half a turn from the free angle; this is no
    corner.
    """

    met: Callable[[float, Array, Parameters], bool] = lambda t, z, p: True
    """Function that returns whether the law is at the bound, from time, states and costates (2n, 1), and parameters."""


@dataclass(frozen=True, eq=False)
class _Read:
    """Corners along a motion in order of time: their times, and which junctions of a list they are."""

    times: Array
    which: tuple[int, ...]


def _bounds_of(instance: Instance) -> list[Junction]:
    """Return a junction for each finite bound of the controls."""
    within = instance.control_set
    parts = within.parts or ((tuple(range(len(instance.model.spec.controls))), within),)
    return [one for places, part in parts for one in _bounds(instance, places, part)]


def _bounds(instance: Instance, places: tuple[int, ...], part: ControlSet) -> Iterator[Junction]:
    if part.directed:
        return
    if part.kind == "box":
        ends = zip(places, part.lower, part.upper, strict=True)
        for place, bound in ((place, bound) for place, *both in ends for bound in both):
            if math.isfinite(bound):
                yield _Corner(_slope_at(instance, place, bound), (place,), _met(instance, place, bound))
    elif part.kind in ("ball", "annulus"):
        norms = (part.radius,) if part.kind == "ball" else (part.inner, part.radius)
        yield from (Junction(_beyond(instance, places, norm), places) for norm in norms if math.isfinite(norm))


def _slope_at(instance: Instance, place: int, bound: float) -> Vanishing:
    """Return a function that gives the derivative of H with respect to a control at its bound."""
    model, n, arguments = instance.model, len(instance.initial), instance.control_set.arguments

    def vanishing(t: Array, z: Array, p: Parameters) -> Array:
        u = _law(instance, t, z, p, arguments)
        u[place] = bound
        found = np.broadcast_to(model.stationarity_batch(t, z[:n], u, z[n:], p), u.shape)
        return _as(z, found[place])

    return vanishing


def _met(instance: Instance, place: int, bound: float) -> Callable[[float, Array, Parameters], bool]:
    """Return a function that tells whether the law of a control is at a bound."""
    arguments = instance.control_set.arguments

    def met(t: float, z: Array, p: Parameters) -> bool:
        u = _law(instance, np.array([t]), z, p, arguments).real[place]
        return bool(np.abs(u - bound).max() <= MET * max(1.0, abs(bound)))

    return met


def _beyond(instance: Instance, places: tuple[int, ...], norm: float) -> Vanishing:
    """Return a function that gives the excess of the norm of an unbounded control vector over a given norm."""
    within = instance.control_set
    free = [replace(part, radius=math.inf, inner=0.0) if at == places else part for at, part in within.parts]
    parts = tuple((at, part) for (at, _), part in zip(within.parts, free, strict=True))
    arguments = (replace(within, parts=parts) if parts else within.without_bounds).arguments

    def vanishing(t: Array, z: Array, p: Parameters) -> Array:
        u = _law(instance, t, z, p, arguments)[list(places)]
        return _as(z, np.sqrt((u * u).sum(axis=0)) - norm)

    return vanishing


def _as(z: Array, values: Array) -> Array:
    """Return real values if the arguments are real, otherwise the complex values."""
    return values if np.iscomplexobj(z) else np.asarray(values.real)


def _law(instance: Instance, t: Array, z: Array, p: Parameters, arguments: tuple[float, ...]) -> Array:
    """Return the control law (m, M) for given bounds; for control sets with angles, imaginary steps are ignored.

    Functions of an angle are not defined for complex numbers. The effect of the angles on H is of second order, so that
    Newton's method only converges a little more slowly, unless controls in boxes and angles do not interact in H.
    """
    model, n = instance.model, len(instance.initial)
    if instance.control_set.angles:
        t, z, p = np.real(t), z.real, tuple(np.real(value) for value in p)
    law = model.control_law_batch(t, z[:n], z[n:], p, arguments)
    return np.array(np.broadcast_to(law, (len(model.spec.controls), z.shape[1])), dtype=complex)


def _read_corners(bounds: list[Junction], along: Callable[[Array], Array], times: Array, p: Parameters) -> _Read | None:
    """Return the corners of the law along a motion; ``None`` if there are too many or values are not finite.

    Parameters
    ----------
    bounds
        Junctions at the bounds of the instance's controls, from :func:`_bounds_of`.
    along
        Function that returns states above costates (2n, M) at times (M,).
    times
        Increasing times (N,) between which corners are searched for.
    """
    found, z = list[tuple[float, int]](), along(times)
    for number, bound in enumerate(bounds):

        def value(at: Array, bound: Junction = bound) -> Array:
            return np.broadcast_to(bound.vanishing(at, along(at), p), at.shape)

        values = np.broadcast_to(bound.vanishing(times, z, p), times.shape)
        if not np.isfinite(values).all():
            return None
        momentary = beyond(lambda at, value=value: float(value(np.array([at]))[0]), times, values)  # type: ignore[misc]
        every = np.union1d(times, momentary)
        at = zeros(every, values if len(every) == len(times) else value(every))
        if isinstance(bound, _Corner):
            at = [time for time in at if bound.met(time, along(np.array([time])), p)]
        found += [(time, number) for time in at]
    found.sort()
    if len(found) > MOST_CORNERS:
        return None
    return _Read(np.array([time for time, _ in found]), tuple(number for _, number in found))


def _read_again(bounds: list[Junction], extremal: Extremal) -> _Read | None:
    """Return the corners of the law along an extremal, which may differ from its junctions."""
    shares, edges = np.linspace(INSIDE, 1.0 - INSIDE, SAMPLES), extremal.times
    if not (np.diff(edges) > 0.0).all():
        return None
    times = np.concatenate([a + (b - a) * shares for a, b in pairwise(edges)])
    return _read_corners(bounds, partial(_values_at, extremal), times, extremal.problem.given(extremal.unknown))


def _values_at(extremal: Extremal, times: Array) -> Array:
    """Return states above costates (2n, M) of an extremal at times (M,)."""
    edges = extremal.times
    arc = np.clip(np.searchsorted(edges, times, side="right") - 1, 0, len(edges) - 2)
    shares = (times - edges[arc]) / (edges[arc + 1] - edges[arc])
    found = np.empty((2 * extremal.problem.n, len(times)))
    for k in np.unique(arc).tolist():
        found[:, arc == k] = between(extremal.problem, extremal.unknown, k, shares[arc == k])
    return found


def _jumps_along(extremal: Extremal) -> bool:
    """Return whether a law without closed form jumps from one minimiser of H to another, which is no corner."""
    problem = extremal.problem
    if not problem.instance.model.spec.stationary:
        return False
    law, p = problem.laws[0], problem.given(extremal.unknown)
    edges, shares = extremal.times, np.linspace(INSIDE, 1.0 - INSIDE, SAMPLES)
    times = np.concatenate([a + (b - a) * shares for a, b in pairwise(edges)])
    return bool(jumps(lambda at: law.control(at, _values_at(extremal, at), p), times, JUMPED))
