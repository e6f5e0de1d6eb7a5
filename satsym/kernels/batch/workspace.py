"""Workspaces: one flat array for all numbers of a block of columns, at places fixed when code is written.

With constant places the compiler need not check whether two rows overlap, and a loop over the columns of a block
becomes vector instructions. Code that calls a function for each column hardly ever does; so the body of a generated
scalar function is written into such a loop, line by line, under names of its own.
"""

from __future__ import annotations

import ast
import copy
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache

from satsym.kernels.bodies import recursing_through

LANES = 16
"""Number of columns of a block: several vectors, so that the processor overlaps their divisions."""


@dataclass
class Workspace:
    """The places of the rows of a block."""

    size: int = 0
    """Number of places reserved so far."""
    places: dict[str, int] = field(default_factory=dict)
    """Name -> position of the first of the reserved rows."""

    def place(self, name: str, rows: int) -> int:
        """Reserve a number of new rows, and return their place."""
        begin = self.places[name] = self.size
        self.size += rows * LANES
        return begin

    def __getitem__(self, name: str) -> int:
        return self.places[name]


def element(begin: int | str, row: int) -> str:
    """Write the entry of a row in the current column."""
    return f"w[{begin} + {row * LANES} + j]"


def over_lanes(lines: Sequence[str]) -> list[str]:
    """Write a loop over the columns of a block around some lines."""
    return [f"for j in range({LANES}):", *indented(lines)]


def over_rows(rows: int, lines: Sequence[str]) -> list[str]:
    """Write a loop over the entries ``q`` of several rows, all columns of which lie together in memory."""
    return [f"for q in range({rows * LANES}):", *indented(lines)]


def indented(lines: Sequence[str]) -> list[str]:
    """Indent lines by one level."""
    return [f"    {line}" for line in lines]


def function(head: str, lines: Sequence[str]) -> list[str]:
    """Write a function with a head and lines."""
    return ["", "", f"def {head}:", *indented(lines)]


def over_blocks(columns: str, lines: Sequence[str]) -> list[str]:
    """Write a loop over blocks of columns ``at``, ``at + 1``, ..., of which ``width`` exist."""
    head = [f"for at in range(0, {columns}, {LANES}):", f"    width = min({LANES}, {columns} - at)"]
    return [*head, *indented(lines)]


def lanes_of(target: str, source: str) -> list[str]:
    """Write ``target = source`` for each column of a block; the last column stands in for missing ones.

    In the source the column is ``{column}``. Full blocks are read as vectors, which incomplete ones cannot be.
    """
    return [
        f"if width == {LANES}:",
        *indented(over_lanes([f"{target} = {source.format(column='at + j')}"])),
        "else:",
        *indented(over_lanes([f"{target} = {source.format(column='at + min(j, width - 1)')}"])),
    ]


def loaded(begin: int, source: str, rows: int) -> list[str]:
    """Write the copy of an array's rows into the workspace."""
    if not rows:
        return []
    take = lanes_of(f"w[{begin} + i * {LANES} + j]", f"{source}[i, {{column}}]")
    return [f"for i in range({rows}):", *indented(take)]


def stored(begin: int, target: str, rows: int) -> list[str]:
    """Write the copy of workspace rows into an array."""
    give = f"{target}[i, at + j] = w[{begin} + i * {LANES} + j]"
    return [
        f"for i in range({rows}):",
        f"    if width == {LANES}:",
        *indented(indented(over_lanes([give]))),
        "    else:",
        "        for j in range(width):",
        f"            {give}",
    ]


Loads = Mapping[str, Callable[[int], str]]
"""Argument of a function -> function from the index of a component to the expression that loads it."""

KEPT = frozenset({"math", "range", "float"})
"""Names in the body of a function that are not renamed."""


@dataclass(frozen=True)
class Inlined:
    """Lines of an inlined function, and the expressions of its results, row by row."""

    lines: tuple[str, ...]
    results: tuple[str, ...]

    @property
    def nonzero(self) -> list[int]:
        """Return the places of results that are not identically zero."""
        return [k for k, result in enumerate(self.results) if result != "0.0"]


def inlined(text: str, function: str, loads: Loads, prefix: str) -> Inlined:
    """Return a function of a module's text as lines for a loop over columns.

    Parameters
    ----------
    text
        Text of a generated module.
    function
        Name of a scalar form.
    loads
        Expressions for the arguments of the function.
    prefix
        Prefix of all names in the lines.
    """
    definition = _definition(text, function)
    arguments = {argument.arg for argument in definition.args.args}
    renamed = _Renamed({name: loads[name](0) for name in arguments if name == "t"}, prefix)
    lines: list[str] = []
    *statements, last = definition.body[1:]
    with recursing_through(definition):
        for statement in statements:
            match statement:
                case ast.Assign(targets=[ast.Tuple(elts=targets)], value=ast.Name(id=group)) if group in arguments:
                    lines += [f"{prefix}{ast.unparse(name)} = {loads[group](k)}" for k, name in enumerate(targets)]
                case _:
                    lines += ast.unparse(renamed.visit(statement)).splitlines()
        assert isinstance(last, ast.Return)
        value = last.value
        results: Sequence[ast.expr] = value.elts if isinstance(value, ast.Tuple) else [value] if value else []
        return Inlined(tuple(lines), tuple(ast.unparse(renamed.visit(one)) for one in results))


class _Renamed(ast.NodeTransformer):
    """Prefixes every name, except those that are replaced by an expression."""

    def __init__(self, given: Mapping[str, str], prefix: str) -> None:
        self.given, self.prefix = given, prefix

    def visit_Name(self, node: ast.Name) -> ast.expr:
        if node.id in KEPT:
            return node
        return ast.Name(self.given.get(node.id, self.prefix + node.id), node.ctx)


@lru_cache(maxsize=8)
def _parsed(text: str) -> dict[str, ast.FunctionDef]:
    return {each.name: each for each in ast.parse(text).body if isinstance(each, ast.FunctionDef)}


def _definition(text: str, name: str) -> ast.FunctionDef:
    """Return a fresh syntax tree of a function each time, because renaming changes it."""
    return copy.deepcopy(_parsed(text)[name])
