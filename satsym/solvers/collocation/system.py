"""The collocation equations: residuals of all stages at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from satsym.arrays import Array
from satsym.solvers.collocation.curve import Curve, stage_times
from satsym.solvers.collocation.gauss import Scheme, scheme
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.control.jumps import Jump, Saltation


@dataclass(frozen=True, eq=False)
class Residual:
    """Residuals of the collocation equations of a curve."""

    stages: Array
    """Residuals of the stages, Z - z_i - h A F(Z), shape (2n, N, s)."""
    ends: Array
    """Residuals of continuity, z_{i+1} minus the end of the interval's polynomial, shape (2n, N)."""
    start: Array
    finish: Array
    """Residuals of the initial and final conditions, shapes (n,) and (n + e,)."""
    rates: Array
    """A F(Z), shape (2n, N, s): negative derivative of the stage residuals by the duration, without explicit time."""
    saltations: dict[int, Saltation] = field(default_factory=dict)
    """Saltations at jumps of the control law, by the index of the interval that ends there."""

    @property
    def by_interval(self) -> Array:
        """Return the negative residuals of the stages for each interval, shape (N, s 2n)."""
        found: Array = -self.stages.transpose(1, 2, 0).reshape(self.stages.shape[1], -1)
        return found


class System:
    """The collocation equations of a problem on a mesh, with jumps of the control law near some nodes."""

    def __init__(self, problem: TwoPoint, mesh: Array, order: int, jumps: Sequence[Jump] = ()) -> None:
        self.problem, self.mesh, self.order, self.jumps = problem, mesh, order, jumps
        self.scheme: Scheme = scheme(order)
        self.widths: Array = mesh[1:] - mesh[:-1]
        self.tau: Array = stage_times(mesh, order).ravel()
        self.intervals, self.rows = len(mesh) - 1, 2 * problem.states

    @cached_property
    def matrix(self) -> Array:
        """Return the scheme's matrix times each interval's length, entries repeated for all rows, (N, s, s 2n)."""
        found: Array = self.widths[:, None, None] * np.repeat(self.scheme.matrix, self.rows, axis=1)
        return found

    def cost(self, curve: Curve) -> float:
        """Return the scaled cost J along a curve, under the control law at its stages."""
        return self._summed(curve, self.problem.running_cost(self.tau, curve.flat, curve.theta))

    def _summed(self, curve: Curve, running: Array) -> float:
        """Return the cost of a curve from the running cost at its stages, shape (N s,)."""
        problem, theta = self.problem, curve.theta
        integral = float((running.reshape(self.intervals, self.order) @ self.scheme.weights) @ self.widths)
        return problem.elapsed(theta) * integral + problem.terminal_cost(curve.nodes[:, -1], theta)

    def residual(self, curve: Curve) -> Residual:
        """Return the residuals of the equations for a curve."""
        problem, theta = self.problem, curve.theta
        shape = (self.rows, self.intervals, self.order)
        rates = problem.rates(self.tau, curve.flat, theta).reshape(shape)
        grown = self.widths[:, None] * (rates @ self.scheme.matrix.T)
        differences = curve.stages - curve.nodes[:, :-1, None]
        ends = curve.nodes[:, :-1] + differences @ self.scheme.end
        saltations = self._saltations(ends, theta)
        for k, one in saltations.items():
            ends[:, k] += one.gap
        return Residual(
            stages=differences - problem.elapsed(theta) * grown,
            ends=curve.nodes[:, 1:] - ends,
            start=curve.nodes[: problem.states, 0] - problem.initial,
            finish=problem.boundary(curve.nodes[:, -1], theta),
            rates=grown,
            saltations=saltations,
        )

    def _saltations(self, ends: Array, theta: Array) -> dict[int, Saltation]:
        """Return the saltations at the jumps, by the interval that ends there; ``ends`` has shape (2n, N)."""
        found = {}
        for jump in self.jumps:
            k = int(np.abs(self.mesh[1:] - jump.time).argmin())
            found[k] = self.problem.saltation(float(self.mesh[k + 1]), ends[:, k], theta, jump)
        return {k: one for k, one in found.items() if np.isfinite(one.matrix).all()}

    def infeasibility(self, residual: Residual) -> Array:
        """Return the summed violation of the constraints that have multipliers, shape (n + constraints,).

        First the equations of motion and given ends, for each state; then the terminal constraints.
        """
        n, problem = self.problem.states, self.problem
        by_stage = np.abs(residual.stages[:n] @ self.scheme.inverse.T) @ self.scheme.weights
        finish = np.abs(residual.finish)
        ends = np.abs(residual.ends[:n]).sum(axis=1) + np.abs(residual.start) + np.where(problem.fixed, finish[:n], 0.0)
        constraints = finish[n : n + problem.unknowns - problem.free_time]
        return np.concatenate([by_stage.sum(axis=1) + ends, constraints])

    def jacobian(self, curve: Curve) -> Array:
        """Return the derivatives of the rates by z at all stages, shape (2n, 2n, N s)."""
        return self.problem.jacobian(self.tau, curve.flat, curve.theta)

    def largest_turn(self, curve: Curve, jacobian: Array) -> float:
        """Return the largest angle, in rad, by which the fastest mode of the motion turns in one interval."""
        n = self.problem.states
        at_middles = jacobian[:n, :n, self.order // 2 :: self.order]
        speed = np.abs(np.linalg.eigvals(at_middles.transpose(2, 0, 1))).max(axis=1)
        return float((speed * self.widths).max()) * self.problem.elapsed(curve.theta)


def costs(along: Sequence[tuple[System, Curve]]) -> list[float]:
    """Return the costs of several curves of one problem, evaluated together if the problem has no extra unknowns."""
    if not along or along[0][0].problem.unknowns:
        return [system.cost(curve) for system, curve in along]
    tau, z = (np.concatenate(rows, axis=-1) for rows in zip(*((s.tau, c.flat) for s, c in along), strict=True))
    running, found, begin = along[0][0].problem.running_cost(tau, z, along[0][1].theta), [], 0
    for system, curve in along:
        end = begin + len(system.tau)
        found.append(system._summed(curve, running[begin:end]))
        begin = end
    return found
