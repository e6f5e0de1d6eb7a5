"""Matrices whose entries are rational: characteristic polynomial, Jordan blocks, signs and ranks, decided exactly.

The characteristic polynomial is split by multiplicity, and where roots are multiple into irreducible factors f; the
ranks of f(A), f(A)^2, ... tell the Jordan blocks. Roots are numbers with error bounds. How many of them lie on the
imaginary axis is counted beforehand: those iw for which w is a real root of both parts of p(iw), that is, the roots of
gcd(p(s), p(-s)) = e(s^2) for which e has a negative root. Bounds are narrowed until all others are off the axis.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

if TYPE_CHECKING:
    from flint import acb, fmpq, fmpq_mat, fmpz_poly

BITS = 192
"""Fewest bits to which roots of a polynomial are enclosed."""


@dataclass(frozen=True, eq=False)
class Rational:
    """The matrices of a linear system, exactly."""

    A: fmpq_mat
    B: fmpq_mat
    C: fmpq_mat

    def with_inputs(self, columns: Sequence[int]) -> Rational:
        """Return the system with some of its inputs alone."""
        from flint import fmpq_mat

        chosen = [row[j] for row in self.B.tolist() for j in columns]
        return Rational(self.A, fmpq_mat(self.B.nrows(), len(columns), chosen), self.C)

    def transposed(self) -> Rational:
        """The dual system."""
        return Rational(self.A.transpose(), self.C.transpose(), self.B.transpose())


@dataclass(frozen=True, eq=False)
class Root:
    """An eigenvalue, and the sizes of its Jordan blocks, the largest first."""

    value: acb
    """Within an error bound, real or imaginary part exactly zero where they are."""
    blocks: tuple[int, ...]

    @property
    def rounded(self) -> complex:
        """The nearest floats."""
        return nearest(self.value)


def nearest(value: acb) -> complex:
    """The floats that are nearest to the midpoint; those of the library are cut off."""
    parts = (part.mid().fmpq() for part in (value.real, value.imag))
    return complex(*(int(part.p) / int(part.q) for part in parts))


def matrix(rows: ArrayLike | Sequence[Sequence[Fraction]]) -> fmpq_mat:
    """A matrix from floats, each as the fraction that it is, or from fractions; shape (n, m)."""
    from flint import fmpq_mat

    table = np.asarray(rows, dtype=object)
    n, m = table.shape
    return fmpq_mat(n, m, [_fraction(value) for value in table.ravel().tolist()])


def _fraction(value: float | Fraction) -> fmpq:
    from flint import fmpq

    return fmpq(*value.as_integer_ratio())


def characteristic(A: fmpq_mat) -> list[Fraction]:
    """Coefficients of det(s - A), highest power first."""
    return [Fraction(int(c.p), int(c.q)) for c in reversed(A.charpoly().coeffs())]


def roots(A: fmpq_mat) -> list[Root]:
    """Distinct eigenvalues of a square matrix."""
    found: list[Root] = []
    for factor, multiplicity in A.charpoly().numer().factor_squarefree()[1]:
        if multiplicity == 1:
            found += [Root(value, (1,)) for value in located(factor)]
            continue
        for irreducible, _ in factor.factor()[1]:
            blocks = _blocks(A, irreducible, multiplicity)
            found += [Root(value, blocks) for value in located(irreducible)]
    return found


def _blocks(A: fmpq_mat, factor: fmpz_poly, multiplicity: int) -> tuple[int, ...]:
    """Block sizes of each root of an irreducible factor f: f(A)^k loses a rank of deg f for each of size k or more."""
    size, degree = A.nrows(), factor.degree()
    value = at(factor, A)
    ranks, power = [size], value
    while size - ranks[-1] < degree * multiplicity:
        ranks.append(power.rank())
        power = power * value
    at_least = [(a - b) // degree for a, b in pairwise(ranks)]
    return tuple(sum(count > i for count in at_least) for i in range(at_least[0]))


def at(polynomial: fmpz_poly, A: fmpq_mat) -> fmpq_mat:
    """A polynomial of a square matrix, by Horner's rule."""
    from flint import fmpq_mat

    n = A.nrows()
    one = fmpq_mat(n, n, [int(i == j) for i in range(n) for j in range(n)])
    value = one * 0
    for coefficient in reversed(polynomial.coeffs()):
        value = value * A + one * coefficient
    return value


def located(polynomial: fmpz_poly) -> list[acb]:
    """Roots of a polynomial that has none twice; the real parts of those on the imaginary axis are exactly zero."""
    from flint import acb, ctx

    degree, bits = polynomial.degree(), BITS
    while True:
        with ctx.workprec(bits):
            found = _complex_roots(polynomial)
            off = [value.real > 0 or value.real < 0 for value in found]
            if sum(off) == degree - _on_axis(polynomial):
                return [
                    value if away else acb(0, 0 if value.imag.contains(0) else value.imag)
                    for value, away in zip(found, off, strict=True)
                ]
        bits *= 2


def _on_axis(polynomial: fmpz_poly) -> int:
    """Number of roots on the imaginary axis, of a polynomial that has none twice."""
    from flint import fmpz_poly

    coefficients = polynomial.coeffs()
    mirrored = fmpz_poly([-c if k % 2 else c for k, c in enumerate(coefficients)])
    shared = polynomial.gcd(mirrored).coeffs()
    zero = int(shared[0] == 0)
    squares = fmpz_poly(shared[zero::2])
    return zero + 2 * sum(value.imag == 0 and value.real < 0 for value in _complex_roots(squares))


def _complex_roots(polynomial: Any) -> list[acb]:
    """Enclose the complex roots of a polynomial without multiple roots."""
    return [value for value, _ in polynomial.complex_roots()]


def reached(A: fmpq_mat, B: fmpq_mat) -> tuple[int, list[Root]]:
    """Dimension of what the inputs move, and the eigenvalues of the rest."""
    from flint import fmpq_mat

    n = A.nrows()
    powers = [B]
    for _ in range(n - 1):
        powers.append(A * powers[-1])
    unit = [[int(i == j) for j in range(n)] for i in range(n)]
    columns = [row for power in powers for row in power.transpose().tolist()]
    # independent columns of (B, AB, ...), filled up with unit vectors
    whole = fmpq_mat(n, len(columns) + n, [v for row in zip(*columns, *unit, strict=True) for v in row])
    pivots = _pivots(whole.rref()[0].tolist())
    rank = sum(p < len(columns) for p in pivots)
    if rank == n:
        return n, []
    chosen = [(columns + unit)[p] for p in pivots]
    basis = fmpq_mat(n, n, [v for row in chosen for v in row]).transpose()
    form = basis.solve(A * basis).tolist()
    rest = [v for row in form[rank:] for v in row[rank:]]
    return rank, roots(fmpq_mat(n - rank, n - rank, rest))


def _pivots(rows: Iterable[Sequence[Any]]) -> list[int]:
    firsts = (next((j for j, value in enumerate(row) if value != 0), None) for row in rows)
    return [first for first in firsts if first is not None]
