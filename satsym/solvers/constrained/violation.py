"""By how much a trajectory violates path constraints, between its nodes as well."""

from __future__ import annotations

import numpy as np

from satsym.solution import Solution

BETWEEN = 8
"""Places between two nodes."""


def violation(solution: Solution) -> float:
    """Largest violation of a path constraint at the nodes and between them, relative to its size along the way.

    Between two nodes a constraint is followed as the cubic with its values and rates at both.
    """
    model, p, t = solution.instance.model, solution.instance.parameters, solution.times
    g = np.asarray(model.path_constraints_batch(t, solution.x, p))
    rates = np.asarray(model.path_rates_batch(t, solution.x, solution.u, p)).reshape(len(g), 2, -1)[:, 0]
    h, found = np.diff(t), [g.max(axis=1)]
    for s in np.linspace(0.0, 1.0, BETWEEN + 2)[1:-1]:
        parts = (1 + 2 * s) * (1 - s) ** 2 * g[:, :-1] + s * s * (3 - 2 * s) * g[:, 1:]
        found.append((parts + h * (s * (1 - s) ** 2 * rates[:, :-1] - s * s * (1 - s) * rates[:, 1:])).max(axis=1))
    return float((np.max(found, axis=0) / np.maximum(np.abs(g).max(axis=1), 1e-300)).max())
