"""Shipped derivations by the names that addresses begin with, and their expressions in the notation of one document.

Each model is derived once. Symbols of several derivations with the same name are one symbol, which is positive only if
every derivation declares it so.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, cached_property
from typing import TypeAlias

import sympy as sp

from satsym.formula.budget import exempt
from satsym.formula.evaluation import Engine
from satsym.formula.functions import OPERATIONS
from satsym.formula.tree import Node
from satsym.formula.values import Matrix, Relation, Value
from satsym.records import record, shelf
from satsym.records.record import Equated, Family
from satsym.status import BadInput
from satsym.symbolic import dimensions, loader
from satsym.symbolic.analysis.structure import LinearSystem
from satsym.symbolic.derivation import Derivation, DerivationError
from satsym.symbolic.dimensions import Known
from satsym.symbolic.lookup import formulas
from satsym.symbolic.lookup.formulas import NotAFormula, from_tree, is_zero, to_tree
from satsym.symbolic.pipeline import derive
from satsym.wording import shown, suggestion

Order: TypeAlias = Callable[[tuple[str, ...]], tuple[int, ...]]
"""Function from names of rows or columns to their positions in the order of a document."""


@cache
def derivation(name: str) -> Derivation:
    """Return the derivation of a shipped problem or model.

    Raises
    ------
    BadInput
        If there is none, or a file cannot be derived from.
    """
    with exempt():
        found = {problem.name: problem for path in loader.shipped() for problem in loader.load(path)}
        if name not in found:
            raise BadInput(f"there is no derivation {shown(name)}; {suggestion(name, found)}")
        try:
            return derive(found[name])
        except DerivationError as error:
            raise BadInput(" ".join(str(error).split())) from error


@dataclass(frozen=True)
class Names:
    """The names that some derivations and a ledger define."""

    symbols: Mapping[str, sp.Symbol]
    """Symbols by name, with their assumptions."""
    definitions: Mapping[str, sp.Expr]
    """Named constants with their values, which replace them wherever they occur."""

    @cached_property
    def positive(self) -> frozenset[str]:
        """Return the names of positive symbols."""
        return frozenset(name for name, symbol in self.symbols.items() if symbol.is_positive)

    def expression(self, name: str) -> sp.Expr:
        """Return the expression that a name stands for."""
        if name in ("I", "pi"):
            return sp.I if name == "I" else sp.pi
        return self.definitions[name] if name in self.definitions else self.symbols[name]

    def tree(self, name: str) -> Node:
        """Return the expression of a name as a tree."""
        return to_tree(self.expression(name))


def names(models: Iterable[str], own: Mapping[str, bool]) -> Names:
    """Return the names of some derivations and of a ledger, each with whether it is positive."""
    positive: dict[str, bool] = {}
    definitions: dict[str, Node] = {}
    for model in models:
        found = shelf.find(model)
        for name, entry in found.names.items():
            positive[name] = positive.get(name, True) and entry.positive
        definitions |= {name: record.formula(text) for name, text in found.definitions.items() if text}
    positive = {**own, **positive}
    symbols = {name: sp.Symbol(name, real=True, positive=True if flag else None) for name, flag in positive.items()}
    shared: dict[str, sp.Expr] = {}
    for name, tree in definitions.items():
        shared[name] = from_tree(tree, lambda inside: Names(symbols, shared).expression(inside))
    return Names(symbols, shared)


def named(name: str, shared: Names) -> sp.Expr:
    """Return a name as a symbol, whether or not it is defined by an expression.

    Raises
    ------
    NotAFormula
        If nothing is called so.
    """
    if name in ("I", "pi"):
        return shared.expression(name)
    if name in shared.symbols:
        return shared.symbols[name]
    if name in shared.definitions:
        return sp.Symbol(name, positive=True)
    raise NotAFormula(name)


def at(address: str, shared: Names, order: Order) -> Value:
    """Return the expression at an address in shared symbols, a matrix in the order of the document.

    Raises
    ------
    BadInput
        If there is none.
    """
    found = record.look_up(shelf.find(address.partition(":")[0]), address)

    def exact(tree: Node) -> sp.Expr:
        try:
            return from_tree(tree, lambda name: _expression(name, shared))
        except NotAFormula as error:
            raise BadInput(f"{shown(address)}: {error}") from None

    if isinstance(found, Equated) and isinstance(found.rhs, Matrix):
        return Matrix(tuple(tuple(map(exact, row)) for row in found.rhs.rows))
    if isinstance(found, Equated):
        assert not isinstance(found.rhs, Matrix)
        return Relation(exact(found.lhs), exact(found.rhs))
    if isinstance(found, Family):
        rows, columns = order(found.rows), order(found.columns)
        return Matrix(tuple(tuple(exact(found.entries[i][j]) for j in columns) for i in rows))
    return exact(found)


def _expression(name: str, shared: Names) -> sp.Expr:
    known = name in ("I", "pi") or name in shared.symbols or name in shared.definitions
    return shared.expression(name) if known else sp.Symbol(name, real=True)


def in_trees(value: Value) -> Value:
    """Convert a derived expression or matrix to trees.

    Raises
    ------
    BadInput
        If it has no counterpart in printed formulas.
    """
    try:
        if isinstance(value, Relation):
            return Relation(to_tree(value.lhs), to_tree(value.rhs))
        if isinstance(value, Matrix):
            return Matrix(tuple(tuple(to_tree(entry) for entry in row) for row in value.rows))
        return to_tree(value)
    except NotAFormula as error:
        raise BadInput(str(error)) from None


def rates_by_name(model: str, shared: Names) -> dict[str, sp.Expr]:
    """Return the rates of the states of a model, with definitions filled in, by names such as ``d_x``.

    States whose rates are states themselves are left out.
    """
    found = shelf.find(model)
    step = next((step for step in found.steps if step.name == "first_order"), None)
    addresses = [f"{model}:first_order.{equation.name}" for equation in step.equations] if step else []
    values = [at(address, shared, lambda entries: tuple(range(len(entries)))) for address in addresses]
    rates = {value.lhs.name: value.rhs for value in values if isinstance(value, Relation) and value.lhs.is_Symbol}
    return {name: rate for name, rate in rates.items() if not rate.is_Symbol}


def rates(model: str) -> list[sp.Expr]:
    """Return the rates of the states of a model, in which definitions keep their names."""
    found, shared = shelf.find(model), names((model,), {})
    step = next((step for step in found.steps if step.name == "first_order"), None)
    if step is None:
        raise BadInput(f"{model} has no equations of its states")
    equated = [record.look_up(found, f"{model}:first_order.{e.name}") for e in step.equations]
    trees = [e.rhs for e in equated if isinstance(e, Equated) and not isinstance(e.rhs, Matrix)]
    return [from_tree(tree, lambda name: named(name, shared)) for tree in trees]


def linear_system(model: str) -> LinearSystem:
    """Return the matrices of a linear model with constant coefficients, with named constants filled in.

    Raises
    ------
    BadInput
        If the model is not linear, or its coefficients are not constant.
    """
    found, shared = shelf.find(model), names((model,), {})
    states, inputs, outputs = (record.variables(found, kind) for kind in record.VARIABLES)

    def matrix(address: str, rows: tuple[str, ...], columns: tuple[str, ...]) -> sp.ImmutableMatrix:
        if not rows or not columns:
            return sp.ImmutableMatrix(len(rows), len(columns), [])
        entries = at(f"{model}:{address}", shared, lambda entries: tuple(range(len(entries)))).entries
        return sp.ImmutableMatrix(len(rows), len(columns), entries)

    refusal = (
        f"{model}: the system is not linear with constant coefficients; linearise the model about a motion, as "
        "derivations/clohessy_wiltshire.py does"
    )
    if all(step.name != "linearisation" for step in found.steps):
        raise BadInput(refusal)
    a, b = matrix("linearisation.A", states, states), matrix("linearisation.B", states, inputs)
    c, d = matrix("output_matrix.C", outputs, states), matrix("output_matrix.D", outputs, inputs)
    moving = {shared.symbols[name] for name in (*states, *inputs)} | {sp.Symbol("t", real=True)}
    moving |= {symbol for name, symbol in shared.symbols.items() if name == "t"}
    rest = [rate.subs(dict.fromkeys(moving, 0)).subs(shared.definitions) for rate in rates(model)]
    if any(e.free_symbols & moving for part in (a, b, c, d) for e in part) or not all(map(is_zero, rest)):
        raise BadInput(refusal)
    return LinearSystem(a, b, c, d, states, inputs, outputs)


def dimensions_of(models: Iterable[str], own: Mapping[str, str]) -> Known:
    """Return the dimensions of the names of some derivations, and of those to which a ledger gives a unit."""
    known: dict[str, dimensions.Dimension | None] = {}
    for model in models:
        for name, powers in record.dimensions(shelf.find(model)).items():
            known.setdefault(
                name, {base: sp.Rational(power.numerator, power.denominator) for base, power in powers.items()}
            )
    for name, unit in own.items():
        if unit:
            known[name] = dimensions.of_unit(unit)
    return known


def inhomogeneity(sides: Iterable[sp.Expr], known: Known) -> tuple[str, ...]:
    """Explain why expressions cannot be equal because of their dimensions; empty where they can be.

    The explanation is the kind of fault and the expressions that it combines.
    """
    found: list[dimensions.Dimension] = []
    for side in sides:
        if any(symbol.name not in known for symbol in side.free_symbols):
            return ()
        try:
            dimension = dimensions.dimension_of(side, known)
        except dimensions.Disagreement as error:
            return error.kind, *error.parts
        if dimension is not None:
            found.append(dimension)
    if len(found) == 2 and found[0] != found[1]:
        return "equates", *map(dimensions.written, found)
    return ()


def dimension(expression: sp.Expr, known: Known) -> dict[str, Fraction] | None:
    """Return the dimension of an expression; ``None`` for zero.

    Raises
    ------
    BadInput
        If it has none.
    """
    try:
        found = dimensions.dimension_of(expression, known)
    except dimensions.Disagreement as error:
        raise BadInput(f"the expression {error}") from None
    return None if found is None else {base: Fraction(str(power)) for base, power in found.items()}


def written_dimension(exponents: Mapping[str, Fraction]) -> str:
    """Write a dimension for people."""
    return dimensions.written({base: sp.Rational(str(power)) for base, power in exponents.items()})


__all__ = [
    "Names",
    "NotAFormula",
    "at",
    "derivation",
    "dimension",
    "dimensions_of",
    "from_tree",
    "in_trees",
    "inhomogeneity",
    "linear_system",
    "named",
    "names",
    "rates",
    "written_dimension",
]


class Sympy(Engine[sp.Expr]):
    """Evaluates formulas as expressions of sympy."""

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
            raise BadInput("a determinant requires a square matrix")
        return sp.expand(sp.Matrix(matrix.rows).det(method="berkowitz"))

    def rank(self, matrix: Matrix[sp.Expr]) -> int:
        return int(sp.Matrix(matrix.rows).rank(simplify=True))

    def require_linear(self, expression: sp.Expr, slope: sp.Expr, rest: sp.Expr, by: str) -> None:
        if formulas.is_zero(slope) or not formulas.is_zero(expression - slope * _symbol(expression, by) - rest):
            raise BadInput(f"solve(...) requires an equation that is linear in {by}")


def _symbol(expression: sp.Expr, name: str) -> sp.Symbol:
    """Return the symbol of the given name in an expression, or a new one if the expression has none."""
    return next((s for s in expression.free_symbols if s.name == name), sp.Symbol(name, real=True))
