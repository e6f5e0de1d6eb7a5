"""The first engine: formulas over derived and printed things, by sympy."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

import sympy as sp

from satsym.formula.evaluation import Engine
from satsym.formula.functions import OPERATIONS
from satsym.formula.values import Matrix
from satsym.status import BadInput
from satsym.symbolic.lookup import formulas


class Sympy(Engine[sp.Expr]):
    """Evaluates formulas over expressions of sympy's."""

    operations = OPERATIONS

    def number(self, value: Fraction) -> sp.Expr:
        return formulas.rational(value)

    def add(self, terms: Sequence[sp.Expr]) -> sp.Expr:
        return sp.Add(*terms)

    def multiply(self, factors: Sequence[sp.Expr]) -> sp.Expr:
        return sp.Mul(*factors)

    def power(self, base: sp.Expr, exponent: Fraction) -> sp.Expr:
        return sp.Pow(base, formulas.rational(exponent))

    def function(self, name: str, arguments: Sequence[sp.Expr]) -> sp.Expr:
        return formulas.function(name, list(arguments))

    def derivative(self, expression: sp.Expr, by: str) -> sp.Expr:
        return sp.diff(expression, _symbol(expression, by))

    def substitute(self, expression: sp.Expr, values: Mapping[str, sp.Expr]) -> sp.Expr:
        return expression.xreplace({s: values[s.name] for s in expression.free_symbols if s.name in values})

    def determinant(self, matrix: Matrix[sp.Expr]) -> sp.Expr:
        if matrix.shape[0] != matrix.shape[1]:
            raise BadInput("the determinant of a matrix that is not square")
        return sp.expand(sp.Matrix(matrix.rows).det(method="berkowitz"))

    def rank(self, matrix: Matrix[sp.Expr]) -> int:
        return int(sp.Matrix(matrix.rows).rank(simplify=True))

    def require_linear(self, expression: sp.Expr, slope: sp.Expr, rest: sp.Expr, by: str) -> None:
        if formulas.is_zero(slope) or not formulas.is_zero(expression - slope * _symbol(expression, by) - rest):
            raise BadInput(f"solve(...) needs what is linear in {by}")


def _symbol(expression: sp.Expr, name: str) -> sp.Symbol:
    """The symbol of that name in an expression; another, which does not occur, if there is none."""
    return next((s for s in expression.free_symbols if s.name == name), sp.Symbol(name, real=True))
