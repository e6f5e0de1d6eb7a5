"""Values of an extremal of exact arcs at many times, its cost, and a test whether the control minimises H."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.collocation.gauss import scheme
from satsym.solvers.simulation.extrapolation import integrate, leap
from satsym.solvers.switching.extremal_arcs import TOLERANCE, WHOLE, Arc
from satsym.solvers.switching.structure import LOWER, REST, SINGULAR, UPPER
from satsym.solvers.switching.throttled import signs

PANELS, POINTS = 20, 8
"""Number of panels of a whole trajectory, and of Gauss points in each panel, at which cost and switching functions are
evaluated."""

NEAR_ENDS = np.geomspace(1e-6, 1e-2, 9)
"""Fractions of an arc after its start and before its end at which switching functions are evaluated as well. If one
vanishes at an end, it may have the wrong sign for a short time only."""


DECIDING = 1e-3
"""Minimum scale of a switching function, relative to the largest effect on H of any control."""


@dataclass(frozen=True, eq=False)
class Trajectory:
    """An extremal of exact arcs, with interpolation data."""

    arcs: list[Arc]
    """Exact arcs that have a length."""
    stations: list[tuple[Array, Array, int]]
    """For each arc: times (S,) and values (2n, S) at the starts of the integration steps, and the number of columns of
    the extrapolation table."""
    points: list[tuple[Array, Array, Array, Array]]
    """For each arc: Gauss points, shape (N,), with their weights, values (2n, N) and controls (m, N)."""

    @classmethod
    def of(cls, arcs: list[Arc], sizes: Array) -> Trajectory:
        """Return the trajectory of all arcs that have a length."""
        kept = [arc for arc in arcs if arc.end > arc.start]
        whole = sum(arc.end - arc.start for arc in kept)
        bare = cls(kept, [_stations(arc, sizes) for arc in kept], [])
        panels = [_panels(arc, whole) for arc in kept]
        return replace(bare, points=[(*panel, *bare.at(k, panel[0])) for k, panel in enumerate(panels)])

    def at(self, which: int, times: Array) -> tuple[Array, Array]:
        """Return values (2n, N) and controls (m, N) at increasing times on an arc."""
        field = self.arcs[which].field
        known, values, columns = self.stations[which]
        step = np.maximum(np.searchsorted(known, times, side="right") - 1, 0)
        start = known[step]
        z = leap(lambda t, y: field.along(t, y)[1], start, values[:, step], times - start, columns)
        return z, field.along(times, z)[0]

    @property
    def looked_at(self) -> list[tuple[Array, Array]]:
        """Return times, shape (N,), and values (2n, N) on each arc: at Gauss points, at and near the ends."""
        tables = []
        for which, (arc, (inside, _, values, _)) in enumerate(zip(self.arcs, self.points, strict=True)):
            near = NEAR_ENDS * (arc.end - arc.start)
            ends = np.concatenate([arc.start + near, arc.end - near[::-1]])
            times = np.concatenate([[arc.start], inside, [arc.end], ends])
            z = np.concatenate([arc.before[:, None], values, arc.after[:, None], self.at(which, ends)[0]], axis=1)
            order = np.argsort(times, kind="stable")
            tables.append((times[order], z[:, order]))
        return tables

    def cost(self, instance: Instance) -> float:
        """Return the running cost by Gauss quadrature plus the terminal cost."""
        model, p, n = instance.model, instance.parameters, len(instance.initial)
        total = 0.0
        for times, weights, z, u in self.points:
            total += float(np.broadcast_to(model.running_cost_batch(times, z[:n], u, p), len(times)) @ weights)
        end = tuple(self.arcs[-1].after[:n].tolist())
        return total + float(model.terminal_cost(self.arcs[-1].end, end, p))

    def grid(self, nodes: Array) -> tuple[Array, Array, Array]:
        """Return times, values and controls at given times and on both sides of every switch.

        Parameters
        ----------
        nodes
            Increasing times, from the start to the end.

        Returns
        -------
        times : (M,)
            The times, with each switching time twice: as the end of one arc and as the start of the next.
        values : (2n, M)
        controls : (m, M)
        """
        parts = []
        for which, arc in enumerate(self.arcs):
            inside = nodes[(nodes > arc.start) & (nodes < arc.end)]
            times = np.concatenate([[arc.start], inside, [arc.end]])
            z, u = self.at(which, times)
            z[:, 0], z[:, -1] = arc.before, arc.after
            new = int(which > 0 and self.arcs[which - 1].stop is not None)
            parts.append((times[new:], z[:, new:], u[:, new:]))
        return tuple(np.concatenate(rows, axis=-1) for rows in zip(*parts, strict=True))  # type: ignore[return-value]


@dataclass(frozen=True)
class Violation:
    """An interval on which a control does not minimise H, or leaves its bounds on a singular arc."""

    control: int
    arc: int
    """Index of the control, and index of the arc between switches of any control."""
    start: float
    end: float
    """Times between which another level would be better."""
    level: int
    """The better level."""
    amount: float
    """Excess of the switching function on the wrong side, relative to its largest value; or of the control beyond its
    bounds, relative to their distance."""
    beyond: bool = False
    """Whether the control is beyond its bounds."""


def violations(trajectory: Trajectory, slack: float = 1e-9) -> list[Violation]:
    """Return all intervals on which a control is not at the level that minimises H, or beyond its bounds."""
    n, instance = trajectory.arcs[0].field.n, trajectory.arcs[0].field.instance
    tables = [(times, z, *signs(instance, times, z[:n], z[n:])) for times, z in trajectory.looked_at]
    largest = np.max([np.abs(sigma).max(axis=1) + weight.max(axis=1) for *_, sigma, weight in tables], axis=0)
    largest = np.maximum(largest, DECIDING * deciding(instance, largest))
    found: list[Violation] = []
    for which, (arc, (times, z, sigma, weight)) in enumerate(zip(trajectory.arcs, tables, strict=True)):
        for control, level in enumerate(arc.field.levels):
            if level >= SINGULAR:
                wrong, amounts = _beyond(arc, times, z, control)
                bad = amounts > slack
            else:
                size = max(float(largest[control]), 1e-300)
                wrong, bad, amounts = _worse(sigma[control] / size, weight[control] / size, level, slack)
            for first, last in runs(bad):
                better = int(wrong[(first + last) // 2])
                amount = float(amounts[first : last + 1].max())
                low, high = times[max(first - 1, 0)], times[min(last + 1, len(times) - 1)]
                found.append(Violation(control, which, float(low), float(high), better, amount, level >= SINGULAR))
    return found


def deciding(instance: Instance, sizes: Array) -> Array:
    """Return the values of switching functions at which all controls affect H as much as the strongest, (m,).

    Parameters
    ----------
    sizes
        Magnitudes of all switching functions, shape (m,).
    """
    low, high = map(np.array, instance.control_set.switching)
    room = np.maximum(high - low, 1e-300)
    return np.asarray((sizes * room).max() / room)


def _worse(sigma: Array, weight: Array, level: int, slack: float) -> tuple[NDArray[np.int64], NDArray[np.bool_], Array]:
    """Return the level that minimises H, whether the control's level is wrong, and the margin."""
    wrong = np.where(sigma > weight + slack, LOWER, np.where(sigma < -weight - slack, UPPER, REST))
    inside = np.abs(sigma) < weight - slack
    return wrong, (wrong != REST) & (wrong != level) | inside & (level != REST), np.abs(np.abs(sigma) - weight)


def _beyond(arc: Arc, times: Array, z: Array, control: int) -> tuple[NDArray[np.int64], Array]:
    """Return the bound nearer to a singular control, and the excess of the control beyond it, relative to the box."""
    low, high = arc.field.instance.lower[control], arc.field.instance.upper[control]
    u = arc.field.along(times, z)[0][control]
    excess = np.maximum(low - u, u - high) / (high - low)
    return np.where(u < (low + high) / 2.0, LOWER, UPPER), np.where(np.isfinite(u), excess, np.inf)


def runs(flags: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return first and last index of each run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(int), [0]])))
    return [(int(a), int(b) - 1) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def _stations(arc: Arc, sizes: Array) -> tuple[Array, Array, int]:
    """Return the starts of the integrator's steps on an arc, from which interpolation is as accurate as the steps."""
    field = arc.field

    def rates(t: float, y: Array) -> Array:
        return np.array(field.rates(t, y.tolist()))

    (piece,) = integrate(rates, np.array([arc.start, arc.end]), arc.before, TOLERANCE, sizes, WHOLE)
    return piece.times[:-1], piece.values[:-1].T, piece.columns


def _panels(arc: Arc, whole: float) -> tuple[Array, Array]:
    """Return the Gauss points of the panels of an arc, and their weights."""
    count = max(2, int(np.ceil(PANELS * (arc.end - arc.start) / whole)))
    edges = np.linspace(arc.start, arc.end, count + 1)
    gauss = scheme(POINTS)
    times = (edges[:-1, None] + np.diff(edges)[:, None] * gauss.nodes).ravel()
    return times, np.outer(np.diff(edges), gauss.weights).ravel()
