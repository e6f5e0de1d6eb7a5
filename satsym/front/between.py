"""Interpolation of trajectories between their nodes by integration from both neighbouring nodes.

Interpolated values are therefore as accurate as those at the nodes. From each node the equations of the trajectory are
integrated by RK4, with steps that are halved until two runs agree. The two results in an interval are blended, with
more weight on the nearer node. If a control meets a bound or jumps within the interval, they are not blended: each
applies on its own side.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array, distinct
from satsym.control_set import ControlSet
from satsym.instance import Instance

Rates: TypeAlias = Callable[[Array, Array, NDArray[np.intp]], Array]
"""A function of times (M,), values (k, M) and indices of the preceding nodes that returns time derivatives (k, M)."""

FRACTION = 0.1
"""Fraction of the instance's tolerance that interpolation may add to the error."""
MOST_STEPS = 64
"""Largest number of integration steps between a node and an interpolated point."""
ROUNDING = 1e-13
GAINED = 15.0
"""Ratio of the difference between two runs of RK4, one with half the steps, to the error of the better one."""


@dataclass(frozen=True, eq=False)
class Motion:
    """A trajectory that can be evaluated between its nodes.

    Attributes
    ----------
    times, values
        Nodes (N+1,) in non-decreasing order, and values there, shape (k, N+1).
    rates
        Function that returns the time derivatives.
    corners
        Times between nodes at which the time derivatives are not smooth.
    tolerance
        Tolerance of the interpolation, relative to the largest magnitude of each value.
    """

    times: Array
    values: Array
    rates: Rates
    corners: Array
    tolerance: float

    def behind(self, t: Array) -> NDArray[np.intp]:
        """Return the indices of the intervals that contain some times.

        A repeated time belongs to the later interval.
        """
        return np.clip(np.searchsorted(self.times, t, side="right") - 1, 0, len(self.times) - 2)

    @np.errstate(all="ignore")
    def __call__(self, t: Array) -> Array:
        """Return values at times (M,) within the nodes, shape (k, M)."""
        left = self.behind(t)
        a, b = self.times[left], self.times[left + 1]
        fraction = np.where(b > a, (t - a) / np.where(b > a, b - a, 1.0), 1.0)
        weight = fraction**2 * (3.0 - 2.0 * fraction)
        place = np.searchsorted(self.corners, a, side="right")
        corner = np.append(self.corners, np.inf)[place]
        weight = np.where(corner < b, t >= corner, weight)
        first, second = self._from(left, left, t), self._from(left + 1, left, t)
        both = (1.0 - weight) * first + weight * second
        return np.where(weight == 0.0, first, np.where(weight == 1.0, second, both))

    def _from(self, node: NDArray[np.intp], interval: NDArray[np.intp], t: Array) -> Array:
        """Return values at times by integration from nodes, with steps that are halved until two runs agree."""
        steps, found, enough = 1, self._run(node, interval, t, 1), FRACTION * self.tolerance
        size = np.abs(self.values).max(axis=1, keepdims=True)
        before = np.inf
        while steps < MOST_STEPS:
            steps *= 2
            finer = self._run(node, interval, t, steps)
            off = np.abs(finer - found) / GAINED
            error = float(np.nanmax(off / np.where(size > 0.0, size, 1.0), initial=0.0))
            found = finer
            if not enough < error < before or error < ROUNDING:
                break
            before = error
        return found

    def _run(self, node: NDArray[np.intp], interval: NDArray[np.intp], t: Array, steps: int) -> Array:
        now, z = self.times[node].copy(), self.values[:, node].copy()
        h = (t - now) / steps
        for _ in range(steps):
            k1 = self.rates(now, z, interval)
            k2 = self.rates(now + h / 2, z + h / 2 * k1, interval)
            k3 = self.rates(now + h / 2, z + h / 2 * k2, interval)
            k4 = self.rates(now + h, z + h * k3, interval)
            # what does not move is not touched, whatever its rates are
            z = np.where(h == 0.0, z, z + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4))
            now = now + h
        return z


@dataclass(frozen=True, eq=False)
class Pieces:
    """Controls between nodes, one arc at a time; a node time that occurs twice separates two arcs.

    Constant controls are interpolated exactly. Other controls are interpolated by splines of degree five, which suit
    smooth arcs, or by monotonic cubics (PCHIP), which suit jumps: the method that predicts every second node better
    from the remaining nodes is used. Interpolated controls are projected onto the control set.
    """

    times: Array
    values: Array
    admissible: ControlSet
    _arcs: list[Callable[[Array], Array]] = field(default_factory=list)

    @cached_property
    def edges(self) -> NDArray[np.intp]:
        """Return the index of the first node of each arc."""
        return np.concatenate([[0], np.flatnonzero(np.diff(self.times) == 0.0) + 1])

    def __call__(self, t: Array, left: NDArray[np.intp]) -> Array:
        """Return controls at times (M,), in the intervals after the nodes with indices `left`; shape (m, M)."""
        found = np.empty((len(self.values), len(t)))
        arcs = np.searchsorted(self.edges, left, side="right") - 1
        for arc in distinct(arcs):
            here = arcs == arc
            found[:, here] = self._piece(int(arc))(t[here])
        return found

    def _piece(self, arc: int) -> Callable[[Array], Array]:
        if not self._arcs:
            ends = [*self.edges[1:].tolist(), len(self.times)]
            self._arcs.extend(self._fitted(a, b) for a, b in zip(self.edges.tolist(), ends, strict=True))
        return self._arcs[arc]

    def _fitted(self, begin: int, end: int) -> Callable[[Array], Array]:
        times, values = self.times[begin:end], self.values[:, begin:end]
        if len(times) < 2 or not np.isfinite(values).all() or not np.ptp(values, axis=1).any():
            return lambda t: np.repeat(values[:, :1], len(t), axis=1)
        kept = distinct([*range(0, len(times), 2), len(times) - 1])
        misses = [np.abs(fit(times[kept], values[:, kept])(times) - values).max() for fit in (_spline, _monotone)]
        fitted = (_spline if misses[0] <= misses[1] else _monotone)(times, values)
        return lambda t: self.admissible.project(fitted(t))


def _spline(times: Array, values: Array) -> Callable[[Array], Array]:
    from scipy.interpolate import make_interp_spline

    fitted: Callable[[Array], Array] = make_interp_spline(times, values, k=min(5, len(times) - 1), axis=1)
    return fitted


def _monotone(times: Array, values: Array) -> Callable[[Array], Array]:
    from scipy.interpolate import PchipInterpolator

    fitted: Callable[[Array], Array] = PchipInterpolator(times, values, axis=1)
    return fitted


def extremal(case: Instance, times: Array, x: Array, lam: Array, corners: Array) -> tuple[Motion, Pieces | None]:
    """Return the motion of states and costates, shape (2n, N+1), under the control that minimises the Hamiltonian."""
    model, p, bounds, n = case.model, case.parameters, case.control_set.arguments, len(x)

    def rates(t: Array, z: Array, _: NDArray[np.intp]) -> Array:
        return np.asarray(model.canonical_batch(t, z[:n], z[n:], p, bounds))

    return Motion(times, np.vstack([x, lam]), rates, corners, case.solver.tolerance), None


def bounded(
    case: Instance, times: Array, x: Array, lam: Array, arcs: Sequence[tuple[int, ...]]
) -> tuple[Motion, Pieces | None]:
    """Return the motion of an extremal with boundary arcs; `arcs` are the active constraints on each arc."""
    from satsym.solvers.constrained.active import field

    edges = np.flatnonzero(np.diff(times) == 0.0) + 1

    def rates(t: Array, z: Array, left: NDArray[np.intp]) -> Array:
        found, which = np.empty_like(z), np.searchsorted(edges, left, side="right")
        for arc in distinct(which):
            here = which == arc
            found[:, here] = field(case, arcs[int(arc)], t[here], z[:, here])
        return found

    return Motion(times, np.vstack([x, lam]), rates, np.empty(0), case.solver.tolerance), None


def controlled(case: Instance, times: Array, x: Array, u: Array, lam: Array | None) -> tuple[Motion, Pieces]:
    """Return the motion of states, and of costates if given, under controls interpolated from the nodes."""
    model, p, n = case.model, case.parameters, len(x)
    pieces = Pieces(times, u, case.control_set)

    def rates(t: Array, z: Array, left: NDArray[np.intp]) -> Array:
        now = pieces(t, left)
        moved = np.asarray(model.dynamics_batch(t, z[:n], now, p))
        return moved if lam is None else np.vstack([moved, model.costate_rate_batch(t, z[:n], now, z[n:], p)])

    values = x if lam is None else np.vstack([x, lam])
    return Motion(times, values, rates, np.empty(0), case.solver.tolerance), pieces
