"""The Routh array of a polynomial with numbers for coefficients, special cases included.

A row of zeros tells that the row above it, as a polynomial, has its roots in pairs s, -s; its derivative takes the
place of the row. A row that merely begins with k zeros is added to itself shifted left by k places, with the sign
(-1)^k. With both, changes of sign in the first column count the roots with positive real parts in every case,
which a small number in the place of a zero does not.

Source: M. Benidir and B. Picinbono, Extended table for eliminating the singularities in Routh's array,
IEEE Transactions on Automatic Control 35 (1990).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from numbers import Rational
from typing import Any, TypeAlias

from satsym.status import BadInput

ZERO_ELEMENT, ZERO_ROW = "zero in the first column", "row of zeros"
CANCELLED = 1e-10
"""A difference of floats is zero if it is smaller than this, relative to what was subtracted from one another."""

Row: TypeAlias = tuple[Any, ...]


@dataclass(frozen=True)
class Routh:
    """A Routh array.

    Attributes
    ----------
    rows
        One for each power of s from the highest down, all of the same length; after what special cases ask for.
    special_cases
        What was met, in order: ``"zero in the first column"``, ``"row of zeros"``.
    sign_changes
        Along the first column: the number of roots with positive real parts.
    on_axis
        Number of roots on the imaginary axis, counted with multiplicity.
    """

    rows: tuple[Row, ...]
    special_cases: tuple[str, ...]
    sign_changes: int
    on_axis: int

    @property
    def column(self) -> Row:
        """The first column."""
        return tuple(row[0] for row in self.rows)

    @property
    def special_case(self) -> str | None:
        """The special cases in words, each once; ``None`` where there is none."""
        return " and ".join(dict.fromkeys(self.special_cases)) or None


def routh(coefficients: Sequence[Any]) -> Routh:
    """The Routh array of a polynomial.

    Parameters
    ----------
    coefficients
        Highest power first, the first one not zero. Whole numbers and fractions are reckoned with exactly.

    Raises
    ------
    BadInput
        If the leading coefficient is zero or there is none.
    """
    if not len(coefficients) or not coefficients[0]:
        raise BadInput("a polynomial must have a leading coefficient other than 0; leave out higher powers")
    exact = all(isinstance(value, Rational) for value in coefficients)
    given = [Fraction(value) if exact else float(value) for value in coefficients]
    degree, limit = len(given) - 1, 0.0 if exact else CANCELLED
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
    """The row that follows from two; what cancels but for rounding is zero."""
    ratio = above[0] / row[0]
    found = []
    for upper, lower in zip(above[1:], row[1:], strict=True):
        difference = upper - ratio * lower
        size = abs(upper) + abs(ratio * lower)
        found.append(difference if abs(difference) > limit * size else size * 0)
    return (*found, abs(above[0]) * 0)
