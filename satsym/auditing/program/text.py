"""A printed Python program as text and syntax tree, and the dependencies between its names.

The text is parsed and its length measured, but never executed; :mod:`satsym.auditing.program.run` interprets the tree.
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
    """A printed program would stop here with an error, as in Python."""


@dataclass(frozen=True, eq=False)
class Program:
    """A printed program with its parsed statements."""

    text: str
    """Printed lines of the program, joined by line breaks."""
    statements: tuple[ast.stmt, ...]
    """Parsed statements of the program, in order."""

    def line(self, node: ast.AST) -> str:
        """Return the printed line on which a node of the syntax tree begins."""
        return self.text.splitlines()[getattr(node, "lineno", 1) - 1].strip()


def read(lines: Sequence[object]) -> Program:
    """Parse a program given as lines.

    Raises
    ------
    BadInput
        If the text is too long, nested too deeply, or not Python.
    """
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
    """Return the names that have no value when they are used, in the order of the lines.

    The body of a function may use all names of the program, as it runs only when the function is called.
    """
    everywhere = {name for statement in program.statements for name in given_names(statement)}
    known, found = set(dir(builtins)), []
    for statement in program.statements:
        inside = known | everywhere if isinstance(statement, ast.FunctionDef) else known
        found += [name for name in _used_names(statement) if name not in inside]
        known |= set(given_names(statement))
    return found


def given_names(statement: ast.stmt) -> list[str]:
    """Return the names to which a statement assigns a value."""
    if isinstance(statement, ast.Import | ast.ImportFrom):
        return [(alias.asname or alias.name).partition(".")[0] for alias in statement.names]
    if isinstance(statement, ast.FunctionDef):
        return [statement.name]
    return [
        node.id for node in ast.walk(statement) if isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load)
    ]


def sources(program: Program, names: Iterable[str]) -> set[str]:
    """Return the names on which the values of some names depend, directly or not; a function depends on its body."""
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
    """Return the names that an expression uses."""
    return {part.id for part in ast.walk(node) if isinstance(part, ast.Name) and isinstance(part.ctx, ast.Load)}


def _used_names(statement: ast.stmt) -> Iterator[str]:
    """Yield the names that a statement uses from outside: neither its parameters nor assigned within it."""
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
