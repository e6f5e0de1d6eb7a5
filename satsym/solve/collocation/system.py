"""The collocation equations: residuals for all stages at once, and their exact linearisation, solved.

Stages are eliminated interval by interval, all intervals in one call; what remains couples neighbouring nodes
only and goes to LAPACK's band solver. Extra unknowns are bordered: one more right-hand side each.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.solve.collocation.curve import Curve, Step, stage_times
from satsym.solve.collocation.gauss import Scheme, scheme
from satsym.solve.collocation.problem import TwoPoint

Array = NDArray[np.floating[Any]]


@dataclass(frozen=True, eq=False)
class Residual:
    """By how much the equations of a curve fail.

    Attributes
    ----------
    stages
        Z - z_i - h A F(Z), shape (2n, N, s).
    ends
        z_{i+1} minus the end of the interval's polynomial, shape (2n, N).
    start, finish
        At the boundary, shapes (n,) and (n + e,).
    finish_by_end, finish_by_theta
        Derivatives of the latter.
    rates
        A F(Z), shape (2n, N, s): the change of the stages by the duration, apart from explicit time.
    """

    stages: Array
    ends: Array
    start: Array
    finish: Array
    finish_by_end: Array
    finish_by_theta: Array
    rates: Array


class System:
    """The collocation equations of a problem on a mesh."""

    def __init__(self, problem: TwoPoint, mesh: Array, order: int) -> None:
        self.problem, self.mesh, self.order = problem, mesh, order
        self.scheme: Scheme = scheme(order)
        self.widths: Array = np.diff(mesh)
        self.tau: Array = stage_times(mesh, order).ravel()
        self.intervals, self.rows = len(mesh) - 1, 2 * problem.states
        self._matrix = self.widths[:, None, None] * self.scheme.matrix

    def cost(self, curve: Curve) -> float:
        """The scaled cost J along a curve, under the control law of its stages."""
        problem, theta = self.problem, curve.theta
        running = problem.running_cost(self.tau, curve.flat, theta).reshape(self.intervals, self.order)
        integral = float((running @ self.scheme.weights) @ self.widths)
        return problem.elapsed(theta) * integral + problem.terminal_cost(curve.nodes[:, -1], theta)

    def residual(self, curve: Curve) -> Residual:
        """How far a curve is from a solution."""
        problem, theta = self.problem, curve.theta
        shape = (self.rows, self.intervals, self.order)
        rates = problem.rates(self.tau, curve.flat, theta).reshape(shape)
        grown = self.widths[:, None] * (rates @ self.scheme.matrix.T)
        differences = curve.stages - curve.nodes[:, :-1, None]
        finish, by_end, by_theta = problem.boundary(curve.nodes[:, -1], theta)
        return Residual(
            stages=differences - problem.elapsed(theta) * grown,
            ends=curve.nodes[:, 1:] - curve.nodes[:, :-1] - differences @ self.scheme.end,
            start=curve.nodes[: problem.states, 0] - problem.initial,
            finish=finish,
            finish_by_end=by_end,
            finish_by_theta=by_theta,
            rates=grown,
        )

    def infeasibility(self, residual: Residual) -> Array:
        """Summed violation of what multipliers are for, shape (n + constraints,).

        First the equations of motion with the given ends, state by state; then the terminal constraints.
        """
        n, problem = self.problem.states, self.problem
        by_stage = np.abs(residual.stages[:n] @ self.scheme.inverse.T) @ self.scheme.weights
        finish = np.abs(residual.finish)
        ends = np.abs(residual.ends[:n]).sum(axis=1) + np.abs(residual.start) + np.where(problem.fixed, finish[:n], 0.0)
        constraints = finish[n : n + problem.unknowns - problem.free_time]
        return np.concatenate([by_stage.sum(axis=1) + ends, constraints])

    def jacobian(self, curve: Curve) -> Array:
        """The rates by z at all stages, shape (2n, 2n, N s)."""
        return self.problem.jacobian(self.tau, curve.flat, curve.theta)

    def largest_turn(self, curve: Curve, jacobian: Array) -> float:
        """The largest angle that the fastest mode of the motion passes in one interval, in radians."""
        n = self.problem.states
        speed = np.abs(np.linalg.eigvals(jacobian[:n, :n].transpose(2, 0, 1))).max(axis=1)
        by_interval = speed.reshape(self.intervals, self.order).max(axis=1)
        return float((by_interval * self.widths).max()) * self.problem.elapsed(curve.theta)

    def linearised(self, curve: Curve, residual: Residual, jacobian: Array) -> Linearised:
        """Eliminate the stages and factor what remains.

        Raises
        ------
        numpy.linalg.LinAlgError
            If the equations are singular here.
        """
        n, s, count, e = self.rows, self.order, self.intervals, self.problem.unknowns
        elapsed = self.problem.elapsed(curve.theta)
        by_stage = jacobian.reshape(n, n, count, s).transpose(2, 0, 3, 1)
        matrix = ((-elapsed) * self._matrix[:, :, None, :, None] * by_stage[:, None]).reshape(count, s * n, s * n)
        diagonal = np.arange(s * n)
        matrix[:, diagonal, diagonal] += 1.0
        right = np.zeros((count, s * n, n + 1 + e))
        right[:, :, :n] = np.tile(np.eye(n), (s, 1))
        right[:, :, n] = _by_interval(residual)
        if self.problem.free_time:
            right[:, :, -1] = self._by_duration(curve, residual).transpose(1, 2, 0).reshape(count, -1)
        solved = np.linalg.solve(matrix, right)
        response = solved[:, :, :n]
        transition = np.einsum("j,ijab->iab", self.scheme.end, response.reshape(count, s, n, n))
        transition[:, np.arange(n), np.arange(n)] += 1.0 - self.scheme.end.sum()
        return Linearised(self, matrix, response, transition, residual, solved[:, :, n], solved[:, :, n + 1 :])

    def _by_duration(self, curve: Curve, residual: Residual) -> Array:
        """Minus the derivative of the stage residuals by the duration, shape (2n, N, s)."""
        drift = self.problem.drift(self.tau, curve.flat, curve.theta)
        if np.ndim(drift) == 0:
            return residual.rates
        explicit = (np.asarray(drift) * self.tau).reshape(residual.rates.shape) @ self.scheme.matrix.T
        return residual.rates + self.problem.elapsed(curve.theta) * self.widths[:, None] * explicit


class Linearised:
    """A factored linearisation, ready for right-hand sides.

    Attributes
    ----------
    transition
        Transition matrices of the intervals, shape (N, 2n, 2n).
    """

    def __init__(
        self,
        system: System,
        matrix: Array,
        response: Array,
        transition: Array,
        residual: Residual,
        local: Array,
        extra: Array,
    ) -> None:
        from scipy.linalg.lapack import dgbtrf

        self.system, self.transition = system, transition
        self._matrix, self._response = matrix, response
        self._residual, self._local_step = residual, local
        n, half = system.rows, system.problem.states
        self._by_end, self._by_theta = residual.finish_by_end, residual.finish_by_theta
        self._band = _band(half, system.intervals)
        kl, ku, row, column, first, first_column, last, last_column = self._band
        band = np.zeros((2 * kl + ku + 1, n * (system.intervals + 1)))
        band[row, column] = transition
        band[kl + ku + half - n, n:] = -1.0
        band[first, first_column] = np.eye(n)[:half]
        band[last, last_column] = self._by_end[:half]
        self._factors, self._pivots, info = dgbtrf(band, kl, ku)
        if info:
            raise np.linalg.LinAlgError("singular")
        zero = np.zeros((n, system.intervals))
        self._columns = [
            self._inner(extra[:, :, j], zero, np.zeros(half), self._by_theta[:half, j])
            for j in range(system.problem.unknowns)
        ]

    def step(self, residual: Residual) -> Step:
        """The Newton correction for a residual."""
        half = self.system.problem.states
        nodes, stages = self._inner(self._local(residual), residual.ends, residual.start, residual.finish[:half])
        if not self._columns:
            return Step(nodes, stages, np.zeros(0))
        lower, slopes = self._by_end[half:], self._by_theta[half:]
        reduced = slopes + np.stack([lower @ column[:, -1] for column, _ in self._columns], axis=1)
        theta = np.linalg.solve(reduced, -(residual.finish[half:] + lower @ nodes[:, -1]))
        for value, (node_column, stage_column) in zip(theta, self._columns, strict=True):
            nodes, stages = nodes + value * node_column, stages + value * stage_column
        return Step(nodes, stages, theta)

    def reduced(self) -> Array:
        """The last residuals by the extra unknowns, all else solved for, shape (e, e)."""
        half = self.system.problem.states
        lower, slopes = self._by_end[half:], self._by_theta[half:]
        return slopes + np.stack([lower @ column[:, -1] for column, _ in self._columns], axis=1)

    def defects(self, residual: Residual) -> Array:
        """Defects between neighbouring intervals once the stages fit, shape (N, 2n)."""
        count, s, n = self.system.intervals, self.system.order, self.system.rows
        local = self._local(residual).reshape(count, s, n)
        found: Array = np.einsum("j,ija->ia", self.system.scheme.end, local) - residual.ends.T
        return found

    def _local(self, residual: Residual) -> Array:
        """Corrections of the stages that keep the nodes, shape (N, s 2n); known already for the first residual."""
        if residual is self._residual:
            return self._local_step
        solved: Array = np.linalg.solve(self._matrix, _by_interval(residual)[:, :, None])[:, :, 0]
        return solved

    def _inner(self, local: Array, ends: Array, start: Array, finish: Array) -> tuple[Array, Array]:
        """Nodes and stages for corrections of the stages that keep the nodes."""
        from scipy.linalg.lapack import dgbtrs

        count, s, n = self.system.intervals, self.system.order, self.system.rows
        local = local.reshape(count, s, n)
        defects = np.einsum("j,ija->ia", self.system.scheme.end, local) - ends.T
        right = np.concatenate([-start, -defects.ravel(), -finish])
        nodes, _ = dgbtrs(self._factors, self._band[0], self._band[1], right, self._pivots)
        nodes = nodes.reshape(count + 1, n)
        stages = local + (self._response @ nodes[:-1, :, None]).reshape(count, s, n)
        return nodes.T, stages.transpose(2, 0, 1)


def _by_interval(residual: Residual) -> Array:
    """Minus the residuals of the stages, interval by interval, shape (N, s 2n)."""
    count = residual.stages.shape[1]
    found: Array = -residual.stages.transpose(1, 2, 0).reshape(count, -1)
    return found


@lru_cache
def _band(half: int, count: int) -> tuple[Any, ...]:
    """Widths of the band, and where transition matrices, initial and final rows lie in LAPACK's storage."""
    n = 2 * half
    a, b = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    kl, ku = half + n - 1, n - 1
    diagonal, interval = kl + ku, np.arange(count)[:, None, None]
    return (
        kl,
        ku,
        np.broadcast_to(diagonal + half + a - b, (count, n, n)).copy(),
        interval * n + b,
        diagonal + (a - b)[:half],
        b[:half],
        diagonal + half + (a - b)[: n - half],
        count * n + b[: n - half],
    )
