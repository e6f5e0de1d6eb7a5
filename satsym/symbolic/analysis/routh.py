"""The Routh array, exact: numbers or symbols, and a count of roots that is right in every special case.

An array meets two special cases. Where a whole row vanishes, the row above it is a polynomial d(s) whose roots lie
symmetrically to the imaginary axis; its derivative takes the place of the row. Where only the first element of a
row vanishes, a small positive number takes its place. Textbooks stop there, but the second remedy moves roots, and
so gives wrong counts where the first case is still to come. Here d is split off beforehand as the greatest common
divisor of the even and the odd part: the remedy is applied to the quotient, which has no roots on the axis that it
could move over it, and every row of its array is multiplied by d again. Without the first special case this is the
textbook's array.

Source: F. R. Gantmacher, The Theory of Matrices, volume 2, chapter XV, sections 3 and 4.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import sympy as sp

from satsym.symbolic.analysis.field import Field, exact, sign_of

ROOT = sp.Symbol("s")
ZERO_ELEMENT, ZERO_ROW = "zero in the first column", "row of zeros"


def small(k: int) -> sp.Symbol:
    """Return the symbol of the positive number that replaces the k-th vanishing element of a Routh array.

    It counts as smaller than any power of those before it.
    """
    return sp.Symbol(f"epsilon_{k}", positive=True)


@dataclass(frozen=True)
class RouthArray:
    """The Routh array of a polynomial, with the special cases that occurred."""

    rows: tuple[tuple[sp.Expr, ...], ...]
    """The rows of the array, one for each power of s, the highest first."""
    special_cases: tuple[str, ...]
    """The special cases in order of occurrence: :data:`ZERO_ELEMENT` and :data:`ZERO_ROW`."""
    auxiliary: tuple[tuple[sp.Expr, ...], ...]
    """The polynomials (coefficients, highest power first) whose derivatives replaced rows of zeros."""
    signs: tuple[int | None, ...]
    """Signs of the first column as the small numbers tend to zero; ``None`` if a sign depends on parameters."""
    right: int | None
    axis: int | None
    left: int | None
    """Numbers of roots with positive, zero and negative real parts, counted with multiplicity.

    ``None`` if a number depends on parameters.
    """

    @property
    def column(self) -> tuple[sp.Expr, ...]:
        """Return the first column of the Routh array."""
        return tuple(row[0] for row in self.rows)

    @property
    def sign_changes(self) -> int | None:
        """Count changes of sign down the first column: the number of roots with a positive real part."""
        return _changes(self.signs)

    @property
    def special_case(self) -> str | None:
        """Name the special cases that occurred, each once; ``None`` where there was none."""
        return " and ".join(dict.fromkeys(self.special_cases)) or None


def routh(coefficients: Sequence[Any]) -> RouthArray:
    """Return the Routh array of a polynomial.

    Parameters
    ----------
    coefficients
        Highest power first; numbers, or expressions in real symbols. The first must not vanish.

    Raises
    ------
    NotExact
        If they are not rational functions of parameters and of roots of positive ones.
    ValueError
        If the first one is zero, or there are none.
    """
    field, (row,) = exact(sp.Matrix([list(map(sp.sympify, coefficients))]))
    polynomial = field.polynomial(row.to_list()[0], ROOT)
    degree = len(coefficients) - 1
    if polynomial.degree() != degree:
        raise ValueError("a Routh array needs a polynomial whose first coefficient is not zero")
    array = _Array(field, degree)
    scale, symmetric = field.domain.one, 0
    while True:
        divisor = _symmetric_part(polynomial)
        last = array.extend(polynomial.exquo(divisor), divisor, scale)
        if divisor.degree() == 0:
            break
        symmetric = symmetric or divisor.degree()
        array.replace_row_of_zeros(divisor, last)
        scale, polynomial = last, divisor + divisor.diff(ROOT)
    rows = tuple(tuple(array.expressions(line, degree // 2 + 1)) for line in array.lines)
    signs = tuple(_limit_sign(row[0], array.small) for row in rows)
    right, right_symmetric = _changes(signs), _changes(signs[degree - symmetric :])
    axis = None if right_symmetric is None else symmetric - 2 * right_symmetric
    left = None if right is None or axis is None else degree - right - axis
    return RouthArray(rows, tuple(array.special_cases), tuple(array.auxiliary), signs, right, axis, left)


class _Array:
    """A Routh array under construction: rows of elements, each for every other power of s.

    The elements lie in the field of the coefficients, from the first small number on in its extension by those.
    """

    def __init__(self, field: Field, degree: int) -> None:
        self.field, self.domain = field, field.domain
        self.extension = field.domain.frac_field(*map(small, range(1, degree + 2)))
        self.small: list[sp.Symbol] = []
        self.lines: list[list[Any]] = []
        self.special_cases: list[str] = []
        self.auxiliary: list[tuple[sp.Expr, ...]] = []

    def extend(self, quotient: sp.Poly, divisor: sp.Poly, scale: Any) -> Any:
        """Append the rows for ``scale * quotient * divisor`` after the first row; return the last multiplier."""
        whole = quotient.rep.to_list()
        lines = [whole[k::2] for k in (0, 1)] if len(whole) > 1 else [whole]
        while len(lines) < len(whole):
            lines = self._with_small_number(lines)
            above, line = lines[-2:]
            padded = [*line, self.domain.zero]
            lines.append([(line[0] * above[k] - above[0] * padded[k]) / line[0] for k in range(1, len(above))])
        scale, factor = self._convert(scale), divisor.rep.to_list()[::2]
        shown = [[scale * e for e in self._product(line, factor)] for line in lines]
        self.lines += shown[bool(self.lines) :]
        return scale * lines[-1][0]

    def replace_row_of_zeros(self, divisor: sp.Poly, multiplier: Any) -> None:
        """Note that the derivative of ``multiplier * divisor`` takes the place of a row of zeros."""
        self.special_cases.append(ZERO_ROW)
        shown = self.expressions([multiplier * self._convert(c) for c in divisor.rep.to_list()])
        self.auxiliary.append(tuple(shown))

    def expressions(self, line: Sequence[Any], width: int = 0) -> list[sp.Expr]:
        """Return the elements of a row as expressions, padded with zeros to a width."""
        found = [self.field.shown(self.domain.to_sympy(self._convert(e))) for e in line]
        return found + [sp.Integer(0)] * (width - len(found))

    def _with_small_number(self, lines: list[list[Any]]) -> list[list[Any]]:
        """Return the rows, with a small number in place of a zero at the beginning of the last one."""
        if lines[-1][0]:
            return lines
        self.small.append(small(len(self.small) + 1))
        self.special_cases.append(ZERO_ELEMENT)
        self.domain = self.extension
        lines = [[self._convert(e) for e in line] for line in lines]
        lines[-1][0] = self.domain.from_sympy(self.small[-1])
        return lines

    def _product(self, line: Sequence[Any], factor: Sequence[Any]) -> list[Any]:
        found = [self.domain.zero] * (len(line) + len(factor) - 1)
        for i, a in enumerate(line):
            for j, b in enumerate(factor):
                found[i + j] += a * self._convert(b)
        return found

    def _convert(self, element: Any) -> Any:
        """Convert an element to the present domain; sympy cannot convert between fields of fractions itself."""
        base = self.field.domain
        if self.domain is self.extension and base.is_FractionField and getattr(element, "field", None) == base.field:
            return self.extension.field.ground_new(element)
        return self.domain.convert(element)


def _symmetric_part(polynomial: sp.Poly) -> sp.Poly:
    """Return the monic greatest common divisor of p(s) and p(-s)."""
    return sp.gcd(polynomial, polynomial.compose(sp.Poly(-ROOT, ROOT, domain=polynomial.domain))).monic()


def _limit_sign(element: sp.Expr, numbers: Sequence[sp.Symbol]) -> int | None:
    """Return the sign of an element as the small numbers tend to zero, the last one first."""
    sign: int | None = 1
    for part in sp.fraction(sp.cancel(element)):
        for number in reversed(numbers):
            part = sp.Poly(part, number).all_coeffs()
            part = next(c for c in reversed(part) if c != 0)
        known = sign_of(part)
        sign = None if sign is None or known is None else sign * known
    return sign


def _changes(signs: Sequence[int | None]) -> int | None:
    """Count changes in a list of signs; ``None`` if any sign is unknown."""
    known = [s for s in signs if s is not None]
    return sum(a != b for a, b in pairwise(known)) if len(known) == len(signs) else None
