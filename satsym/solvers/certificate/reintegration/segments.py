"""The canonical equations linearised from node to node of a solution: the motion of neighbouring extremals."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array, distinct
from satsym.solution import Solution
from satsym.solvers.certificate.reintegration.flow import unit_sizes
from satsym.solvers.certificate.reintegration.passages import passages
from satsym.solvers.control.slopes import without_poles
from satsym.solvers.failures import FAILURES
from satsym.solvers.simulation.extrapolation import SUBSTEPS, leap_varied

FEWEST = 64
"""Minimum number of segments."""

MOST_STEPS = 20_000
"""Maximum number of steps. If neighbouring extremals rotate so often that more would be needed, they are not
followed."""

TURN = np.pi / 2.0
"""Largest change of the sum of all phases within a step, in rad, see :mod:`satsym.solvers.certificate.jacobi`. It is
less than pi, so that the values at both ends determine the change."""

FRACTION = 0.75
"""Change of the sum of eigenphases in a segment, as a fraction of the largest change allowed in a step, by which
segments are laid out."""

COLUMNS, ACCURATE = (3, 5), 3e-7
"""Numbers of columns of the extrapolation table for transition matrices: the smaller number if its difference from the
next lower order, which is hundreds of times its error, is within the tolerance ``ACCURATE``. With bounds, which make
corners, the larger number is always used. Errors of phases matter only near a full turn."""

PLACES = 2048
"""Number of points at which derivatives are held in memory at the same time."""

LOST_DIGITS = 1e16
"""Growth of errors at which no correct digit is left."""

SWEEPS, STEADY = 12, 1e-2
"""Maximum number of passes through all units, and the relative change of the units in a pass below which iteration
stops."""


@dataclass(frozen=True, eq=False)
class Segments:
    """Steps from node to node of a solution, and the derivatives of their ends with respect to their beginnings."""

    times: Array
    """Times of the stations, shape (K,): the nodes where segments begin and, if steps are shorter, times between
    them."""
    begins: Array
    """States and costates at the beginning of each step, shape (2n, K-1)."""
    transition: Array
    """Transition matrices from each station to the next, in units of ``scale``, shape (K-1, 2n, 2n)."""
    scale: Array
    """Units of states and costates, shape (2n,). The products of the units of each state and its costate are all the
    same, so that transition matrices are symplectic."""
    nodes: NDArray[np.intp]
    """Indices of the nodes at which segments begin, and of the last node."""
    steps: int
    """Number of steps in each segment."""
    jumped: frozenset[int] = frozenset()
    """Indices of the steps in which the control jumps."""

    @property
    def growth(self) -> float:
        """Return the largest growth of initial errors, in units of ``scale``; infinite if no digit is left."""
        total, found = np.eye(len(self.scale)), 1.0
        for matrix in self.transition:
            total = matrix @ total
            found = max(found, float(np.abs(total).max()))
            if not found < LOST_DIGITS:
                return float("inf")
        return found


def segments(solution: Solution) -> Segments | None:
    """Linearise from node to node; ``None`` if values are not finite or more than ``MOST_STEPS`` steps are needed."""
    times, z = solution.times, values(solution)
    slopes = _slopes(solution, times, z)
    if not np.isfinite(slopes).all():
        return None
    for scale in _scales(solution, slopes):
        turned = np.append(0.0, np.cumsum(_turning(slopes, scale, np.diff(times))))
        if turned[-1] <= MOST_STEPS * TURN:
            break
    else:
        return None
    nodes = _nodes(solution, turned)
    steps = max(1, int(np.ceil(np.diff(turned[nodes]).max() / TURN)))
    try:
        return _linearised(solution, nodes, steps, scale)
    except FAILURES:
        return None


def _scales(solution: Solution, slopes: Array) -> Iterator[Array]:
    """Yield candidates for the units of states and costates, in which neighbouring extremals may rotate slowly.

    They are derived from the units of the problem and from the largest states along the motion, since a state that is
    zero at both ends, such as the height above a plane, need not be small between them. Both are balanced for the
    largest rates and for the mean rates, since a short steep interval should not determine the units of a long motion.
    """
    lasting, n, unit = float(np.ptp(solution.times)), len(solution.x), unit_sizes(solution)
    steepest = np.abs(slopes).max(axis=2)
    mean = np.trapezoid(np.abs(slopes), solution.times, axis=2) / lasting
    largest = np.abs(solution.x).max(axis=1)
    largest = np.where(largest > 0.0, largest, unit[:n])
    for begun in (unit, np.concatenate([largest, unit[n:] * unit[:n] / largest])):
        for sizes in (steepest, mean):
            yield balanced(begun, sizes, lasting)


def between(solution: Solution, found: Segments, station: int, times: Array) -> Array:
    """Return transition matrices from a station to times before the next station, shape (M, 2n, 2n)."""
    begin = float(found.times[station])
    z = np.repeat(found.begins[:, station : station + 1], len(times), axis=1)
    return _leapt(solution, found.scale, np.full(len(times), begin), z, times - begin)[1]


def values(solution: Solution) -> Array:
    """Return states and costates at the nodes, shape (2n, N+1)."""
    return np.concatenate([solution.x, solution.lam])


def _slopes(solution: Solution, t: Array, z: Array) -> Array:
    """Return derivatives of the canonical rates with respect to states and costates, shape (2n, 2n, M)."""
    instance, n, found = solution.instance, len(z) // 2, np.empty((len(z), *z.shape))
    bounds = without_poles(instance, solution.times, solution.x, solution.lam).arguments
    instance.model.canonical_jacobian_batch(t, z[:n], z[n:], instance.parameters, bounds, out=found)
    return found


def balanced(scale: Array, sizes: Array, duration: float) -> Array:
    """Return units in which neighbouring extremals rotate as slowly and evenly as possible.

    They minimise the sum of the squares of all rates, one unit after the other (Osborne, On pre-conditioning of
    matrices, 1960), with a penalty for units far from the given ones.

    Parameters
    ----------
    scale
        Units of states and costates, shape (2n,).
    sizes
        Magnitudes of the derivatives of canonical rates with respect to states and costates, shape (2n, 2n).
    duration
        Duration tf - t0.
    """
    n = len(scale) // 2
    size = sizes * (scale / scale[:, None])
    response = float(size[:n, n:].max())
    if not response > 0.0:
        return scale
    costates = 1.0 / (response * duration)  # so that the response is one over the duration
    unit = np.repeat([1.0, costates], n)
    rates, smallest = (((size * unit / unit[:, None]) ** 2).ravel(), 1.0 / duration**2)
    moves, powers, weighing = _moves(n)
    owns = np.argmax(moves, axis=1).tolist()
    change = np.ones(2 * n)
    for _ in range(SWEEPS):
        before = change
        for move, power, weights, own in zip(moves, powers, weighing, owns, strict=True):
            rising, falling = (weights @ rates).tolist()
            moved = float(change[own] ** 2)
            factor = ((falling + smallest / moved) / (rising + smallest * moved)) ** 0.125
            change, rates = change * factor**move, rates * factor**power
        if (np.abs(change / before - 1.0) < STEADY).all():
            break
    return scale * unit * change


@lru_cache
def _moves(n: int) -> tuple[Array, Array, Array]:
    """Return the changes of units, shape (n + 1, 2n), and the exponents with which rates rise and fall.

    One change scales a state and, inversely, its costate; the last one scales all costates together.
    """
    moves = np.concatenate([np.append(np.eye(n), -np.eye(n), axis=1), np.repeat([[0.0, 1.0]], n, axis=1)])
    powers = (moves[:, None, :] - moves[:, :, None]).reshape(len(moves), -1)
    return moves, 2.0 * powers, np.stack([np.maximum(powers, 0.0), np.maximum(-powers, 0.0)], axis=1)


def _turning(slopes: Array, scale: Array, widths: Array) -> Array:
    """Return bounds of the change of the sum of phases between neighbouring nodes, shape (M-1,).

    The sum changes at twice the trace of the Hessian of H on an n-dimensional subspace.
    """
    ratio = (scale / scale[:, None]).reshape(-1, 1)
    scaled = slopes.reshape(len(ratio), -1) * ratio
    rate = 2.0 * np.sqrt(len(scale) / 2.0 * np.einsum("ij,ij->j", scaled, scaled))
    found: Array = np.maximum(rate[1:], rate[:-1]) * widths
    return found


def _nodes(solution: Solution, turned: Array) -> NDArray[np.intp]:
    """Return indices of the nodes where segments begin: even in time, dense enough, and at switching times."""
    times, last = solution.times, len(solution.times) - 1
    even = np.searchsorted(times, np.linspace(times[0], times[-1], FEWEST + 1)[1:-1])
    dense = np.searchsorted(turned, np.arange(FRACTION * TURN, turned[-1], FRACTION * TURN)) - 1
    switches = np.array([t for own in solution.switching_times for t in own])
    met = [int(np.abs(times - t).argmin()) for t in switches]  # a corner within a step is seen by none of its stages
    beside = [node for one in passages(solution) if one.located for node in (one.node, one.node + 1)]
    return distinct(np.clip(np.concatenate([[0, last], even, dense, met, beside]), 0, last).astype(np.intp))


def _linearised(solution: Solution, nodes: NDArray[np.intp], steps: int, scale: Array) -> Segments:
    begun, widths = solution.times[nodes][:-1], np.diff(solution.times[nodes]) / steps
    begins, transition = [values(solution)[:, nodes[:-1]]], []
    for step in range(steps):
        after, matrices = _leapt(solution, scale, begun + step * widths, begins[-1], widths)
        begins.append(after)
        transition.append(matrices)
    stations = np.append((begun[:, None] + np.arange(steps) * widths[:, None]).ravel(), solution.times[-1])
    every = np.stack(transition, axis=1).reshape(-1, len(scale), len(scale))
    before = np.stack(begins[:-1], axis=2).reshape(len(scale), -1)
    jumped = set()
    for one in (one for one in passages(solution) if one.located):
        step = (int(np.searchsorted(nodes, one.node)) + 1) * steps - 1
        every[step] = one.saltation(solution, scale).matrix @ every[step]
        jumped.add(step)
    return Segments(stations, before, every, scale, nodes, steps, frozenset(jumped))


def _leapt(solution: Solution, scale: Array, t: Array, z: Array, h: Array) -> tuple[Array, Array]:
    """Return the ends of steps from many beginnings, shape (2n, M), and their transition matrices, (M, 2n, 2n)."""
    instance, n = solution.instance, len(z) // 2
    p, bounds = instance.parameters, instance.control_set.arguments

    def rates(t: Array, z: Array) -> Array:
        found = np.empty_like(z)
        instance.model.canonical_batch(t, z[:n], z[n:], p, bounds, out=found)
        return found

    def slopes(t: Array, z: Array) -> Array:
        return np.ascontiguousarray(_slopes(solution, t, z).transpose(2, 0, 1))

    def leapt(chosen: NDArray[np.intp], columns: int) -> tuple[Array, Array, Array]:
        places = len(chosen) * sum(SUBSTEPS[:columns])
        parts = np.array_split(chosen, -(-places // PLACES))
        found = [leap_varied(rates, slopes, t[own], z[:, own], h[own], columns) for own in parts]
        ends, whole, error = zip(*found, strict=True)
        return np.concatenate(ends, axis=1), np.concatenate(whole), np.concatenate(error)

    (few, more), every, unit = COLUMNS, np.arange(len(t)), scale / scale[:, None]
    ends, transition, error = leapt(every, more if instance.control_set.bounded else few)
    if instance.control_set.bounded:
        return ends, transition * unit
    transition, rough = transition * unit, (error * unit).max(axis=(1, 2))
    poor = np.flatnonzero(~(rough <= ACCURATE * np.abs(transition).max(axis=(1, 2))))
    if len(poor):
        ends[:, poor], better, _ = leapt(poor, more)
        transition[poor] = better * unit
    return ends, transition
