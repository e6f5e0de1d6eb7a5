"""Motions under controls that are drawn, those that come nearest to the end: from these one starts where others fail.

Where motions swing, only those arrive that push at the right times; no straight line, bent or not, leads to these. Many
controls are simulated at once: constant on pieces, most of them at bounds, and others that switch where the state
crosses a plane, which push what swings in its way.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from satsym.arrays import Array
from satsym.grid import Grid
from satsym.solvers.collocation.problem import TwoPoint

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
    limits = _limits(problem)
    if limits is None or problem.free_time or not (problem.fixed.any() or problem.unknowns):
        return []
    found = (_nearest(problem, limits, (_pieces, _planes)[k % 2](problem, len(limits[0]), rng)) for k in range(KEPT))
    return [motion for motion in found if motion is not None]


def _limits(problem: TwoPoint) -> tuple[Array, Array] | None:
    """Lower and upper bounds of a box round the control set, each of shape (m, 1)."""
    whole, count = problem.instance.control_set, len(problem.instance.model.spec.controls)
    low, high = np.full((count, 1), -np.inf), np.full((count, 1), np.inf)
    for places, part in whole.parts if whole.kind == "product" else ((tuple(range(count)), whole),):
        if part.kind == "box":
            low[list(places)], high[list(places)] = part.box
        else:
            largest = np.pi if part.kind == "angle" else part.radius
            low[list(places)], high[list(places)] = -largest, largest
    return (low, high) if np.isfinite(low).all() and np.isfinite(high).all() else None


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
    grid = Grid.uniform(instance.t0, instance.tf, STEPS)
    low, high = limits
    states = [np.repeat(np.array(instance.initial)[:, None], SAMPLES, axis=1)]
    controls: list[Array] = []
    with np.errstate(all="ignore"):
        for step, t in enumerate(grid.nodes.tolist()):
            shares = law(step, states[-1] / unit)
            controls.append(instance.control_set.project(low + (high - low) * shares))
            if step < STEPS:
                rates = partial(instance.model.dynamics_batch, u=controls[-1], p=instance.parameters)
                states.append(_stepped(rates, t, states[-1], (instance.tf - instance.t0) / STEPS))
        x = np.array(states) / unit
        bad = ~np.isfinite(x).all(axis=(0, 1)) | ~(x[:, list(problem.positive)] > 0.0).all(axis=(0, 1))
        misses = np.array([_miss(problem, end) for end in x[-1].T])
    misses[bad] = np.inf
    best = int(np.argmin(misses))
    return Motion(np.array(controls)[:, :, best].T, x[:, :, best].T) if np.isfinite(misses[best]) else None


def _stepped(rates: Callable[..., Array], t: float, x: Array, h: float) -> Array:
    one = np.asarray(rates(t, x))
    two = np.asarray(rates(t + h / 2.0, x + h / 2.0 * one))
    three = np.asarray(rates(t + h / 2.0, x + h / 2.0 * two))
    return x + h / 6.0 * (one + 2.0 * (two + three) + np.asarray(rates(t + h, x + h * three)))


def _miss(problem: TwoPoint, end: Array) -> float:
    """Largest residual of what ties the end, scaled."""
    n = problem.states
    residual = problem.boundary(np.append(end, np.zeros(n)), problem.theta)
    found = float(np.abs(np.append(residual[:n][problem.fixed], residual[n:])).max())
    return found if np.isfinite(found) else float("inf")
