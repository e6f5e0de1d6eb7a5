"""Simulations of an instance beside a solution, with as few steps as tell what is compared."""

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
"""RK4 steps with which neighbours are compared, on as many as the solution itself, and the relative distance from the
solution's end within which these follow it; the fewest that do."""


@dataclass(frozen=True, eq=False)
class Simulations:
    """Simulations of one instance with as many steps."""

    instance: Instance
    """What is simulated."""
    rows: NDArray[np.intp]
    """Indices of the boundary residuals that tie the final state."""
    scale: Array
    """Sizes of these."""
    steps: int
    """How many steps each simulation takes."""
    end: float
    """The final time."""

    def grid(self, longer: float = 0.0) -> Grid:
        """The grid of a motion to a final time that much later."""
        return Grid.uniform(self.instance.t0, self.end + longer, self.steps)

    def __call__(self, control: Array, grid: Grid) -> tuple[float, Array]:
        """The cost of a control at nodes and midpoints, shape (m, 2 N + 1), and what ties the end, in sizes."""
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
        """States at the nodes and the integral of the running cost."""
        instance = self.instance
        x, _, running = instance.model.forward(
            grid.nodes, instance.initial, control[:, ::2], control[:, 1::2], instance.parameters
        )
        return x, running


def simulations_of(solution: Solution) -> Simulations | None:
    """Simulations with the fewest steps with which the solution's own control leads to its end."""
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
    """The control of a solution at nodes and midpoints, shape (m, 2 N + 1)."""
    times = interleave(grid.nodes, grid.midpoints)
    return np.array([np.interp(times, solution.times, row) for row in solution.u])
