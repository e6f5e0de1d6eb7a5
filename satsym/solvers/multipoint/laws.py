"""Which control an arc has, and what determines where the next one begins."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance

Parameters: TypeAlias = "tuple[Any, ...]"

Vanishing: TypeAlias = "Callable[[Array, Array, Parameters], Array]"
"""(t, z, p) -> values (M,), real or complex."""


@dataclass(frozen=True)
class Law:
    """The control of an arc as a function of time, states and costates.

    Attributes
    ----------
    rates
        (t, z, p) -> rates (2n, M) of states and costates z (2n, M); real or complex.
    control
        (t, z, p) -> controls (m, M).
    bounds
        The argument ``bounds`` of generated functions with which this law is the one that minimises H.
    name
        For messages.
    """

    rates: Callable[[Array, Array, Parameters], Array]
    control: Callable[[Array, Array, Parameters], Array]
    bounds: tuple[float, ...]
    name: str


@dataclass(frozen=True)
class Junction:
    """Where one arc ends and the next begins: a function of time, states and costates vanishes there.

    Attributes
    ----------
    vanishing
        What is zero there.
    controls
        Places of the controls that switch, or that meet or leave a bound.
    """

    vanishing: Vanishing
    controls: tuple[int, ...] = ()


def derived(instance: Instance, bounds: tuple[float, ...], name: str = "") -> Law:
    """The law that the derivation has for a control set with these bounds."""
    model, n = instance.model, len(instance.initial)

    def rates(t: Array, z: Array, p: Parameters) -> Array:
        return np.asarray(np.broadcast_to(model.canonical_batch(t, z[:n], z[n:], p, bounds), z.shape))

    def control(t: Array, z: Array, p: Parameters) -> Array:
        found = model.control_law_batch(t, z[:n], z[n:], p, bounds)
        return np.asarray(np.broadcast_to(found, (len(model.spec.controls), len(t))))

    return Law(rates, control, bounds, name)
