"""Small HTML for notebooks: no scripts, no styles from elsewhere, every text escaped."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any

from satsym.report.terminal.table import figure


def page(title: str, lines: Sequence[str], *tables: str) -> str:
    """A heading, paragraphs and tables."""
    paragraphs = [f"<p>{escape(line)}</p>" for line in lines if line]
    return "\n".join([f"<h4>{escape(title)}</h4>", *paragraphs, *filter(None, tables)])


def table(header: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """A table; numbers as reports have them. Empty without rows."""
    body = [f"<tr>{''.join(f'<td>{escape(_shown(cell))}</td>' for cell in row)}</tr>" for row in rows]
    head = "".join(f"<th>{escape(name)}</th>" for name in header)
    return "\n".join(["<table>", f"<tr>{head}</tr>", *body, "</table>"]) if body else ""


def facts(values: Mapping[str, Any]) -> str:
    """A table of names and values."""
    return table(("", ""), values.items())


def _shown(cell: Any) -> str:
    if cell is None:
        return "-"
    if isinstance(cell, list | tuple):
        return ", ".join(map(_shown, cell))
    return figure(cell, 10) if isinstance(cell, float) else str(cell)
