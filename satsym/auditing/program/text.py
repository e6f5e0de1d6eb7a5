"""A printed Python program: its text is parsed and measured, never executed; what its names refer to.

What it does is found by :mod:`satsym.auditing.program.run`, which walks the tree that is read here and knows a few
kinds of statements and expressions only.
"""

from __future__ import annotations

import ast
import builtins
import warnings
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from satsym.status import BadInput
from satsym.wording import shown

MAX_LENGTH = 20_000
MAX_DEPTH = 50


class Stops(BadInput):
    """The program would stop here with an error, as Python would say, too."""


@dataclass(frozen=True, eq=False)
class Program:
    """A program as it is printed, and the statements Python's parser finds in it."""

    text: str
    """Its lines, joined."""
    statements: tuple[ast.stmt, ...]
    """From first to last."""

    def line(self, node: ast.AST) -> str:
        """The printed line that a node begins on."""
        return self.text.splitlines()[getattr(node, "lineno", 1) - 1].strip()


def read(lines: Sequence[object]) -> Program:
    """Parse a program."""
    text = "\n".join(str(line) for line in lines)
    depth = 0
    for character in text:
        depth += (character in "([{") - (character in ")]}")
        if depth > MAX_DEPTH:
            raise BadInput(f"the program nests brackets more than {MAX_DEPTH} levels deep")
    if len(text) > MAX_LENGTH:
        raise BadInput(f"the program has more than {MAX_LENGTH} characters")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return Program(text, tuple(ast.parse(text).body))
    except SyntaxError as error:
        raise BadInput(f"line {error.lineno} of the program, {shown(error.text or '')}: not Python") from None
    except (RecursionError, MemoryError, ValueError):
        raise BadInput("the program is nested too deeply") from None


def loose_names(program: Program) -> list[str]:
    """Names that have no value yet where they are used, in the order of the lines.

    The body of a function is looked at with what the whole program defines, for it runs when it is called.
    """
    everywhere = {name for statement in program.statements for name in given_names(statement)}
    known, found = set(dir(builtins)), []
    for statement in program.statements:
        inside = known | everywhere if isinstance(statement, ast.FunctionDef) else known
        found += [name for name in _used_names(statement) if name not in inside]
        known |= set(given_names(statement))
    return found


def given_names(statement: ast.stmt) -> list[str]:
    """Names to which a statement gives a value."""
    if isinstance(statement, ast.Import | ast.ImportFrom):
        return [(alias.asname or alias.name).partition(".")[0] for alias in statement.names]
    if isinstance(statement, ast.FunctionDef):
        return [statement.name]
    return [
        node.id for node in ast.walk(statement) if isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load)
    ]


def sources(program: Program, names: Iterable[str]) -> set[str]:
    """Names that the values of some names are made from, directly or not; a function from what its body uses."""
    made_from: dict[str, set[str]] = {}
    for statement in program.statements:
        for name in given_names(statement):
            made_from.setdefault(name, set()).update(_used_names(statement))
    found, left = set(), list(names)
    while left:
        name = left.pop()
        if name not in found:
            found.add(name)
            left += made_from.get(name, ())
    return found


def names_in(node: ast.AST) -> set[str]:
    """Names that an expression uses."""
    return {part.id for part in ast.walk(node) if isinstance(part, ast.Name) and isinstance(part.ctx, ast.Load)}


def _used_names(statement: ast.stmt) -> Iterator[str]:
    """Names that come from outside a statement: neither parameters of a function nor given in it."""
    own: set[str] = set()
    for node in ast.walk(statement):
        if isinstance(node, ast.arg):
            own.add(node.arg)
        elif isinstance(node, ast.comprehension):
            own.update(part.id for part in ast.walk(node.target) if isinstance(part, ast.Name))
    if isinstance(statement, ast.FunctionDef):
        own.update(name for inner in statement.body for name in given_names(inner))
    for node in ast.walk(statement):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load) and node.id not in own:
            yield node.id
