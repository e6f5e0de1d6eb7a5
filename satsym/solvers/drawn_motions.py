"""Motions under controls that are drawn, those that come nearest to the end: from these one starts where others fail.

Where motions swing, only those arrive that push at the right times; no straight line, bent or not, leads to these. Many
controls are simulated at once: constant on pieces, most of them at bounds, and others that switch where the state
crosses a plane, which push what swings in its way.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.simulation.together import together

STEPS = 200
"""Of each motion, by the classical Runge-Kutta method; a control is kept for each step."""

KEPT, SAMPLES, PIECES = 4, 500, 10
"""Motions that are kept, controls of which each is the one that comes nearest, and most of their constant pieces."""

SATURATED = 0.8
"""Share of the pieces that lie at a bound."""

Law = Callable[[int, Array], Array]
"""Shares of the way from lower to upper bounds, shape (m, SAMPLES), at a step and scaled states (n, SAMPLES)."""


@dataclass(frozen=True, eq=False)
class Motion:
    """A motion under a control that was drawn."""

    control: Array
    """At the nodes, shape (m, STEPS + 1)."""
    states: Array
    """Scaled, at the same, shape (n, STEPS + 1)."""

    def path(self, tau: Array) -> Array:
        """Scaled states at times tau in [0, 1], shape (n, M)."""
        nodes = np.linspace(0.0, 1.0, self.states.shape[1])
        return np.array([np.interp(tau, nodes, row) for row in self.states])


def motions(problem: TwoPoint, rng: np.random.Generator) -> list[Motion]:
    """The nearest motion of each sample; none where controls have no bounds, or nothing is asked of the end.

    Parameters
    ----------
    problem
        With its bounds, and a given duration.
    """
    limits = problem.instance.control_set.around(len(problem.instance.model.spec.controls))
    given = problem.fixed.any() or problem.unknowns
    if not np.isfinite(limits).all() or problem.free_time or not given:
        return []
    found = (_nearest(problem, limits, (_pieces, _planes)[k % 2](problem, len(limits[0]), rng)) for k in range(KEPT))
    return [motion for motion in found if motion is not None]


def _pieces(problem: TwoPoint, controls: int, rng: np.random.Generator) -> Law:
    """Constant on pieces of any lengths."""
    levels = rng.uniform(size=(controls, SAMPLES, PIECES))
    levels = np.where(rng.uniform(size=levels.shape) < SATURATED, levels.round(), levels)
    edges = np.sort(rng.uniform(size=(SAMPLES, PIECES - 1)), axis=1)
    edges[np.arange(PIECES - 1) >= rng.integers(PIECES, size=(SAMPLES, 1))] = 2.0  # with fewer pieces
    piece = (edges[:, :, None] < np.linspace(0.0, 1.0, STEPS + 1)).sum(axis=1)
    return lambda step, _: np.asarray(levels[:, np.arange(SAMPLES), piece[:, step]])


def _planes(problem: TwoPoint, controls: int, rng: np.random.Generator) -> Law:
    """Zero or one, by the side of a plane on which the state is, through some of the axes."""
    normals = rng.standard_normal((controls, SAMPLES, problem.states))
    normals *= rng.uniform(size=normals.shape) < 0.5
    offsets = rng.standard_normal((controls, SAMPLES)) * (rng.uniform(size=SAMPLES) < 0.5)
    return lambda _, x: np.asarray(np.einsum("mkn,nk->mk", normals, x) + offsets > 0.0, dtype=float)


def _nearest(problem: TwoPoint, limits: tuple[Array, Array], law: Law) -> Motion | None:
    """That of a sample which misses the end by least; ``None`` where none stays in the domain."""
    instance, unit = problem.instance, problem.scale.state[:, None]
    assert instance.tf is not None
    low, high = limits

    def steady(step: int, x: Array) -> tuple[Array, Array, Array]:
        u = low + (high - low) * law(step, x / unit)
        return u, u, u

    lasting = np.full(SAMPLES, instance.tf - instance.t0)
    found = together(instance, steady, lasting, STEPS, costing=False)
    misses = np.array([_miss(problem, end) for end in (found.states[-1] / unit).T])
    misses[np.isinf(found.costs)] = np.inf
    best = int(np.argmin(misses))
    if not np.isfinite(misses[best]):
        return None
    return Motion(found.controls[:, :, best].T, found.states[:, :, best].T / unit)


def _miss(problem: TwoPoint, end: Array) -> float:
    """Largest residual of what ties the end, scaled."""
    n = problem.states
    residual = problem.boundary(np.append(end, np.zeros(n)), problem.theta)
    found = float(np.abs(np.append(residual[:n][problem.fixed], residual[n:])).max())
    return found if np.isfinite(found) else float("inf")
