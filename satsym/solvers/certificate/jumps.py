"""Jumps of a control law along a solution, from one minimiser of H to another that is as good."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.solution import Solution

HALVINGS, LEFT = 40, 1e-3
"""Of each interval, towards where the control moves most, and the share of its move that a jump leaves."""

MOVED = 1e-6
"""Share of the largest control by which one moves that may have jumped."""


def jumps(solution: Solution) -> int:
    """How many times controls jump while states and costates move on: on shorter and shorter times by as much."""
    instance, model = solution.instance, solution.instance.model
    if not model.spec.stationary:
        return 0
    n, t, z = len(solution.x), solution.times, np.concatenate([solution.x, solution.lam])

    def law(share: Array) -> Array:
        times, at = t[:-1] + share * np.diff(t), z[:, :-1] + share * np.diff(z)
        bounds = instance.control_set.arguments
        return np.asarray(model.control_law_batch(times, at[:n], at[n:], instance.parameters, bounds))

    low, high = np.zeros(len(t) - 1), np.ones(len(t) - 1)
    first, last = law(low), law(high)
    moved = np.abs(last - first).max(axis=0)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        between = law(middle)
        later = np.abs(last - between).max(axis=0) > np.abs(between - first).max(axis=0)
        low, high = np.where(later, middle, low), np.where(later, high, middle)
        first, last = np.where(later, between, first), np.where(later, last, between)
    left = np.abs(last - first).max(axis=0)
    return int(((left > LEFT * moved) & (moved > MOVED * np.abs(solution.u).max())).sum())
