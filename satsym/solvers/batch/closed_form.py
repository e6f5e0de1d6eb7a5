"""Closed-form solution of many linear problems, by their common Gramian and matrix exponentials.

See :mod:`satsym.solvers.linear` for a single problem. Problems that are not solved to rounding errors are left to
shooting.
"""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.solvers.batch.many import Many
from satsym.solvers.batch.newton import ROUNDING, Nodes, Outcome
from satsym.solvers.batch.solving import bounds_met
from satsym.solvers.linear import Exponential, is_linear
from satsym.status import BadInput

POINTS = 8
"""Number of quadrature points of the running cost on each segment, for which the quadrature error is below rounding."""


def applies(many: Many) -> bool:
    """Return whether the canonical equations are linear, autonomous, and the same for all problems."""
    same = not np.ptp(many.parameters, axis=1).any() if len(many.parameters) else True
    if not (same and many.instance.model.spec.autonomous) or many.instance.parameters != tuple(many.parameters[:, 0]):
        return False
    try:
        return is_linear(many.problem)
    except BadInput:
        return False


def solved(many: Many) -> Nodes:
    """Return the solutions of problems to which :func:`applies`."""
    n, rows, count = many.states, 2 * many.states, many.count
    mesh = many.mesh[:, 0]
    arcs = Exponential(many.problem, mesh, np.ones((rows, len(mesh))), many.problem.theta)
    points, weights = np.polynomial.legendre.leggauss(POINTS)
    widths, shares = np.diff(mesh), np.append((points + 1.0) / 2.0, 1.0)
    unit = np.append(many.units, 1.0)
    with np.errstate(all="ignore"):
        flows = arcs.flows(np.outer(widths, shares).ravel()) * unit[:, None] / unit
        flows = flows.reshape(len(widths), len(shares), rows + 1, rows + 1)
        begins = np.empty((len(mesh), rows + 1, rows + 1))
        begins[0] = np.eye(rows + 1)
        for k, flow in enumerate(flows[:, -1]):
            begins[k + 1] = flow @ begins[k]
        whole = begins[-1]
        given = np.concatenate([many.initial, np.zeros((n, count)), np.ones((1, count))])
        missing = (many.end - (whole @ given)[:n]) / unit[:n, None]
        try:
            gramian = whole[:n, n:rows] * unit[n:rows] / unit[:n, None]
            given[n:rows] = np.linalg.solve(gramian, missing) * unit[n:rows, None]
        except np.linalg.LinAlgError:
            given[n:rows] = np.nan
        z = np.ascontiguousarray((begins @ given)[:, :rows].transpose(1, 0, 2))
        size = np.abs(z).max(axis=1)[:n] + unit[:n, None]
        error = (np.abs(z[:n, -1] - many.end) / size).max(axis=0)
        outcome = np.full(count, Outcome.SOLVED, dtype=object)
        outcome[~(error <= ROUNDING) | ~np.isfinite(z).all(axis=(0, 1))] = Outcome.INACCURATE
        fine = np.flatnonzero(outcome == Outcome.SOLVED)
        outcome[fine[bounds_met(many.only(fine), z[:, :, fine])]] = Outcome.BOUNDS
        inside = flows[:, :-1].reshape(-1, rows + 1, rows + 1) @ np.repeat(begins[:-1] @ given, POINTS, axis=0)
        cost = _cost(many, inside[:, :rows], np.outer(widths, weights / 2.0).ravel(), np.outer(widths, shares[:-1]))
    return Nodes(z, cost, error, outcome)


def _cost(many: Many, z: Array, weights: Array, shares: Array) -> Array:
    """Return the integral of the running cost from values at quadrature points of all segments, shape (K, 2n, M)."""
    n, model, p = many.states, many.instance.model, many.instance.parameters
    flat = z.transpose(1, 0, 2).reshape(2 * n, -1)
    t = np.repeat(many.instance.t0 + many.problem.duration * (many.mesh[:-1] + shares).ravel(), many.count)
    u = model.control_law_batch(t, flat[:n], flat[n:], p, many.problem.control_set.arguments)
    running = np.broadcast_to(model.running_cost_batch(t, flat[:n], u, p), t.shape).reshape(len(weights), -1)
    return np.asarray(many.problem.duration * (weights @ running))
