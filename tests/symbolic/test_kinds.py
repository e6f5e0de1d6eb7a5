"""What is special about a kind of model is known in symbolic/kinds/ and nowhere else."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

import satsym
from satsym.symbolic import Model

KINDS = Path(satsym.__file__).parent / "symbolic" / "kinds"


def kinds() -> set[str]:
    """Classes of models in kinds/."""

    def below(kind: type[Model]) -> Iterator[type[Model]]:
        for child in kind.__subclasses__():
            yield from (child, *below(child))

    return {kind.__name__ for kind in below(Model) if kind.__module__.startswith("satsym.symbolic.kinds")}


def told_apart_by(source: str, known: set[str]) -> list[str]:
    """What a program tells kinds apart by: names of kinds where instances, classes or cases are compared."""
    found = []
    for node in ast.walk(ast.parse(source)):
        inspected: list[ast.AST] = []
        if (
            isinstance(node, ast.Call)
            and isinstance(node.func, ast.Name)
            and node.func.id in ("isinstance", "issubclass")
        ):
            inspected = [*node.args[1:]]
        elif isinstance(node, ast.Compare):
            inspected = [node.left, *node.comparators]
        elif isinstance(node, ast.MatchClass):
            inspected = [node.cls]
        elif isinstance(node, ast.Dict):
            inspected = [key for key in node.keys if key]
        for part in inspected:
            for leaf in ast.walk(part):
                name = leaf.id if isinstance(leaf, ast.Name) else leaf.attr if isinstance(leaf, ast.Attribute) else None
                name = leaf.value if isinstance(leaf, ast.Constant) and isinstance(leaf.value, str) else name
                found += [name] if name in known else []
    return found


def test_no_module_outside_kinds_tells_kinds_apart() -> None:
    known = kinds()
    assert {"Newton", "FirstOrder", "Linearised", "Gyrostat", "Scaled", "Reduced", "ClosedLoop"} <= known
    sources = [path for path in Path(satsym.__file__).parent.rglob("*.py") if KINDS not in path.parents]
    assert len(sources) > 300
    texts = {str(path): path.read_text(encoding="utf-8") for path in sources}
    found = {path: told_apart_by(text, known) for path, text in texts.items() if any(name in text for name in known)}
    assert {path: names for path, names in found.items() if names} == {}


@pytest.mark.parametrize(
    "source",
    [
        "isinstance(model, Newton)",
        "isinstance(model, kinds.Newton | Scaled)",
        "type(model) is Newton",
        "type(model).__name__ == 'Newton'",
        "{Newton: 1}[type(model)]",
        "match model:\n    case Newton():\n        pass",
    ],
)
def test_ways_to_tell_kinds_apart_are_found(source: str) -> None:
    assert "Newton" in told_apart_by(source, kinds())
