"""Competitors close by: the control changed where the second variation gains most, corrected until the end is met."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.grid import Grid, interleave
from satsym.instance import Instance
from satsym.solution import Check, Competitors, Kind, Solution
from satsym.solvers.certificate.accessory import Along, accessory
from satsym.solvers.certificate.comparison import COST_MARGIN, HIDDEN, hidden, margin
from satsym.solvers.certificate.end_form import fixed_states
from satsym.solvers.certificate.reintegration.flow import idle_end, products, typical
from satsym.solvers.collocation.problem import ended
from satsym.solvers.collocation.scaling import final_argument
from satsym.solvers.control.regularised import sloping

STEPS = ((200, 1e-3), (800, 1e-3), (3200, 1e-2))
"""RK4 steps with which neighbours are compared, on as many as the solution itself, and the relative distance from the
solution's end within which these follow it; the fewest that do."""

AMPLITUDES = (0.05, 0.01)
"""Of departures from the control to both sides, relative to the largest control, and of the final time's change."""

SADDLE = 1e-4
"""Curvature below zero by more than this is no error of the grid's."""

CORRECTIONS = 12
MISSED = 1e-9
"""Miss of the end up to which a neighbour counts as feasible, relative to its size and to how far the control moves it.
"""


@dataclass(frozen=True, eq=False)
class Neighbours:
    """What neighbours came to."""

    margin: float
    """Excess of the cheapest pair of opposite ones in the mean, relative to the cost; infinite where none
    could be simulated."""
    curvature: float
    """The least of the second variation on short pieces of the control, in units of what the change of the control
    costs; infinite where the end leaves no choice, NaN where it could not be resolved."""
    competitors: Competitors
    """How many, and the cheapest."""

    @property
    def checks(self) -> list[Check]:
        """Each is a deficit that must not be positive."""
        found = []
        if math.isfinite(self.curvature):
            found.append(Check("second variation on pieces of the control", float(self.curvature < -SADDLE), 0.0))
        if math.isfinite(self.margin):
            found.append(Check(f"cheaper by: {Kind.NEIGHBOURS.value}", max(0.0, -self.margin), COST_MARGIN))
        return found


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
    """Of each simulation."""
    end: float
    """The final time."""
    own: tuple[Array, float] = (np.zeros((0, 0)), 0.0)
    """States at the nodes and the integral of the running cost under the solution's own control."""
    missed: float = 0.0
    """Relative distance of the end to which that leads from the solution's."""

    def grid(self, longer: float = 0.0) -> Grid:
        """To a final time that much later."""
        return Grid.uniform(self.instance.t0, self.end + longer, self.steps)

    def __call__(self, control: Array, grid: Grid) -> tuple[float, Array]:
        """The cost of a control at nodes and midpoints, shape (m, 2 N + 1), and what ties the end, in sizes."""
        return self.measured(*self.motion(control, grid), grid)

    def measured(self, x: Array, running: float, grid: Grid) -> tuple[float, Array]:
        """The same of a motion."""
        instance, end = self.instance, tuple(x[:, -1].tolist())
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


def neighbours(solution: Solution) -> Neighbours:
    """The cheapest neighbour in the direction in which the second variation is least."""
    nothing = Neighbours(float("inf"), float("nan"), Competitors(Kind.NEIGHBOURS, 2 * len(AMPLITUDES), 0, float("nan")))
    simulations = simulations_of(solution)
    if simulations is None:
        return nothing
    grid = simulations.grid()
    second = accessory(solution, grid)
    if second is None:
        return nothing
    curvature, direction = second.smallest
    if not np.isfinite(curvature):
        return Neighbours(float("inf"), curvature, Competitors(Kind.NEIGHBOURS, 0, 0, float("nan")))
    simulations, u = replace(simulations, scale=second.sizes), stated_control(solution, grid)
    reference = simulations.measured(*simulations.own, grid)
    idle = simulations.measured(idle_end(solution, simulations.steps)[:, None], 0.0, grid)
    moved = float(np.abs(reference[1] - idle[1]).max(initial=0.0))
    missed = MISSED * min(1.0, max(moved, HIDDEN / MISSED))
    # Corrections of least size combine what ties the end.
    basis = np.linalg.qr(np.column_stack([direction, second.ties.T]))[0]
    along, direction = second.along(basis), basis.T @ direction
    size = _size(along, direction, float(np.abs(u).max()) or 1.0)
    if not size > 0.0:  # every control is saturated throughout
        return Neighbours(float("inf"), float("inf"), Competitors(Kind.NEIGHBOURS, 0, 0, float("nan")))
    unit = direction / size
    search = _Search(simulations, along, solution, reference[1], missed)
    # The grid's own end may make one side cheaper: that is of first order, and cancels in the mean of both.
    means, turned, before = list[float](), np.zeros((2, len(unit))), math.inf
    for a in AMPLITUDES:
        # of what corrections add, the part that is the same to both sides goes with the square of the amplitude
        share, (one, two) = a / before, turned / 2.0
        same, other = share**2 * (one + two), share * (one - two)
        both = [search.corrected(side * a * unit, same + side * other) for side in (1.0, -1.0)]
        means.append((both[0][0] + both[1][0]) / 2.0)
        turned, before = np.array([added for _, added in both]), a
    solved = [cost for cost in means if np.isfinite(cost)]
    cheapest = min(solved, default=float("inf"))
    stated = solution.objective + (cheapest - reference[0])  # without what simulating makes of both
    # To another end than the solution's, its control is not the best, by the square of the distance.
    own = max(hidden(solution), simulations.missed**2 * max(products(solution), abs(reference[0])))
    own = max(own, abs(reference[0] - solution.objective))  # nor does a grid tell less than it is off itself
    return Neighbours(
        margin(cheapest, reference[0], hidden=own),
        curvature,
        Competitors(Kind.NEIGHBOURS, 2 * len(means), 2 * len(solved), stated if solved else float("nan")),
    )


def _size(second: Along, direction: Array, largest: float) -> float:
    """Of a direction: of the change of the control, or of the final time, relative to their own."""
    lasting = float(np.abs(second.duration).max()) or 1.0
    longer = abs(float(second.duration @ direction)) / lasting
    return max(float(np.abs(second.controls @ direction).max()) / largest, longer)


@dataclass(frozen=True, eq=False)
class _Search:
    simulations: Simulations
    second: Along
    solution: Solution
    end: Array
    missed: float

    @cached_property
    def _own(self) -> tuple[Grid, Array, Array]:
        """The grid of the solution's own duration, its nodes with midpoints, and the solution's control there."""
        grid = self.simulations.grid()
        return grid, interleave(grid.nodes, grid.midpoints), stated_control(self.solution, grid)

    def corrected(self, change: Array, added: Array) -> tuple[float, Array]:
        """The cost of a neighbour once its end is as the solution's, and what that adds to the change.

        The former is infinite, and the latter zero, where it cannot be made so.

        Parameters
        ----------
        added
            Where to begin.
        """
        response, tried = self.second.ties, change[:0]
        for _ in range(CORRECTIONS):
            cost, reached = self._simulated(change + added)
            gap = reached - self.end
            miss = float(np.abs(gap).max(initial=0.0))
            if miss <= self.missed:
                return cost, added
            if not np.isfinite(miss):
                break
            if len(tried):  # Broyden: the response as the last correction found it
                response = response + np.outer(gap, tried) / float(tried @ tried)
                if not np.isfinite(response).all():
                    break
            tried = -np.linalg.lstsq(response, gap, rcond=None)[0]
            added = added + tried
        return float("inf"), np.zeros_like(change)

    def _simulated(self, change: Array) -> tuple[float, Array]:
        longer, (before, times, u) = float(self.second.duration @ change), self._own
        by = self.second.controls @ change
        if not longer:
            return self.simulations(self.simulations.instance.control_set.project(u + by), before)
        grid = self.simulations.grid(longer)
        at = interleave(grid.nodes, grid.midpoints)
        moved = np.array([np.interp(at, times, row) for row in by])
        control = self.simulations.instance.control_set.project(stated_control(self.solution, grid) + moved)
        return self.simulations(control, grid)


def simulations_of(solution: Solution) -> Simulations | None:
    """Simulations with the fewest steps with which the solution's own control leads to its end."""
    instance, n = solution.instance, len(solution.x)
    size, _ = typical(solution)
    fixed = np.flatnonzero(fixed_states(instance))
    tied = n + np.arange(len(instance.model.spec.multipliers))
    for steps, limit in STEPS:
        found = Simulations(instance, np.append(fixed, tied), np.ones(1), steps, float(solution.times[-1]))
        grid = found.grid()
        own = found.motion(stated_control(solution, grid), grid)
        missed = float((np.abs(own[0][:, -1] - solution.x[:, -1]) / size).max())
        if missed < limit:
            return replace(found, own=own, missed=missed)
    return None


def stated_control(solution: Solution, grid: Grid) -> Array:
    """The control of a solution at nodes and midpoints, shape (m, 2 N + 1)."""
    times = interleave(grid.nodes, grid.midpoints)
    return np.array([np.interp(times, solution.times, row) for row in solution.u])
