"""Revolutions about the origin: which states turn, how fast, and spirals as starts of nonlinear programmes."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.instance.unknowns import Place
from satsym.solvers.search.controls import Controls
from satsym.solvers.search.sizes import flow, resting

EQUAL_RATE = 1e-9
"""Relative difference of a rate and a state below which they count as the same quantity."""

Pairs = list[tuple[int, int]]
"""Indices of two or three positions, each with that of its velocity."""


def pairs(instance: Instance, controls: Controls) -> Pairs:
    """Return positions with their velocities, or an empty list.

    It is empty if a position has to be positive: it is a distance then, and the other positions are angles.
    """
    rng, n = np.random.default_rng(1), len(instance.initial)
    x = np.array(instance.initial) * (1.0 + 0.1 * rng.uniform(-1.0, 1.0, n)) + 1e-3 * rng.uniform(1.0, 2.0, n)
    v = resting(controls)
    with np.errstate(all="ignore"):
        f = flow(instance, controls, instance.t0, x, v)
    found = [(i, j) for i in range(n) for j in range(n) if i != j and abs(f[i] - x[j]) <= EQUAL_RATE * abs(x[j])]
    polar = any(instance.model.spec.states[i].positive for i, _ in found)
    return found if 2 <= len(found) <= 3 and not polar else []


def rate(instance: Instance, controls: Controls, start: Array, end: Array, found: Pairs) -> float:
    """Return the mean angular rate of both ends; if initial velocities are free, that of a circular orbit there."""
    (p, vp), (q, vq) = found[:2]
    own = _circular(instance, controls, start, found) if _begins_freely(instance, found) else _rate(start, found)
    if _begins_freely(instance, found) and np.isnan(end[[p, q, vp, vq]]).any():
        return own
    return 0.5 * (own + _rate(np.where(np.isnan(end), start, end), found))


def swept(start: Array, end: Array, found: Pairs) -> float:
    """Return the angle from the initial to the final position in the sense of the initial motion, below a turn."""
    (p, _), (q, _) = found[:2]
    apart = np.arctan2(end[q], end[p]) - np.arctan2(start[q], start[p])
    return float((_sense(start, found) * apart) % (2.0 * np.pi))


def spiral(
    instance: Instance, controls: Controls, x: Array, times: Array, both: tuple[Array, Array], turns: int
) -> Array:
    """Return states on a spiral about the origin, or those of a straight line if the final position is not given.

    Free initial velocities are those of the spiral, and free final ones those of a circular orbit.

    Parameters
    ----------
    x
        States of the straight line at the times, shape (n, M).
    both
        Initial and final states.
    turns
        Number of full turns besides the angle between both ends.
    """
    found, (start, end) = pairs(instance, controls), both
    (p, vp), (q, vq) = found[:2]
    if np.isnan(end[[p, q]]).any():
        return x
    lasting, share = times[-1] - times[0], (times - times[0]) / (times[-1] - times[0])
    sense, sweep = _sense(start, found), swept(start, end, found) + 2.0 * np.pi * turns
    begin, radius = np.arctan2(start[q], start[p]), np.hypot(start[p], start[q])
    far, last = np.hypot(end[p], end[q]), np.hypot(end[vp], end[vq])
    first = radius * abs(sweep) / lasting if _begins_freely(instance, found) else np.hypot(start[vp], start[vq])
    speeds = first, first * np.sqrt(radius / max(far, 1e-300)) if np.isnan(last) else last
    r, angle = radius + (far - radius) * share, begin + sense * sweep * share
    speed = sense * np.sign(sweep) * (speeds[0] + (speeds[1] - speeds[0]) * share)
    x = x.copy()
    x[p], x[q], x[vp], x[vq] = r * np.cos(angle), r * np.sin(angle), -speed * np.sin(angle), speed * np.cos(angle)
    return x


def _begins_freely(instance: Instance, found: Pairs) -> bool:
    """Return whether an initial velocity in the plane of revolutions is free."""
    speeds = {speed for _, speed in found[:2]}
    return any(one.place is Place.INITIAL and one.index in speeds for one in instance.free)


def _circular(instance: Instance, controls: Controls, start: Array, found: Pairs) -> float:
    """Return the angular rate of a circular orbit at a position, from the attraction there; 0 if there is none."""
    (p, vp), (q, vq) = found[:2]
    still = start.copy()
    still[[speed for _, speed in found]] = 0.0
    pull = flow(instance, controls, instance.t0, still, resting(controls))
    inwards = -(pull[vp] * still[p] + pull[vq] * still[q])
    return float(np.sqrt(max(inwards, 0.0) / max(still[p] ** 2 + still[q] ** 2, 1e-300)))


def _rate(x: Array, found: Pairs) -> float:
    (p, vp), (q, vq) = found[:2]
    return float(abs(x[p] * x[vq] - x[q] * x[vp]) / max(x[p] ** 2 + x[q] ** 2, 1e-300))


def _sense(x: Array, found: Pairs) -> float:
    (p, vp), (q, vq) = found[:2]
    return float(np.sign(x[p] * x[vq] - x[q] * x[vp])) or 1.0
