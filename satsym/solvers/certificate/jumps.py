"""Jumps of a control law along a solution from one minimiser of H to another, and others that stay as good."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.solution import Solution

HALVINGS, LEFT = 40, 1e-3
"""Of each interval, towards where the control moves most, and the share of its move that a jump leaves."""

MOVED = 1e-6
"""Share of the largest control by which one moves that may have jumped."""


LOOKED_AT, GRID = 9, 201
"""Times within a solution and values of a control at which other minimisers of H are looked for."""

EQUAL, APART = 1e-9, 1e-3
"""Share of H's range by which one may be worse that is as good, and of the control's by which it is another one."""


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


def ties(solution: Solution) -> int:
    """How often, from one of the times looked at to the next, another value of a control stays as good for H.

    Where that is so for a while, no control is the best one: any two may take turns. At single instants it may be so.
    """
    if not solution.instance.model.spec.stationary:
        return 0
    nodes = np.unique(np.linspace(0, solution.times.size - 1, LOOKED_AT + 2).astype(int)[1:-1])
    tied = np.array([_tied(solution, int(node)) for node in nodes])
    return int((tied[1:] & tied[:-1]).sum())


def _tied(solution: Solution, node: int) -> bool:
    """Whether H has another minimiser at a node, one control being changed at a time."""
    from scipy.optimize import minimize_scalar

    instance, model = solution.instance, solution.instance.model
    t, x, u, lam = solution.times[node], solution.x[:, node], solution.u[:, node], solution.lam[:, node]
    wide = 1.0 + 2.0 * float(np.abs(solution.u).max())
    for k, variable in enumerate(model.spec.controls):
        low, high = max(instance.lower[k], -wide), min(instance.upper[k], wide)

        def h(value: float, k: int = k) -> float:
            return float(model.hamiltonian(t, x, (*u[:k], value, *u[k + 1 :]), lam, instance.parameters))

        grid = np.linspace(low, high, GRID)
        values = np.array([h(value) for value in grid])
        padded = np.pad(values, 1, constant_values=np.inf)
        lowest = np.flatnonzero((values <= padded[:-2]) & (values <= padded[2:]))
        for at in map(int, lowest):
            ends = grid[max(at - 1, 0)], grid[min(at + 1, GRID - 1)]
            other = minimize_scalar(h, bounds=ends, method="bounded", options={"xatol": 1e-10 * (high - low)})
            distance = abs(other.x - u[k])
            if variable.kind == "angle":
                distance = abs(np.remainder(other.x - u[k] + np.pi, 2.0 * np.pi) - np.pi)
            best = min(other.fun, values[at])
            if distance > APART * (high - low) and best - h(u[k]) <= EQUAL * np.ptp(values):
                return True
    return False
