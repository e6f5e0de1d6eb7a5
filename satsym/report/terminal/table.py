"""Plain-text tables for people."""

from __future__ import annotations

from collections.abc import Sequence

GAP = "  "


def table(rows: Sequence[Sequence[str]], right: Sequence[int] = (), indent: str = GAP) -> list[str]:
    """Lines of a table whose columns are aligned; columns without any text below the header are left out.

    Parameters
    ----------
    rows
        Header first, all of the same length.
    right
        Columns to align to the right, as numbers are.
    indent
        Begins every line.
    """
    kept = [i for i, column in enumerate(zip(*rows[1:], strict=True)) if any(column)]
    width = {i: max(len(row[i]) for row in rows) for i in kept}
    return [
        (indent + GAP.join(row[i].rjust(width[i]) if i in right else row[i].ljust(width[i]) for i in kept)).rstrip()
        for row in rows
    ]


def figure(value: float, digits: int = 6) -> str:
    """A number as tables show it; a dash where there is none."""
    if value != value:
        return "-"
    return f"{value + 0.0:.{digits}g}"
