"""Derivations by the names that addresses begin with, and their things in the notation of one document.

Each is derived once. Symbols of several derivations that have the same name are one symbol; it is positive only if
all of them say so.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, cached_property
from typing import TypeAlias

import sympy as sp

from satsym.formula.budget import exempt
from satsym.formula.tree import Node
from satsym.formula.values import Matrix, Relation, Value
from satsym.status import BadInput
from satsym.symbolic import dimensions, loader
from satsym.symbolic.algebra import definitions_of
from satsym.symbolic.declared import begin
from satsym.symbolic.derivation import Derivation, DerivationError, Equation
from satsym.symbolic.dimensions import Known
from satsym.symbolic.lookup import addresses
from satsym.symbolic.lookup.formulas import NotAFormula, from_tree, in_symbols, plain, to_tree
from satsym.symbolic.model import variables_of
from satsym.symbolic.pipeline import derive
from satsym.wording import shown, suggestion

Order: TypeAlias = Callable[[tuple[str, ...]], tuple[int, ...]]
"""Names of rows or columns -> their places in the order of a document."""


@cache
def derivation(name: str) -> Derivation:
    """The derivation of a shipped problem or model.

    Raises
    ------
    BadInput
        If there is none, or a file cannot be derived from.
    """
    with exempt():
        found = {problem.name: problem for path in loader.shipped() for problem in loader.load(path)}
        if name not in found:
            raise BadInput(f"no derivation {shown(name)}; {suggestion(name, found)}")
        try:
            return derive(found[name])
        except DerivationError as error:
            raise BadInput(" ".join(str(error).split())) from error


@cache
def known_dimensions(name: str) -> Known:
    """Dimensions of all names of a derivation."""
    found = derivation(name)
    with exempt():
        known = dimensions.declared(begin(found.model, found.problem))
        for step in found.steps:
            known = dimensions.extended(known, step)
    return known


@dataclass(frozen=True)
class Names:
    """The names that some derivations, and a ledger, have."""

    symbols: Mapping[str, sp.Symbol]
    """Name -> symbol, with what is assumed of it."""
    definitions: Mapping[str, sp.Expr]
    """Named constants -> their values, which are put in wherever they occur."""

    @cached_property
    def positive(self) -> frozenset[str]:
        """Names of positive symbols."""
        return frozenset(name for name, symbol in self.symbols.items() if symbol.is_positive)

    def expression(self, name: str) -> sp.Expr:
        """What a name stands for."""
        if name in ("I", "pi"):
            return sp.I if name == "I" else sp.pi
        return self.definitions[name] if name in self.definitions else self.symbols[name]

    def tree(self, name: str) -> Node:
        """Return the expression of a name as a tree."""
        return to_tree(self.expression(name))


def names(models: Iterable[str], own: Mapping[str, bool]) -> Names:
    """The names of some derivations and those of a ledger's own, each with whether it is positive."""
    positive: dict[str, bool] = {}
    definitions: dict[str, sp.Expr] = {}
    for model in models:
        found = derivation(model)
        equations = [e for step in found.steps for e in step.equations]
        for symbol in set().union(*(e.lhs.free_symbols | e.rhs.free_symbols for e in equations)):
            positive[symbol.name] = positive.get(symbol.name, True) and bool(symbol.is_positive)
        for variable in variables_of(found.model):
            positive[variable.symbol] = positive.get(variable.symbol, True) and variable.positive
        for name in found.notation:
            positive.setdefault(name, False)
        definitions |= {symbol.name: value for symbol, value in definitions_of(found.model).items()}
    positive = {**own, **positive}
    symbols = {name: sp.Symbol(name, real=True, positive=True if flag else None) for name, flag in positive.items()}
    shared = {name: in_symbols(sp.sympify(value), symbols) for name, value in definitions.items()}
    return Names(symbols, shared)


def named(name: str, shared: Names) -> sp.Expr:
    """A name as a symbol, defined or not.

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
    """The thing at an address, in shared symbols, a matrix in the order of the document.

    Raises
    ------
    BadInput
        If there is none.
    """
    found = addresses.resolve(derivation(address.partition(":")[0]), address)
    if isinstance(found, Equation) and isinstance(found.rhs, sp.MatrixBase):
        return Matrix(tuple(tuple(_shared(entry, shared) for entry in row) for row in found.rhs.tolist()))
    if isinstance(found, Equation):
        return Relation(_shared(found.lhs, shared), _shared(found.rhs, shared))
    if isinstance(found, addresses.Family):
        rows, columns = order(found.rows), order(found.columns)
        return Matrix(tuple(tuple(_shared(found.entries[i][j], shared) for j in columns) for i in rows))
    return _shared(found, shared)


def in_trees(value: Value) -> Value:
    """A derived thing as trees.

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


def _shared(expression: sp.Expr, shared: Names) -> sp.Expr:
    values = {**shared.symbols, **shared.definitions}
    return plain(in_symbols(sp.sympify(expression), values))


def dimensions_of(models: Iterable[str], own: Mapping[str, str]) -> Known:
    """Dimensions of the names of some derivations, and of those that a ledger gives a unit."""
    known: dict[str, dimensions.Dimension | None] = {}
    for model in models:
        for name, dimension in known_dimensions(model).items():
            known.setdefault(name, dimension)
    for name, unit in own.items():
        if unit:
            known[name] = dimensions.of_unit(unit)
    return known


def inhomogeneity(sides: Iterable[sp.Expr], known: Known) -> tuple[str, ...]:
    """Why expressions that ought to be equal cannot be, by their dimensions; empty where they can, or nobody knows.

    Otherwise it is the kind of fault, and what it puts together.
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
    """Dimension of an expression; ``None`` for zero.

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
    """A dimension for people."""
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
    "known_dimensions",
    "named",
    "names",
    "written_dimension",
]
