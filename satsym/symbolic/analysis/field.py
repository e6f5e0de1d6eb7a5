"""Exact arithmetic: matrices over the rational functions of the parameters, and signs that are certain.

A rank, a factor or a zero over this field holds for all values of the parameters, except those at which a divisor
vanishes; :func:`sign_of` tells which divisors cannot vanish.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import sympy as sp
from sympy.polys.constructor import construct_domain
from sympy.polys.matrices import DomainMatrix

from satsym.symbolic.factoring import factor_list, factored


class NotExact(ValueError):
    """The entries of a matrix are beyond exact linear algebra; the message says which and why."""


@dataclass(frozen=True)
class Field:
    """The field of rational functions that contains the entries of some matrices."""

    domain: Any
    """The domain of sympy to which the elements belong."""
    restore: dict[sp.Symbol, sp.Expr]
    """Symbols that replace roots of parameters, with the roots."""

    def element(self, expression: sp.Expr) -> Any:
        """Convert an expression to an element of the field."""
        roots = {power.base: symbol ** (1 / power.exp) for symbol, power in self.restore.items()}
        return self.domain.from_sympy(expression.xreplace(roots))

    def expression(self, element: Any) -> sp.Expr:
        """Convert an element of the field to an expression in its shortest form."""
        return self.shown(self.domain.to_sympy(element))

    def shown(self, expression: sp.Expr) -> sp.Expr:
        """Return an expression in its shortest form, with roots of parameters written as roots."""
        return shortest(expression).xreplace(self.restore)

    def matrix(self, found: DomainMatrix) -> sp.ImmutableMatrix:
        """Convert a matrix over the field to a matrix of expressions."""
        rows, columns = found.shape
        entries = [[self.expression(e) for e in row] for row in found.to_dense().to_list()]
        return sp.ImmutableMatrix(rows, columns, [e for row in entries for e in row])

    def polynomial(self, coefficients: Iterable[Any], symbol: sp.Symbol) -> sp.Poly:
        """Return a polynomial over the field from its coefficients, highest power first."""
        return sp.Poly.from_list(list(coefficients), symbol, domain=self.domain)

    def at(self, polynomial: sp.Poly, matrix: DomainMatrix) -> DomainMatrix:
        """Evaluate a polynomial at a square matrix by Horner's rule."""
        size = matrix.shape[0]
        one = DomainMatrix.eye(size, self.domain).to_dense()
        value = DomainMatrix.zeros((size, size), self.domain).to_dense()
        for coefficient in polynomial.rep.to_list():
            value = value * matrix + one * coefficient
        return value


def exact(*matrices: sp.MatrixBase) -> tuple[Field, list[DomainMatrix]]:
    """Return the field of some matrices, and the matrices over it; decimal numbers are read as exact fractions.

    Raises
    ------
    NotExact
        If an entry is no rational function of its symbols and of roots of single positive symbols.
    """
    plain = [sp.ImmutableMatrix(m).applyfunc(_rational_numbers) for m in matrices]
    entries = [e for m in plain for e in m]
    roots = _roots(entries)
    entries = [e.xreplace({s: root**power for s, (root, power) in roots.items()}) for e in entries]
    for entry in entries:
        if entry.has(sp.I) or not entry.is_rational_function(*entry.free_symbols):
            raise NotExact(f"{entry} is not a rational function of real parameters")
    domain, elements = construct_domain(entries or [sp.Integer(0)], field=True, extension=True)
    if not (domain.is_QQ or domain.is_Algebraic or domain.is_FractionField):
        raise NotExact("the entries lie in no field that exact elimination knows")
    remaining = iter(elements)
    found = []
    for m in plain:
        rows = [[next(remaining) for _ in range(m.cols)] for _ in range(m.rows)]
        found.append(DomainMatrix(rows, m.shape, domain).to_dense())
    return Field(domain, {root: s ** sp.Rational(1, power) for s, (root, power) in roots.items()}), found


@lru_cache(maxsize=4096)  # matrices repeat their entries
def shortest(expression: sp.Expr) -> sp.Expr:
    """Return the shortest of the usual ways to write an expression."""
    if expression.is_Atom:
        return expression
    whole = sp.cancel(expression) if expression.is_rational_function() else expression
    candidates = [whole, sp.expand(whole), factored(whole)]
    return min(candidates, key=lambda e: (sp.count_ops(e), sp.default_sort_key(e)))


def sign_of(expression: sp.Expr) -> int | None:
    """Return 1, -1 or 0 where an expression has that sign for all values of its symbols; ``None`` where unknown.

    A sum whose terms all have the same sign has that sign; products and quotients follow from their factors. An
    expression that is positive because of a difference is recognised only where sympy knows it.
    """
    e = sp.sympify(expression)
    if e.is_number:
        return 0 if e == 0 or e.is_zero else 1 if e.is_positive else -1 if e.is_negative else None
    numerator, denominator = sp.fraction(sp.together(e))
    signs = [_sign_of_product(part) for part in (numerator, denominator)]
    return None if None in signs else signs[0] * signs[1]  # type: ignore[operator]


def never_zero(expression: sp.Expr) -> bool:
    """Tell whether an expression is certainly not zero, whatever the values of its symbols."""
    content, factors = factor_list(sp.fraction(sp.together(expression))[0])
    return content != 0 and all(bool(sign_of(f)) or f.is_nonzero for f, _ in factors)


def certain_rank(matrix: sp.MatrixBase) -> tuple[int, tuple[sp.Expr, ...]]:
    """Return the rank of a matrix, and the expressions that must not vanish for this rank to hold.

    The list is empty where the rank holds for all parameters. Elimination prefers pivots that cannot vanish.
    """
    field, (found,) = exact(matrix)
    rows = [list(row) for row in found.to_list()]
    assumed: list[sp.Expr] = []
    rank = 0
    while rows and (pivot := _best_pivot(field, rows)) is not None:
        i, j, sure = pivot
        top = rows.pop(i)
        if not sure:
            assumed.append(field.expression(top[j]))
        rows = [[a - row[j] / top[j] * b for a, b in zip(row, top, strict=True)] for row in rows]
        rank += 1
    return rank, tuple(assumed)


def _best_pivot(field: Field, rows: list[list[Any]]) -> tuple[int, int, bool] | None:
    fallback = None
    for i, row in enumerate(rows):
        for j, element in enumerate(row):
            if element:
                if never_zero(field.expression(element)):
                    return i, j, True
                fallback = fallback or (i, j, False)
    return fallback


def _sign_of_product(expression: sp.Expr) -> int | None:
    content, factors = factor_list(expression) if expression.free_symbols else (expression, [])
    sign = 0 if content == 0 else 1 if content.is_positive else -1
    for factor, power in factors:
        known = _sign_of_sum(factor)
        if known is None and power % 2 == 0 and factor.is_nonzero:
            known = 1
        if known is None:
            return None
        sign *= known**power
    return sign


def _sign_of_sum(expression: sp.Expr) -> int | None:
    signs = {
        1 if term.is_positive else -1 if term.is_negative else None for term in sp.Add.make_args(sp.expand(expression))
    }
    if len(signs) == 1:
        return signs.pop()
    return 1 if expression.is_positive else -1 if expression.is_negative else None


def _rational_numbers(entry: sp.Expr) -> sp.Expr:
    return sp.nsimplify(entry, rational=True) if entry.has(sp.Float) else entry


def _roots(entries: Sequence[sp.Expr]) -> dict[sp.Symbol, tuple[sp.Symbol, int]]:
    """Map positive symbols under roots to a symbol for the root and its degree."""
    found: dict[sp.Symbol, int] = {}
    for entry in entries:
        for power in entry.atoms(sp.Pow):
            if power.base.is_Symbol and power.base.is_positive and power.exp.is_Rational and power.exp.q > 1:
                found[power.base] = int(sp.ilcm(found.get(power.base, 1), power.exp.q))
    return {s: (sp.Symbol(f"_root_{s.name}", positive=True), q) for s, q in sorted(found.items(), key=str)}
