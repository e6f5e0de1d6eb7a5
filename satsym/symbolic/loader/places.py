"""Where a derivation file states something: the line that a message about it names."""

from __future__ import annotations

import ast
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path

from satsym.symbolic.model import Model, Problem


def line_of(path: Path, subject: Problem | Model, named: Sequence[str]) -> int | None:
    """The line of the statement of a problem or its model at which something stands; ``None`` where none is known.

    Parameters
    ----------
    named
        Fields of the statement, or symbols, that the message is about, the likeliest first. Without any, or where none
        of them stands there, it is the line where the statement begins.
    """
    try:
        tree = ast.parse(path.read_text(encoding="utf-8"))
    except (OSError, SyntaxError, ValueError):
        return None
    model = subject.model if isinstance(subject, Problem) else subject
    calls = [call for name in (subject.name, model.name) for call in _statements(tree, name)]
    fields = [k for name in named for call in calls for k in call.keywords if k.arg == name]
    rows = [
        value
        for k in fields
        if isinstance(k.value, ast.Dict)
        for key, value in zip(k.value.keys, k.value.values, strict=True)
        if isinstance(key, ast.Name) and key.id in named
    ]
    if rows:
        return rows[0].lineno
    within = [*(k.value for k in fields), *calls]
    found = next((line for node in within for line in _mentions(node, named)), None)
    if found is None and fields:
        return fields[0].value.lineno
    if found is None:
        found = next(_mentions(tree, named), None)
    return found if found is not None or not calls else calls[0].lineno


def _statements(tree: ast.Module, name: str) -> Iterator[ast.Call]:
    """Calls that state something of this name."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            keywords = {k.arg: k.value for k in node.keywords}
            stated = keywords.get("name")
            if isinstance(stated, ast.Constant) and stated.value == name:
                yield node


def _mentions(node: ast.AST, named: Collection[str]) -> Iterator[int]:
    """Lines at which one of these names is used, as a variable or in quotes, from the top."""
    lines = []
    for each in ast.walk(node):
        used = each.id if isinstance(each, ast.Name) else each.value if isinstance(each, ast.Constant) else None
        if isinstance(used, str) and used in named and isinstance(each, ast.expr):
            lines.append(each.lineno)
    yield from sorted(lines)
