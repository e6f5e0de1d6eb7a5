"""The keys of instance files, as text for the terminal and as a page of the documentation."""

from __future__ import annotations

import shutil
import textwrap
from itertools import compress, groupby
from pathlib import Path

from satsym.instance.keys import Entry, entries
from satsym.report.said import message, say

HEAD = """# Instance files

<!-- Written by `make derive` from satsym/instance/schema.py: do not edit. -->

An instance is a problem with its numbers: a model, the values of its parameters, and the conditions at both ends. It is
a short TOML file. This page lists all keys of such a file; [start in five minutes](start.md) shows a first one.

```toml
model = "polar_orbit"
title = "A return in one day"

[parameters]
sigma = "42164.17 km"
omega = "7.2921159e-5 rad/s"

[initial]
r = "42169.17 km"
r_dot = 0.0
theta = "0.02 deg"
theta_dot = "7.2921159e-5 rad/s"

[final]
r = "reference"
r_dot = "reference"
theta = "reference"
theta_dot = "reference"

[time]
tf = "1 day"
```

`model`, `[initial]` and `[time] tf` are all that solving needs. Names in capitals stand for those of the model, which
`satsym models MODEL` lists with their units and defaults. A number is in the unit that is listed; a text may carry its
own, such as `"5 km"`. Unknown keys are rejected.

| command | what it does |
| --- | --- |
| `satsym instances` | lists the instances that come with satsym |
| `satsym instances soft-return` | prints one of them |
| `satsym new my_case --instance soft-return` | copies one, to start from |
| `satsym instances --keys` | prints the keys of this page |
| `satsym instances --schema` | prints the keys as a JSON Schema |

Editors that support TOML can complete and check an instance file: write the schema to a file by
`satsym instances --schema > instance.schema.json`, and begin the instance file with the line
`#:schema instance.schema.json`.
"""


REQUIRED = "must be given"
WIDEST, DEEPEST = 100, 20
"""Largest number of columns of the terminal that are used, and largest width of names with text beside them."""
TITLES = ("key", "value", "unit", "default", "meaning", "used by")
FILE = Path(__file__).parents[3] / "docs" / "instances.md"


def keys_text() -> str:
    """Return a block for each table, with a paragraph for each key."""
    width = min(WIDEST, shutil.get_terminal_size().columns)
    blocks = []
    for title, rows in _blocks():
        names = [row[0] if row[0] == row[0].lower() else message(row[0]) for row in rows]
        deep = 4 + max((len(name) for name in names if len(name) <= DEEPEST), default=0)
        lines = [message(title)]
        for name, (_, value, unit, default, meaning, _) in zip(names, rows, strict=True):
            of = unit and say("unit: <unit>", unit=message(unit))
            about = "; ".join(part for part in (message(value), of, _said(default)) if part)
            first = f"  {name}".ljust(deep)
            if len(first) > deep:
                lines.append(first)
                first = " " * deep
            for start, text in ((first, message(meaning)), (" " * deep, about)):
                lines += textwrap.wrap(text, width, initial_indent=start, subsequent_indent=" " * deep)
        blocks.append("\n".join(lines))
    return "\n\n".join(blocks)


def _said(default: str) -> str:
    return message(default) if default in ("", REQUIRED) else say("by default <value>", value=default)


def page() -> str:
    """Return the page of the documentation."""
    blocks = [HEAD]
    for title, rows in _blocks():
        marked = [
            (f"`{key}`", value, unit, default if default in ("", REQUIRED) else f"`{default}`", *more)
            for key, value, unit, default, *more in rows
        ]
        used = [any(column) for column in zip(*marked, strict=True)]
        table = (compress(cells, used) for cells in (TITLES, ["---"] * len(TITLES), *marked))
        lines = [f"| {' | '.join(cells)} |" for cells in table]
        blocks.append("\n".join([f"## {f'`{title}`' if title.startswith('[') else title}", "", *lines, ""]))
    return "\n".join(blocks)


def _blocks() -> list[tuple[str, list[tuple[str, ...]]]]:
    """Return the tables with the cells of their keys."""
    return [
        (f"[{place}]" if place else "Before the first table", [_cells(entry) for entry in group])
        for place, group in groupby(entries(), key=lambda entry: entry.table)
    ]


def _cells(entry: Entry) -> tuple[str, ...]:
    key = entry.key
    default = REQUIRED if entry.required else entry.default
    return entry.name, entry.kind, key.unit, default, key.meaning, ", ".join(key.commands)


if __name__ == "__main__":
    FILE.write_text(page(), encoding="utf-8")
