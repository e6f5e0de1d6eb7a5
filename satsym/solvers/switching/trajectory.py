"""An extremal of exact arcs at many times, its cost, and whether the control minimises H all along."""

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
"""Panels of a whole trajectory, and Gauss points in each: where its cost and its switching functions are looked at."""

NEAR_ENDS = np.geomspace(1e-6, 1e-2, 9)
"""Shares of an arc after its start and before its end at which its switching functions are looked at as well: where one
vanishes there, it may have the wrong sign for a moment only."""


DECIDING = 1e-3
"""Share of what another control decides on, with which a switching function that is always smaller is compared."""


@dataclass(frozen=True, eq=False)
class Trajectory:
    """An extremal arc by arc."""

    arcs: list[Arc]
    """Exact arcs that have a length."""
    stations: list[tuple[Array, Array, int]]
    """Starts of the integrator's steps on each arc, times (S,) and values (2n, S), and the columns they need."""
    points: list[tuple[Array, Array, Array, Array]]
    """Gauss points of each arc, shape (N,), with their weights, values (2n, N) and controls (m, N) there."""

    @classmethod
    def of(cls, arcs: list[Arc], sizes: Array) -> Trajectory:
        """Integrate along each arc that has a length."""
        kept = [arc for arc in arcs if arc.end > arc.start]
        whole = sum(arc.end - arc.start for arc in kept)
        bare = cls(kept, [_stations(arc, sizes) for arc in kept], [])
        panels = [_panels(arc, whole) for arc in kept]
        return replace(bare, points=[(*panel, *bare.at(k, panel[0])) for k, panel in enumerate(panels)])

    def at(self, which: int, times: Array) -> tuple[Array, Array]:
        """Values (2n, N) and controls (m, N) on an arc, at increasing times within it."""
        field = self.arcs[which].field
        known, values, columns = self.stations[which]
        step = np.maximum(np.searchsorted(known, times, side="right") - 1, 0)
        start = known[step]
        z = leap(lambda t, y: field.along(t, y)[1], start, values[:, step], times - start, columns)
        return z, field.along(times, z)[0]

    @property
    def looked_at(self) -> list[tuple[Array, Array]]:
        """Times of each arc, shape (N,), and values (2n, N): Gauss points, ends, and what is next to these."""
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
        """The running cost, by Gauss's rule, and the terminal cost."""
        model, p, n = instance.model, instance.parameters, len(instance.initial)
        total = 0.0
        for times, weights, z, u in self.points:
            total += float(np.broadcast_to(model.running_cost_batch(times, z[:n], u, p), len(times)) @ weights)
        end = tuple(self.arcs[-1].after[:n].tolist())
        return total + float(model.terminal_cost(self.arcs[-1].end, end, p))

    def grid(self, nodes: Array) -> tuple[Array, Array, Array]:
        """Times, values and controls at given times and on both sides of every switch.

        Parameters
        ----------
        nodes
            Increasing, from the start to the end.

        Returns
        -------
        times : (M,)
            With each switching time twice: first as the end of one arc, then as the start of the next.
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
    """Where a control does not minimise H, or leaves its bounds on a singular arc."""

    control: int
    arc: int
    """Which control, and which of the arcs between any switches."""
    start: float
    end: float
    """The times between which another level would be better."""
    level: int
    """The level that would be better."""
    amount: float
    """How far the switching function is on the wrong side, relative to its largest value; or how far the control is
    beyond its bounds, relative to the distance between them."""
    beyond: bool = False
    """Whether it is beyond them."""


def violations(trajectory: Trajectory, slack: float = 1e-9) -> list[Violation]:
    """All stretches on which a control is not at the level that minimises H, or beyond its bounds."""
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
    """For each control the switching function with which it would decide on as much as any does, shape (m,).

    Parameters
    ----------
    sizes
        Of all switching functions, shape (m,).
    """
    low, high = map(np.array, instance.control_set.switching)
    room = np.maximum(high - low, 1e-300)
    return np.asarray((sizes * room).max() / room)


def _worse(sigma: Array, weight: Array, level: int, slack: float) -> tuple[NDArray[np.int64], NDArray[np.bool_], Array]:
    """The level that a switching function asks for, where it is not that of the control, and by how much."""
    wrong = np.where(sigma > weight + slack, LOWER, np.where(sigma < -weight - slack, UPPER, REST))
    inside = np.abs(sigma) < weight - slack
    return wrong, (wrong != REST) & (wrong != level) | inside & (level != REST), np.abs(np.abs(sigma) - weight)


def _beyond(arc: Arc, times: Array, z: Array, control: int) -> tuple[NDArray[np.int64], Array]:
    """The bound that is nearer to a singular control, and by how much it is beyond, relative to the box."""
    low, high = arc.field.instance.lower[control], arc.field.instance.upper[control]
    u = arc.field.along(times, z)[0][control]
    excess = np.maximum(low - u, u - high) / (high - low)
    return np.where(u < (low + high) / 2.0, LOWER, UPPER), np.where(np.isfinite(u), excess, np.inf)


def runs(flags: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """First and last index of each run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(int), [0]])))
    return [(int(a), int(b) - 1) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def _stations(arc: Arc, sizes: Array) -> tuple[Array, Array, int]:
    """Starts of the integrator's steps: a step that is no longer is no less accurate."""
    field = arc.field

    def rates(t: float, y: Array) -> Array:
        return np.array(field.rates(t, y.tolist()))

    (piece,) = integrate(rates, np.array([arc.start, arc.end]), arc.before, TOLERANCE, sizes, WHOLE)
    return piece.times[:-1], piece.values[:-1].T, piece.columns


def _panels(arc: Arc, whole: float) -> tuple[Array, Array]:
    """Gauss points of the panels of an arc, and their weights."""
    count = max(2, int(np.ceil(PANELS * (arc.end - arc.start) / whole)))
    edges = np.linspace(arc.start, arc.end, count + 1)
    gauss = scheme(POINTS)
    times = (edges[:-1, None] + np.diff(edges)[:, None] * gauss.nodes).ravel()
    return times, np.outer(np.diff(edges), gauss.weights).ravel()
