"""Competitors close by: the control changed where the second variation gains most, corrected until the end is met."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from satsym.arrays import Array
from satsym.grid import Grid, interleave
from satsym.solution import Check, Competitors, Kind, Solution
from satsym.solvers.certificate.competitors.accessory import Along, accessory
from satsym.solvers.certificate.competitors.comparison import COST_MARGIN, HIDDEN, hidden, margin
from satsym.solvers.certificate.competitors.side_by_side import SideBySide
from satsym.solvers.certificate.competitors.simulations import Simulations, simulations_of, stated_control
from satsym.solvers.certificate.reintegration.flow import idle_end, products, typical

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
    means = search.together(unit, u) or search.one_by_one(unit)
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

    def together(self, unit: Array, control: Array) -> list[float] | None:
        """Mean costs of both sides for each amplitude, all side by side; ``None`` where these do not settle.

        Parameters
        ----------
        unit
            The departure of size one, shape (k,).
        control
            The solution's own at nodes and midpoints.
        """
        if self.second.duration.any():
            return None
        changes = np.outer(unit, [side * a for a in AMPLITUDES for side in (1.0, -1.0)])
        beside = SideBySide(self.simulations, self.second, control, typical(self.solution)[0])
        costs = beside.costs(changes, self.end, self.missed)
        return None if costs is None else [float(mean) for mean in costs.reshape(-1, 2).mean(axis=1)]

    def one_by_one(self, unit: Array) -> list[float]:
        """The same, each from what was found of the ones before; infinite where a side cannot be made to end there."""
        means, turned, before = list[float](), np.zeros((2, len(unit))), math.inf
        for a in AMPLITUDES:
            # of what corrections add, the part that is the same to both sides goes with the square of the amplitude
            share, (one, two) = a / before, turned / 2.0
            same, other = share**2 * (one + two), share * (one - two)
            both = [self.corrected(side * a * unit, same + side * other) for side in (1.0, -1.0)]
            means.append((both[0][0] + both[1][0]) / 2.0)
            turned, before = np.array([added for _, added in both]), a
        return means

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
