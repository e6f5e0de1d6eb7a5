"""The distance of a matrix from matrices with multiple eigenvalues, or with eigenvalues on the imaginary axis.

Distances are relative changes of entries, all of them together (the root of the sum of their squares): a zero stays a
zero, and a matrix keeps its small eigenvalues however large others are. To first order a change E of A changes the
matrix M of A in its invariant subspace to some eigenvalues by L E X, where the columns of X span the subspace, the rows
of L the left one, and L X = 1. M has a single eigenvalue where the coefficients of the characteristic polynomial of M -
tr(M)/m vanish, except the leading one, and the distance is the smallest change that does this to first order; or where
M - tr(M)/m is nilpotent up to the effect of such a change on its entries. Differences that cancel are computed with
many digits; A itself counts as exact.

Source: T. Kato, Perturbation Theory for Linear Operators, chapter II (invariant subspaces and the mean of a group of
eigenvalues depend smoothly on the matrix, even where eigenvalues do not).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from satsym.analysis.linear.rational import nearest
from satsym.arrays import Array

if TYPE_CHECKING:
    from flint import acb, acb_mat

BITS = 320
"""Working precision, in bits, for all functions of this module."""
NOTHING = 2.0 ** (-BITS // 2)
"""Numbers smaller than this value, relative to the terms they consist of, are zero."""


@dataclass(frozen=True, eq=False)
class Group:
    """Some eigenvalues of a matrix A of shape (n, n), with their sensitivity to changes of A."""

    entries: Array
    """The change of each entry that counts as a relative change of 1; shape (n, n)."""
    values: Sequence[acb]
    """The m eigenvalues."""
    X: acb_mat
    L: acb_mat
    M: acb_mat
    """The matrices X, L and M, shapes (n, m), (m, n) and (m, m), with L X = 1 and M = L A X."""

    @cached_property
    def mean(self) -> acb:
        """Return the mean of the eigenvalues; exactly real, or on the imaginary axis, where they are."""
        return sum(self.values[1:], start=self.values[0]) / len(self.values)

    def off_axis(self) -> float:
        """Return the relative change that brings the real part of the mean to zero."""
        if abs(self.mean.real) <= abs(self.mean) * NOTHING:
            return 0.0
        slope, unit = _floats((self.X * self.L).transpose())
        size = float(np.linalg.norm(slope.real * self.entries)) * unit / len(self.values)
        return abs(float(self.mean.real)) / size if size else np.inf

    def single(self, change: float) -> bool:
        """Tell whether a relative change of this size can merge the eigenvalues into one.

        Where the merged one has several Jordan blocks, coefficients beyond the largest block say nothing to first
        order.
        """
        if self.apart <= change:
            return True
        added = self._weyr(change)
        return sum(added) == len(self.values) and added[0] > 1 and self._solved(len(added)) <= change

    def blocks(self, change: float) -> tuple[int, ...]:
        """Return the sizes of the Jordan blocks of the merged eigenvalue, neglecting relative changes of this size.

        They follow from by how much each power of M - s enlarges the null space (Weyr's characteristic).
        """
        added = self._weyr(change, known=True)
        return tuple(sum(count > i for count in added) for i in range(added[0]))

    def _weyr(self, change: float, known: bool = False) -> list[int]:
        """Return the Weyr characteristic: by how much each power of the shifted matrix enlarges the null space.

        It is found by deflation, without powers of the matrix (G. H. Golub and J. H. Wilkinson, SIAM Review 18, 1976).
        """
        rest, unit = self._in_units
        added: list[int] = []
        while len(rest):
            _, singular, right = np.linalg.svd(rest)
            rank = int((singular > change * unit).sum())
            if rank == len(rest):
                if not known:
                    break
                rank -= 1
            added.append(len(rest) - rank)
            kept = right[:rank]
            rest = kept @ rest @ kept.conj().T
        return added

    @cached_property
    def apart(self) -> float:
        """Return the smallest relative change that merges the eigenvalues into one, to first order."""
        return self._solved(len(self.values))

    def _solved(self, highest: int) -> float:
        """Return the relative change with which the characteristic polynomial agrees up to this coefficient."""
        rows, wanted = self._equations(highest)
        if not wanted.any():
            return 0.0
        change, *_ = np.linalg.lstsq(rows, wanted, rcond=1e-13)
        fits = np.abs(rows @ change - wanted).max() <= 1e-3 * np.abs(wanted).max()
        return float(np.linalg.norm(change)) if fits else np.inf

    @cached_property
    def _deviation(self) -> acb_mat:
        return self.M - _identity(len(self.values)) * (self.M.trace() / len(self.values))

    @cached_property
    def _in_units(self) -> tuple[Array, float]:
        """Return M - tr(M)/m and the sensitivity of its entries, in coordinates that make this sensitivity uniform."""
        from scipy.linalg import matrix_balance

        rest, left, right = (_floats(part) for part in (self._deviation, self.L, self.X))
        reached = np.abs(left[0]) @ np.abs(self.entries) @ np.abs(right[0]) * (left[1] * right[1])
        balanced, (scale, _) = matrix_balance(reached, permute=False, separate=True)
        each = float(np.abs(balanced).max()) / max(1.0, float(np.count_nonzero(self.entries))) ** 0.5
        return rest[0] * rest[1] * (scale / scale[:, None]), each

    def _equations(self, highest: int) -> tuple[Array, Array]:
        """Return linear equations for relative changes of the entries: rows of size 1, and right-hand sides."""
        m, one = len(self.values), _identity(len(self.values))
        power, rows, wanted = one, [], []
        used = self.entries.ravel() != 0.0
        size, around = _largest(self._deviation) * m, _largest(self.X) * _largest(self.L)
        for k in range(1, highest + 1):  # Faddeev and Le Verrier: coefficients, and their derivatives by entries
            product = self._deviation * power
            coefficient = -product.trace() / k
            if k > 1:
                inner = power - one * (power.trace() / m)
                slope, unit = _floats((self.X * inner * self.L).transpose())
                row = (-slope * self.entries).ravel()[used]
                length = float(np.linalg.norm(row))
                vanishes = abs(coefficient) <= NOTHING * size**k
                if unit > NOTHING * size ** (k - 1) * around and length > 0.0:
                    rows.append(row / length)
                    wanted.append(0.0 if vanishes else -nearest(coefficient / unit) / length)
                elif not vanishes:
                    return np.zeros((1, 1)), np.ones(1)  # no change does that
            power = product + one * coefficient
        found, right = np.array(rows).reshape(len(rows), int(used.sum())), np.array(wanted, dtype=complex)
        if self.mean.imag == 0:
            return found.real, right.real
        return np.vstack([found.real, found.imag]), np.hstack([right.real, right.imag])


def group(A: Array, entries: Array, inside: Sequence[acb], outside: Sequence[acb]) -> Group:
    """Prepare some eigenvalues of a matrix for estimates of distances.

    Parameters
    ----------
    A
        Shape (n, n).
    entries
        See :class:`Group`.
    inside, outside
        The eigenvalues of the group and all others, each as often as it occurs; both with more digits than
        floats have.
    """
    from flint import acb_mat

    n, m = len(A), len(inside)
    exact = acb_mat(n, n, A.ravel().tolist())
    X = _span(exact, outside, m)
    L = _span(exact.transpose(), outside, m).transpose()
    L = (L * X).mid().solve(L).mid()
    return Group(entries, [value.mid() for value in inside], X, L, (L * exact * X).mid())


def _span(A: acb_mat, outside: Sequence[acb], count: int) -> acb_mat:
    """Return orthonormal columns of the product of all A - s for the outside eigenvalues s.

    They span the invariant subspace of the other eigenvalues.
    """
    from flint import acb_mat, arb

    n = A.nrows()
    drawn = np.random.default_rng(0).integers(-1000, 1000, n * count).tolist()
    found = acb_mat(n, count, drawn)
    for value in outside:
        found = (A * found - found * value.mid()).mid()
        found = found * (1 / sum((abs(entry) for entry in found.entries()), arb(0)).mid())
    columns: list[acb_mat] = []
    for row in found.transpose().tolist():
        column = acb_mat(n, 1, row)
        for other in columns * 2:
            column = (column - other * (other.conjugate().transpose() * column)[0, 0]).mid()
        columns.append((column * (1 / _length(column))).mid())
    return acb_mat(n, count, [value for row in zip(*(c.entries() for c in columns), strict=True) for value in row])


def _length(column: acb_mat) -> Any:
    from flint import arb

    return sum((abs(entry) ** 2 for entry in column.entries()), arb(0)).sqrt().mid()


def _identity(size: int) -> acb_mat:
    from flint import acb_mat

    return acb_mat(size, size, [int(i == j) for i in range(size) for j in range(size)])


def _floats(matrix: acb_mat) -> tuple[Any, float]:
    """Return a matrix as floats of moderate size, and the factor that restores it."""
    unit = _largest(matrix) or 1.0
    values = np.array([complex(entry / unit) for entry in matrix.entries()])
    return values.reshape(matrix.nrows(), matrix.ncols()), unit


def _largest(matrix: acb_mat) -> float:
    return max((float(abs(entry).mid()) for entry in matrix.entries()), default=0.0)
