"""Audit of one ledger, from its first row to its last."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING

from satsym.auditing.ledger.contents import Ledger, Row
from satsym.formula import budget
from satsym.records import shelf
from satsym.wording import printable

if TYPE_CHECKING:
    from satsym.auditing.comparison.bench import Bench
    from satsym.auditing.judged import Judged
    from satsym.auditing.outcome import Outcome


def audit(ledger: Ledger, items: Sequence[str] = (), announce: Callable[[str], None] = lambda _: None) -> list[Judged]:
    """Judge the rows of a ledger.

    Parameters
    ----------
    ledger
        The ledger as it was read.
    items
        Items, or items with parts, whose rows are judged; by default all. Rows that they depend on are also judged.
    announce
        Function that is called with a text before each row.

    Raises
    ------
    BadInput
        If a row refers to a quantity that no derivation has, or cannot be compared with its target.
    """
    with shelf.opened(ledger.folder):
        return _judged(ledger, items, announce)


def _judged(ledger: Ledger, items: Sequence[str], announce: Callable[[str], None]) -> list[Judged]:
    from satsym.auditing.comparison.bench import Bench
    from satsym.auditing.verdict import verdicts

    bench = Bench(ledger)
    wanted = [row.key for row in ledger.rows if not items or row.table.item in items or row.key in items]
    needed = _bearing(bench, wanted) if items else set(wanted)
    rows = [row for row in ledger.rows if row.key in needed]
    outcomes = []
    for i, row in enumerate(rows, start=1):
        announce(f"{ledger.document.key}: row {i} of {len(rows)}, {printable(row.key)}")
        limit = budget.FORMULA if row.claims is None else budget.CLAIM
        outcomes.append(bench.within(limit, row, partial(_outcome, bench, row)))
    return verdicts(bench, outcomes, wanted)


def _outcome(bench: Bench, row: Row) -> Outcome:
    from satsym.auditing.judge import claim, formula, value
    from satsym.auditing.outcome import Outcome

    if not row.table.legible:
        return Outcome(row, None)
    if row.claims is not None:
        return claim.judge(bench, row)
    judges = {"number": value.number, "unit": value.unit}
    return judges.get(row.table.kind, formula.judge)(bench, row)


def _bearing(bench: Bench, wanted: Sequence[str]) -> set[str]:
    """Return the keys of rows on which some verdicts depend: those used, those that use them, and equal targets."""
    rows = bench.ledger.rows
    found = set(wanted)
    for row in (bench.rows[key] for key in wanted):
        found.update(row.uses)
        for other in rows:
            if row.key in other.uses:
                found.update([other.key, *other.uses])
            if bench.within(budget.FORMULA, other, partial(bench.same_target, row, other)):
                found.add(other.key)
    return found
