"""The linearised and factored collocation equations: corrections of nodes, stages and extra unknowns.

When the stages are eliminated, the remaining system couples neighbouring nodes only.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from satsym.arrays import Array
from satsym.solvers.collocation.curve import Curve, Step
from satsym.solvers.collocation.elimination import Blocks, Matching
from satsym.solvers.collocation.system import Residual, System


class Linearised:
    """A factored linearisation of the collocation equations, for several right-hand sides.

    Attributes
    ----------
    matching
        The remaining system of the nodes and the extra unknowns.
    """

    def __init__(
        self,
        system: System,
        blocks: Blocks,
        matching: Matching,
        response: Array,
        extra: Array,
        residual: Residual,
        local: Array,
    ) -> None:
        self.system, self.matching, self._blocks, self._response = system, matching, blocks, response
        self._extra, self._residual, self._local_step = extra, residual, local

    def step(self, residual: Residual) -> Step:
        """Return the Newton correction for a residual."""
        local = self._local(residual)
        defects = self.system.scheme.end @ local
        for k, one in self._residual.saltations.items():
            defects[k] = one.matrix @ defects[k]
        defects -= residual.ends.T
        nodes, theta = self.matching.correction(defects, residual.start, residual.finish)
        stages = local + self.spread(nodes, theta, None)
        return Step(nodes.T, stages.transpose(2, 0, 1), theta)

    def spread(self, nodes: Array, theta: Array, onto: Array | None) -> Array:
        """Return the corrections between the nodes that follow from corrections of the nodes and the extra unknowns.

        Parameters
        ----------
        nodes, theta
            Corrections as returned by :meth:`Matching.correction`.
        onto
            Interpolation from the beginning and the stages of an interval to other points; ``None`` means the stages.

        Returns
        -------
        array of shape (N, points, 2n)
        """
        count, s, n = self.system.intervals, self.system.order, self.system.rows
        inner = (nodes[:-1, None] @ self._response).reshape(count, s, n)
        for k, value in enumerate(theta):
            inner += value * self._extra[:, k]
        if onto is None:
            return inner
        return onto[:, 1:] @ inner + onto[:, :1] * nodes[:-1, None]

    def fundamental(self, onto: Array) -> Array:
        """Return derivatives of values between the nodes by the beginning of their interval, (N, points, 2n, 2n)."""
        count, s, n = self.system.intervals, self.system.order, self.system.rows
        inner = self._response.reshape(count, n, s, n)
        found: Array = np.einsum("kj,ibja->ikab", onto[:, 1:], inner)
        found += onto[:, 0, None, None] * np.eye(n)
        return found

    def _local(self, residual: Residual) -> Array:
        """Return corrections of the stages for fixed nodes, shape (N, s, 2n); cached for the first residual."""
        shape = (self.system.intervals, self.system.order, self.system.rows)
        if residual is self._residual:
            return self._local_step.reshape(shape)
        return self._blocks.solve(residual.by_interval[:, None]).reshape(shape)


def linearise(
    system: System, curve: Curve, residual: Residual, jacobian: Array, at_end: Array | None = None
) -> Linearised:
    """Eliminate the stages of all intervals in one call, and factor the remaining system.

    Parameters
    ----------
    at_end
        Derivatives of the final residuals by the final values, if they differ from those of the problem.

    Raises
    ------
    numpy.linalg.LinAlgError
        If the equations are singular at the curve.
    """
    n, s, count, e = system.rows, system.order, system.intervals, system.problem.unknowns
    by_stage = jacobian.reshape(n, n, count, s).transpose(2, 0, 3, 1).reshape(count, 1, n, s * n)
    grown = (-system.problem.elapsed(curve.theta)) * system.matrix
    matrix = (grown[:, :, None] * by_stage).reshape(count, s * n, s * n)
    matrix.reshape(count, -1)[:, :: s * n + 1] += 1.0
    blocks = Blocks(matrix)
    right = _by_nodes(count, s, n, e).copy()
    right[:, n] = residual.by_interval
    if system.problem.free_time:
        right[:, -1] = _by_duration(system, curve, residual).transpose(1, 2, 0).reshape(count, -1)
    solved = blocks.solve(right)
    response = solved[:, :n]
    transition = np.ascontiguousarray((system.scheme.end @ response.reshape(count, n, s, n)).swapaxes(1, 2))
    transition.reshape(count, -1)[:, :: n + 1] += 1.0 - system.scheme.end.sum()
    extra = solved[:, n + 1 :].reshape(count, e, s, n)
    by_theta = (system.scheme.end @ extra).swapaxes(1, 2) if e else extra.reshape(count, n, 0)
    for k, one in residual.saltations.items():
        transition[k], by_theta[k] = one.matrix @ transition[k], one.matrix @ by_theta[k]
        if system.problem.free_time:
            by_theta[k, :, -1] += one.leap * (one.drift * system.mesh[k + 1] / one.speed)
    ends = system.problem.boundary_slopes(curve.nodes[:, -1], curve.theta)
    by_end = ends[0] if at_end is None else at_end
    matching = Matching(transition, by_theta, by_end, ends[1], mixed=system.problem.homogeneous)
    return Linearised(system, blocks, matching, response, extra, residual, solved[:, n])


@lru_cache
def _by_nodes(count: int, stages: int, n: int, extra: int) -> Array:
    """Return right-hand sides that give derivatives of the stages by their interval's beginning; the rest is zero."""
    right = np.zeros((count, n + 1 + extra, stages, n))
    right[:, np.arange(n), :, np.arange(n)] = 1.0
    return right.reshape(count, n + 1 + extra, stages * n)


def _by_duration(system: System, curve: Curve, residual: Residual) -> Array:
    """Return the negative derivative of the stage residuals with respect to the duration, shape (2n, N, s)."""
    drift = system.problem.drift(system.tau, curve.flat, curve.theta)
    if np.ndim(drift) == 0:
        return residual.rates
    explicit = (np.asarray(drift) * system.tau).reshape(residual.rates.shape) @ system.scheme.matrix.T
    return residual.rates + system.problem.elapsed(curve.theta) * system.widths[:, None] * explicit
