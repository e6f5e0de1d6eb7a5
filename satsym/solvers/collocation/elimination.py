"""The two linear systems of a collocation step: the stages of each interval, and the nodes between the intervals."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.lapack import lapack

AT_ONCE = 2
"""Times that the stages are solved for without keeping factors."""


class Blocks:
    """Square matrices of a stack, to be solved with.

    Parameters
    ----------
    matrices
        Shape (N, k, k).
    """

    def __init__(self, matrices: Array) -> None:
        self._matrices = matrices
        self._factors: list[tuple[Array, Array]] | None = None
        self._solved = 0

    def solve(self, right: Array) -> Array:
        """Solutions for right-hand sides, both of shape (N, columns, k): a column of the system is a row here.

        The first times they are solved for at once; after that factors are kept.

        Raises
        ------
        numpy.linalg.LinAlgError
            If a matrix is singular.
        """
        if self._solved < AT_ONCE:
            self._solved += 1
            solutions: Array = np.linalg.solve(self._matrices, right.swapaxes(1, 2)).swapaxes(1, 2)
            return solutions
        if self._factors is None:
            # LAPACK reads columns, so it is handed the transposes, without a copy.
            factored = [lapack().dgetrf(matrix.T, overwrite_a=True) for matrix in self._matrices]
            if any(info for _, _, info in factored):
                raise np.linalg.LinAlgError("singular")
            self._factors = [(factors, pivots) for factors, pivots, _ in factored]
        solutions = np.array(right)
        for (factors, pivots), columns in zip(self._factors, solutions, strict=True):
            lapack().dgetrs(factors, pivots, columns.T, trans=1, overwrite_b=True)
        return solutions


class Nodes:
    """The system that remains once the stages are eliminated: initial rows, transitions, final rows.

    Parameters
    ----------
    transition
        From each node to the next, shape (N, 2n, 2n).
    final
        Derivatives of the final residuals with respect to the last node, shape (n, 2n).

    Raises
    ------
    numpy.linalg.LinAlgError
        If the system is singular; when it is constructed.
    """

    def __init__(self, transition: Array, final: Array) -> None:
        count, n = transition.shape[:2]
        half = n // 2
        kl, ku, row, column, first, first_column, last, last_column, unity = _band(half, count)
        band = np.zeros((2 * kl + ku + 1, n * (count + 1)))
        band[row, column] = transition
        band[kl + ku + half - n, n:] = -1.0
        band[first, first_column] = unity
        band[last, last_column] = final
        self._band = (kl, ku)
        self._factors, self._pivots, info = lapack().dgbtrf(band, kl, ku)
        if info:
            raise np.linalg.LinAlgError("singular")

    def solve(self, right: Array) -> Array:
        """Nodes for right-hand sides, initial rows first, shape (2n (N+1), columns); in that shape."""
        return np.asarray(lapack().dgbtrs(self._factors, *self._band, right, self._pivots)[0])


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
        np.eye(n)[:half],
    )


class Matching:
    """Newton's linear system for the nodes: a given start, intervals that must meet, residuals at the end; factored.

    Extra unknowns, such as a free duration, are bordered: one more right-hand side each.

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
    mixed
        Whether the system without the extra unknowns is singular. The last residuals are then added to the others at
        the end, by which the whole stays equivalent.

    Raises
    ------
    numpy.linalg.LinAlgError
        If the system is singular.
    """

    def __init__(
        self,
        transition: Array,
        by_theta: Array,
        finish_by_end: Array,
        finish_by_theta: Array,
        mixed: bool = False,
    ) -> None:
        half = transition.shape[1] // 2
        self._mixing: Array | None = None
        if mixed:
            self._mixing = np.repeat(np.cos(np.arange(1.0, half + 1.0))[:, None], by_theta.shape[2], axis=1)
            finish_by_end, finish_by_theta = self._mixed(finish_by_end), self._mixed(finish_by_theta)
        self.transition, self._lower, self._slopes = transition, finish_by_end[half:], finish_by_theta[half:]
        self._between, extra = Nodes(transition, finish_by_end[:half]), by_theta.shape[2]
        self._columns: Array | None = None
        if extra:
            between = by_theta.reshape(-1, extra)
            right = np.concatenate([np.zeros((half, extra)), between, finish_by_theta[:half]])
            self._columns = self._between.solve(-right)

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
        finish = finish if self._mixing is None else self._mixed(finish)
        nodes = self._between.solve(-np.concatenate([start, defects.ravel(), finish[:half]])[:, None])[:, 0]
        if self._columns is None:
            return nodes.reshape(-1, 2 * half), np.zeros(0)
        theta = np.linalg.solve(self.reduced(), -(finish[half:] + self._lower @ nodes[-2 * half :]))
        return (nodes + self._columns @ theta).reshape(-1, 2 * half), theta

    def _mixed(self, finish: Array) -> Array:
        """Rows at the end with the last ones added to the others."""
        assert self._mixing is not None
        half = len(self._mixing)
        return np.concatenate([finish[:half] + self._mixing @ finish[half:], finish[half:]])

    def reduced(self) -> Array:
        """The last residuals by the extra unknowns, all else solved for, shape (e, e)."""
        if self._columns is None:
            return self._slopes
        return np.asarray(self._slopes + self._lower @ self._columns[-self.transition.shape[1] :])
