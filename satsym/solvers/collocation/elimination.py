"""The two linear systems of a collocation step: for the stages of each interval, and for the nodes of the mesh."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.lapack import lapack

AT_ONCE = 2
"""Number of times that the stages are solved for directly, before factors are kept."""


class Blocks:
    """Stack of square matrices with which linear systems are solved.

    Parameters
    ----------
    matrices
        Stack of matrices, shape (N, k, k).
    """

    def __init__(self, matrices: Array) -> None:
        self._matrices = matrices
        self._factors: list[tuple[Array, Array]] | None = None
        self._solved = 0

    def solve(self, right: Array) -> Array:
        """Return solutions for right-hand sides, both of shape (N, columns, k): columns of the system are rows here.

        The first calls solve directly; later calls keep the factors of the matrices.

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
    """The linear system that remains when the stages are eliminated: initial rows, transitions, final rows.

    Parameters
    ----------
    transition
        Transition matrices from each node to the next, shape (N, 2n, 2n).
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
        """Return node values for right-hand sides, initial rows first, both of shape (2n (N+1), columns)."""
        return np.asarray(lapack().dgbtrs(self._factors, *self._band, right, self._pivots)[0])


@lru_cache
def _band(half: int, count: int) -> tuple[Any, ...]:
    """Return the widths of the band, and the positions of all matrix entries in LAPACK's storage."""
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
    """Factored linear system of Newton's method for the nodes: initial values, continuity, and final residuals.

    Extra unknowns, such as a free duration, are treated by bordering, with one more right-hand side each.

    Attributes
    ----------
    transition
        Transition matrices of the intervals.

    Parameters
    ----------
    transition
        Derivatives of the ends of the N intervals with respect to their beginnings, shape (N, 2n, 2n).
    by_theta
        Derivatives of the ends of the intervals with respect to the extra unknowns, shape (N, 2n, e).
    finish_by_end, finish_by_theta
        Derivatives of the final residuals with respect to the final values and the extra unknowns, shapes (n + e, 2n)
        and (n + e, e).
    mixed
        Whether the system without the extra unknowns is singular. The last residuals are then added to the other final
        residuals, which gives an equivalent system.

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
        """Return corrections of the nodes, shape (N+1, 2n), and of the extra unknowns, shape (e,).

        Parameters
        ----------
        defects
            End of each interval minus the beginning of the next one, shape (N, 2n).
        start, finish
            Residuals at both boundaries, shapes (n,) and (n + e,).
        """
        half = len(start)
        finish = finish if self._mixing is None else self._mixed(finish)
        nodes = self._between.solve(-np.concatenate([start, defects.ravel(), finish[:half]])[:, None])[:, 0]
        if self._columns is None:
            return nodes.reshape(-1, 2 * half), np.zeros(0)
        theta = np.linalg.solve(self.reduced(), -(finish[half:] + self._lower @ nodes[-2 * half :]))
        return (nodes + self._columns @ theta).reshape(-1, 2 * half), theta

    def _mixed(self, finish: Array) -> Array:
        """Return the final rows with the last ones added to the others."""
        assert self._mixing is not None
        half = len(self._mixing)
        return np.concatenate([finish[:half] + self._mixing @ finish[half:], finish[half:]])

    def reduced(self) -> Array:
        """Return derivatives of the last residuals by the extra unknowns with all others eliminated, shape (e, e)."""
        if self._columns is None:
            return self._slopes
        return np.asarray(self._slopes + self._lower @ self._columns[-self.transition.shape[1] :])
