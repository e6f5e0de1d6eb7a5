"""Simple HTML for notebooks: no scripts, no external styles, every text escaped."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any

from satsym.report.display import unit_text
from satsym.report.terminal.table import figure


def page(title: str, lines: Sequence[str], *tables: str) -> str:
    """Return a title, paragraphs and tables.

    The title is no heading, since the heading level in a notebook is unknown.
    """
    paragraphs = [f"<p>{escape(line)}</p>" for line in lines if line]
    return "\n".join([f"<p><strong>{escape(title)}</strong></p>", *paragraphs, *filter(None, tables)])


def table(header: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """Return a table without its empty columns, with numbers and units as in reports; empty without rows."""
    shown = [[_shown(cell) for cell in row] for row in rows]
    kept = [k for k, column in enumerate(zip(*shown, strict=True)) if any(column)]
    right = {k for k in kept if any(_is_number(row[k]) for row in shown) and not any(" " in row[k] for row in shown)}
    body = []
    for row in shown:
        cells = (_cell(unit_text(row[k]) if header[k] == "unit" else row[k], k in right) for k in kept)
        body.append(f"<tr>{''.join(cells)}</tr>")
    looks = {k: ' style="text-align: right"' if k in right else "" for k in kept}
    head = "".join(f'<th scope="col"{looks[k]}>{escape(header[k])}</th>' if header[k] else "<td></td>" for k in kept)
    return "\n".join(["<table>", f"<tr>{head}</tr>", *body, "</table>"]) if body else ""


def facts(values: Mapping[str, Any]) -> str:
    """Return a table of names and values, without a header."""
    rows = (f'<tr><th scope="row">{escape(name)}</th>{_cell(_shown(value))}</tr>' for name, value in values.items())
    return "\n".join(["<table>", *rows, "</table>"]) if values else ""


def _cell(text: str, right: bool = False) -> str:
    """Return a table cell with a text; numbers are not broken across lines, e.g. after the sign of an exponent."""
    looks = [*(["white-space: nowrap"] if _is_number(text) else []), *(["text-align: right"] if right else [])]
    style = f' style="{"; ".join(looks)}"' if looks else ""
    return f"<td{style}>{escape(text)}</td>"


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _shown(cell: Any) -> str:
    if cell is None:
        return "-"
    if isinstance(cell, list | tuple):
        return ", ".join(map(_shown, cell))
    return figure(cell, 10) if isinstance(cell, float) else str(cell)
