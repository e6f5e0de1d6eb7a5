"""Solution of many problems to the required accuracy and within bounds: by shooting, or in closed form if linear.

Shooting begins at the straight line or at a guess. Linear problems with a common motion have a common Gramian and
common matrix exponentials; see :mod:`satsym.solvers.linear` for a single problem. Those that are not solved to rounding
errors are left to shooting.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.solvers.batch.many import Many
from satsym.solvers.batch.newton import ROUNDING, Nodes, Outcome, accurate, rough
from satsym.solvers.collocation.accuracy.refinement import AIM, FINEST
from satsym.solvers.linear import Exponential, is_linear
from satsym.status import BadInput

SEEDED_EVERY = 8
"""Every problem with this number in the sequence starts from the straight line, the others from a solved neighbour."""

ROUNDS = 2
"""Number of times that an unsolved problem is started from another solved neighbour."""

ROUNDED = 1e-14
"""Relative error that is required if results must be accurate to rounding."""

POINTS = 8
"""Number of quadrature points of the running cost on each segment, for which the quadrature error is below rounding."""


@dataclass(frozen=True, eq=False)
class Answers:
    """Results of many problems that were solved together."""

    nodes: Nodes
    neighbour: NDArray[np.bool_]
    """Whether each problem was started from the solution of a neighbour, shape (M,)."""


def solved_together(many: Many) -> Answers:
    """Solve problems whose order places neighbours next to each other.

    Which problems are solved, and from which initial guess, depends only on the problems and their order.
    """
    line, every = many.line, np.arange(many.count)
    seeds = every % SEEDED_EVERY == 0
    found = _blank(many)
    _put(found, every[seeds], solved(many.only(every[seeds]), line[:, :, seeds]))
    neighbour, tried = np.zeros(many.count, dtype=bool), seeds.copy()
    for _ in range(ROUNDS):
        left, known = every[_open(found)], every[found.solved]
        if not len(left) or not len(known):
            break
        _put(found, left, solved(many.only(left), found.z[:, :, _nearest(many, left, known)]))
        neighbour[left] = True
    left = every[_open(found) & ~tried]
    if len(left):
        _put(found, left, solved(many.only(left), line[:, :, left]))
        neighbour[left] = False
    return Answers(found, neighbour)


def to_rounding(many: Many, nodes: Nodes, chosen: NDArray[np.intp]) -> Nodes:
    """Return the solutions with some of them improved to rounding errors.

    This is needed where controls have little influence on the final state.
    """
    if not len(chosen):
        return nodes
    near = np.full(len(chosen), Outcome.SOLVED, dtype=object)
    with np.errstate(all="ignore"):
        again = accurate(many.only(chosen), nodes.z[:, :, chosen], near, ROUNDED)
    _put(nodes, chosen[again.solved], again.only(np.flatnonzero(again.solved)))
    return nodes


def _open(nodes: Nodes) -> NDArray[np.bool_]:
    """Return which problems may still be solved from another initial guess."""
    return np.asarray(~nodes.solved & (nodes.outcome != Outcome.BOUNDS))


def _blank(many: Many) -> Nodes:
    """Return the results of problems of which none is solved yet."""
    count = many.count
    return Nodes(
        np.full((2 * many.states, len(many.mesh), count), np.nan),
        np.full(count, np.nan),
        np.full(count, np.inf),
        np.full(count, Outcome.NO_CONVERGENCE, dtype=object),
    )


def _put(found: Nodes, chosen: NDArray[np.intp], some: Nodes) -> None:
    """Write the results of some problems into those of all problems, in place."""
    found.z[:, :, chosen] = some.z
    found.cost[chosen], found.error[chosen], found.outcome[chosen] = some.cost, some.error, some.outcome


def _nearest(many: Many, left: NDArray[np.intp], known: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return, for each unsolved problem, the index of the solved problem with the nearest data."""
    places = np.concatenate([many.initial, many.end, many.parameters])
    spread = np.ptp(places, axis=1)
    varied = spread > 0.0
    scaled = places[varied] / spread[varied, None]
    apart = ((scaled[:, left, None] - scaled[:, None, known]) ** 2).sum(axis=0)
    return np.asarray(known[apart.argmin(axis=1)])


def solved(many: Many, start: Array) -> Nodes:
    """Solve problems from an initial guess, without bounds.

    Parameters
    ----------
    many
        The problems.
    start
        Initial guess of the values at the nodes, shape (2n, N+1, M).
    """
    with np.errstate(all="ignore"):
        nodes = accurate(many, *rough(many, start), aim_of(many))
        met = np.flatnonzero(nodes.solved)
        nodes.outcome[met[bounds_met(many.only(met), nodes.z[:, :, met])]] = Outcome.BOUNDS
    return nodes


def aim_of(many: Many) -> float:
    """Return the relative error that is required of the nodes."""
    return max(AIM * many.instance.solver.tolerance, FINEST)


def bounds_met(many: Many, z: Array) -> NDArray[np.bool_]:
    """Return whose controls may exceed their bounds, shape (M,).

    Controls between nodes are estimated from the change between neighbouring nodes.
    """
    within = many.instance.control_set
    if not within.bounded or not many.count:
        return np.zeros(many.count, dtype=bool)
    n, segments = many.states, len(many.mesh)
    flat, (p, _) = z.reshape(len(z), -1), many.arguments(segments)
    times = many.at_nodes(slice(None))
    law = many.instance.model.control_law_batch(times, flat[:n], flat[n:], p, within.without_bounds.arguments)
    u = np.asarray(law).reshape(-1, segments, many.count)
    moved = np.zeros_like(u)
    moved[:, 1:] = np.abs(np.diff(u, axis=1))
    moved[:, :-1] = np.maximum(moved[:, :-1], moved[:, 1:])
    if within.kind == "ball":
        return np.asarray((np.linalg.norm(np.abs(u) + moved, axis=0) >= many.radius).any(axis=0))
    low, high = many.lower[:, None], many.upper[:, None]
    return np.asarray(((u - moved <= low) | (u + moved >= high)).any(axis=(0, 1)))


def has_closed_form(many: Many) -> bool:
    """Return whether the canonical equations are linear, autonomous, and the same for all problems."""
    same = not np.ptp(many.parameters, axis=1).any() if len(many.parameters) else True
    if not (same and many.instance.model.spec.autonomous) or many.instance.parameters != tuple(many.parameters[:, 0]):
        return False
    try:
        return is_linear(many.problem)
    except BadInput:
        return False


def in_closed_form(many: Many) -> Nodes:
    """Return the solutions of problems to which :func:`has_closed_form`."""
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
