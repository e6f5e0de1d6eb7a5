"""Eigenvalues in closed form, and the sizes of their Jordan blocks, computed in the field of the entries.

The characteristic polynomial is factored over the rational functions of the parameters. All roots of one irreducible
factor f have blocks of the same sizes, which follow from the ranks of f(A), f(A)^2, ...
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import sympy as sp
from sympy.polys.matrices import DomainMatrix

from satsym.symbolic.analysis.field import Field, exact, never_zero, shortest, sign_of
from satsym.symbolic.analysis.routh import routh
from satsym.symbolic.factoring import factored

LAMBDA = sp.Symbol("eigenvalue")
"""The variable of characteristic polynomials."""


@dataclass(frozen=True)
class Factor:
    """An irreducible factor of a characteristic polynomial, with its multiplicity and its roots."""

    polynomial: sp.Poly
    """The factor as a monic polynomial in :data:`LAMBDA` over the field of the entries."""
    coefficients: tuple[sp.Expr, ...]
    """Coefficients of the polynomial as expressions, highest power first."""
    blocks: tuple[int, ...]
    """Sizes of the Jordan blocks of each of its roots, the largest first."""
    roots: tuple[sp.Expr, ...]
    """The roots of the factor in closed form, or sympy's numbered roots of a polynomial with known coefficients; empty
    where there is no closed form."""
    right: int | None
    axis: int | None
    left: int | None
    """Numbers of the factor's roots with positive, zero and negative real parts; ``None`` if they depend on
    parameters."""

    @property
    def degree(self) -> int:
        """Return the number of roots of this factor."""
        return int(self.polynomial.degree())


@dataclass(frozen=True)
class Eigenvalue:
    """An eigenvalue with its multiplicities."""

    value: sp.Expr
    """Eigenvalue in closed form."""
    algebraic: int
    geometric: int
    """The multiplicity as a root of the characteristic polynomial, and the number of independent eigenvectors."""
    blocks: tuple[int, ...]
    """Sizes of the eigenvalue's Jordan blocks, the largest first."""


@dataclass(frozen=True)
class Spectrum:
    """The characteristic polynomial of a square matrix, its factors and its eigenvalues."""

    field: Field
    matrix: DomainMatrix
    """The matrix in exact arithmetic."""
    coefficients: tuple[sp.Expr, ...]
    """Coefficients of the characteristic polynomial det(s I - A), which is monic, highest power first."""
    factors: tuple[Factor, ...]
    """The irreducible factors of the characteristic polynomial, by degree and then by name."""
    assumed: tuple[sp.Expr, ...]
    """Expressions that are assumed not to vanish.

    They are zero if eigenvalues of different factors, or roots of one factor, coincide.
    """

    @property
    def polynomial(self) -> sp.Expr:
        """Return the characteristic polynomial in the variable :data:`LAMBDA`."""
        return polynomial_of(self.coefficients, LAMBDA)

    @property
    def closed_form(self) -> bool:
        """Tell whether every eigenvalue has a closed form; numbered roots of polynomials have none."""
        return all(f.roots and not any(r.has(sp.CRootOf) for r in f.roots) for f in self.factors)

    @property
    def eigenvalues(self) -> tuple[Eigenvalue, ...]:
        """Return each distinct eigenvalue that has a closed form."""
        return tuple(Eigenvalue(root, sum(f.blocks), len(f.blocks), f.blocks) for f in self.factors for root in f.roots)


def spectrum(a: sp.MatrixBase) -> Spectrum:
    """Return the characteristic polynomial of a matrix, with its factors and their roots.

    Raises
    ------
    NotExact
        If the entries are not rational functions of parameters and of roots of positive ones.
    """
    return _spectrum(sp.ImmutableMatrix(a))


@lru_cache(maxsize=64)
def _spectrum(a: sp.ImmutableMatrix) -> Spectrum:
    field, (matrix,) = exact(a)
    coefficients = matrix.charpoly()
    whole = field.polynomial(coefficients, LAMBDA)
    _, found = whole.factor_list()
    parts = [(p.monic().set_domain(field.domain), m) for p, m in found]
    parts.sort(key=lambda part: (part[0].degree(), not part[0].as_expr().has(LAMBDA), sp.default_sort_key(part[0])))
    factors = tuple(_factor(field, matrix, p, m) for p, m in parts)
    return Spectrum(
        field, matrix, tuple(map(field.expression, coefficients)), factors, _assumed(field, [p for p, _ in parts])
    )


def polynomial_of(coefficients: tuple[sp.Expr, ...], symbol: sp.Symbol) -> sp.Expr:
    """Return the polynomial with the given coefficients, highest power first."""
    highest = len(coefficients) - 1
    return sp.Add(*(c * symbol ** (highest - k) for k, c in enumerate(coefficients)))


def _factor(field: Field, matrix: DomainMatrix, polynomial: sp.Poly, multiplicity: int) -> Factor:
    coefficients = tuple(field.shown(c) for c in polynomial.all_coeffs())
    array = routh(coefficients)
    return Factor(
        polynomial,
        coefficients,
        _block_sizes(field, matrix, polynomial, multiplicity),
        _roots(coefficients),
        array.right,
        array.axis,
        array.left,
    )


def _block_sizes(field: Field, matrix: DomainMatrix, polynomial: sp.Poly, multiplicity: int) -> tuple[int, ...]:
    """Return the sizes of the Jordan blocks of one root of a factor f of a matrix A.

    The number of blocks of size k or more is the fall in rank from f(A)^(k-1) to f(A)^k, divided by the degree of f.
    """
    size, degree = matrix.shape[0], int(polynomial.degree())
    value = field.at(polynomial, matrix)
    ranks, power = [size], value
    while size - ranks[-1] < degree * multiplicity:
        ranks.append(power.rank())
        power = power * value
    at_least = [(a - b) // degree for a, b in pairwise(ranks)]
    sizes = [k for k, (n, more) in enumerate(pairwise([*at_least, 0]), 1) for _ in range(n - more)]
    return tuple(sorted(sizes, reverse=True))


def _roots(coefficients: tuple[sp.Expr, ...]) -> tuple[sp.Expr, ...]:
    """Return the roots of a monic irreducible polynomial; of a pair, the greater or the upper one first."""
    if len(coefficients) == 2:
        return (shortest(-coefficients[1]),)
    if len(coefficients) == 3:
        _, b, c = coefficients
        return _pair(shortest(-b / 2), shortest(b**2 / 4 - c))
    if len(coefficients) == 5 and coefficients[1] == coefficients[3] == 0:
        return _biquadratic(coefficients[2], coefficients[4])
    if all(c.is_number for c in coefficients):
        polynomial = sp.Poly.from_list(coefficients, LAMBDA, extension=True)
        if polynomial.domain.is_QQ or polynomial.domain.is_ZZ:
            return tuple(sp.CRootOf(polynomial, k) for k in range(polynomial.degree()))
    return ()


def _pair(centre: sp.Expr, square: sp.Expr) -> tuple[sp.Expr, ...]:
    """Return ``centre`` plus and minus the square root of ``square``."""
    half = sp.I * _root(-square) if sign_of(square) == -1 else _root(square)
    return centre + half, centre - half


def _biquadratic(p: sp.Expr, q: sp.Expr) -> tuple[sp.Expr, ...]:
    """Return the four roots of s^4 + p s^2 + q."""
    square = shortest(p**2 / 4 - q)
    if sign_of(square) == -1:  # then q is positive, and its root greater than half of p
        real, imaginary = (_root(shortest(_root(q) / 2 + sign * p / 4)) for sign in (-1, 1))
        return tuple(a * real + b * sp.I * imaginary for a in (1, -1) for b in (1, -1))
    return tuple(root for y in (-p / 2 + _root(square), -p / 2 - _root(square)) for root in _pair(sp.Integer(0), y))


def _root(square: sp.Expr) -> sp.Expr:
    """Return a square root, with squares of positive factors taken out of it."""
    return sp.sqrt(factored(square))


def _assumed(field: Field, factors: list[sp.Poly]) -> tuple[sp.Expr, ...]:
    differences = [sp.resultant(a, b) for k, a in enumerate(factors) for b in factors[:k]]
    differences += [sp.discriminant(f) for f in factors if f.degree() > 1]
    shown = (field.shown(sp.sympify(d)) for d in differences)
    return tuple(dict.fromkeys(d for d in shown if not never_zero(d)))
