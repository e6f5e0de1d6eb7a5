"""Violation of path constraints by a trajectory without boundary arcs, at its nodes and between them."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.solution import Solution
from satsym.solvers.constrained.arcs import sizes, values

VIOLATED = 1e-9
"""Largest violation, relative to the constraint's magnitude, that is tolerated."""

BETWEEN = 8
"""Number of points evaluated between two nodes."""


def violation(solution: Solution) -> float:
    """Return the largest violation of a path constraint at nodes and between them, relative to its magnitude."""
    instance, n, t = solution.instance, len(solution.x), solution.times
    model, p, bounds = instance.model, instance.parameters, instance.control_set.arguments
    found = [values(instance, t, solution.x, solution.u)]
    for s in np.linspace(0.0, 1.0, BETWEEN + 2)[1:-1]:
        times = t[:-1] + s * np.diff(t)
        z = between(solution, times)
        u = np.asarray(
            solution.u[:, :-1] if model.spec.switching else model.control_law_batch(times, z[:n], z[n:], p, bounds)
        )
        found.append(values(instance, times, z[:n], np.broadcast_to(u, (len(solution.u), len(times)))))
    g, room = np.concatenate(found, axis=1), sizes(instance, t, solution.x, solution.u)
    return float((g.max(axis=1) / np.maximum(room, np.abs(g).max(axis=1))).max())


def between(solution: Solution, at: Array) -> Array:
    """Return states and costates at any times, shape (2n, M), by cubic Hermite interpolation between the nodes."""
    instance, n, t = solution.instance, len(solution.x), solution.times
    model, p, z = instance.model, instance.parameters, np.concatenate([solution.x, solution.lam])
    moving = (model.dynamics_batch(t, z[:n], solution.u, p), model.costate_rate_batch(t, z[:n], solution.u, z[n:], p))
    rates = np.concatenate([np.broadcast_to(one, solution.x.shape) for one in moving])
    k = np.clip(np.searchsorted(t, at, side="right") - 1, 0, len(t) - 2)
    h = t[k + 1] - t[k]
    s = (at - t[k]) / np.where(h > 0.0, h, 1.0)
    found = (1 + 2 * s) * (1 - s) ** 2 * z[:, k] + s * s * (3 - 2 * s) * z[:, k + 1]
    return np.asarray(found + h * (s * (1 - s) ** 2 * rates[:, k] - s * s * (1 - s) * rates[:, k + 1]))
