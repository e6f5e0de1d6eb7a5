"""Lines of tables and keys in the files of a ledger, for error messages; the TOML library does not provide them."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from satsym.wording import printable

_HEADER = re.compile(r"\s*+\[\[?([^\[\]]++)\]\]?\s*+(?:#.*)?$")
"""Pattern of a table header; possessive, so that long runs of spaces after a bracket are read only once."""
_KEY = re.compile(r"""\s*("[^"]*"|'[^']*'|[A-Za-z0-9_-]+)\s*=""")
_DELIMITER = re.compile(r'"""|' + r"'''")


@dataclass(frozen=True)
class Part:
    """A file of a ledger with its contents."""

    path: Path
    tree: dict[str, Any]
    """Contents of the file as tables."""
    first: int
    """Number of rows in the files before this one."""

    @cached_property
    def _lines(self) -> dict[tuple[str, int, str], int]:
        return lines(self.path.read_text(encoding="utf-8-sig"))  # only read where a place is asked for

    def place(self, table: str, index: int = 0, key: str = "") -> str:
        """Return file and line of a key in the n-th table of a name in the whole ledger.

        If the key does not exist, the line of the table is returned, otherwise line 1.
        """
        own, found = index - self.first if table == "row" else index, self._lines
        line = found.get((table, own, key)) or found.get((table, own, ""), 1)
        return f"{printable(str(self.path), 200)}:{line}"


def lines(text: str) -> dict[tuple[str, int, str], int]:
    """Return the line numbers of all tables and keys in a valid TOML text, by table, number of the table, and key."""
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
