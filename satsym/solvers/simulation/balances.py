"""Balances: quantities that change only by external effects, whatever the controls, e.g. total angular momentum."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solution import Invariant


def balances(instance: Instance, times: Array, x: Array, u: Array) -> dict[str, Invariant]:
    """Return the balances of the model along a motion, with external effects subtracted.

    Parameters
    ----------
    instance
        The instance of the motion.
    times, x, u
        Nodes (N+1,), states (n, N+1) and controls (m, N+1) at the nodes.

    Returns
    -------
    dict
        For each balance by name: the value at the initial state of the instance, which may precede an impulse before
        the first column of `x`, and the largest deviation from that value.
    """
    spec, p = instance.model.spec, instance.parameters
    if not spec.balances or not np.isfinite(x).all():
        return {}
    values = instance.model.balances_batch(times, x, u, p)
    before = instance.model.balances(instance.t0, instance.initial, [0.0] * len(spec.controls), p)
    found = {}
    for k, variable in enumerate(spec.balances):
        kept, rate = values[2 * k], values[2 * k + 1]
        departure = kept - _brought(times, rate) - before[2 * k]
        found[variable.symbol] = Invariant(before[2 * k], float(np.abs(departure).max()))
    return found


def _brought(times: Array, rate: Array) -> Array:
    """Return the integral of a rate up to each node; exactly zero for a zero rate."""
    if not rate.any() or len(times) < 3:
        return np.zeros_like(rate)
    from scipy.integrate import cumulative_simpson

    found: Array = cumulative_simpson(rate, x=times, initial=0.0)
    return found
