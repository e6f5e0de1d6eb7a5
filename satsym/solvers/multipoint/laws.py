"""Control laws of arcs, and the conditions that determine the junctions between arcs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance

Parameters: TypeAlias = "tuple[Any, ...]"

Vanishing: TypeAlias = "Callable[[Array, Array, Parameters], Array]"
"""Function (t, z, p) -> values (M,) that vanish at a junction, for times, states above costates, and parameters."""


@dataclass(frozen=True)
class Law:
    """The control of an arc as a function of time, states and costates.

    Attributes
    ----------
    rates
        Function (t, z, p) -> rates (2n, M) of states and costates z (2n, M); real or complex.
    control
        Function (t, z, p) -> controls (m, M).
    bounds
        The argument ``bounds`` of generated functions for which this law minimises H.
    name
        Name of the law in messages.
    """

    rates: Callable[[Array, Array, Parameters], Array]
    control: Callable[[Array, Array, Parameters], Array]
    bounds: tuple[float, ...]
    name: str


@dataclass(frozen=True)
class Junction:
    """The junction of two arcs, where a function of time, states and costates vanishes.

    Attributes
    ----------
    vanishing
        The function that vanishes at the junction.
    controls
        Indices of the controls that switch, or that reach or leave a bound.
    """

    vanishing: Vanishing
    controls: tuple[int, ...] = ()


def derived(instance: Instance, bounds: tuple[float, ...], name: str = "") -> Law:
    """Return the derived control law for a control set with the given bounds."""
    model, n = instance.model, len(instance.initial)

    def rates(t: Array, z: Array, p: Parameters) -> Array:
        return np.asarray(np.broadcast_to(model.canonical_batch(t, z[:n], z[n:], p, bounds), z.shape))

    def control(t: Array, z: Array, p: Parameters) -> Array:
        found = model.control_law_batch(t, z[:n], z[n:], p, bounds)
        return np.asarray(np.broadcast_to(found, (len(model.spec.controls), len(t))))

    return Law(rates, control, bounds, name)
