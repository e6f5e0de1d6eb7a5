"""Formulas as people print them: an immutable tree of our own, which no other library reads or evaluates.

A tree keeps what is printed: ``a - b`` stays a sum of ``a`` and ``-b``, ``a/b*c`` stays a product whose first factor
is a quotient. So an edit of the tree is an edit of the print.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TypeAlias, TypeVar, overload

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Num:
    """A number, exactly as printed: 0.5 is one half."""

    value: Fraction


@dataclass(frozen=True, slots=True)
class Sym:
    """A name."""

    name: str


@dataclass(frozen=True, slots=True)
class Neg:
    """An expression with a minus in front."""

    operand: Node


@dataclass(frozen=True, slots=True)
class Add:
    """A sum of two or more terms; a subtracted term is a :class:`Neg`."""

    terms: tuple[Node, ...]


@dataclass(frozen=True, slots=True)
class Mul:
    """A product of two or more factors."""

    factors: tuple[Node, ...]


@dataclass(frozen=True, slots=True)
class Div:
    """A quotient."""

    numerator: Node
    denominator: Node


@dataclass(frozen=True, slots=True)
class Pow:
    """A power."""

    base: Node
    exponent: Node


@dataclass(frozen=True, slots=True)
class Call:
    """A function of some arguments, by position and by name."""

    function: str
    arguments: tuple[Node, ...]
    named: tuple[tuple[str, Node], ...] = ()


@dataclass(frozen=True, slots=True)
class Text:
    """A text in quotes, such as an address."""

    value: str


@dataclass(frozen=True, slots=True)
class Grid:
    """A list, or a list of rows, in brackets."""

    entries: tuple[Node, ...]


Node: TypeAlias = Num | Sym | Neg | Add | Mul | Div | Pow | Call | Text | Grid

Path: TypeAlias = tuple[int, ...]
"""The place of a part in a tree: the place of a child, of its child, and so on."""


def grid(rows: Iterable[Iterable[Node]]) -> Grid:
    """Return the rows of a matrix as a node."""
    return Grid(tuple(Grid(tuple(row)) for row in rows))


def lines(node: Grid) -> list[tuple[Node, ...]]:
    """Return the rows of a matrix; an entry that is no list is a row of its own."""
    return [entry.entries if isinstance(entry, Grid) else (entry,) for entry in node.entries]


ZERO, ONE = Num(Fraction(0)), Num(Fraction(1))


@dataclass(frozen=True, slots=True)
class Equality:
    """``lhs = rhs`` as printed."""

    lhs: Node
    rhs: Node


Formula: TypeAlias = Node | Equality | tuple[tuple[Node, ...], ...]
"""A printed formula: an expression, an equality, or the rows of a matrix."""


def children(node: Node) -> tuple[Node, ...]:
    """Return the parts of a node, in printed order."""
    if isinstance(node, Neg):
        return (node.operand,)
    if isinstance(node, Add):
        return node.terms
    if isinstance(node, Mul):
        return node.factors
    if isinstance(node, Div):
        return (node.numerator, node.denominator)
    if isinstance(node, Pow):
        return (node.base, node.exponent)
    if isinstance(node, Call):
        return (*node.arguments, *(value for _, value in node.named))
    if isinstance(node, Grid):
        return node.entries
    return ()


def rebuilt(node: Node, parts: tuple[Node, ...]) -> Node:
    """Return the node with other parts in the same places."""
    if isinstance(node, Neg):
        return Neg(*parts)
    if isinstance(node, Add):
        return Add(parts)
    if isinstance(node, Mul):
        return Mul(parts)
    if isinstance(node, Div):
        return Div(*parts)
    if isinstance(node, Pow):
        return Pow(*parts)
    if isinstance(node, Call):
        count = len(node.arguments)
        names = (name for name, _ in node.named)
        return Call(node.function, parts[:count], tuple(zip(names, parts[count:], strict=True)))
    if isinstance(node, Grid):
        return Grid(parts)
    return node


def walk(node: Node, path: Path = ()) -> Iterator[tuple[Path, Node]]:
    """Yield every part of a tree with its path, the whole tree first."""
    yield path, node
    for i, child in enumerate(children(node)):
        yield from walk(child, (*path, i))


def replaced(node: Node, path: Path, new: Node) -> Node:
    """Return the tree with another part at a path."""
    if not path:
        return new
    parts = list(children(node))
    parts[path[0]] = replaced(parts[path[0]], path[1:], new)
    return rebuilt(node, tuple(parts))


def mapped(node: Node, function: Callable[[Node], Node | None]) -> Node:
    """Replace every part for which `function` returns a result; replaced parts are not entered."""
    found = function(node)
    if found is not None:
        return found
    parts = children(node)
    return rebuilt(node, tuple(mapped(part, function) for part in parts)) if parts else node


def substituted(node: Node, values: Mapping[str, Node]) -> Node:
    """Replace symbols of a tree by trees, all at once."""
    return mapped(node, lambda part: values.get(part.name) if isinstance(part, Sym) else None)


def symbols(node: Node) -> set[str]:
    """Return the names that occur in a tree."""
    return {part.name for _, part in walk(node) if isinstance(part, Sym)}


def size(node: Node) -> int:
    """Return the number of nodes of a tree."""
    return sum(1 for _ in walk(node))


def number(value: int | Fraction) -> Node:
    """Return the tree of a number; a negative one has its minus in front, a fraction is a quotient."""
    exact = Fraction(value)
    if exact < 0:
        return Neg(number(-exact))
    if exact.denominator == 1:
        return Num(exact)
    return Div(Num(Fraction(exact.numerator)), Num(Fraction(exact.denominator)))


def constant(node: Node) -> Fraction | None:
    """Return the value of a tree of numbers and small powers alone; ``None`` for any other."""
    if isinstance(node, Num):
        return node.value
    parts = [constant(child) for child in children(node)]
    values = [part for part in parts if part is not None]
    if len(values) < len(parts) or not parts:
        return None
    if isinstance(node, Neg):
        return -values[0]
    if isinstance(node, Add):
        return sum(values, Fraction(0))
    if isinstance(node, Div):
        return values[0] / values[1] if values[1] else None
    if isinstance(node, Mul):
        product = Fraction(1)
        for value in values:
            product *= value
        return product
    if isinstance(node, Pow) and values[1].denominator == 1 and abs(values[1]) <= 100:
        return values[0] ** int(values[1]) if values[0] or values[1] > 0 else None
    return None


def cells(formula: Formula | None) -> list[Node]:
    """Return the expressions in a formula: itself, both sides of an equality, or the entries of a matrix."""
    if formula is None:
        return []
    if isinstance(formula, tuple):
        return [entry for line in formula for entry in line]
    return [formula.lhs, formula.rhs] if isinstance(formula, Equality) else [formula]


def shaped(entries: Sequence[T], columns: int) -> tuple[tuple[T, ...], ...]:
    """Arrange entries of a matrix, given row by row, in rows."""
    return tuple(tuple(entries[i : i + columns]) for i in range(0, len(entries), columns))


@overload
def each(formula: Node | Equality, function: Callable[[Node], Node]) -> Node | Equality: ...
@overload
def each(formula: Formula, function: Callable[[Node], Node]) -> Formula: ...
def each(formula: Formula, function: Callable[[Node], Node]) -> Formula:
    """Replace each expression in a formula by the result of a function."""
    if isinstance(formula, tuple):
        return tuple(tuple(map(function, line)) for line in formula)
    if isinstance(formula, Equality):
        return Equality(function(formula.lhs), function(formula.rhs))
    return function(formula)


def names_in(formula: Formula | None) -> set[str]:
    """Return the names of all symbols in a formula."""
    return set().union(*map(symbols, cells(formula)))


def calls_in(formula: Formula | None) -> Iterator[Call]:
    """Return all function calls in a formula, from the outside inwards."""
    return (part for cell in cells(formula) for _, part in walk(cell) if isinstance(part, Call))
