"""Weights of magnitudes of controls in H, which may have either sign where magnitudes stand in the motion.

H is affine in a control u but for w |u|. Between two levels u and v it changes by (u - v) (sigma + ratio w) with
ratio = (|u| - |v|) / (u - v): that this vanishes is what a switch between them asks for.
"""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance


def ratio(u: float, v: float) -> float:
    """What multiplies the weight of a magnitude beside the switching function, between two levels."""
    return (abs(u) - abs(v)) / (u - v) if u != v else 0.0


def effective(low: Array, high: Array, sigma: Array, weight: Array) -> tuple[Array, Array]:
    """Switching functions and weights, none of them negative, that decide alike.

    Where a magnitude is worth having, one of the bounds is best: which one, the ratio between them says.

    Parameters
    ----------
    low, high
        Bounds, of shapes that go with the others.
    """
    room = high - low
    both = np.divide(np.abs(high) - np.abs(low), room, out=np.zeros(np.shape(room)), where=room > 0.0)
    weight = np.broadcast_to(weight, np.shape(sigma))
    return sigma + both * np.minimum(weight, 0.0), np.maximum(weight, 0.0)


def moving(instance: Instance) -> tuple[bool, ...]:
    """Which controls' magnitudes stand in the motion."""
    spec = instance.model.spec
    return tuple(name in spec.moving_magnitudes for name in spec.control_names)


def costs(instance: Instance) -> tuple[float, ...]:
    """What magnitudes cost at the start, by the running cost alone."""
    none = (0.0,) * len(instance.initial)
    return tuple(instance.model.magnitude_weight(instance.t0, instance.initial, none, instance.parameters))


def resting(instance: Instance) -> tuple[bool, ...]:
    """Which controls may best be at rest for a while: those whose magnitudes cost something, or stand in the motion."""
    return tuple(cost > 0.0 or moves for cost, moves in zip(costs(instance), moving(instance), strict=True))
