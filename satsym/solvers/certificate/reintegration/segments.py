"""The canonical equations, linearised from node to node of a solution: how neighbouring extremals go on."""

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
"""Segments."""

MOST_STEPS = 20_000
"""Steps: neighbouring extremals that turn about each other more often are not followed."""

TURN = np.pi / 2.0
"""Largest turn within a step of the sum of all phases, see :mod:`satsym.solvers.certificate.jacobi`; less than pi, so
that it is known from where it begins and ends."""

FRACTION = 0.75
"""Share of the largest turn that segments between nodes are to have."""

COLUMNS, ACCURATE = (3, 5), 3e-7
"""How many the extrapolation table has for transitions: the fewer where they differ by no more than that from those of
the next lower order, whose error is hundreds of times their own; but not where bounds make corners, of which such
differences say little. Errors of phases matter only where they are a full turn."""

PLACES = 2048
"""At which derivatives are known at a time: few enough to stay in memory that is at hand."""

LOST_DIGITS = 1e16
"""Growth at which nothing is left of a number's digits."""

SWEEPS, STEADY = 12, 1e-2
"""Through all units, at most; and the relative change of units in one below which there is no other."""


@dataclass(frozen=True, eq=False)
class Segments:
    """Steps from node to node of a solution, and how their ends follow their beginnings."""

    times: Array
    """Stations: the nodes and what lies between, where steps are shorter than segments, shape (K,)."""
    begins: Array
    """States and costates where each step begins, shape (2n, K-1)."""
    transition: Array
    """From each station to the next by states and costates in units of ``scale``, shape (K-1, 2n, 2n)."""
    scale: Array
    """Units of states and costates, shape (2n,). The products of the two are all the same, so that transitions are
    symplectic."""
    nodes: NDArray[np.intp]
    """Indices of the solution's times at which segments begin, and of the last."""
    steps: int
    """In each segment."""
    jumped: frozenset[int] = frozenset()
    """The steps in which the control jumps."""

    @property
    def growth(self) -> float:
        """By how much errors of the initial values grow at most, in units of the scale."""
        total, found = np.eye(len(self.scale)), 1.0
        for matrix in self.transition:
            total = matrix @ total
            found = max(found, float(np.abs(total).max()))
            if not found < LOST_DIGITS:
                return float("inf")
        return found


def segments(solution: Solution) -> Segments | None:
    """Integrate from node to node; ``None`` where that is not finite or takes more than ``MOST_STEPS`` steps."""
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
    """Units of states and costates, one after the other, in each of which neighbouring extremals may turn slowly.

    They start from the units of the problem and from the largest states along the way: what is next to zero at both
    ends, as the height above a plane may be, is not so between them. Both are balanced for the steepest rates and for
    their mean: what is steep for a moment is not what units are for where there is far more time without it.
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
    """Transitions from a station to times until the next, shape (M, 2n, 2n)."""
    begin = float(found.times[station])
    z = np.repeat(found.begins[:, station : station + 1], len(times), axis=1)
    return _leapt(solution, found.scale, np.full(len(times), begin), z, times - begin)[1]


def values(solution: Solution) -> Array:
    """States and costates at the nodes, shape (2n, N+1)."""
    return np.concatenate([solution.x, solution.lam])


def _slopes(solution: Solution, t: Array, z: Array) -> Array:
    """The canonical rates by states and costates, shape (2n, 2n, M)."""
    instance, n, found = solution.instance, len(z) // 2, np.empty((len(z), *z.shape))
    bounds = without_poles(instance, solution.times, solution.x, solution.lam).arguments
    instance.model.canonical_jacobian_batch(t, z[:n], z[n:], instance.parameters, bounds, out=found)
    return found


def balanced(scale: Array, sizes: Array, duration: float) -> Array:
    """The scale with other units, in which neighbouring extremals turn as slowly and evenly as may be.

    The squares of all rates together are least, by one unit after the other (Osborne, On pre-conditioning of
    matrices, 1960), where a unit far from the one given counts as a rate of one over the duration.

    Parameters
    ----------
    scale
        Units of states and costates, shape (2n,).
    sizes
        Of the canonical rates by states and costates, without their signs, shape (2n, 2n).
    duration
        tf - t0.
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
    """How units may be changed, shape (n + 1, 2n), by which powers rates change then, and which of them rise and fall.

    A state with its costate, each the other way; all costates together.
    """
    moves = np.concatenate([np.append(np.eye(n), -np.eye(n), axis=1), np.repeat([[0.0, 1.0]], n, axis=1)])
    powers = (moves[:, None, :] - moves[:, :, None]).reshape(len(moves), -1)
    return moves, 2.0 * powers, np.stack([np.maximum(powers, 0.0), np.maximum(-powers, 0.0)], axis=1)


def _turning(slopes: Array, scale: Array, widths: Array) -> Array:
    """By how much the sum of the phases turns at most between neighbouring nodes, shape (M-1,).

    It turns at twice the trace of the Hessian of H on an n-dimensional space.
    """
    ratio = (scale / scale[:, None]).reshape(-1, 1)
    scaled = slopes.reshape(len(ratio), -1) * ratio
    rate = 2.0 * np.sqrt(len(scale) / 2.0 * np.einsum("ij,ij->j", scaled, scaled))
    found: Array = np.maximum(rate[1:], rate[:-1]) * widths
    return found


def _nodes(solution: Solution, turned: Array) -> NDArray[np.intp]:
    """Indices of the nodes where segments begin: evenly in time, dense enough, switching times among them."""
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
    """Where steps from many beginnings end, shape (2n, M), and their transitions, (M, 2n, 2n)."""
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
