"""Rows of the table, and what must be reached."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Goal:
    """What must be reached, and what was.

    Attributes
    ----------
    text
        In words, such as ``"at least 3 x ours"``.
    found
        The number that is compared.
    limit
        What it is compared with.
    least
        Whether the limit is the least allowed, not the most.
    """

    text: str
    found: float
    limit: float
    least: bool = False

    @property
    def reached(self) -> bool:
        """Whether the number is on the right side of the limit."""
        return self.found >= self.limit if self.least else self.found <= self.limit


@dataclass(frozen=True)
class Row:
    """One line: what was timed, how long it took, and what must be reached.

    Attributes
    ----------
    name
        What was timed.
    least, middle
        Fastest and median sample, in the unit of its table; None where there is nothing to time.
    ratio
        As a multiple of the table's first row, pair by pair; None where that says nothing.
    goals
        What must be reached; mostly nothing.
    note
        What a reader must know: why a peer is missing, how its work differs.
    """

    name: str
    least: float | None = None
    middle: float | None = None
    ratio: float | None = None
    goals: tuple[Goal, ...] = ()
    note: str = ""


@dataclass(frozen=True)
class Table:
    """A subject with its rows."""

    title: str
    unit: str
    rows: tuple[Row, ...]


def missing(name: str, reason: str) -> Row:
    """The row of a peer that cannot be timed here."""
    return Row(name, note=f"not timed: {reason}")


WIDEST = 46
"""Columns of the names, in every table."""


def text(table: Table) -> str:
    """A table in columns."""
    heads = f"  {table.unit:<{WIDEST}}  {'fastest':>9}  {'median':>9}  {'ratio':>7}  what must be reached"
    lines = ["", table.title, heads]
    for row in table.rows:
        cells = [_number(row.least, 9), _number(row.middle, 9), _number(row.ratio, 7)]
        said = [_verdict(goal) for goal in row.goals] + ([row.note] if row.note else [])
        lines.append("  ".join([f"  {row.name:<{WIDEST}}", *cells, "; ".join(said)]).rstrip())
    return "\n".join(lines)


def summary(tables: Iterable[Table]) -> str:
    """How many goals were reached."""
    goals = [goal for table in tables for row in table.rows for goal in row.goals]
    return f"{sum(goal.reached for goal in goals)} of {len(goals)} goals reached"


def _verdict(goal: Goal) -> str:
    return f"{goal.text}: {'reached' if goal.reached else 'NOT REACHED'} ({goal.found:.3g})"


def _number(value: float | None, width: int) -> str:
    return " " * width if value is None else f"{value:>{width}.4g}"
