"""Weights of the magnitudes of controls in H, which can have either sign if magnitudes occur in the dynamics.

H is affine in a control u except for w |u|. Between two levels u and v it changes by (u - v) (sigma + ratio w) with
ratio = (|u| - |v|) / (u - v): a switch between these levels requires that this vanishes.
"""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance


def ratio(u: float, v: float) -> float:
    """Return the factor of the weight of |u| in the condition of a switch between two levels."""
    return (abs(u) - abs(v)) / (u - v) if u != v else 0.0


def effective(low: Array, high: Array, sigma: Array, weight: Array) -> tuple[Array, Array]:
    """Return switching functions and nonnegative weights that give the same decisions.

    If the weight of a magnitude is negative, one of the bounds is optimal; the ratio between them decides which.

    Parameters
    ----------
    low, high
        Bounds of the controls, in shapes that broadcast with the other arguments.
    """
    room = high - low
    both = np.divide(np.abs(high) - np.abs(low), room, out=np.zeros(np.shape(room)), where=room > 0.0)
    weight = np.broadcast_to(weight, np.shape(sigma))
    return sigma + both * np.minimum(weight, 0.0), np.maximum(weight, 0.0)


def moving(instance: Instance) -> tuple[bool, ...]:
    """Return for each control whether its magnitude occurs in the dynamics."""
    spec = instance.model.spec
    return tuple(name in spec.moving_magnitudes for name in spec.control_names)


def costs(instance: Instance) -> tuple[float, ...]:
    """Return the weights of the magnitudes in the running cost at the initial time."""
    none = (0.0,) * len(instance.initial)
    return tuple(instance.model.magnitude_weight(instance.t0, instance.initial, none, instance.parameters))


def resting(instance: Instance) -> tuple[bool, ...]:
    """Return which controls can optimally be at rest: their magnitudes have a cost or occur in the dynamics."""
    return tuple(cost > 0.0 or moves for cost, moves in zip(costs(instance), moving(instance), strict=True))
