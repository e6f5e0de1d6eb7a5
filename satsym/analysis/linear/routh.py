"""The Routh array of a polynomial with numeric coefficients, special cases included.

Where a row is zero, the row above it, as a polynomial, has its roots in pairs s, -s; its derivative replaces the row. A
row that begins with k zeros is added to itself shifted left by k places, with the sign (-1)^k. With both, changes of
sign in the first column count the roots with positive real parts in every case, which a small number in the place of a
zero does not. Source: M. Benidir and B. Picinbono, Extended table for eliminating the singularities in Routh's array,
IEEE Transactions on Automatic Control 35 (1990).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise
from numbers import Rational
from typing import Any, TypeAlias

from satsym.analysis.linear.spectrum import companion_matrix, spectrum
from satsym.status import BadInput

ZERO_ELEMENT, ZERO_ROW = "zero in the first column", "row of zeros"
CANCELLED = 1e-10
"""Largest difference of floats that is zero, relative to the numbers that are subtracted."""

Row: TypeAlias = tuple[Any, ...]


@dataclass(frozen=True)
class Routh:
    """The Routh array of a polynomial, with its special cases."""

    rows: tuple[Row, ...]
    """The rows, one for each power of s from the highest down, of equal length, after the rules for special cases."""
    special_cases: tuple[str, ...]
    """The special cases in order: ``"zero in the first column"``, ``"row of zeros"``."""
    sign_changes: int
    """Number of sign changes in the first column: the number of roots with positive real parts."""
    on_axis: int
    """Number of roots on the imaginary axis, counted with multiplicity."""

    @property
    def column(self) -> Row:
        """Return the first column of the Routh array."""
        return tuple(row[0] for row in self.rows)

    @property
    def rounded(self) -> Routh:
        """Return the array in floats."""
        return replace(self, rows=tuple(tuple(map(float, row)) for row in self.rows))

    @property
    def special_case(self) -> str | None:
        """Name the special cases that occurred, each once; ``None`` where there was none."""
        return " and ".join(dict.fromkeys(self.special_cases)) or None


def routh(coefficients: Sequence[Any], roots: Sequence[complex] | None = None) -> Routh:
    """Return the Routh array of a polynomial.

    Arithmetic with whole numbers and fractions is exact. For floats, the array never contradicts the roots: where
    rounding errors would make it do so, the exact array of the polynomial with these roots is returned.

    Parameters
    ----------
    coefficients
        Highest power first, the first one not zero.
    roots
        Roots of the polynomial, needed only where the coefficients are floats: each as often as it occurs, complex ones
        with their conjugates, and those that count as lying on the imaginary axis exactly there. By default the
        eigenvalues of the companion matrix.

    Raises
    ------
    BadInput
        If the leading coefficient is zero or there is none.
    """
    if not len(coefficients) or not coefficients[0]:
        raise BadInput("the leading coefficient of a polynomial must not be 0; leave out the leading zeros")
    if all(isinstance(value, Rational) for value in coefficients):
        return _array([Fraction(value) for value in coefficients], 0.0)
    given = [float(value) for value in coefficients]
    roots = _roots(given) if roots is None else roots
    right, on_axis = sum(root.real > 0.0 for root in roots), sum(root.real == 0.0 for root in roots)
    found = _array(given, CANCELLED)
    if (found.sign_changes, found.on_axis) == (right, on_axis):
        return found
    return _array(_with_roots(given[0], roots), 0.0).rounded


def _roots(coefficients: Sequence[float]) -> list[complex]:
    """Return the eigenvalues of the companion matrix, on the axis where rounding of the coefficients allows."""
    monic = [value / coefficients[0] for value in coefficients]
    if len(monic) == 1:
        return []
    return [each.value for each in spectrum(companion_matrix(monic)) for _ in range(each.algebraic)]


def _with_roots(leading: float, roots: Sequence[complex]) -> list[Fraction]:
    """Return the exact polynomial with these roots; complex ones are taken with their conjugates."""
    found = [Fraction(leading)]
    for root in roots:
        real, imaginary = Fraction(root.real), Fraction(root.imag)
        if imaginary < 0:
            continue
        factor = [Fraction(1), -real] if imaginary == 0 else [Fraction(1), -2 * real, real**2 + imaginary**2]
        longer = [Fraction(0)] * (len(found) + len(factor) - 1)
        for i, a in enumerate(found):
            for j, b in enumerate(factor):
                longer[i + j] += a * b
        found = longer
    return found


def _array(given: Sequence[Any], limit: float) -> Routh:
    """Compute the array by its rule; differences that cancel to a small fraction of their terms are zero."""
    degree = len(given) - 1
    width = degree // 2 + 1
    above, row = (_padded(given[start::2], width) for start in (0, 1))
    rows, met, symmetric = [above], [], None
    for power in range(degree - 1, -1, -1):
        if not any(row):
            met.append(ZERO_ROW)
            symmetric = power + 1 if symmetric is None else symmetric
            row = tuple((power + 1 - 2 * j) * value for j, value in enumerate(above))
        elif not row[0]:
            met.append(ZERO_ELEMENT)
            row = _shifted(row)
        rows.append(row)
        above, row = row, _next(above, row, limit)
    signs = [each[0] > 0 for each in rows]
    changes = [a != b for a, b in pairwise(signs)]
    # the polynomial at the first row of zeros has as many roots on the right as on the left, the others on the axis
    on_axis = 0 if symmetric is None else symmetric - 2 * sum(changes[degree - symmetric :])
    return Routh(tuple(rows), tuple(met), sum(changes), on_axis)


def _padded(values: Sequence[Any], width: int) -> Row:
    return (*values, *[type(values[0])(0) if values else 0.0] * (width - len(values)))


def _shifted(row: Row) -> Row:
    zeros = next(j for j, value in enumerate(row) if value)
    sign = -1 if zeros % 2 else 1
    return tuple(value + sign * (row[j + zeros] if j + zeros < len(row) else 0) for j, value in enumerate(row))


def _next(above: Row, row: Row, limit: float) -> Row:
    """Compute a row from the two above it; differences that cancel up to rounding are zero."""
    ratio = above[0] / row[0]
    found = []
    for upper, lower in zip(above[1:], row[1:], strict=True):
        difference = upper - ratio * lower
        size = abs(upper) + abs(ratio * lower)
        found.append(difference if abs(difference) > limit * size else size * 0)
    return (*found, abs(above[0]) * 0)
