"""Times at which a schedule in the equations jumps or has a corner, where meshes need nodes."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance

PLACES, HALVINGS = 256, 48
"""Number of intervals in each of which one break is searched for, and number of bisections of each interval."""

JUMP = 1e-7
"""Change of a rate or of its time derivative within rounding of the time, relative to its range, that counts as a
jump."""

BESIDE = 1e-12
"""Minimum distance of a break from both ends, relative to the duration."""


def find_breaks(instance: Instance) -> Array:
    """Find the fractions of a given duration between which rates jump or have a corner that depends on time alone.

    Rates and their derivatives with respect to explicit time are evaluated at the initial state. Of each interval the
    half with the larger change is kept: the change of a smooth function tends to zero, that of a jump does not.

    Returns
    -------
    Array
        Shape (2, K): the last fractions before the breaks, and the first ones after them. Breaks at the ends are left
        out.
    """
    if instance.model.spec.autonomous or instance.tf is None:
        return np.zeros((2, 0))
    model, p, bounds = instance.model, instance.parameters, instance.control_set.arguments
    start, lasting = instance.t0, instance.tf - instance.t0
    state = np.array(instance.initial)[:, None]

    def along(shares: Array) -> Array:
        t, x = start + lasting * shares, np.repeat(state, len(shares), 1)
        lam = np.ones_like(x)
        parts = [function(t, x, lam, p, bounds) for function in (model.canonical_batch, model.canonical_drift_batch)]
        return np.concatenate([np.broadcast_to(part, (2 * len(x), len(shares))) for part in parts])

    with np.errstate(all="ignore"):
        edges = np.linspace(0.0, 1.0, PLACES + 1)
        low, high = edges[:-1].copy(), edges[1:].copy()
        at_low, at_high = along(low), along(high)
        values = np.concatenate([at_low, at_high], axis=1)
        span = np.ptp(values, axis=1, keepdims=True)
        unit = 1.0 / np.where(span > 0.0, span, 1.0)
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            between = along(middle)
            before, after = (np.abs((b - a) * unit).max(axis=0) for a, b in ((at_low, between), (between, at_high)))
            first = before > after
            high, at_high = np.where(first, middle, high), np.where(first, between, at_high)
            low, at_low = np.where(first, low, middle), np.where(first, at_low, between)
        jumped = np.abs((at_high - at_low) * unit).max(axis=0) > JUMP
    found = np.array([low, high])[:, jumped]
    return np.asarray(found[:, (found[0] > BESIDE) & (found[1] < 1.0 - BESIDE)])
