"""The body of a generated scalar function as lines that stand in another function, under names of their own.

What calls a function for each column of an array hardly ever becomes vector instructions; a loop over a known number of
columns with the straight-line body in it does.
"""

from __future__ import annotations

import ast
import copy
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

Loads = Mapping[str, Callable[[int], str]]
"""By argument: the expression of each of its components; of a number that of the component 0."""

KEPT = frozenset({"math", "range", "float"})
"""Names that a body shares with its surroundings."""


@dataclass(frozen=True)
class Inlined:
    """Lines that compute, and the expressions of what is returned, row by row."""

    lines: tuple[str, ...]
    results: tuple[str, ...]

    @property
    def nonzero(self) -> list[int]:
        """Places of results that are not always zero."""
        return [k for k, result in enumerate(self.results) if result != "0.0"]


def inlined(text: str, function: str, loads: Loads, prefix: str) -> Inlined:
    """A function of a module's text.

    Parameters
    ----------
    text
        Of a generated module.
    function
        Name of a scalar form.
    loads
        Where its arguments come from.
    prefix
        Of all names in the lines.
    """
    definition = _definition(text, function)
    arguments = {argument.arg for argument in definition.args.args}
    renamed = _Renamed({name: loads[name](0) for name in arguments if name == "t"}, prefix)
    lines: list[str] = []
    *statements, last = definition.body[1:]
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
    """Every name with a prefix, but for those that stand for something else."""

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
    """A fresh one each time: renaming changes it."""
    return copy.deepcopy(_parsed(text)[name])
