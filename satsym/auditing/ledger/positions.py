"""Where in its files a table or a key of a ledger stands, for messages: the library that reads TOML does not say."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from satsym.wording import printable

_HEADER = re.compile(r"\s*+\[\[?([^\[\]]++)\]\]?\s*+(?:#.*)?$")
"""Possessive, so that a line of nothing but spaces after a bracket is gone through once."""
_KEY = re.compile(r"""\s*("[^"]*"|'[^']*'|[A-Za-z0-9_-]+)\s*=""")
_DELIMITER = re.compile(r'"""|' + r"'''")


@dataclass(frozen=True)
class Part:
    """A file of a ledger."""

    path: Path
    tree: dict[str, Any]
    """And what is in it."""
    first: int
    """Number of the rows in the files before it."""

    @cached_property
    def _lines(self) -> dict[tuple[str, int, str], int]:
        return lines(self.path.read_text(encoding="utf-8-sig"))  # only read where a place is asked for

    def place(self, table: str, index: int = 0, key: str = "") -> str:
        """File and line of a key in the n-th table of a name in the whole ledger, else of the table, else the first."""
        own, found = index - self.first if table == "row" else index, self._lines
        line = found.get((table, own, key)) or found.get((table, own, ""), 1)
        return f"{printable(str(self.path), 200)}:{line}"


def lines(text: str) -> dict[tuple[str, int, str], int]:
    """Line numbers, from 1, in a text that is valid TOML: of the n-th table of a name, and of each key in it."""
    found: dict[tuple[str, int, str], int] = {}
    seen: Counter[str] = Counter([""])
    table, inside = "", ""
    for number, line in enumerate(text.splitlines(), start=1):
        if not inside:
            header, key = _HEADER.match(line), _KEY.match(line)
            if header:
                table = "".join(header[1].split())
                found[table, seen[table], ""] = number
                seen[table] += 1
            elif key:
                found.setdefault((table, seen[table] - 1, key[1].strip("\"'")), number)
        for delimiter in _DELIMITER.findall(line):
            inside = "" if inside == delimiter else inside or delimiter
    return found
