"""The gap between two motions that nearly meet is closed by changes of both controls.

One motion begins at the start and the other, backwards, at the end, so neither has to follow what is unstable for as
long as both together. Each round takes the least change after which they meet, to first order, by alternating
projections onto these changes and onto the admissible controls; where the two have nothing in common that ends where
the gap is smallest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.grid import Grid
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.drawn_motions import STEPS, Motion

ROUNDS, PROJECTIONS = 40, 60
"""Changes of the controls, and projections for each."""

CLOSED = 1e-10
"""Scaled gap that is none."""

FRACTIONS = (1.0, 0.5, 0.25, 0.1, 0.03, 0.01)
"""Of a change that are tried until the gap shrinks."""

WORTH = 1e-3
"""Share by which it has to shrink."""


def closed(problem: TwoPoint, motion: Motion) -> Array:
    """The control at the nodes that leaves the smallest gap that is found, shape (m, STEPS + 1)."""
    both = _Both(problem, motion)
    project = problem.instance.control_set.project
    u: Array = project(motion.control)
    gap, x = both.gap(u)
    for _ in range(ROUNDS):
        size = float(gap @ gap)
        if not size > CLOSED**2:
            break
        slopes = both.slopes(u, x).reshape(len(gap), -1)
        inverse = np.linalg.pinv(slopes)
        v = u
        for _ in range(PROJECTIONS):
            least = np.asarray(inverse @ (gap + slopes @ (v - u).ravel()), dtype=float)
            v = project(v - least.reshape(u.shape))
        for share in FRACTIONS:
            there = project(u + share * (v - u))
            gap, x = both.gap(there)
            if float(gap @ gap) < (1.0 - WORTH) * size:
                break
        else:
            break
        u = there
    return u


@dataclass(frozen=True, eq=False)
class _Both:
    """A motion from the start and one from the end backwards, each up to the meeting."""

    problem: TwoPoint
    motion: Motion

    @property
    def _nodes(self) -> Array:
        instance = self.problem.instance
        return Grid.uniform(instance.t0, instance.t0 + self.problem.duration, STEPS).nodes

    def gap(self, u: Array) -> tuple[Array, Array]:
        """The scaled gap, shape (n,), and the states of both at the nodes, (n, STEPS + 1)."""
        problem, t, k = self.problem, self._nodes, self.motion.meeting
        model, p = problem.instance.model, problem.instance.parameters
        middle, end = (u[:, 1:] + u[:, :-1]) / 2.0, self.motion.states[:, -1] * problem.scale.state
        first, _, _ = model.forward(t[: k + 1], problem.instance.initial, u[:, : k + 1], middle[:, :k], p)
        second: Array = end[:, None]
        if k < STEPS:
            last, _, _ = model.forward(t[k:][::-1], tuple(end.tolist()), u[:, k:][:, ::-1], middle[:, k:][:, ::-1], p)
            second = last[:, ::-1]
        missed = (first[:, -1] - second[:, 0]) / problem.scale.state
        return np.where(np.isfinite(missed), missed, np.inf), np.concatenate([first[:, :-1], second], axis=1)

    def slopes(self, u: Array, x: Array) -> Array:
        """Derivatives of the gap by the control, shape (n, m, STEPS + 1), by trapezoids."""
        problem, t, k, n = self.problem, self._nodes, self.motion.meeting, self.problem.states
        model, p, shape = problem.instance.model, problem.instance.parameters, (n, STEPS + 1)
        by_x = np.broadcast_to(model.jacobian_x_batch(t, x, u, p), (n, *shape)).transpose(2, 0, 1)
        by_u = np.broadcast_to(model.jacobian_u_batch(t, x, u, p), (n, len(u), STEPS + 1))
        width, one = t[1] - t[0], np.eye(n)
        ahead = np.linalg.solve(one - width / 2.0 * by_x[1:], one + width / 2.0 * by_x[:-1])
        back = np.linalg.inv(ahead)
        moved = np.empty((STEPS + 1, n, n))
        moved[k] = np.diag(1.0 / problem.scale.state)
        for j in range(k, 0, -1):
            moved[j - 1] = moved[j] @ ahead[j - 1]
        for j in range(k, STEPS):
            moved[j + 1] = moved[j] @ back[j]
        weights = np.full(STEPS + 1, width)
        weights[[0, -1]] /= 2.0
        return np.asarray(np.einsum("kij,jmk->imk", moved, by_u) * weights)
