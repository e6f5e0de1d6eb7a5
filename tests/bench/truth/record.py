"""Answers kept line by line, so that a bench broken off goes on; independent ones outlive changes of satsym."""

from __future__ import annotations

import ast
import hashlib
import json
from collections.abc import Callable, Iterable
from functools import cache
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[3]
HERE = Path(__file__).resolve().parent
FOLDER = ROOT / "results" / "truth"
SATSYM = ("satsym/**/*.py", "generated/*.py", "tests/bench/truth/models/*.py")
USED = {
    "multistart": ("multistart", "collocate", "simulate", "starts", "physics"),
    "duality": ("duality", "linear", "physics"),
    "programs": ("programs", "linear", "physics"),
    "closed": ("closed", "linear", "physics"),
}
"""What an independent answer depends on, by the module that gives it."""


class Record:
    """Rows of one side by key; a key of another revision, or of a case drawn otherwise, counts as missing."""

    def __init__(self, name: str) -> None:
        self.path = FOLDER / f"{name}.jsonl"
        self.rows: dict[str, dict[str, Any]] = {}
        if self.path.exists():
            for line in self.path.read_text(encoding="utf-8").splitlines(keepends=True):
                if line.endswith("\n"):  # one without its line end was broken off
                    row = json.loads(line)
                    self.rows[row["key"]] = row

    def get(self, key: str, text: str, revision: str | None) -> dict[str, Any] | None:
        """The row of an instance; ``revision`` ``None`` takes any."""
        row = self.rows.get(key)
        if row is None or row["case"] != digest(text) or revision not in (None, row["revision"]):
            return None
        return row

    def add(self, key: str, text: str, revision: str, values: dict[str, Any]) -> dict[str, Any]:
        """Put a row to the end."""
        row = {"key": key, "case": digest(text), "revision": revision, **values}
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with self.path.open("a", encoding="utf-8") as file:
            file.write(json.dumps(row) + "\n")
        self.rows[key] = row
        return row


def digest(text: str) -> str:
    """Eight digits that stand for a text."""
    return hashlib.sha256(text.encode()).hexdigest()[:8]


@cache
def of_satsym() -> str:
    """The revision of satsym's side."""
    paths = sorted(path for pattern in SATSYM for path in ROOT.glob(pattern))
    return digest("".join(path.relative_to(ROOT).as_posix() + path.read_text(encoding="utf-8") for path in paths))


def of_truth(answered: Callable[..., Any]) -> str:
    """The revision of an independent method: of what its sources do, not of how they are laid out."""
    return _of_modules(USED[answered.__module__.rpartition(".")[2]])


@cache
def _of_modules(names: Iterable[str]) -> str:
    return digest("".join(_meaning(HERE / f"{name}.py") for name in names))


def _meaning(path: Path) -> str:
    """A source without comments and docstrings."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        if (
            isinstance(body, list)
            and body
            and isinstance(body[0], ast.Expr)
            and isinstance(body[0].value, ast.Constant)
        ):
            body[0].value = ast.Constant("")
    return ast.unparse(tree)
