"""What the program says, as its source has it: texts that are looked up, and texts of which messages are made."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import click

import satsym

SOURCE = Path(satsym.__file__).parent
HOLE = re.compile(r"<([a-z_]+)>")
ENGLISH = re.compile(
    r"\b(the|of|and|with|for|from|to|by|at|are|has|no|not|on|states?|control|costs?|final|initial|unit|value|written|"
    r"costate|given|free|eigenvalues?|iterations?|circle|ellipse|unstable|ok|failed|certified|converged)\b"
)
"""Words that no Indonesian text has."""


@cache
def tree(path: Path) -> ast.Module:
    """The syntax of a file, parsed once for all tests of a process."""
    return ast.parse(path.read_text("utf-8"))


def _trees() -> Iterator[ast.Module]:
    return (tree(path) for top in (SOURCE, SOURCE.parent / "derivations") for path in sorted(top.rglob("*.py")))


def _literals(node: ast.expr) -> Iterator[str]:
    """Texts that an argument may be."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield node.value
    if isinstance(node, ast.IfExp):
        yield from _literals(node.body)
        yield from _literals(node.orelse)


@cache
def looked_up() -> frozenset[str]:
    """Texts given to ``say``, ``each`` and ``counted`` of satsym.report.said, wherever these stand there themselves."""
    found = set[str]()
    for module in _trees():
        nodes = [node for node in ast.walk(module) if isinstance(node, ast.ImportFrom | ast.Call)]
        imported = {
            name.asname or name.name
            for node in nodes
            if isinstance(node, ast.ImportFrom) and node.module in ("satsym.report.said", "satsym.report")
            for name in node.names
        }
        for node in nodes if imported else ():
            if not isinstance(node, ast.Call):
                continue
            called = node.func
            if isinstance(called, ast.Attribute) and isinstance(called.value, ast.Name) and called.value.id == "said":
                name = called.attr
            elif isinstance(called, ast.Name) and called.id in imported:
                name = called.id
            else:
                continue
            given = {"say": node.args[:1], "each": node.args, "counted": node.args[1:2]}.get(name, [])
            found.update(text for argument in given for text in _literals(argument))
    return frozenset(found)


@cache
def written() -> frozenset[str]:
    """Every text in the source, and in that of click, with ``<>`` where a formatted one has a value."""
    found = set[str]()
    used = (ast.parse(path.read_text("utf-8")) for path in Path(click.__file__).parent.glob("*.py"))
    for module in (*_trees(), *used):
        for node in ast.walk(module):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                found.add(anonymous(node.value))
            elif isinstance(node, ast.JoinedStr):
                found.add(template(node))
    found |= {text.removeprefix(before) for text in found for before in ("<> ", "<>; ")}
    return frozenset(found.union(*map(runs_of_clauses, found)))


REFUSALS = {
    *("BadInput", "DerivationError", "Disagreement", "MissingText", "NotAFormula", "Refused", "Stopped"),
    *("TooManyTerms", "Unexpected", "WrongKey", "again", "unusable", "_bad", "_refusal"),
}
"""What carries a text to people; the other errors are for callers in Python, or become one of these."""


@cache
def refused() -> frozenset[str]:
    """Texts that refusals are raised with, with ``<>`` for each value; what has no space is a key."""
    found = set[str]()
    for tree in _trees():
        for node in ast.walk(tree):
            if not isinstance(node, ast.Raise) or not isinstance(node.exc, ast.Call):
                continue
            raised = node.exc.func
            name = raised.id if isinstance(raised, ast.Name) else getattr(raised, "attr", "")
            given = [*node.exc.args, *(word.value for word in node.exc.keywords)] if name in REFUSALS else []
            texts = [text for argument in given for text in _literals(argument)]
            texts += [template(argument) for argument in given if isinstance(argument, ast.JoinedStr)]
            found.update(text for text in texts if " " in text and re.search("[a-z]{3}", text))
    return frozenset(found)


def runs_of_clauses(text: str) -> set[str]:
    """Its clauses, and what neighbours among them say together."""
    parts = re.split(r"(; |(?<=[.:]) )", text)
    ends = range(0, len(parts), 2)
    return {"".join(parts[begin : end + 1]) for begin in ends for end in ends if begin <= end}


def anonymous(text: str) -> str:
    """A text with ``<>`` for each place in it, and for several in a row."""
    return re.sub(r"(?:<>)+", "<>", re.sub(r"\{[^{}]*\}", "<>", HOLE.sub("<>", text)))


def template(node: ast.JoinedStr) -> str:
    """A formatted text with ``<>`` for each of its values."""
    return anonymous("".join(str(part.value) if isinstance(part, ast.Constant) else "<>" for part in node.values))
