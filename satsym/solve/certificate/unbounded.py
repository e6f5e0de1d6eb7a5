"""Whether the cost of a problem falls without end: shown by controls that are larger and larger.

From an extremal that is no minimum the control is changed along the direction in which the second variation is least,
by twice as much again and again. Where the end stays as it is asked for and the cost falls at least in proportion,
time after time, no control is the best one. Of linear problems with quadratic costs this decides; of others it is
evidence.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.grid import Grid
from satsym.solution import Solution
from satsym.solve.certificate.accessory import accessory
from satsym.solve.certificate.flow import unit_sizes
from satsym.solve.certificate.neighbours import Simulations, simulations_of, stated_control

Array = NDArray[np.floating[Any]]

DOUBLINGS = 12
"""Of the change, from the size of the control on that moves the state by its own size."""

FALLS = 6
"""Last ones of these over which the cost must fall at least in proportion."""

PROPORTIONAL = 1.9
"""Growth of the fall from one doubling to the next that counts so."""

KEPT = 1e-6
"""Relative miss of the end beside what the change would have moved it."""


@dataclass(frozen=True)
class Fall:
    """A cost that falls without end.

    Attributes
    ----------
    sizes
        The largest control of each motion.
    costs
        What these cost.
    """

    sizes: tuple[float, ...]
    costs: tuple[float, ...]

    @property
    def message(self) -> str:
        """One line."""
        costs, sizes = (", ".join(f"{value:.4g}" for value in row[-3:]) for row in (self.costs, self.sizes))
        return f"the cost is unbounded below: controls up to {sizes} cost {costs}"


def fall(solution: Solution) -> Fall | None:
    """The fall of the cost from an extremal that is no minimum; ``None`` where none shows.

    Parameters
    ----------
    solution
        With a given final time; controls that have bounds are not asked.
    """
    simulations = simulations_of(solution)
    bounded = bool(np.isfinite(solution.instance.bounds).any())
    if solution.instance.tf is None or bounded or simulations is None:
        return None
    grid = simulations.grid()
    second = accessory(solution, grid)
    if second is None:
        return None
    curvature, direction = second.least
    if not curvature < 0.0:
        return None
    shape = second.controls @ direction
    unit = max(float(np.abs(solution.u).max()), _natural(solution, shape)) / float(np.abs(shape).max())
    u = stated_control(solution, grid)
    found = [_doubled(simulations, grid, u, sign * unit * shape) for sign in (1.0, -1.0)]
    return next(filter(None, found), None)


def _natural(solution: Solution, shape: Array) -> float:
    """The size of a control that moves the state by its own size over the duration."""
    instance, lasting = solution.instance, float(solution.times[-1] - solution.times[0])
    u, x, t = (np.asarray(row)[..., :1] for row in (solution.u, solution.x, solution.times))
    by_control = np.abs(np.asarray(instance.model.jacobian_u_batch(t, x, u, instance.parameters))).max(axis=(1, 2))
    size = unit_sizes(solution)[: len(solution.x)]
    response = float((by_control / size).max()) * lasting
    return 1.0 / response if response > 0.0 else float(np.abs(shape).max())


def _doubled(simulations: Simulations, grid: Grid, u: Array, change: Array) -> Fall | None:
    """What changes of a control by more and more cost, where they fall without end."""
    instance = simulations.instance
    cost, end = simulations(u, grid)
    _, pushed = simulations(u + change, grid)
    falls, sizes, costs = [], [], []
    for k in range(DOUBLINGS):
        control = u + 2.0**k * change
        now, reached = simulations(control, grid)
        x, _ = simulations.motion(control, grid)
        if not np.isfinite(now) or not instance.model.in_domain(x):
            return None
        moved = 2.0**k * max(1.0, float(np.abs(pushed).max(initial=0.0)))
        if np.abs(reached - end).max(initial=0.0) > KEPT * moved:
            return None
        falls.append(cost - now)
        sizes.append(float(np.abs(control).max()))
        costs.append(now)
    last = np.array(falls[-FALLS - 1 :])
    endless = (last > 0.0).all() and (last[1:] >= PROPORTIONAL * last[:-1]).all()
    return Fall(tuple(sizes), tuple(costs)) if endless else None
