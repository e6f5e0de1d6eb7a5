"""The point of a convex set that is nearest to the origin, for a set that is known by its support points.

Wolfe's algorithm: the nearest point of the hull of few support points, one more at a time (Wolfe, Finding the nearest
point in a polytope, Mathematical Programming 11, 1976).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array

ROUNDS = 400
"""Support points that are asked for at most."""

NO_GAIN = 1e-13
"""Relative gain of a support point below which rounding has the last word."""


@dataclass(frozen=True, eq=False)
class Near:
    """A point next to the nearest."""

    point: Array
    """Point of the set, shape (d,): also the direction of a hyperplane that separates it from the origin, if any."""
    distance: float
    """Distance of the hyperplane from the origin, a lower bound of the set's; not positive where there is none."""
    corners: Array
    fractions: Array
    """Support points, shape (k, d), whose mean with these weights the point is."""


def nearest_point(support: Callable[[Array], Array], first: Array, close: float, tight: float) -> Near:
    """Look for the nearest point.

    Parameters
    ----------
    support
        From a direction to a point of the set that is farthest against it: the least product with it.
    first
        A point of the set.
    close
        Distance that counts as none.
    tight
        Share of its distance by which a hyperplane may be nearer to the origin than the point.
    """
    corners: Array = first[None]
    fractions: Array = np.ones(1)
    point, direction, best = first, first, -np.inf
    for _ in range(ROUNDS):
        length = float(np.linalg.norm(point))
        if length <= close:
            break
        found = support(point)
        distance = float(point @ found) / length
        if distance > best:
            best, direction = distance, point
        if best >= (1.0 - tight) * length or float(point @ (point - found)) <= NO_GAIN * length * length:
            break
        corners, fractions = _with(corners, fractions, found)
        point = fractions @ corners
    return Near(direction if best > 0.0 else point, best, corners, fractions)


def _with(corners: Array, fractions: Array, new: Array) -> tuple[Array, Array]:
    """The nearest point of the hull with one corner more, and without those that it does not need."""
    corners, fractions = np.concatenate([corners, new[None]]), np.append(fractions, 0.0)
    for _ in range(2 * len(corners)):
        wanted = _affine(corners)
        if (wanted > 0.0).all():
            return corners, wanted
        falling = wanted <= 0.0
        steps = fractions[falling] / np.maximum(fractions[falling] - wanted[falling], 1e-300)
        fractions = fractions + min(float(steps.min()), 1.0) * (wanted - fractions)
        kept = fractions > 1e-14
        kept[int(np.argmax(fractions))] = True
        if kept.all():
            kept[np.flatnonzero(falling)[int(np.argmin(steps))]] = False
        corners, fractions = corners[kept], fractions[kept] / fractions[kept].sum()
    return corners, fractions


def _affine(corners: Array) -> Array:
    """Weights, of sum one, of the point of least norm on the plane through all corners."""
    if len(corners) == 1:
        return np.ones(1)
    sides = corners[1:] - corners[0]
    found = np.linalg.lstsq(sides.T, -corners[0], rcond=1e-13)[0]
    return np.append(1.0 - found.sum(), found)
