"""The linearised collocation equations, factored: corrections of nodes, extra unknowns and all between the nodes.

With the stages eliminated, what remains couples neighbouring nodes only. Extra unknowns are bordered: one more
right-hand side each.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from satsym.solve.collocation.curve import Step
from satsym.solve.collocation.elimination import Blocks, Nodes

if TYPE_CHECKING:
    from satsym.solve.collocation.system import Residual, System

Array = NDArray[np.floating[Any]]


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
        blocks: Blocks,
        response: Array,
        transition: Array,
        residual: Residual,
        local: Array,
        extra: Array,
    ) -> None:
        self.system, self.transition = system, transition
        self._blocks, self._response = blocks, response
        self._residual, self._local_step = residual, local
        n, half = system.rows, system.problem.states
        self._by_end, self._by_theta = residual.finish_by_end, residual.finish_by_theta
        self._between = Nodes(transition, self._by_end[:half])
        self._extra = extra.reshape(system.intervals, -1, system.order, n)
        self._columns = [
            self._nodes(self._defects(self._extra[:, j]), np.zeros(half), self._by_theta[:half, j])
            for j in range(system.problem.unknowns)
        ]

    def step(self, residual: Residual) -> Step:
        """The Newton correction for a residual."""
        local = self._local(residual)
        nodes, theta = self.correction(self._defects(local) - residual.ends.T, residual.start, residual.finish)
        stages = local + self.spread(nodes, theta, None)
        return Step(nodes.T, stages.transpose(2, 0, 1), theta)

    def correction(self, defects: Array, start: Array, finish: Array) -> tuple[Array, Array]:
        """Corrections of the nodes, shape (N+1, 2n), and of the extra unknowns, for what is wrong between them.

        Parameters
        ----------
        defects
            Where each interval would end, less where the next one begins, shape (N, 2n).
        start, finish
            Residuals at the boundary, shapes (n,) and (n + e,).
        """
        half = self.system.problem.states
        nodes = self._nodes(defects, start, finish[:half])
        if not self._columns:
            return nodes, np.zeros(0)
        theta = np.linalg.solve(self.reduced(), -(finish[half:] + self._by_end[half:] @ nodes[-1]))
        for value, column in zip(theta, self._columns, strict=True):
            nodes = nodes + value * column
        return nodes, theta

    def spread(self, nodes: Array, theta: Array, onto: Array | None) -> Array:
        """What corrections of the nodes and the extra unknowns do between the nodes.

        Parameters
        ----------
        nodes, theta
            As from :meth:`correction`.
        onto
            Interpolation from the start and the stages of an interval to other points; ``None``: the stages.

        Returns
        -------
        array of shape (N, points, 2n)
        """
        count, s, n = self.system.intervals, self.system.order, self.system.rows
        inner = (nodes[:-1, None] @ self._response).reshape(count, s, n)
        for value, extra in zip(theta, self._extra.transpose(1, 0, 2, 3), strict=True):
            inner = inner + value * extra
        if onto is None:
            return inner
        return onto[:, 1:] @ inner + onto[:, :1] * nodes[:-1, None]

    def fundamental(self, onto: Array) -> Array:
        """How values between the nodes follow the start of their interval, shape (N, points, 2n, 2n)."""
        count, s, n = self.system.intervals, self.system.order, self.system.rows
        inner = self._response.reshape(count, n, s, n)
        found: Array = np.einsum("kj,ibja->ikab", onto[:, 1:], inner)
        found += onto[:, 0, None, None] * np.eye(n)
        return found

    def reduced(self) -> Array:
        """The last residuals by the extra unknowns, all else solved for, shape (e, e)."""
        half = self.system.problem.states
        lower, slopes = self._by_end[half:], self._by_theta[half:]
        return slopes + np.stack([lower @ column[-1] for column in self._columns], axis=1)

    def _local(self, residual: Residual) -> Array:
        """Corrections of the stages that keep the nodes, shape (N, s, 2n); known already for the first residual."""
        shape = (self.system.intervals, self.system.order, self.system.rows)
        if residual is self._residual:
            return self._local_step.reshape(shape)
        return self._blocks.solve(residual.by_interval[:, None]).reshape(shape)

    def _defects(self, local: Array) -> Array:
        """What corrections of the stages do to the ends of the intervals, shape (N, 2n)."""
        found: Array = np.einsum("j,ija->ia", self.system.scheme.end, local)
        return found

    def _nodes(self, defects: Array, start: Array, finish: Array) -> Array:
        """Corrections of the nodes, shape (N+1, 2n)."""
        return self._between.solve(-start, -defects, -finish)
