"""Sentences are for people: what they say of an outcome is decided by enums and numbers, never read back from them."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from tests.support.said import tree

PROSE = {"message", "reason", "origin", "way"}
READ = {"startswith", "endswith", "find", "partition", "split"}


def steering(module: ast.Module) -> list[int]:
    """Lines where the text of an outcome decides on what happens next."""
    found = []
    for node in ast.walk(module):
        if isinstance(node, ast.Compare):
            sides = [node.left, *node.comparators]
            texts = any(
                isinstance(part, ast.Constant) and isinstance(part.value, str) for s in sides for part in ast.walk(s)
            )
            found += [node.lineno] if texts and any(_outcome(side) for side in sides) else []
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in READ:
            found += [node.lineno] if _outcome(node.func.value) else []
    return found


def _outcome(node: ast.AST) -> bool:
    name = node.attr if isinstance(node, ast.Attribute) else node.id if isinstance(node, ast.Name) else ""
    return name in PROSE


@pytest.mark.parametrize("floor", ["solvers", "instance", "analysis"])
def test_no_sentence_steers_the_program(floor: str, repository: Path) -> None:
    files = sorted((repository / "satsym" / floor).rglob("*.py"))
    assert files
    assert [f"{file}:{line}" for file in files for line in steering(tree(file))] == []


@pytest.mark.parametrize(
    "source",
    ['start.way == "none"', 'found.reason.startswith("no")', 'one.reason in ("minimum", "saddle")', 'way != "last"'],
)
def test_a_sentence_that_steers_would_be_seen(source: str) -> None:
    assert steering(ast.parse(source)) == [1]
