"""Competitors close by: random smooth changes of the control, corrected until the end is met again."""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.grid import Grid, interleave
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solve import control_set
from satsym.solve.certificate.competitors import HIDDEN, hidden, margin
from satsym.solve.collocation.scaling import final_argument

Array = NDArray[np.floating[Any]]

STEPS = (200, 800, 3200)
"""RK4 steps with which neighbours are compared, on the same grid as the solution itself: the fewest that fly it."""

FLOWN = 1e-2
"""Relative distance from the solution's end within which a grid flies it: what is compared is the same on both."""

NEIGHBOURS, WAVES = 8, 6
AMPLITUDE = 0.05
"""Of a neighbour's departure from the control, relative to the largest control."""

CORRECTIONS = 12
MISSED = 1e-9
"""Miss of the end up to which a neighbour counts as feasible, relative to its size and to how far the control moves it.
"""

NUDGE, MOVED = 1e-4, 1e-8
"""Relative change of the control that shows its effect on the end, and least share by which that must be moved."""


@dataclass(frozen=True, eq=False)
class Flights:
    """Flights of one instance on one grid.

    Attributes
    ----------
    instance, grid
        What is flown, and where controls are given: at the nodes and midpoints.
    fixed
        Indices of the states whose end is given.
    scale
        Sizes of these.
    """

    instance: Instance
    grid: Grid
    fixed: NDArray[np.intp]
    scale: Array

    @property
    def times(self) -> Array:
        """Nodes and midpoints."""
        return interleave(self.grid.nodes, self.grid.midpoints)

    def __call__(self, control: Array) -> tuple[float, Array]:
        """The cost of a control, shape (m, 2 N + 1), and by how many sizes the given states end from zero."""
        instance, grid = self.instance, self.grid
        x, _, running = instance.model.forward(
            grid.nodes, instance.initial, control[:, ::2], control[:, 1::2], instance.parameters
        )
        terminal = instance.model.terminal_cost(grid.tf, tuple(x[:, -1].tolist()), instance.parameters)
        return running + terminal, x[self.fixed, -1] / self.scale


def neighbours(solution: Solution) -> float:
    """How much dearer the cheapest neighbour is, relative to the cost; infinite where none could be flown."""
    flown = _flights(solution)
    if flown is None:
        return float("inf")
    instance, times = solution.instance, flown.times
    u = _control(solution, times)
    size = float(np.abs(u).max()) or 1.0
    shapes = list(_shapes(instance, times, u))
    cost, end = flown(u)
    moved = float(np.abs(end - flown(np.zeros_like(u))[1]).max(initial=0.0))
    nudge = size * (NUDGE if moved == 0.0 else max(NUDGE, MOVED / moved))
    missed = MISSED * min(1.0, max(moved, HIDDEN / MISSED))
    response = np.stack([(flown(u + nudge * shape)[1] - end) / nudge for shape in shapes], axis=1)
    if not np.isfinite(response).all():
        return float("inf")
    rng = random.Random("neighbours")
    cheapest = float("inf")
    for _ in range(NEIGHBOURS):
        weights = np.array([rng.gauss(0.0, 1.0) for _ in shapes])
        weights *= AMPLITUDE * size / max(1.0, float(np.linalg.norm(weights)))
        cheapest = min(cheapest, _corrected(flown, u, shapes, weights, response, end, missed))
    return margin(cheapest, cost, hidden=hidden(solution))


def _corrected(
    flown: Flights, u: Array, shapes: list[Array], weights: Array, response: Array, end: Array, missed: float
) -> float:
    """The cost of a neighbour once it ends where the solution does; infinite where it cannot be made to."""
    tried: Array = np.zeros(0)
    for _ in range(CORRECTIONS):
        change = sum((w * s for w, s in zip(weights, shapes, strict=True)), np.zeros_like(u))
        cost, reached = flown(control_set.project(flown.instance, u + change))
        gap = reached - end
        miss = float(np.abs(gap).max(initial=0.0))
        if miss <= missed:
            return cost
        if not np.isfinite(miss):
            break
        if len(tried):  # Broyden: the response as the last correction found it
            response = response + np.outer(gap, tried) / float(tried @ tried)
            if not np.isfinite(response).all():
                break
        tried = -np.linalg.lstsq(response, gap, rcond=None)[0]
        weights = weights + tried
    return float("inf")


def _flights(solution: Solution) -> Flights | None:
    """Flights on the first grid on which the solution's own control leads to its end."""
    n = len(solution.instance.initial)
    final = np.array(final_argument(solution.instance))
    # Where constraints tie the end, a neighbour keeps them by keeping the whole of it.
    tied = bool(solution.instance.model.spec.multipliers)
    fixed = np.arange(n) if tied else np.flatnonzero(final[:n] + final[n : 2 * n] > 0.0)
    scale = np.maximum(np.abs(solution.x).max(axis=1), 1e-300)
    for steps in STEPS:
        grid = Grid.uniform(float(solution.times[0]), float(solution.times[-1]), steps)
        everything = Flights(solution.instance, grid, np.arange(n), scale)
        _, end = everything(_control(solution, everything.times))
        if np.abs(end - solution.x[:, -1] / scale).max() < FLOWN:
            return Flights(solution.instance, grid, fixed, scale[fixed])
    return None


def _control(solution: Solution, times: Array) -> Array:
    return np.array([np.interp(times, solution.times, row) for row in solution.u])


def _shapes(instance: Instance, times: Array, u: Array) -> Iterator[Array]:
    """Smooth changes of one control each, which vanish where a bound holds it."""
    share = (times - times[0]) / (times[-1] - times[0])
    room = _room(instance, u)
    for i in range(len(u)):
        for wave in range(WAVES):
            shape = np.zeros_like(u)
            shape[i] = np.cos(np.pi * wave * share) * room[i]
            yield shape


def _room(instance: Instance, u: Array) -> Array:
    """One where a control is far from its bounds, zero on them, shape (m, M)."""
    size = max(float(np.abs(u).max()), 1e-300)
    distance = control_set.excess(instance, u)
    kind = instance.model.spec.control_set
    if kind == "box":
        m = len(u)
        distance = np.minimum(np.abs(distance[:m]), np.abs(distance[m:]))
    elif kind == "ball":
        distance = np.broadcast_to(np.abs(distance), u.shape)
    else:
        return np.ones_like(u)
    return np.clip(distance / (2.0 * AMPLITUDE * size), 0.0, 1.0)
