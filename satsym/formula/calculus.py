"""The rules of the second engine: derivatives, substitution and determinants on our own trees, without sympy."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from fractions import Fraction

from satsym.formula import field
from satsym.formula.evaluation import Engine
from satsym.formula.functions import OPERATIONS
from satsym.formula.tree import ONE, ZERO, Add, Call, Div, Mul, Neg, Node, Num, Pow, Sym, constant, number, substituted
from satsym.formula.values import Matrix, Sources, without
from satsym.formula.weight import Scales
from satsym.formula.writing import written
from satsym.status import BadInput

_MINUS_ONE = Num(Fraction(-1))


class Calculus(Engine[Node]):
    """An evaluator of formulas on trees.

    Parameters
    ----------
    sources
        Names, addresses and rows.
    positive
        Names of symbols that are positive.
    """

    operations = OPERATIONS

    def __init__(self, sources: Sources[Node], positive: Collection[str]) -> None:
        super().__init__(sources)
        self._positive = positive
        self._scales = Scales()

    def number(self, value: Fraction) -> Node:
        return number(value)

    def add(self, terms: Sequence[Node]) -> Node:
        return self._weighed(total(terms))

    def multiply(self, factors: Sequence[Node]) -> Node:
        return self._weighed(product(factors))

    def power(self, base: Node, exponent: Fraction) -> Node:
        return self._weighed(raised(base, exponent))

    def function(self, name: str, arguments: Sequence[Node]) -> Node:
        return self._weighed(Call(name, tuple(arguments)))

    def derivative(self, expression: Node, by: str) -> Node:
        return self._weighed(derivative(expression, by))

    def substitute(self, expression: Node, values: Mapping[str, Node]) -> Node:
        return self._weighed(substituted(expression, values))

    def determinant(self, matrix: Matrix[Node]) -> Node:
        """Return the determinant of a matrix, by minors of the first row."""
        if matrix.shape[0] != matrix.shape[1]:
            raise BadInput("a determinant requires a square matrix")
        if matrix.shape == (1, 1):
            return matrix.rows[0][0]
        terms = []
        for j, entry in enumerate(matrix.rows[0]):
            if entry != ZERO:
                terms.append(self.multiply([number((-1) ** j), entry, self.determinant(without(matrix, 0, j))]))
        return self.add(terms)

    def rank(self, matrix: Matrix[Node]) -> int:
        """Return the largest rank at a few random points, which is the generic rank almost certainly."""
        entries = [entry for row in matrix.rows for entry in row]
        columns = matrix.shape[1]
        found = []
        for point in field.points_for(entries, "rank", self._positive, 3):
            values = [point.value(entry) for entry in entries]
            found.append(field.rank([values[i : i + columns] for i in range(0, len(values), columns)]))
        return max(found)

    def require_linear(self, expression: Node, slope: Node, rest: Node, by: str) -> None:
        remainder = total([expression, product([_MINUS_ONE, slope, Sym(by)]), product([_MINUS_ONE, rest])])
        try:
            linear = field.vanishes(remainder, "linear", self._positive)
            unique = not field.vanishes(slope, "slope", self._positive)
        except field.Undecided:  # without a value at zero, where the slope and the rest are taken
            linear = unique = False
        if not (linear and unique):
            raise BadInput(f"solve(...) requires an equation that is linear in {by}")

    def _weighed(self, tree: Node) -> Node:
        """Return the tree after a check that it is not too heavy for sympy or the field."""
        return self._scales.checked(tree)


def total(terms: Sequence[Node]) -> Node:
    """Return the sum of terms, without zeros."""
    kept = [term for term in terms if term != ZERO]
    if len(kept) < 2:
        return kept[0] if kept else ZERO
    return Add(tuple(kept))


def product(factors: Sequence[Node]) -> Node:
    """Return the product of factors, without ones; zero if a factor is zero."""
    scale, kept = Fraction(1), []
    for factor in factors:
        value = constant(factor)
        if value is None:
            kept.append(factor)
        else:
            scale *= value
    if not scale:
        return ZERO
    if scale != 1 or not kept:
        kept.insert(0, Num(scale))
    return kept[0] if len(kept) == 1 else Mul(tuple(kept))


def raised(base: Node, exponent: Fraction) -> Node:
    """Return a power; the base itself where the exponent is one."""
    if exponent == 1:
        return base
    return Pow(base, Num(exponent)) if exponent else ONE


def difference(one: Node, other: Node) -> Node:
    """Return one minus the other."""
    return total([one, Neg(other)]) if other != ZERO else one


def derivative(node: Node, by: str) -> Node:
    """Return a partial derivative, by the rules of calculus.

    Raises
    ------
    BadInput
        For a function that has no rule here.
    """
    if isinstance(node, Num):
        return ZERO
    if isinstance(node, Sym):
        return ONE if node.name == by else ZERO
    if isinstance(node, Neg):
        return product([_MINUS_ONE, derivative(node.operand, by)])
    if isinstance(node, Add):
        return total([derivative(term, by) for term in node.terms])
    if isinstance(node, Mul):
        parts = node.factors
        return total([product([*parts[:i], derivative(p, by), *parts[i + 1 :]]) for i, p in enumerate(parts)])
    if isinstance(node, Div):
        return derivative(Mul((node.numerator, Pow(node.denominator, _MINUS_ONE))), by)
    if isinstance(node, Pow):
        exponent = constant(node.exponent) or Fraction(0)
        return product([number(exponent), raised(node.base, exponent - 1), derivative(node.base, by)])
    if isinstance(node, Call):
        return _chain(node, by)
    raise BadInput(f"{written(node)} cannot be differentiated")


def _chain(node: Call, by: str) -> Node:
    inner = [derivative(argument, by) for argument in node.arguments]
    if all(slope == ZERO for slope in inner):
        return ZERO
    rules = _SLOPES.get(node.function)
    if rules is None:
        raise BadInput(f"{node.function}(...) cannot be differentiated")
    return product([rules(node.arguments[0]), inner[0]])


def _call(name: str, argument: Node) -> Node:
    return Call(name, (argument,))


_SLOPES: Mapping[str, Callable[[Node], Node]] = {
    "sin": lambda x: _call("cos", x),
    "cos": lambda x: Neg(_call("sin", x)),
    "tan": lambda x: Add((ONE, Pow(_call("tan", x), Num(Fraction(2))))),
    "exp": lambda x: _call("exp", x),
    "log": lambda x: Pow(x, _MINUS_ONE),
    "sqrt": lambda x: Div(Num(Fraction(1, 2)), _call("sqrt", x)),
    "sinh": lambda x: _call("cosh", x),
    "cosh": lambda x: _call("sinh", x),
    "tanh": lambda x: Add((ONE, Neg(Pow(_call("tanh", x), Num(Fraction(2)))))),
    "atan": lambda x: Pow(Add((ONE, Pow(x, Num(Fraction(2))))), _MINUS_ONE),
}
