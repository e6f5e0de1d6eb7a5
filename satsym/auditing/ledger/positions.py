"""Where in its files a table or a key of a ledger stands, for messages: the library that reads TOML does not say."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
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
    """A file of a ledger.

    Attributes
    ----------
    path, tree
        And what is in it.
    first
        Number of the rows in the files before it.
    """

    path: Path
    tree: dict[str, Any]
    first: int

    @cached_property
    def positions(self) -> Positions:
        """Where things stand in it; only read where that is asked for."""
        return positions(self.path.read_text(encoding="utf-8-sig"))

    def place(self, table: str, index: int = 0, key: str = "") -> str:
        """File and line of the n-th table of a name in the whole ledger, or of a key in it."""
        own = index - self.first if table == "row" else index
        return f"{printable(str(self.path), 200)}:{self.positions.line(table, own, key)}"


@dataclass
class Positions:
    """Line numbers, from 1: of the n-th table of a name, and of keys in it."""

    tables: dict[tuple[str, int], int] = field(default_factory=dict)
    keys: dict[tuple[str, int, str], int] = field(default_factory=dict)

    def line(self, table: str, index: int = 0, key: str = "") -> int:
        """Line of a key, else of its table, else the first."""
        return self.keys.get((table, index, key)) or self.tables.get((table, index), 1)


def positions(text: str) -> Positions:
    """Find tables and keys in a text that is valid TOML."""
    found = Positions()
    seen: dict[str, int] = {}
    table, index, inside = "", 0, ""
    for number, line in enumerate(text.splitlines(), start=1):
        if not inside:
            header, key = _HEADER.match(line), _KEY.match(line)
            if header:
                table = "".join(header[1].split())
                index = seen.get(table, -1) + 1
                seen[table] = index
                found.tables[table, index] = number
            elif key:
                found.keys.setdefault((table, index, key[1].strip("\"'")), number)
        for delimiter in _DELIMITER.findall(line):
            if not inside:
                inside = delimiter
            elif inside == delimiter:
                inside = ""
    return found
