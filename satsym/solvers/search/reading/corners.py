"""Extremals whose controls meet and leave bounds: one law, whose corners are junctions of arcs.

The law of the derivation is continuous where a bound is met, but has a corner there. Each corner is a junction, at
which a function vanishes: the slope of H by a control in a box, with that control at the bound, or by how much the norm
of a vector that no bound held would exceed its limit.
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
from satsym.solvers.multipoint.equations import between
from satsym.solvers.multipoint.laws import Junction, Parameters, Vanishing
from satsym.solvers.multipoint.newton import Extremal

MOST_CORNERS = 40
"""Corners of an extremal. More are the noise of a control that stays next to a bound."""

SAMPLES, INSIDE = 200, 1e-6
"""Places on an arc between which corners are looked for, and the share of the arc at either end that is left out."""

MET = 1e-2
"""How far a law may be from a bound at a corner that is read between two times, relative to that or to one."""

JUMPED = 1e-3
"""Share of the largest control by which a law jumps from one minimiser to another."""


@dataclass(frozen=True, eq=False)
class Corner(Junction):
    """A junction at a bound of a control in a box.

    The slope of H by an angle that is at a bound vanishes half a turn from the free angle as well, which is no corner.
    """

    met: Callable[[float, Array, Parameters], bool] = lambda t, z, p: True
    """Whether the law is at the bound, at a time and its states and costates (2n, 1)."""


@dataclass(frozen=True, eq=False)
class Read:
    """Corners along a motion, in order: their times, and the junctions by their places in the list of all."""

    times: Array
    which: tuple[int, ...]


def bounds_of(instance: Instance) -> list[Junction]:
    """A junction for each finite bound of the controls."""
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
                yield Corner(_slope_at(instance, place, bound), (place,), _met(instance, place, bound))
    elif part.kind in ("ball", "annulus"):
        norms = (part.radius,) if part.kind == "ball" else (part.inner, part.radius)
        yield from (Junction(_beyond(instance, places, norm), places) for norm in norms if math.isfinite(norm))


def _slope_at(instance: Instance, place: int, bound: float) -> Vanishing:
    """The slope of H by a control that is at a bound."""
    model, n, arguments = instance.model, len(instance.initial), instance.control_set.arguments

    def vanishing(t: Array, z: Array, p: Parameters) -> Array:
        u = _law(instance, t, z, p, arguments)
        u[place] = bound
        found = np.broadcast_to(model.stationarity_batch(t, z[:n], u, z[n:], p), u.shape)
        return _as(z, found[place])

    return vanishing


def _met(instance: Instance, place: int, bound: float) -> Callable[[float, Array, Parameters], bool]:
    """Whether the law of a control is at a bound."""
    arguments = instance.control_set.arguments

    def met(t: float, z: Array, p: Parameters) -> bool:
        u = _law(instance, np.array([t]), z, p, arguments).real[place]
        return bool(np.abs(u - bound).max() <= MET * max(1.0, abs(bound)))

    return met


def _beyond(instance: Instance, places: tuple[int, ...], norm: float) -> Vanishing:
    """By how much a vector that no bound held would exceed a norm."""
    within = instance.control_set
    free = [replace(part, radius=math.inf, inner=0.0) if at == places else part for at, part in within.parts]
    parts = tuple((at, part) for (at, _), part in zip(within.parts, free, strict=True))
    arguments = (replace(within, parts=parts) if parts else within.without_bounds).arguments

    def vanishing(t: Array, z: Array, p: Parameters) -> Array:
        u = _law(instance, t, z, p, arguments)[list(places)]
        return _as(z, np.sqrt((u * u).sum(axis=0)) - norm)

    return vanishing


def _as(z: Array, values: Array) -> Array:
    """Values as real numbers where the arguments are."""
    return values if np.iscomplexobj(z) else np.asarray(values.real)


def _law(instance: Instance, t: Array, z: Array, p: Parameters, arguments: tuple[float, ...]) -> Array:
    """The control law (m, M) with some bounds. Where it has angles, how it moves with an imaginary step is left out.

    Functions of an angle have none for complex numbers. What H loses by the angles is of second order, so Newton's
    method is a little slower then, unless controls in boxes and angles do not meet in H.
    """
    model, n = instance.model, len(instance.initial)
    if instance.control_set.angles:
        t, z, p = np.real(t), z.real, tuple(np.real(value) for value in p)
    law = model.control_law_batch(t, z[:n], z[n:], p, arguments)
    return np.array(np.broadcast_to(law, (len(model.spec.controls), z.shape[1])), dtype=complex)


def read(bounds: list[Junction], along: Callable[[Array], Array], times: Array, p: Parameters) -> Read | None:
    """The corners of the law along a motion; ``None`` where there are too many, or arithmetic fails.

    Parameters
    ----------
    bounds
        Of the instance, from :func:`bounds_of`.
    along
        States above costates (2n, M) at times (M,).
    times
        Increasing, between which corners are looked for (N,).
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
        if isinstance(bound, Corner):
            at = [time for time in at if bound.met(time, along(np.array([time])), p)]
        found += [(time, number) for time in at]
    found.sort()
    if len(found) > MOST_CORNERS:
        return None
    return Read(np.array([time for time, _ in found]), tuple(number for _, number in found))


def read_again(bounds: list[Junction], extremal: Extremal) -> Read | None:
    """The corners of the law along an extremal, at whose junctions it may have others."""
    shares, edges = np.linspace(INSIDE, 1.0 - INSIDE, SAMPLES), extremal.times
    if not (np.diff(edges) > 0.0).all():
        return None
    times = np.concatenate([a + (b - a) * shares for a, b in pairwise(edges)])
    return read(bounds, partial(values_at, extremal), times, extremal.problem.given(extremal.unknown))


def values_at(extremal: Extremal, times: Array) -> Array:
    """States above costates (2n, M) of an extremal at times (M,)."""
    edges = extremal.times
    arc = np.clip(np.searchsorted(edges, times, side="right") - 1, 0, len(edges) - 2)
    shares = (times - edges[arc]) / (edges[arc + 1] - edges[arc])
    found = np.empty((2 * extremal.problem.n, len(times)))
    for k in np.unique(arc).tolist():
        found[:, arc == k] = between(extremal.problem, extremal.unknown, k, shares[arc == k])
    return found


def jumps_along(extremal: Extremal) -> bool:
    """Whether a law without closed form jumps from one minimiser of H to another, which is no corner."""
    problem = extremal.problem
    if not problem.instance.model.spec.stationary:
        return False
    law, p = problem.laws[0], problem.given(extremal.unknown)
    edges, shares = extremal.times, np.linspace(INSIDE, 1.0 - INSIDE, SAMPLES)
    times = np.concatenate([a + (b - a) * shares for a, b in pairwise(edges)])
    return bool(jumps(lambda at: law.control(at, values_at(extremal, at), p), times, JUMPED))
