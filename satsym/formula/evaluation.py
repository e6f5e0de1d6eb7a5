"""The meaning of formulas over derived and printed expressions, in terms of a few operations of an engine.

There are two engines: sympy's (:mod:`satsym.symbolic.lookup.library`) and our own trees
(:mod:`satsym.formula.calculus`). They share this module, which has products of matrices and the like.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, ClassVar, Generic

from satsym.formula.tree import Add, Call, Div, Equality, Grid, Mul, Neg, Node, Num, Pow, Sym, Text, constant, lines
from satsym.formula.values import Kernel, Matrix, Relation, Roots, S, Sources, Value, plain, size_of, square, without
from satsym.status import BadInput


@dataclass(frozen=True)
class Operation:
    """The meaning of a call, and its number of arguments."""

    meaning: Callable[[Any, Call], Value]
    fewest: int = 1
    most: int = 1


class Engine(ABC, Generic[S]):
    """An evaluator of formulas, with abstract methods for the operations that the two engines do differently."""

    operations: ClassVar[Mapping[str, Operation]]
    """The meaning of calls by name, besides those of elementary functions."""

    def __init__(self, sources: Sources[S]) -> None:
        self.sources = sources

    @abstractmethod
    def number(self, value: Fraction) -> S:
        """Return a number of the engine."""

    @abstractmethod
    def add(self, terms: Sequence[S]) -> S:
        """Return the sum of terms."""

    @abstractmethod
    def multiply(self, factors: Sequence[S]) -> S:
        """Return the product of factors."""

    @abstractmethod
    def power(self, base: S, exponent: Fraction) -> S:
        """Return a power."""

    @abstractmethod
    def function(self, name: str, arguments: Sequence[S]) -> S:
        """Apply an elementary function."""

    @abstractmethod
    def derivative(self, expression: S, by: str) -> S:
        """Return a partial derivative by a symbol."""

    @abstractmethod
    def substitute(self, expression: S, values: Mapping[str, S]) -> S:
        """Replace symbols in an expression, all at once."""

    @abstractmethod
    def determinant(self, matrix: Matrix[S]) -> S:
        """Return the determinant of a square matrix."""

    @abstractmethod
    def rank(self, matrix: Matrix[S]) -> int:
        """Return the rank of a matrix at a generic point."""

    def value(self, tree: Node | Equality) -> Value:
        """Evaluate a formula.

        Raises
        ------
        BadInput
            If it puts together what does not fit, such as matrices of different sizes.
        """
        if isinstance(tree, Equality):
            return Relation(self.scalar(tree.lhs), self.scalar(tree.rhs))
        if isinstance(tree, Num):
            return self.number(tree.value)
        if isinstance(tree, Sym):
            return self.sources.name(tree.name)
        if isinstance(tree, Text):
            return self.sources.address(tree.value)
        if isinstance(tree, Grid):
            return self._grid(tree)
        if isinstance(tree, Neg):
            return self._scaled(self.number(Fraction(-1)), self.operand(tree.operand))
        if isinstance(tree, Add):
            return self._sum([self.operand(term) for term in tree.terms])
        if isinstance(tree, Mul):
            return self._product([self.operand(factor) for factor in tree.factors])
        if isinstance(tree, Div):
            inverse = self.power(self.scalar(tree.denominator), Fraction(-1))
            return self._scaled(inverse, self.operand(tree.numerator))
        if isinstance(tree, Pow):
            return self._power(self.operand(tree.base), constant(tree.exponent) or Fraction(0))
        return self._call(tree)

    def scalar(self, tree: Node) -> S:
        """Evaluate a formula that is no matrix; for an equation, its right-hand side."""
        return plain(self.operand(tree))

    def matrix(self, tree: Node) -> Matrix[S]:
        """Evaluate a formula that is a matrix."""
        found = self.operand(tree)
        if not isinstance(found, Matrix):
            raise BadInput("an expression is given where a matrix is needed")
        return found

    def characteristic(self, matrix: Matrix[S], variable: S) -> S:
        """Return det(x I - A)."""
        n = square(matrix)
        minus = self._scaled(self.number(Fraction(-1)), matrix)
        return self.determinant(
            Matrix.of(n, n, lambda i, j: self.add([*([variable] if i == j else []), minus.rows[i][j]]))
        )

    def product(self, one: Matrix[S], other: Matrix[S]) -> Matrix[S]:
        """Return the product of two matrices."""
        if one.shape[1] != other.shape[0]:
            raise BadInput(f"a {size_of(one)} matrix cannot be multiplied by a {size_of(other)} matrix")
        columns = list(zip(*other.rows, strict=True))
        return Matrix.of(
            one.shape[0],
            other.shape[1],
            lambda i, j: self.add([self.multiply(pair) for pair in zip(one.rows[i], columns[j], strict=True)]),
        )

    def operand(self, tree: Node) -> Value:
        """Evaluate a part of a formula; for an equation, its right-hand side."""
        found = self.value(tree)
        return found.rhs if isinstance(found, Relation) else found

    def _grid(self, tree: Grid) -> Matrix[S]:
        rows = lines(tree)
        if not rows or len({len(row) for row in rows}) > 1 or not rows[0]:
            raise BadInput("all rows of a matrix must have the same length")
        return Matrix(tuple(tuple(self.scalar(entry) for entry in row) for row in rows))

    def _sum(self, terms: Sequence[Value]) -> Value:
        matrices = [term for term in terms if isinstance(term, Matrix)]
        if not matrices:
            return self.add([plain(term) for term in terms])
        if len(matrices) < len(terms) or len({m.shape for m in matrices}) > 1:
            raise BadInput("matrices of different sizes cannot be added")
        return Matrix.of(*matrices[0].shape, lambda i, j: self.add([term.rows[i][j] for term in matrices]))

    def _product(self, factors: Sequence[Value]) -> Value:
        result: Value | None = None
        for factor in factors:
            if result is None:
                result = factor if isinstance(factor, Matrix) else plain(factor)
            elif isinstance(result, Matrix) and isinstance(factor, Matrix):
                result = self.product(result, factor)
            elif isinstance(result, Matrix):
                result = self._scaled(plain(factor), result)
            else:
                result = self._scaled(result, factor)
        assert result is not None
        return result

    def _scaled(self, factor: S, operand: Value) -> Value:
        if isinstance(operand, Matrix):
            return operand.mapped(lambda entry: self.multiply([factor, entry]))
        return self.multiply([factor, plain(operand)])

    def _power(self, base: Value, exponent: Fraction) -> Value:
        if not isinstance(base, Matrix):
            return self.power(plain(base), exponent)
        if exponent.denominator != 1 or exponent < 0:
            raise BadInput("a matrix can be raised only to a nonnegative integer power; write inverse(...)")
        result = self.identity(square(base))
        for _ in range(int(exponent)):
            result = self.product(result, base)
        return result

    def identity(self, n: int) -> Matrix[S]:
        """Return the identity matrix."""
        one, zero = self.number(Fraction(1)), self.number(Fraction(0))
        return Matrix.of(n, n, lambda i, j: one if i == j else zero)

    def _call(self, tree: Call) -> Value:
        operation = self.operations.get(tree.function)
        if operation is not None:
            return operation.meaning(self, tree)
        return self.function(tree.function, [self.scalar(argument) for argument in tree.arguments])

    def relation(self, tree: Node) -> Relation[S]:
        """Evaluate a formula that is an equation."""
        found = self.value(tree)
        if not isinstance(found, Relation):
            raise BadInput("an expression is given where an equation is needed")
        return found

    def along(self, expression: S) -> S:
        """Return the derivative of an expression by time, along the motion."""
        terms = [self.derivative(expression, "t")]
        for name, rate in self.sources.rates().items():
            terms.append(self.multiply([self.derivative(expression, name), self.sources.name(rate)]))
        return self.add(terms)

    def solution(self, expression: Value, by: str) -> S:
        """Return the only root of an expression that is linear in a symbol."""
        if isinstance(expression, Matrix | Roots | Kernel):
            raise BadInput("solve(...) takes an expression or an equation")
        minus, zero = self.number(Fraction(-1)), self.number(Fraction(0))
        if isinstance(expression, Relation):
            expression = self.add([expression.lhs, self.multiply([minus, expression.rhs])])
        slope = self.substitute(self.derivative(expression, by), {by: zero})
        rest = self.substitute(expression, {by: zero})
        self.require_linear(expression, slope, rest, by)
        return self.multiply([minus, rest, self.power(slope, Fraction(-1))])

    @abstractmethod
    def require_linear(self, expression: S, slope: S, rest: S, by: str) -> None:
        """Refuse what is not ``slope*by + rest`` with a slope other than zero."""

    def inverse(self, matrix: Matrix[S]) -> Matrix[S]:
        """Return the inverse of a matrix, by cofactors."""
        n = square(matrix)
        over = self.power(self.determinant(matrix), Fraction(-1))
        sign = [self.number(Fraction(1)), self.number(Fraction(-1))]
        return Matrix.of(n, n, lambda i, j: self.multiply([sign[(i + j) % 2], over, self._cofactor(matrix, j, i)]))

    def _cofactor(self, matrix: Matrix[S], i: int, j: int) -> S:
        if matrix.shape == (1, 1):
            return self.number(Fraction(1))
        return self.determinant(without(matrix, i, j))
