"""What changes only by something from outside, whatever the controls do, such as the angular momentum of all bodies."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solution import Invariant


def balances(instance: Instance, times: Array, x: Array, u: Array) -> dict[str, Invariant]:
    """Each balance of the model along a motion, less what came from outside.

    Parameters
    ----------
    times, x, u
        Nodes (N+1,), states (n, N+1) and controls (m, N+1) there.

    Returns
    -------
    dict
        By name: the value at the initial state of the instance, which may lie before an impulse that `x` begins
        after, and the largest departure from it.
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
    """The integral of a rate until each node; exactly nothing where there is none."""
    if not rate.any() or len(times) < 3:
        return np.zeros_like(rate)
    from scipy.integrate import cumulative_simpson

    found: Array = cumulative_simpson(rate, x=times, initial=0.0)
    return found
