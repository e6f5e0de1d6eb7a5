"""Verdicts for people: a table for the terminal, what is right said first; and objects for JSON."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from typing import Any

from satsym.auditing import VERDICTS, Judged, Ledger
from satsym.report.terminal.table import table
from satsym.wording import printable

WIDTH = 100
_INDENT = "  "
_LONGEST = 2000


def audit_object(judged: Sequence[Judged]) -> dict[str, Any]:
    """All rows, and how many there are of each verdict, for JSON."""
    return {"rows": [_row_object(row) for row in judged], "counts": counts(judged)}


def counts(judged: Sequence[Judged]) -> dict[str, int]:
    """How many rows have each verdict; those that no row has are left out."""
    found = {verdict: sum(row.verdict == verdict for row in judged) for verdict in VERDICTS}
    return {verdict: number for verdict, number in found.items() if number}


def coverage_object(ledgers: Sequence[Ledger]) -> dict[str, Any]:
    """What of the documents has no row, for JSON."""
    return {
        "coverage": [
            {
                "document": x.document.key,
                "numbers": len(x.document.numbers),
                "rows": len(x.rows),
                "missing": x.uncovered(),
            }
            for x in ledgers
        ]
    }


def audit_text(ledgers: Sequence[Ledger], judged: Mapping[str, Sequence[Judged]]) -> str:
    """The verdicts of some documents, for the terminal."""
    return "\n\n".join("\n".join(_document(ledger, judged[ledger.document.key])) for ledger in ledgers)


def coverage_text(ledgers: Sequence[Ledger]) -> str:
    """What of the documents has no row, for the terminal."""
    lines = []
    for ledger in ledgers:
        missing, numbers = ledger.uncovered(), len(ledger.document.numbers)
        if not missing:
            lines.append(f"{ledger.document.key}: each of its {numbers} numbers has a row ({len(ledger.rows)} rows)")
        else:
            lines.append(
                f"{ledger.document.key}: {len(missing)} of {numbers} numbers have no row: {', '.join(missing)}"
            )
    return "\n".join(lines)


def _document(ledger: Ledger, judged: Sequence[Judged]) -> list[str]:
    document = ledger.document
    by = ", ".join(filter(None, [document.authors, str(document.year or "")]))
    lines = [printable(f"{document.key}: {document.title}{f' ({by})' if by else ''}", 300), ""]
    right = [row for row in judged if row.verdict == "confirmed"]
    if right:
        lines += _wrapped(f"Confirmed, {len(right)} of {len(judged)}: {', '.join(items(right))}.")
    open_ = [row for row in judged if row.verdict != "confirmed"]
    if not open_:
        return [*lines, "", f"{_INDENT}There is nothing to correct."]
    summary = ", ".join(f"{number} {verdict}" for verdict, number in counts(open_).items())
    lines += ["", f"{_INDENT}Remarks: {summary}.", ""]
    lines += table([["item", "verdict", "what it is"], *([_short(r.key), r.verdict, _short(r.says)] for r in open_)])
    for row in open_:
        lines += ["", f"{_INDENT}{_short(row.key)}: {row.verdict}{f' ({row.where})' if row.where else ''}"]
        if row.printed:
            lines += _wrapped(f"printed  {_flat(row.printed)}", 2)
        if row.derived and row.derived not in row.diagnosis:
            lines += _wrapped(f"derived  {row.derived}", 2)
        lines += _wrapped(row.diagnosis, 2)
        lines += _wrapped(row.evidence, 2)
    return lines


def _row_object(row: Judged) -> dict[str, Any]:
    return {
        "document": row.document,
        "item": row.item,
        "kind": row.kind,
        "printed": row.printed,
        "derived": row.derived,
        "verdict": row.verdict,
        "diagnosis": row.diagnosis,
        "evidence": row.evidence,
    }


def items(judged: Sequence[Judged]) -> list[str]:
    """Items, each once; how many rows it has in brackets where there are several."""
    numbers: dict[str, int] = {}
    for row in judged:
        numbers[row.item] = numbers.get(row.item, 0) + 1
    return [f"{item} ({number})" if number > 1 else item for item, number in numbers.items()]


def _flat(printed: Any) -> str:
    if isinstance(printed, str):
        return printed
    return f"[{', '.join(map(_flat, printed))}]"


def _short(text: str) -> str:
    return printable(text, 60)


def _wrapped(text: str, depth: int = 1) -> list[str]:
    indent = _INDENT * depth
    return textwrap.wrap(
        printable(text, _LONGEST),
        WIDTH,
        initial_indent=indent,
        subsequent_indent=indent + _INDENT,
        break_on_hyphens=False,
    )
