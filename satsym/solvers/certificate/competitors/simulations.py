"""Simulations of an instance for comparison with a solution, with as few steps as the comparison needs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.grid import Grid, interleave
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers.certificate.end_form import fixed_states
from satsym.solvers.certificate.reintegration.flow import typical
from satsym.solvers.collocation.problem import ended
from satsym.solvers.collocation.scaling import final_argument
from satsym.solvers.control.regularised import sloping

STEPS = ((200, 1e-3), (800, 1e-3), (3200, 1e-2))
"""Numbers of RK4 steps to try, in ascending order, each with the largest distance from the final state of the solution,
relative to the magnitudes of the states. The first number that keeps this distance is used."""


@dataclass(frozen=True, eq=False)
class Simulations:
    """Simulations of one instance with a fixed number of steps."""

    instance: Instance
    """The instance that is simulated."""
    rows: NDArray[np.intp]
    """Indices of the boundary residuals that constrain the final state."""
    scale: Array
    """Typical magnitudes of the boundary residuals that constrain the final state."""
    steps: int
    """Number of steps of each simulation."""
    end: float
    """Final time."""

    def grid(self, longer: float = 0.0) -> Grid:
        """Return the time grid of a motion that ends later than ``end`` by the given time."""
        return Grid.uniform(self.instance.t0, self.end + longer, self.steps)

    def __call__(self, control: Array, grid: Grid) -> tuple[float, Array]:
        """Return cost and scaled end residuals of a control given at nodes and midpoints, shape (m, 2 N + 1)."""
        instance, (x, running) = self.instance, self.motion(control, grid)
        end = tuple(x[:, -1].tolist())
        terminal = instance.model.terminal_cost(grid.tf, end, instance.parameters)
        none, nu = (0.0,) * len(end), (0.0,) * len(instance.model.spec.multipliers)
        if instance.model.spec.throttled:
            none = tuple(sloping(instance, np.zeros((len(end), 1)))[:, 0].tolist())
        arguments = none, nu, instance.parameters, instance.control_set.arguments, final_argument(instance)
        residual = ended(instance, grid.tf, end, *arguments)
        return running + terminal, residual[self.rows] / self.scale

    def motion(self, control: Array, grid: Grid) -> tuple[Array, float]:
        """Return the states at the nodes and the integral of the running cost for a given control."""
        instance = self.instance
        x, _, running = instance.model.forward(
            grid.nodes, instance.initial, control[:, ::2], control[:, 1::2], instance.parameters
        )
        return x, running


def simulations_of(solution: Solution) -> Simulations | None:
    """Return simulations with the fewest steps that reach the final state of a solution by its control, or ``None``."""
    instance, n = solution.instance, len(solution.x)
    size, _ = typical(solution)
    fixed = np.flatnonzero(fixed_states(instance))
    tied = n + np.arange(len(instance.model.spec.multipliers))
    for steps, limit in STEPS:
        found = Simulations(instance, np.append(fixed, tied), np.ones(1), steps, float(solution.times[-1]))
        grid = found.grid()
        own, _ = found.motion(stated_control(solution, grid), grid)
        if float((np.abs(own[:, -1] - solution.x[:, -1]) / size).max()) < limit:
            return found
    return None


def stated_control(solution: Solution, grid: Grid) -> Array:
    """Return the control of a solution at the nodes and midpoints of a grid, shape (m, 2 N + 1)."""
    times = interleave(grid.nodes, grid.midpoints)
    return np.array([np.interp(times, solution.times, row) for row in solution.u])
