"""Small HTML for notebooks: no scripts, no styles from elsewhere, every text escaped."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any

from satsym.report.terminal.table import figure


def page(title: str, lines: Sequence[str], *tables: str) -> str:
    """A title, paragraphs and tables; the title is no heading, for nobody knows what headings are above it."""
    paragraphs = [f"<p>{escape(line)}</p>" for line in lines if line]
    return "\n".join([f"<p><strong>{escape(title)}</strong></p>", *paragraphs, *filter(None, tables)])


def table(header: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """A table; numbers as reports have them. Empty without rows."""
    body = [f"<tr>{''.join(f'<td>{escape(_shown(cell))}</td>' for cell in row)}</tr>" for row in rows]
    head = "".join(f'<th scope="col">{escape(name)}</th>' if name else "<td></td>" for name in header)
    return "\n".join(["<table>", f"<tr>{head}</tr>", *body, "</table>"]) if body else ""


def facts(values: Mapping[str, Any]) -> str:
    """A table of names and values, without a header."""
    rows = (
        f'<tr><th scope="row">{escape(name)}</th><td>{escape(_shown(value))}</td></tr>'
        for name, value in values.items()
    )
    return "\n".join(["<table>", *rows, "</table>"]) if values else ""


def _shown(cell: Any) -> str:
    if cell is None:
        return "-"
    if isinstance(cell, list | tuple):
        return ", ".join(map(_shown, cell))
    return figure(cell, 10) if isinstance(cell, float) else str(cell)
