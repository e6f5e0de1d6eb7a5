"""Plain-text tables and paragraphs for people, fitted to the width of the terminal."""

from __future__ import annotations

import shutil
import textwrap
from collections.abc import Iterator, Sequence

GAP = "  "
WIDEST, NARROWEST = 100, 40
"""Largest and smallest width of paragraphs, in characters."""
SENTENCE, SENTENCES = 16, 40
"""Smallest width of a column of sentences, if it has room for few words only and if all columns fit beside it."""


def room() -> int | None:
    """Return the characters of a line, from COLUMNS or else from the terminal; ``None`` where there is neither."""
    return shutil.get_terminal_size((0, 0)).columns or None


def wrapped(text: str, hanging: str = GAP) -> list[str]:
    """Break an indented paragraph into lines; paths and other long words are never broken.

    Parameters
    ----------
    hanging
        Begins all lines but the first.
    """
    width = max(NARROWEST, min(WIDEST, room() or WIDEST))
    return textwrap.wrap(
        text, width, initial_indent=GAP, subsequent_indent=hanging, break_on_hyphens=False, break_long_words=False
    )


def fitting(line: str) -> list[str]:
    """Break a heading over several lines where it does not fit; indented text is laid out already."""
    limit = room()
    if limit is None or len(line) <= limit or line.startswith(" "):
        return [line]
    return textwrap.wrap(line, limit, subsequent_indent=GAP, break_on_hyphens=False, break_long_words=False)


def table(rows: Sequence[Sequence[str]], right: Sequence[int] = (), indent: str = GAP) -> list[str]:
    """Return the lines of a table with aligned columns, without columns that are empty below the header.

    Where there is no room for all columns, the remaining ones follow below, beside the first one again.

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
    rows = _with_room(_narrowed(rows, kept, len(indent)), kept, len(indent))
    lines: list[str] = []
    for group in _groups(kept, {i: _width(rows, i) for i in kept}, len(indent)):
        shown = _narrowed(rows, group, len(indent))
        lines += [""] if lines and any(rows[0]) else []
        lines += _aligned(shown, group, right, indent)
    return lines


def _aligned(rows: Sequence[Sequence[str]], group: Sequence[int], right: Sequence[int], indent: str) -> list[str]:
    width = {i: _width(rows, i) for i in group}
    cells = [[row[i].rjust(width[i]) if i in right else row[i].ljust(width[i]) for i in group] for row in rows]
    return [(indent + GAP.join(row)).rstrip() for row in cells]


def _width(rows: Sequence[Sequence[str]], column: int) -> int:
    return max(len(row[column]) for row in rows)


def _narrowed(rows: Sequence[Sequence[str]], kept: Sequence[int], indent: int) -> Sequence[Sequence[str]]:
    """Break sentences of the last column over several lines, where that makes room for all columns."""
    limit = room()
    if limit is None or not kept:
        return rows
    last = kept[-1]
    left = limit - indent - sum(_width(rows, i) + len(GAP) for i in kept[:-1])
    if left < SENTENCE or _width(rows, last) <= left:
        return rows
    found: list[Sequence[str]] = []
    for row in rows:
        for k, part in enumerate(textwrap.wrap(row[last], left) or [""]):
            found.append([part if i == last else cell if k == 0 else "" for i, cell in enumerate(row)])
    return found


def _with_room(rows: Sequence[Sequence[str]], kept: Sequence[int], indent: int) -> Sequence[Sequence[str]]:
    """Break the first column over several lines, where this makes room for all other columns, or for any of them."""
    limit = room()
    if limit is None or len(kept) < 2:
        return rows
    first, *others = kept
    left = limit - indent - sum(len(GAP) + _width(rows, i) for i in others)
    if left < SENTENCES:
        left = limit - indent - len(GAP) - max(_width(rows, i) for i in others)
    if left < SENTENCE or _width(rows, first) <= left:
        return rows
    found: list[Sequence[str]] = []
    for row in rows:
        parts = textwrap.wrap(row[first], left, subsequent_indent=GAP, break_on_hyphens=False, break_long_words=False)
        for k, part in enumerate(parts or [""]):
            found.append([part if i == first else cell if k == 0 else "" for i, cell in enumerate(row)])
    return found


def _groups(kept: Sequence[int], width: dict[int, int], indent: int) -> Iterator[list[int]]:
    """Return groups of columns that fit beside each other, each with the first one."""
    limit = room()
    group = list(kept[:1])
    for column in kept[1:]:
        taken = indent + sum(width[i] + len(GAP) for i in group) + width[column]
        if limit is not None and taken > limit and len(group) > 1:
            yield group
            group = list(kept[:1])
        group.append(column)
    yield group


def figure(value: float, digits: int = 6) -> str:
    """Write a number for tables; a dash where there is none."""
    if value != value:
        return "-"
    return f"{value + 0.0:.{digits}g}"


def joined(blocks: Sequence[Sequence[str]]) -> str:
    """Join blocks of lines by empty lines; headings, which are not indented, are fitted."""
    return "\n\n".join("\n".join(part for line in block for part in fitting(line)) for block in blocks if block)
