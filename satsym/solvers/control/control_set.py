"""The set of admissible controls of an instance: projection onto it, and where its boundary is."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance


def project(instance: Instance, u: Array) -> Array:
    """The nearest admissible controls.

    Parameters
    ----------
    u
        Controls, shape (m, M).
    """
    kind = instance.model.spec.control_set
    if kind == "box":
        return np.minimum(np.maximum(u, _column(instance.lower)), _column(instance.upper))
    if kind == "ball":
        norm = np.linalg.norm(u, axis=0)
        return np.where(norm > instance.max_norm, u * (instance.max_norm / np.maximum(norm, 1e-300)), u)
    return u


def nearest(instance: Instance) -> Callable[[Sequence[float]], Sequence[float]]:
    """The nearest admissible control as a function of one, for loops on plain floats; see :func:`project`."""
    kind = instance.model.spec.control_set
    if kind == "box":
        bounds = list(zip(instance.lower, instance.upper, strict=True))
        return lambda u: [min(max(v, low), high) for v, (low, high) in zip(u, bounds, strict=True)]
    if kind == "ball":
        return lambda u: [v * min(1.0, instance.max_norm / max(math.hypot(*u), 1e-300)) for v in u]
    return lambda u: u


def active(instance: Instance, unbounded: Array) -> NDArray[np.int8]:
    """Which bound holds each control: -1 the lower, 1 the upper, 0 none; on a ball 1 or 0.

    Parameters
    ----------
    unbounded
        What the controls would be without bounds, shape (m, M).
    """
    kind = instance.model.spec.control_set
    if kind == "box":
        below, above = unbounded < _column(instance.lower), unbounded > _column(instance.upper)
        return above.astype(np.int8) - below.astype(np.int8)
    if kind == "ball":
        outside = np.linalg.norm(unbounded, axis=0) > instance.max_norm
        return np.broadcast_to(outside, unbounded.shape).astype(np.int8)
    return np.zeros(unbounded.shape, np.int8)


def excess(instance: Instance, unbounded: Array, widening: float = 0.0) -> Array:
    """Signed distances to each bound, whose zeros are the switching times; shape (bounds, M).

    The rows are, for a box, control minus lower bound and control minus upper bound for each control; for a
    ball the norm minus its limit. Bounds that are infinite have rows of infinities.
    """
    kind, limits = instance.model.spec.control_set, widened(instance, widening)
    if kind == "box":
        m = len(unbounded)
        return np.concatenate([unbounded - _column(limits[:m]), unbounded - _column(limits[m : 2 * m])])
    if kind == "ball":
        return (np.linalg.norm(unbounded, axis=0) - limits[0])[None, :]
    return np.empty((0, unbounded.shape[1]))


def violation(instance: Instance, u: Array) -> float:
    """By how much controls leave the control set at most; not positive where they do not."""
    kind = instance.model.spec.control_set
    distances = excess(instance, u)
    if kind == "box":
        m = len(u)
        distances = np.concatenate([-distances[:m], distances[m:]])
    return float(distances.max(initial=-np.inf))


def widened(instance: Instance, by: float) -> tuple[float, ...]:
    """The ``bounds`` argument of kernels with every bound moved outwards, in the controls' units."""
    kind = instance.model.spec.control_set
    if kind == "box":
        kept = instance.bounds[2 * len(instance.lower) :]  # the smoothing of a switching problem
        return (*(low - by for low in instance.lower), *(high + by for high in instance.upper), *kept)
    return (instance.max_norm + by,) if kind == "ball" else ()


def without_bounds(instance: Instance) -> tuple[float, ...]:
    """The ``bounds`` argument of kernels for an unlimited control."""
    return widened(instance, float("inf"))


def _column(values: tuple[float, ...]) -> Array:
    return np.array(values)[:, None]
