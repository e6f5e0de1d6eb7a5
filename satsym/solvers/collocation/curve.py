"""A curve of states and costates: polynomials on the intervals of a mesh, with the extra unknowns."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol

import numpy as np

from satsym.arrays import Array
from satsym.solvers.collocation.gauss import barycentric, interpolation, scheme

SMALL_COSTATE = 1e-4
"""Minimum scale of costates in relative errors, since rounding of the states affects costates by at least as much."""


class Path(Protocol):
    """States and costates over the scaled time tau in [0, 1], smooth between mesh nodes, with extra unknowns."""

    @property
    def mesh(self) -> Array:
        """Nodes of the mesh in [0, 1], shape (N+1,)."""

    @property
    def nodes(self) -> Array:
        """Values of states and costates at the nodes, shape (2n, N+1)."""

    @property
    def theta(self) -> Array:
        """Extra unknowns, such as multipliers and a free duration, shape (e,)."""

    def __call__(self, tau: Array) -> Array:
        """Return states and costates at the times ``tau`` in [0, 1], shape (2n, M)."""


@dataclass(frozen=True, eq=False)
class Curve:
    """Values of states and costates at the nodes of a mesh and at the Gauss points between them."""

    mesh: Array
    """Nodes of the mesh in [0, 1], shape (N+1,)."""
    nodes: Array
    """Values of states and costates at the nodes, shape (2n, N+1)."""
    stages: Array
    """Values of states and costates at the s Gauss points of each interval, shape (2n, N, s)."""
    theta: Array
    """Extra unknowns, such as multipliers and a free duration, shape (e,)."""

    @property
    def order(self) -> int:
        """Return the number s of stages."""
        return int(self.stages.shape[2])

    @property
    def flat(self) -> Array:
        """Return the stage values in order of time, shape (2n, N s)."""
        return self.stages.reshape(len(self.stages), -1)

    def __call__(self, tau: Array) -> Array:
        """Return states and costates at the times ``tau`` in [0, 1], shape (2n, M)."""
        tau = np.asarray(tau, dtype=float)
        mesh = self.mesh
        interval = np.searchsorted(mesh[1:-1], tau, side="right")
        table, total = barycentric(self.order, (tau - mesh[interval]) / (mesh[1:] - mesh[:-1])[interval])
        known = np.concatenate([self.nodes[:, :-1, None], self.stages], axis=2)
        values, turned = np.empty((len(self.nodes), len(tau))), np.flatnonzero(interval[1:] != interval[:-1]) + 1
        ends = [0, *turned.tolist(), len(tau)] if len(tau) else []
        for first, last in pairwise(ends):  # times in one interval after the other
            np.matmul(known[:, interval[first]], table[:, first:last], out=values[:, first:last])
        values /= total
        return values

    def on(self, mesh: Array, order: int) -> Curve:
        """Return this curve interpolated on another mesh or with another number of stages."""
        if mesh is self.mesh:
            return self.with_stages(order)
        tau = stage_times(mesh, order)
        stages = self(tau.ravel()).reshape(len(self.nodes), *tau.shape)
        return Curve(mesh, self(mesh), stages, self.theta)

    def with_stages(self, order: int) -> Curve:
        """Return the same polynomials, represented by their values at another number of Gauss points."""
        if order == self.order:
            return self
        known = np.concatenate([self.nodes[:, :-1, None], self.stages], axis=2)
        return Curve(self.mesh, self.nodes, known @ interpolation(self.order, order).T, self.theta)

    def in_domain(self, positive: tuple[int, ...]) -> bool:
        """Return whether the states with the given indices are positive everywhere."""
        return all(self.stages[i].min() > 0.0 and self.nodes[i].min() > 0.0 for i in positive)

    def moved(self, step: Step, length: float) -> Curve:
        """Return the curve after a fraction of a step."""
        if length == 1.0:
            return Curve(self.mesh, self.nodes + step.nodes, self.stages + step.stages, self.theta + step.theta)
        return Curve(
            self.mesh,
            self.nodes + length * step.nodes,
            self.stages + length * step.stages,
            self.theta + length * step.theta,
        )


@dataclass(frozen=True, eq=False)
class Step:
    """A change of a curve, in arrays of the same shapes."""

    nodes: Array
    stages: Array
    theta: Array

    def size(self, curve: Curve, small: float = SMALL_COSTATE) -> float:
        """Return the largest change, relative to the states (at least 1) and costates (at least ``small``)."""
        sizes = np.maximum(_largest(curve.nodes, curve.stages), (1.0, small))
        found = (_largest(self.nodes, self.stages) / sizes).max()
        if len(self.theta):
            found = np.maximum(found, abs(self.theta[-1]) / max(abs(curve.theta[-1]), 1e-300))
        return float(found)


def _largest(nodes: Array, stages: Array) -> Array:
    """Return the magnitudes of the largest state and the largest costate."""
    both = np.concatenate([nodes, stages.reshape(len(stages), -1)], axis=1)
    largest: Array = np.abs(both).reshape(2, -1).max(axis=1)
    return largest


def stage_times(mesh: Array, order: int) -> Array:
    """Return the Gauss points of each interval, shape (N, s)."""
    times: Array = mesh[:-1, None] + (mesh[1:] - mesh[:-1])[:, None] * scheme(order).nodes
    return times
