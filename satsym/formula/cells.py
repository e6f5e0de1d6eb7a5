"""Formulas as they are printed: an expression, an equality, or the rows of a matrix; what is done to each part."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TypeAlias, TypeVar, overload

from satsym.formula.tree import Call, Equality, Node, calls, symbols

T = TypeVar("T")
Formula: TypeAlias = Node | Equality | tuple[tuple[Node, ...], ...]


def cells(formula: Formula | None) -> list[Node]:
    """An expression, both sides of an equality, or the entries of a matrix; nothing of nothing."""
    if formula is None:
        return []
    if isinstance(formula, tuple):
        return [entry for line in formula for entry in line]
    return [formula.lhs, formula.rhs] if isinstance(formula, Equality) else [formula]


def shaped(entries: Sequence[T], columns: int) -> tuple[tuple[T, ...], ...]:
    """Entries of a matrix, row by row, as its rows."""
    return tuple(tuple(entries[i : i + columns]) for i in range(0, len(entries), columns))


@overload
def each(formula: Node | Equality, function: Callable[[Node], Node]) -> Node | Equality: ...
@overload
def each(formula: Formula, function: Callable[[Node], Node]) -> Formula: ...
def each(formula: Formula, function: Callable[[Node], Node]) -> Formula:
    """The formula with another expression in the place of each part."""
    if isinstance(formula, tuple):
        return tuple(tuple(map(function, line)) for line in formula)
    if isinstance(formula, Equality):
        return Equality(function(formula.lhs), function(formula.rhs))
    return function(formula)


def names_in(formula: Formula | None) -> set[str]:
    """Names of all symbols."""
    return set().union(*map(symbols, cells(formula)))


def calls_in(formula: Formula | None) -> Iterator[Call]:
    """All calls of functions."""
    for cell in cells(formula):
        yield from calls(cell)
