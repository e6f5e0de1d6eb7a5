"""Distance between the canonical flow from each node of a solution and the next node.

The flow from the initial costates does not show an error at a node that is no station of the flow. From node to node,
each node is the end of one short integration and the beginning of another, so that a single wrong node is found.
"""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.solution import Solution
from satsym.solvers.certificate.reintegration.flow import FAINT_COSTATE, typical
from satsym.solvers.simulation.extrapolation import SUBSTEPS, leap, leap_and_error

FINE = 1e-10
"""Relative error of an integration that is negligible in a defect. Larger errors make the integration be refined."""

EASY = 3
"""Number of columns of the extrapolation table for the first attempt between nodes."""

MOST_PARTS = 256
"""Maximum number of parts into which the interval between two nodes is divided."""


def node_defect(solution: Solution) -> float:
    """Return the largest relative distance from the next node; infinite if an integration is not finite.

    If a control switches between two nodes, the integration restarts at the switching time.
    """
    instance, n, times = solution.instance, len(solution.x), solution.times
    z, sizes = np.concatenate([solution.x, solution.lam]), np.concatenate(typical(solution, FAINT_COSTATE))[:, None]
    begins, start, end = times[:-1].copy(), z[:, :-1].copy(), z[:, 1:]

    def rates(t: Array, z: Array) -> Array:
        found = np.empty_like(z)
        arguments = instance.parameters, instance.control_set.arguments
        instance.model.canonical_batch(t, z[:n], z[n:], *arguments, out=found)
        return found

    for corner in sorted(t for own in solution.switching_times for t in own if times[0] < t < times[-1]):
        node = [int(np.searchsorted(times, corner, side="right")) - 1]
        start[:, node] = leap(rates, begins[node], start[:, node], corner - begins[node])
        begins[node] = corner
    lasting, missed, rough = times[1:] - begins, np.full(len(begins), np.inf), np.arange(len(begins))
    parts, columns = 1, EASY
    while len(rough) and parts <= MOST_PARTS:
        now, error, h = start[:, rough], np.zeros((2 * n, len(rough))), lasting[rough] / parts
        for k in range(parts):
            now, own = leap_and_error(rates, begins[rough] + k * h, now, h, columns)
            error = np.maximum(error, own)
        missed[rough] = (np.abs(now - end[:, rough]) / sizes).max(axis=0)
        rough = rough[~((error / sizes).max(axis=0) <= FINE)]
        parts, columns = (parts if columns == EASY else 4 * parts), len(SUBSTEPS)
    return float(np.where(np.isfinite(missed), missed, np.inf).max())
