"""The slope of H by controls that are directions, and where it vanishes: the law says nothing there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance

VANISHING = 1e-9
"""Share of the largest slope below which it counts as none."""


def slope(instance: Instance, places: Sequence[int], t: Array, x: Array, lam: Array) -> Array:
    """The slope of H by a direction, shape (components, N): by the controls, or by cosine and sine of an angle.

    Parameters
    ----------
    places
        Of the controls of the direction.
    t, x, lam
        Times (N,), states and costates, (n, N).
    """
    model, p = instance.model, instance.parameters
    u = np.zeros((len(model.spec.controls), len(t)))

    def slopes() -> Array:
        return np.array(np.broadcast_to(model.stationarity_batch(t, x, u, lam, p), u.shape))[list(places)]

    across = slopes()
    if places[0] not in instance.control_set.angles:
        return across
    u[places[0]] = np.pi / 2.0
    return np.concatenate([-slopes(), across])


def undecided(instance: Instance, t: Array, x: Array, lam: Array) -> NDArray[np.bool_]:
    """Which controls are directions that nothing decides at an instant, shape (m, N)."""
    found = np.zeros((len(instance.model.spec.controls), len(t)), dtype=bool)
    for places, part in instance.control_set.parts:
        if part.directed:
            size = np.linalg.norm(slope(instance, places, t, x, lam), axis=0)
            found[list(places)] = ~(size > VANISHING * size.max(initial=0.0))
    return found


def continued(instance: Instance, t: Array, x: Array, lam: Array, u: Array) -> Array:
    """Controls over time, angles without jumps by a turn, and directions that nothing decides as they were before."""
    open_ones, found = undecided(instance, t, x, lam), np.array(u)
    for row, unknown in enumerate(open_ones):
        if unknown.any() and not unknown.all():
            known = np.flatnonzero(~unknown)
            before = np.searchsorted(known, np.arange(len(t)), side="right") - 1
            found[row] = found[row, known[np.maximum(before, 0)]]
    return instance.control_set.continued(found)
