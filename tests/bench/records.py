"""Outcomes of a long study, kept case by case, so that one broken off goes on where it stopped.

A record belongs to the sources that made it: when they change, another is begun.
"""

from __future__ import annotations

import csv
import hashlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
SOURCES = ("satsym/**/*.py", "satsym/**/*.toml", "generated/*.py", "tests/samples.py", "tests/bench/returns.py")


def place(study: str) -> Path:
    """Where the record of a study by today's sources lies, below results/ (`make clean` removes it)."""
    digest = hashlib.sha256()
    for pattern in SOURCES:
        for path in sorted(ROOT.glob(pattern)):
            digest.update(path.relative_to(ROOT).as_posix().encode() + path.read_bytes())
    return ROOT / "results" / "returns" / f"{study}-{digest.hexdigest()[:8]}.csv"


def read(path: Path) -> Iterator[dict[str, str]]:
    """The rows written whole; none if there is no record yet."""
    if path.exists():
        # A row without its line end was broken off.
        lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
        yield from csv.DictReader(line for line in lines if line.endswith("\n"))


def add(path: Path, row: dict[str, Any]) -> None:
    """Put a row to the end, below a heading if it is the first."""
    path.parent.mkdir(parents=True, exist_ok=True)
    fresh = not path.exists()
    with path.open("a", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, row, lineterminator="\n")
        if fresh:
            writer.writeheader()
        writer.writerow(row)
