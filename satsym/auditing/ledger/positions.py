"""Where in a TOML file a table or a key stands, for messages: the library that reads TOML does not say."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

_HEADER = re.compile(r"\s*+\[\[?([^\[\]]++)\]\]?\s*+(?:#.*)?$")
"""Possessive, so that a line of nothing but spaces after a bracket is gone through once."""
_KEY = re.compile(r"""\s*("[^"]*"|'[^']*'|[A-Za-z0-9_-]+)\s*=""")
_DELIMITER = re.compile(r'"""|' + r"'''")


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
