"""Newton's linear system for the nodes of a mesh: a given start, intervals that must meet, residuals at the end.

Extra unknowns, such as a free duration, are bordered: one more right-hand side each.
"""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.solvers.collocation.elimination import Nodes


class Matching:
    """The system, factored.

    Attributes
    ----------
    transition
        As it was given.

    Parameters
    ----------
    transition
        Ends of the N intervals by their starts, shape (N, 2n, 2n).
    by_theta
        Ends of the intervals by the extra unknowns, shape (N, 2n, e).
    finish_by_end, finish_by_theta
        Residuals at the end by the values there and by the extra unknowns, shapes (n + e, 2n) and (n + e, e).

    Raises
    ------
    numpy.linalg.LinAlgError
        If the system is singular.
    """

    def __init__(self, transition: Array, by_theta: Array, finish_by_end: Array, finish_by_theta: Array) -> None:
        half = transition.shape[1] // 2
        self.transition, self._lower, self._slopes = transition, finish_by_end[half:], finish_by_theta[half:]
        self._between, nothing = Nodes(transition, finish_by_end[:half]), np.zeros(half)
        self._columns = [
            self._between.solve(nothing, -by_theta[:, :, j], -finish_by_theta[:half, j])
            for j in range(by_theta.shape[2])
        ]

    def correction(self, defects: Array, start: Array, finish: Array) -> tuple[Array, Array]:
        """Corrections of the nodes, shape (N+1, 2n), and of the extra unknowns, shape (e,).

        Parameters
        ----------
        defects
            Where each interval ends, less where the next one begins, shape (N, 2n).
        start, finish
            Residuals at the boundary, shapes (n,) and (n + e,).
        """
        half = len(start)
        nodes = self._between.solve(-start, -defects, -finish[:half])
        if not self._columns:
            return nodes, np.zeros(0)
        theta = np.linalg.solve(self.reduced(), -(finish[half:] + self._lower @ nodes[-1]))
        for value, column in zip(theta, self._columns, strict=True):
            nodes = nodes + value * column
        return nodes, theta

    def reduced(self) -> Array:
        """The last residuals by the extra unknowns, all else solved for, shape (e, e)."""
        return self._slopes + np.stack([self._lower @ column[-1] for column in self._columns], axis=1)
