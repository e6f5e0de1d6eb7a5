"""Arcs of multiple shooting: integration of the canonical equations from each node to the next, with derivatives."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.shooting.runge_kutta import ORDER, advance

MOST_STEPS = 32
"""Largest number of integration steps in one arc; if more are needed, more arcs are used."""

FAINT_COSTATE = 1e-2
"""Scaled size below which changes of costates are no longer compared with the costates themselves.

In a return from a nearby initial state, costates are so small that rounding of the states is a larger fraction of them.
"""

ASYMPTOTIC = 1e-3
"""Error of an arc below which the error decreases with the number of steps according to the order of the method."""


@dataclass(frozen=True, eq=False)
class Arcs:
    """States and costates at the nodes of a mesh, from which the canonical equations are integrated."""

    problem: TwoPoint
    """The two-point problem."""
    mesh: Array
    """Nodes in [0, 1], shape (N+1,).

    Corners of the control must be among the nodes to keep the order; with compiled kernels only interpolation needs
    that.
    """
    nodes: Array
    """Values at the nodes, shape (2n, N+1)."""
    theta: Array
    """Extra unknowns, such as a free duration, shape (e,)."""
    steps: int = 1
    """Number S of integration steps in each arc."""

    @cached_property
    def widths(self) -> Array:
        """Lengths of the integration steps, shape (N,)."""
        found: Array = np.diff(self.mesh) / self.steps
        return found

    def moved(self, nodes: Array, theta: Array, length: float) -> Arcs:
        """Return the arcs after a fraction `length` of a correction of nodes, shape (N+1, 2n), and extra unknowns."""
        return type(self)(
            self.problem, self.mesh, self.nodes + length * nodes.T, self.theta + length * theta, self.steps
        )

    def with_steps(self, steps: int) -> Arcs:
        """Return the arcs with another number of steps."""
        return type(self)(self.problem, self.mesh, self.nodes, self.theta, steps)

    def size(self, nodes: Array, theta: Array) -> float:
        """Return the largest relative change of states (or their unit, if larger), costates and a free duration."""
        state, costate = np.abs(self.nodes).reshape(2, -1).max(axis=1).tolist()
        change = np.abs(nodes).max(axis=0).reshape(2, -1).max(axis=1)
        changes = change / (max(1.0, state), max(FAINT_COSTATE, costate))
        found = float(changes.max())  # no number where one is none
        return max(found, abs(float(theta[-1] / self.theta[-1]))) if self.problem.free_time else found

    @cached_property
    def course(self) -> tuple[Array, Array]:
        """Times and values at the beginnings of all steps and at the end, shapes (N S + 1,) and (2n, N S + 1)."""
        times, values = self._beginnings(), [self.nodes[:, :-1]]
        for tau in times[:-1]:
            values.append(advance(self._slope, tau, values[-1], self.widths))
        flat = np.stack(values, axis=2).reshape(len(self.nodes), -1)
        return np.append(np.stack(times, axis=1).ravel(), 1.0), np.append(flat, self.nodes[:, -1:], axis=1)

    def ends(self) -> Array:
        """Return the values at the ends of the arcs, shape (2n, N)."""
        if self._compiled:
            return self._flight(varied=False)[0].T / self.problem.scale.both
        values = self.nodes[:, :-1]
        for tau in self._beginnings():
            values = advance(self._slope, tau, values, self.widths)
        return values

    def variations(self) -> tuple[Array, Array]:
        """Return the ends of the arcs, shape (2n, N), and their transition matrices, shape (N, 2n, 2n).

        The transition matrices are integrated from the variational equations, with the same steps.
        """
        if self._compiled:
            ends, _, transition = self._flight(varied=True)
            return ends.T / self.problem.scale.both, transition * self.problem.scale.ratio[:, :, 0]
        rows = len(self.nodes)
        values = np.zeros((rows, 1 + rows, len(self.widths)))
        values[:, 0] = self.nodes[:, :-1]
        values[:, 1:] = np.eye(rows)[:, :, None]
        for tau in self._beginnings():
            values[:] = advance(self._varied_slope, tau, values, self.widths)
        return values[:, 0], values[:, 1:].transpose(2, 0, 1)

    def by_theta(self, ends: Array, transition: Array) -> Array:
        """Return the derivatives of the ends of arcs with respect to the extra unknowns, shape (N, 2n, e).

        Only a free duration has an effect, because it shifts the times.
        """
        problem, mesh, theta = self.problem, self.mesh, self.theta
        found = np.zeros((len(transition), len(self.nodes), problem.unknowns))
        if problem.free_time:
            begun = problem.rates(mesh[:-1], self.nodes[:, :-1], theta) * mesh[:-1]
            ended = problem.rates(mesh[1:], ends, theta) * mesh[1:]
            found[:, :, -1] = ended.T - (transition @ begun.T[:, :, None])[:, :, 0]
        return found

    def __call__(self, tau: Array) -> Array:
        """Return values at ``tau`` in [0, 1], shape (2n, M), by a shorter step within the step that contains tau."""
        times, values = self.course
        step = np.clip(np.searchsorted(times, tau, side="right") - 1, 0, len(times) - 2)
        return advance(self._slope, times[step], values[:, step], tau - times[step])

    def cost(self) -> float:
        """Return the scaled cost J, with its integral computed by the same method."""
        if self._compiled:
            return self._flight(varied=False)[1] / self.problem.scale.cost + self.terminal_cost
        problem, theta, elapsed = self.problem, self.theta, self.problem.elapsed(self.theta)
        times, values = self.course

        def slope(tau: Array, y: Array) -> Array:
            running = problem.running_cost(tau, y[:-1], theta)
            return np.append(self._slope(tau, y[:-1]), elapsed * running[None], axis=0)

        start = np.append(values[:, :-1], np.zeros((1, len(times) - 1)), axis=0)
        running = advance(slope, times[:-1], start, np.diff(times))[-1]
        return float(running.sum()) + self.terminal_cost

    @property
    def terminal_cost(self) -> float:
        """The scaled terminal cost S."""
        return self.problem.terminal_cost(self.nodes[:, -1], self.theta)

    @property
    def _compiled(self) -> bool:
        return self.problem.instance.model.backend == "numba"

    def _flight(self, varied: bool) -> Any:
        """Return ends, cost and, if `varied`, transition matrices from compiled functions, in the model's units."""
        from satsym.solvers.shooting.compiled import integrator

        problem, instance = self.problem, self.problem.instance
        times = instance.t0 + problem.elapsed(self.theta) * self.mesh
        nodes = np.ascontiguousarray((self.nodes * problem.scale.both).T)
        return integrator(instance.model, varied)(
            times, nodes, self.steps, instance.parameters, problem.control_set.arguments
        )

    def _slope(self, tau: Array, values: Array) -> Array:
        """Return derivatives with respect to tau, shape (2n, M)."""
        return self.problem.elapsed(self.theta) * self.problem.rates(tau, values, self.theta)

    def _varied_slope(self, tau: Array, values: Array) -> Array:
        """Return derivatives of states and costates and of their variations, shape (2n, 1 + 2n, N)."""
        elapsed, z = self.problem.elapsed(self.theta), values[:, 0]
        slopes = self.problem.jacobian(tau, z, self.theta).transpose(2, 0, 1)
        found = np.empty_like(values)
        found[:, 0] = self._slope(tau, z)
        found[:, 1:] = elapsed * (slopes @ values[:, 1:].transpose(2, 0, 1)).transpose(1, 2, 0)
        return found

    def _beginnings(self) -> list[Array]:
        """Return the beginnings of the first steps of all arcs, of the second steps, and so on."""
        return [self.mesh[:-1] + k * self.widths for k in range(self.steps)]


def sufficient(arcs: Arcs, tolerance: float) -> Arcs | None:
    """Return the arcs with the number of steps that a tolerance requires; ``None`` if that is too large.

    The error is estimated from two runs, one with half as many steps (Richardson), and extrapolated by the order of the
    method.
    """
    steps, coarse = 1, arcs.with_steps(1).ends()
    while 2 * steps <= MOST_STEPS:
        steps *= 2
        fine = arcs.with_steps(steps).ends()
        error = arcs.size((fine - coarse).T, np.zeros_like(arcs.theta)) / (2**ORDER - 1)
        if error < ASYMPTOTIC:
            needed = int(np.ceil(steps * (error / tolerance) ** (1.0 / ORDER)))
            return arcs.with_steps(max(needed, 1)) if needed <= MOST_STEPS else None
        coarse = fine
    return None
