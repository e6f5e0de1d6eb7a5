"""By how much a trajectory without boundary arcs violates path constraints, between its nodes as well."""

from __future__ import annotations

import numpy as np

from satsym.solution import Solution
from satsym.solvers.constrained.arcs import sizes, values

VIOLATED = 1e-9
"""Largest violation that is none, relative to the constraint's size along the way."""

BETWEEN = 8
"""Places between two nodes."""


def violation(solution: Solution) -> float:
    """Largest violation of a path constraint at the nodes and between them, relative to its size along the way.

    Between two nodes states and costates are followed as the cubics with their values and rates at both.
    """
    instance, n, t = solution.instance, len(solution.x), solution.times
    model, p, bounds = instance.model, instance.parameters, instance.control_set.arguments
    z, h, found = np.concatenate([solution.x, solution.lam]), np.diff(t), [values(instance, t, solution.x, solution.u)]
    moving = (model.dynamics_batch(t, z[:n], solution.u, p), model.costate_rate_batch(t, z[:n], solution.u, z[n:], p))
    rates = np.concatenate([np.broadcast_to(one, solution.x.shape) for one in moving])
    for s in np.linspace(0.0, 1.0, BETWEEN + 2)[1:-1]:
        between = (1 + 2 * s) * (1 - s) ** 2 * z[:, :-1] + s * s * (3 - 2 * s) * z[:, 1:]
        between += h * (s * (1 - s) ** 2 * rates[:, :-1] - s * s * (1 - s) * rates[:, 1:])
        times, x = t[:-1] + s * h, between[:n]
        u = np.asarray(
            solution.u[:, :-1] if model.spec.switching else model.control_law_batch(times, x, between[n:], p, bounds)
        )
        found.append(values(instance, times, x, np.broadcast_to(u, (len(solution.u), len(times)))))
    g, room = np.concatenate(found, axis=1), sizes(instance, t, solution.x, solution.u)
    return float((g.max(axis=1) / np.maximum(room, np.abs(g).max(axis=1))).max())
