"""The time grid that sweeps, quadrature and trajectories share: nodes of [t0, tf] and the midpoints between them.

Simulation and quadrature are fourth order only where the control is smooth within each step. A control that meets a
bound has corners, so a grid can take given points as nodes; a node that is too close to such a point moves there,
because a tiny step would cost as much as a full one and worsen the conditioning.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from satsym.arrays import Array

CLOSEST = 0.25
"""Smallest distance of an inserted point from its neighbours, as a fraction of the step it falls into."""


@dataclass(frozen=True, eq=False)
class Grid:
    """A time grid with nodes t0 < t1 < ... < tN = tf; all its arrays are read-only.

    Raises
    ------
    ValueError
        If there are fewer than two nodes, if they do not increase, or if a corner is not a node.
    """

    nodes: Array
    """Shape (N+1,), strictly increasing, in the model's unit of time."""
    corners: tuple[float, ...] = ()
    """Times of the nodes that stand for a corner of the trajectory and therefore must not move."""

    def __post_init__(self) -> None:
        nodes = np.array(self.nodes, dtype=float)
        if nodes.ndim != 1 or len(nodes) < 2 or not np.isfinite(nodes).all() or not (np.diff(nodes) > 0.0).all():
            raise ValueError("the nodes of a grid are at least two finite numbers that strictly increase")
        if not set(self.corners) <= set(nodes.tolist()):
            raise ValueError("every corner of a grid is one of its nodes")
        object.__setattr__(self, "nodes", _sealed(nodes))

    @classmethod
    def uniform(cls, t0: float, tf: float, steps: int) -> Grid:
        """Return a grid of ``steps`` equal steps from ``t0`` to ``tf``, with both ends exact."""
        if steps < 1:
            raise ValueError(f"a grid has at least one step, not {steps}")
        return cls(np.linspace(t0, tf, steps + 1))

    @property
    def steps(self) -> int:
        """Return the number N of steps."""
        return len(self.nodes) - 1

    @property
    def t0(self) -> float:
        return float(self.nodes[0])

    @property
    def tf(self) -> float:
        return float(self.nodes[-1])

    @cached_property
    def widths(self) -> Array:
        """Return the lengths of the steps, shape (N,)."""
        return _sealed(np.diff(self.nodes))

    @cached_property
    def midpoints(self) -> Array:
        """Return the middle of each step, shape (N,)."""
        return _sealed(self.nodes[:-1] + 0.5 * self.widths)

    @cached_property
    def node_weights(self) -> Array:
        """Return Simpson weights of values at the nodes, shape (N+1,)."""
        weights = np.zeros(self.steps + 1)
        weights[:-1] += self.widths / 6.0
        weights[1:] += self.widths / 6.0
        return _sealed(weights)

    @cached_property
    def midpoint_weights(self) -> Array:
        """Return Simpson weights of values at the midpoints, shape (N,)."""
        return _sealed(self.widths * (2.0 / 3.0))

    def with_corners(self, points: Iterable[float], closest: float = CLOSEST) -> Grid:
        """Return the grid in which each of the points is a node, as far as the spacing allows.

        A point becomes a new node, unless it is nearer to a node than ``closest`` times the step it falls
        into. Then that node moves to the point, except that ends and corners stay where they are: the point is
        left out. Points outside (t0, tf) are left out too. No step becomes shorter than ``closest`` times
        the shortest step before; steps next to a moved node grow by at most that fraction of a neighbour.

        Parameters
        ----------
        points
            Times of corners, in any order.
        closest
            Between 0 and 1/3.
        """
        if not 0.0 <= closest <= 1.0 / 3.0:
            raise ValueError(f"closest is a fraction between 0 and 1/3, not {closest}")
        before = self.nodes.tolist()
        nodes = self.nodes.tolist()
        corners = set(self.corners)
        fixed = {self.t0, self.tf} | corners
        for point in sorted(p for p in map(float, points) if self.t0 < p < self.tf):
            step = bisect_left(before, point)
            reach = closest * (before[step] - before[step - 1])
            place = bisect_left(nodes, point)
            near = [node for node in nodes[place - 1 : place + 1] if abs(node - point) < reach]
            if point not in nodes:
                if fixed.intersection(near):
                    continue
                if near:
                    nodes[nodes.index(near[0])] = point
                else:
                    nodes.insert(place, point)
            corners.add(point)
            fixed.add(point)
        return Grid(np.array(nodes), tuple(sorted(corners)))


def interleave(at_nodes: Array, at_midpoints: Array) -> Array:
    """Join values at nodes and at midpoints to values at the nodes of the refined grid.

    Parameters
    ----------
    at_nodes, at_midpoints
        Shapes (..., N+1) and (..., N).

    Returns
    -------
    Shape (..., 2N+1).
    """
    values = np.empty((*at_nodes.shape[:-1], at_nodes.shape[-1] + at_midpoints.shape[-1]))
    values[..., ::2] = at_nodes
    values[..., 1::2] = at_midpoints
    return values


def _sealed(values: Array) -> Array:
    values.flags.writeable = False
    return values
