"""Curves in space for pictures, from a model's generated functions: path, thrust, relative motion."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.kernels import Kernels
from satsym.spec import ProblemSpec, Variable

LARGEST_DRAWN = 1e100
"""Largest number that is drawn; larger ones come from failed runs."""
_COMPLEX_STEP = 1e-30
_REAL_STEP = 1e-5
_COMMON_TOLERANCE = 1e-9
"""Largest relative difference of two time derivatives that count as equal."""


def clean(values: Array) -> Array:
    """Return the values with NaN for those that cannot be drawn."""
    array = np.array(values, dtype=float)
    with np.errstate(invalid="ignore"):
        array[~(np.abs(array) < LARGEST_DRAWN)] = np.nan
    return array


def states(model: Kernels, x: Array) -> Array:
    """Return states until they leave their domain, after which they have no meaning; shape (n, N+1)."""
    rows = clean(x)
    positive = [i for i, state in enumerate(model.spec.states) if state.positive]
    with np.errstate(invalid="ignore"):
        outside = np.flatnonzero((rows[positive] <= 0.0).any(axis=0))
    if outside.size:
        rows[:, outside[0] :] = np.nan
    return rows


def path(model: Kernels, times: Array, x: Array, p: Sequence[float]) -> Array:
    """Return position vectors along a trajectory, shape (2 or 3, N+1)."""
    with np.errstate(all="ignore"):
        return clean(model.position_batch(times, x, p))


def reference(model: Kernels, times: Array, p: Sequence[float]) -> Array:
    """Return states on the reference curve, shape (n, N+1)."""
    with np.errstate(all="ignore"):
        return clean(model.reference_batch(times, p))


def uncontrolled(model: Kernels, times: Array, x0: Sequence[float], p: Sequence[float]) -> Array:
    """Return states of the uncontrolled motion at the nodes, shape (n, N+1), by at least a thousand steps."""
    m, parts = len(model.spec.controls), -(-1000 // (len(times) - 1))
    fine = np.interp(np.arange((len(times) - 1) * parts + 1) / parts, np.arange(len(times)), times)
    rest = np.zeros((m, len(fine)))
    x, _, _ = model.forward(fine, x0, rest, rest[:, 1:], p)
    return states(model, x[:, ::parts])


def angles(spec: ProblemSpec) -> frozenset[str]:
    """Return states and controls that are angles, by declaration or as members of an angle set."""
    declared = {v.symbol for v in (*spec.states, *spec.controls) if v.kind == "angle"}
    return frozenset(declared | {name for part in spec.control_parts if part.kind == "angle" for name in part.controls})


def rests(model: Kernels, times: Array, x: Array, p: Sequence[float]) -> bool:
    """Tell whether zero controls have no effect, so that no angle turns a part of the motion."""
    if not _angles(model):
        return True
    with np.errstate(all="ignore"):
        one, *others = (model.dynamics_batch(times, x, u, p) for u in _opposite(model, x.shape[1]))
    size = np.nanmax(np.abs(one), axis=1, initial=0.0)[:, None]
    return all(bool((np.abs(other - one) <= _COMMON_TOLERANCE * size).all()) for other in others)


def _angles(model: Kernels) -> list[int]:
    return [i for i, control in enumerate(model.spec.controls) if control.symbol in angles(model.spec)]


def _opposite(model: Kernels, count: int) -> list[Array]:
    """Return zero controls, and those with some of the angles turned by half a turn, shape (m, count) each."""
    controls = model.spec.controls
    found: list[Array] = [np.zeros((len(controls), count))]
    for i in _angles(model):
        turned = [u.copy() for u in found]
        for u in turned:
            u[i] = 180.0 if controls[i].unit.startswith("deg") else np.pi
        found += turned
    return found


def _drift(model: Kernels, times: Array, x: Array, p: Sequence[float]) -> Array:
    """Return the dynamics without control, shape (n, N+1); effects of angles cancel over half a turn."""
    return np.mean([model.dynamics_batch(times, x, u, p) for u in _opposite(model, x.shape[1])], axis=0)


def thrust(
    model: Kernels, times: Array, x: Array, u: Array, p: Sequence[float], place: Callable[[Array], Array] | None = None
) -> Array:
    """Return the acceleration in space that the controls add, shape (2 or 3, N+1).

    Parameters
    ----------
    place
        From states to places, also of complex numbers; by default the position vector of the model. Of such a place
        only accelerations are given: where the controls act on the velocity itself, zeros.

    Notes
    -----
    The generated functions know positions and rates of states, no forces. But the velocity in space is the
    derivative of the position along the dynamics, and its change along what the controls add to the dynamics is
    the acceleration that they add. Where the controls act on the velocity itself, that is what is returned.
    """
    with np.errstate(all="ignore"):
        added = model.dynamics_batch(times, x, u, p) - _drift(model, times, x, p)

        def velocity(states: Array, rates: Array) -> Array:
            beside = states + 1j * _COMPLEX_STEP * rates
            return np.imag(model.position_batch(times, beside, p) if place is None else place(beside)) / _COMPLEX_STEP

        direct = velocity(x, added)
        if np.nanmax(np.abs(direct), initial=0.0) > 0.0:
            return clean(direct) if place is None else np.zeros_like(direct)
        sizes = np.nanmax(np.abs(x), axis=1, keepdims=True)  # a state that stays at zero has none
        size = np.nanmax(np.abs(added) / np.where(sizes > 0.0, sizes, np.nanmax(sizes)), initial=0.0)
        if not 0.0 < size < np.inf:
            return np.zeros_like(direct)
        step = _REAL_STEP / size
        ahead, behind = x + step * added, x - step * added
        ahead_rates, behind_rates = (_drift(model, times, y, p) for y in (ahead, behind))
        return clean((velocity(ahead, ahead_rates) - velocity(behind, behind_rates)) / (2.0 * step))


@dataclass(frozen=True, eq=False)
class Relative:
    """A motion relative to a moving reference point, in curvilinear orbit coordinates; arrays of shape (N+1,)."""

    along: Array
    """Distance along the reference circle, ahead of the reference point; the circle is about the origin."""
    radial: Array
    """Radial distance from the reference circle, positive outwards."""


def relative(positions: Array, reference: Array) -> Relative | None:
    """Return a path relative to the reference point; ``None`` if that stands still or passes the origin.

    Parameters
    ----------
    positions, reference
        At the same times, shape (2 or 3, N+1).
    """
    if len(reference) == 2:
        positions, reference = (np.vstack([curve, np.zeros(curve.shape[1])]) for curve in (positions, reference))
    radius = np.linalg.norm(reference, axis=0)
    motion = np.gradient(reference, axis=1)
    normal = np.cross(reference, motion, axis=0)
    turning = np.linalg.norm(normal, axis=0)
    if not (turning > 1e-12 * radius**2).all() or not np.isfinite(turning).all():
        return None
    outward = reference / radius
    ahead = np.cross(normal / turning, outward, axis=0)
    up, on = (positions * outward).sum(axis=0), (positions * ahead).sum(axis=0)
    angle = np.full_like(up, np.nan)
    known = np.isfinite(up) & np.isfinite(on)
    angle[known] = np.unwrap(np.arctan2(on[known], up[known]))
    return Relative(radius * angle, np.hypot(up, on) - radius)


CIRCULAR = 1e-6
"""Largest deviation of time derivatives from those of a circular orbit, relative to its velocity and acceleration."""
NUDGE, EXACT = 0.1, 1e-12
"""Distance from the trajectory at which derivatives are compared, relative to the states, and their tolerance."""
_NAME = re.compile(r"(?:|[pqrs]_?|pos_?)([xyz])")


def pairs(model: Kernels, times: Array, x: Array, u: Array, p: Sequence[float]) -> list[tuple[int, int]]:
    """Return states with the states that are their rates: motions in one degree of freedom each.

    Rates are compared beside the trajectory, because different states may agree on it.
    """
    known = np.isfinite(x).all(axis=0) & np.isfinite(u).all(axis=0)
    if not known.any():
        return []
    times, x, u = times[known], x[:, known], u[:, known]
    sizes = np.abs(x).max(axis=1, initial=0.0, keepdims=True)
    beside = x + NUDGE * np.where(sizes > 0.0, sizes, 1.0) * np.random.default_rng(0).uniform(-1.0, 1.0, x.shape)
    with np.errstate(all="ignore"):
        rates = model.dynamics_batch(times, beside, u, p)
    found = []
    for i, own in enumerate(rates):
        same = (j for j, row in enumerate(beside) if j != i and np.allclose(own, row, rtol=EXACT, atol=0.0))
        if (j := next(same, None)) is not None:
            found.append((i, j))
    return found


def polar(states: Sequence[Variable]) -> tuple[int, int] | None:
    """Return the states that are a distance and an angle about the origin, by their names; or ``None``."""
    named = {state.symbol: i for i, state in enumerate(states)}
    distance = next((named[name] for name in ("r", "rho") if name in named), None)
    angle = next((named[name] for name in ("theta", "phi") if name in named), None)
    if distance is None or angle is None or states[angle].kind != "angle" or states[angle].unit not in ("1", "rad"):
        return None
    return distance, angle


@dataclass(frozen=True, eq=False)
class Swept:
    """A path in a plane whose states are a distance and velocities, and tell the angle by its rate alone.

    Attributes
    ----------
    distance
        Place of that state.
    path, thrust
        From an angle of zero at the start, and the acceleration that controls add; shape (2, N+1).
    circle
        The circular orbit that the end is on, shape (2, K); ``None`` where it is on none.
    """

    distance: int
    path: Array
    thrust: Array | None
    circle: Array | None

    @classmethod
    def of(cls, model: Kernels, times: Array, x: Array, u: Array, p: Sequence[float]) -> Swept | None:
        """Return the path of a motion whose states have the meanings of a radial and a transverse velocity, if any."""
        meant = {state.meaning: i for i, state in enumerate(model.spec.states)}
        radial, across = meant.get("radial velocity"), meant.get("transverse velocity")
        named = [i for i, state in enumerate(model.spec.states) if state.symbol in ("r", "rho")]
        if radial is None or across is None or len(named) != 1:
            return None
        r, steps = x[named[0]], np.diff(times)
        with np.errstate(all="ignore"):
            rate = x[across] / r
            angle = np.concatenate([[0.0], np.cumsum(0.5 * steps * (rate[1:] + rate[:-1]))])
            drift = _drift(model, times, x, p)
            added = model.dynamics_batch(times, x, u, p) - drift
        outward = np.array([np.cos(angle), np.sin(angle)])
        ahead = np.array([-outward[1], outward[0]])
        thrust = clean(added[radial] * outward + added[across] * ahead)
        speed = abs(float(x[across, -1]))
        sizes = np.array([speed, speed**2 / r[-1], speed**2 / r[-1]])
        closed = bool((np.abs(drift[[named[0], radial, across], -1]) <= CIRCULAR * sizes).all())
        turn = np.linspace(0.0, 2.0 * np.pi, 361)
        circle = r[-1] * np.array([np.cos(turn), np.sin(turn)])
        moves = np.nanmax(np.abs(thrust), initial=0.0) > 0.0
        return cls(named[0], clean(r * outward), thrust if moves else None, circle if closed else None)


def places(states: Sequence[Variable], rated: Sequence[tuple[int, int]]) -> tuple[int, ...]:
    """Return two or three states that are components of a position, by names or because all have rates; or ``None``."""
    named = {match[1]: i for i, state in enumerate(states) if (match := _NAME.fullmatch(state.symbol))}
    by_rate = tuple(i for i, _ in rated)
    for found in (tuple(named[axis] for axis in "xyz" if axis in named), by_rate):
        if len(found) in (2, 3) and len({states[i].unit for i in found}) == 1 and states[found[0]].kind == "real":
            angular = "rad" in states[found[0]].unit or "deg" in states[found[0]].unit
            if not angular:
                return found
    return ()


def level(
    model: Kernels, times: Array, x: Array, u: Array, p: Sequence[float], found: Sequence[int]
) -> tuple[int, ...]:
    """Return two coordinates in drawing order: first the one that the motion does not depend on.

    For a satellite near a circular orbit that is the distance along the track, for a falling body the horizontal
    distance.
    """
    known = np.isfinite(x).all(axis=0) & np.isfinite(u).all(axis=0)
    if len(found) != 2 or not known.any():
        return tuple(found)
    times, x, u = times[known], x[:, known], u[:, known]
    with np.errstate(all="ignore"):
        rates = model.dynamics_batch(times, x, u, p)

        def matters(i: int) -> bool:
            moved = x.copy()
            moved[i] += NUDGE * (np.abs(x[i]).max() or 1.0)
            return not np.allclose(model.dynamics_batch(times, moved, u, p), rates, rtol=EXACT, atol=0.0)

        first, second = found
        return (second, first) if matters(first) and not matters(second) else (first, second)
