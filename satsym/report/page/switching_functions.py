"""Switching functions, whose sign determines at which bound a control is, where H is linear in it. Draws nothing."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.report.plots.scene import Scene

LINEAR = 1e-9
"""Largest deviation of H from a straight line, relative to its change, at which H counts as linear in a control."""
STEP = 1e-6
"""Size of test controls that show in which direction H decreases, relative to the largest norm."""


@dataclass(frozen=True, eq=False)
class Switching:
    """The switching function of a control, or of a norm.

    Attributes
    ----------
    controls
        Places of the controls that it is about.
    values
        At the nodes, the slope of H: where it is negative the upper bound is best, where it is positive the lower.
    """

    controls: tuple[int, ...]
    values: Array


def of(scene: Scene) -> list[Switching]:
    """Return the switching functions of a solution: of controls bounded on both sides, and of bounded norms."""
    if scene.lam is None:
        return []
    case = scene.instance
    found = []
    for i in range(len(scene.u)):
        if math.isfinite(case.lower[i]) and math.isfinite(case.upper[i]) and case.lower[i] < case.upper[i]:
            ends = [_with(scene, i, value) for value in (case.lower[i], case.upper[i])]
            found.append(_slope(scene, (i,), ends[0], ends[1], case.upper[i] - case.lower[i]))
    for norm in case.bounded_norms:
        places = list(norm.places)
        way = _downhill(scene, places, norm.upper)
        if way is not None:
            none, full = scene.u.copy(), scene.u.copy()
            none[places], full[places] = norm.lower * way, norm.upper * way
            found.append(_slope(scene, tuple(places), none, full, norm.upper - norm.lower))
    return [one for one in found if one is not None]


def _with(scene: Scene, i: int, value: float) -> Array:
    u = scene.u.copy()
    u[i] = value
    return u


def _slope(scene: Scene, places: tuple[int, ...], low: Array, high: Array, width: float) -> Switching | None:
    """Return the slope of H from one value to another, if H is linear between them."""
    if not width > 0.0:
        return None
    first, middle, last = (_hamiltonian(scene, u) for u in (low, 0.5 * (low + high), high))
    bent = np.nanmax(np.abs(middle - 0.5 * (first + last)), initial=0.0)
    if not bent <= LINEAR * np.nanmax(np.abs(np.concatenate([first, last])), initial=1e-300):
        return None
    return Switching(places, (last - first) / width)


def _downhill(scene: Scene, places: list[int], largest: float) -> Array | None:
    """Return the direction in which H falls most quickly from zero control, shape (k, N+1); zero without one."""
    slopes = []
    for i in places:
        step = np.zeros_like(scene.u)
        step[i] = STEP * largest
        rest = scene.u.copy()
        rest[places] = 0.0
        slopes.append(_hamiltonian(scene, rest + step) - _hamiltonian(scene, rest - step))
    gradient = np.array(slopes)
    size = np.linalg.norm(gradient, axis=0)
    if not (size[np.isfinite(size)] > 0.0).any():
        return None
    with np.errstate(all="ignore"):
        return np.where(size > 0.0, -gradient / size, 0.0)


def _hamiltonian(scene: Scene, u: Array) -> Array:
    assert scene.lam is not None
    with np.errstate(all="ignore"):
        return np.asarray(
            scene.instance.model.hamiltonian_batch(scene.nodes, scene.x, u, scene.lam, scene.instance.parameters)
        )
