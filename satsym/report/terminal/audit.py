"""The audit for people: what falls and what stands first, then findings by their weight; and objects for JSON."""

from __future__ import annotations

import re
import shutil
import textwrap
from collections.abc import Mapping, Sequence
from typing import Any

from satsym.auditing import VERDICTS, Judged, Ledger
from satsym.auditing.causes import SILENT, Finding, Weight, findings
from satsym.wording import printable

WIDTH = 100
_INDENT = "  "
_LONGEST = 4000
_PLACES = 6
"""Items that are named before the rest is counted."""
_HEADINGS = {
    Weight.OVERTURNS: "Overturns a conclusion",
    Weight.RESULT: "Wrong results",
    Weight.SLIP: "Slips without consequence",
    Weight.IMPRECISE: "Imprecise",
    Weight.NOTATION: "Notation",
}
_IN_FULL = (Weight.OVERTURNS, Weight.RESULT)


def audit_object(judged: Sequence[Judged]) -> dict[str, Any]:
    """All rows, the findings, and how many rows there are of each verdict, for JSON."""
    by_document: dict[str, list[Judged]] = {}
    for row in judged:
        by_document.setdefault(row.document, []).append(row)
    found = [finding for rows in by_document.values() for finding in findings(rows)]
    return {
        "rows": [_row_object(row) for row in judged],
        "findings": [_finding_object(finding) for finding in found],
        "counts": counts(judged),
    }


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


def audit_text(ledgers: Sequence[Ledger], judged: Mapping[str, Sequence[Judged]], *, rows: bool = False) -> str:
    """The findings of some documents, for the terminal.

    Parameters
    ----------
    rows
        Whether every row that is not confirmed follows in full.
    """
    return "\n\n".join("\n".join(_document(ledger, judged[ledger.document.key], rows)) for ledger in ledgers)


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


def summary(judged: Sequence[Judged], found: Sequence[Finding]) -> list[str]:
    """Which conclusions of a document fall, which stand, and why: three to six sentences."""
    right = sum(row.verdict == "confirmed" for row in judged)
    said = [f"Of {len(judged)} things that are printed {right} are confirmed."]
    conclusions = [row for row in judged if row.role == "conclusion" and row.verdict not in ("illegible", "undecided")]
    fallen = {row.key for finding in found for row in finding.overturned}
    falling = [row for row in conclusions if row.key in fallen]
    standing = [row for row in conclusions if row.key not in fallen]
    if falling:
        said.append(f"Of {len(conclusions)} conclusions {len(falling)} fall: {_quoted(falling)}.")
        why = [f"{_at(f)}: {_first(f.statement)}" for f in found if f.weight is Weight.OVERTURNS]
        said.append(f"The reasons: {'; '.join(why)}.")
    if standing:
        said.append(f"{'These stand' if falling else 'All conclusions stand'}: {_quoted(standing)}.")
    rest = {weight: sum(f.weight is weight for f in found) for weight in Weight if weight is not Weight.OVERTURNS}
    words = [f"{number} {_counted(weight, number)}" for weight, number in rest.items() if number]
    if words:
        said.append(f"{'Besides, there' if falling else 'There'} are {_listed(words)}.")
    open_ = sum(row.verdict in ("illegible", "undecided") for row in judged)
    if open_:
        said.append(f"{open_} could not be read or decided.")
    return said


def _document(ledger: Ledger, judged: Sequence[Judged], rows: bool) -> list[str]:
    document, found = ledger.document, findings(judged)
    by = ", ".join(filter(None, [document.authors, str(document.year or "")]))
    lines = [*_wrapped(f"{document.key}: {document.title}{f' ({by})' if by else ''}", 0), ""]
    lines += _wrapped(" ".join(summary(judged, found)))
    if not found:
        return [*lines, "", f"{_INDENT}There is nothing to correct."]
    number = 0
    for weight in Weight:
        chosen = [finding for finding in found if finding.weight is weight]
        if chosen:
            lines += ["", f"{_INDENT}{_HEADINGS[weight]}"]
        for finding in chosen:
            number += 1
            lines += _in_full(number, finding) if weight in _IN_FULL else _in_a_line(number, finding)
    open_ = [row for row in judged if row.verdict in ("illegible", "undecided")]
    if open_:
        lines += ["", f"{_INDENT}Not judged", *_wrapped(f"{', '.join(items(open_))}.", 2)]
    if rows:
        for row in judged:
            lines += _row(row) if row.verdict not in SILENT else []
    else:
        lines += ["", *_wrapped(f"Every row: satsym audit {ledger.name} --rows; one: --item ITEM.")]
    return lines


def _in_full(number: int, finding: Finding) -> list[str]:
    """A finding with what is printed, what is true, and what it spoils."""
    row = finding.places[0]
    lines = _wrapped(f"{number}. {places(finding.places)}: {row.verdict}", 1)
    if row.original and row.kind == "claim":
        lines += _wrapped(f"says     {_flat(row.original)}", 3)
    if row.printed:
        lines += _wrapped(f"{'that is ' if row.kind == 'claim' else 'printed '} {_flat(row.printed)}", 3)
    lines += _wrapped(row.diagnosis, 3)
    if row.derived and row.derived not in row.diagnosis:
        lines += _wrapped(f"right    {row.derived}", 3)
    if finding.spoiled:
        lines += _wrapped(f"spoils   {places(finding.spoiled)}", 3)
    return lines


def _in_a_line(number: int, finding: Finding) -> list[str]:
    return _wrapped(f"{number}. {places(finding.places)}: {_first(finding.statement)}.", 1)


def _row(row: Judged) -> list[str]:
    """A row in full."""
    lines = ["", *_wrapped(f"{row.key}: {row.verdict}{f' ({row.where})' if row.where else ''}")]
    for label, text in (("says", row.original or row.says), ("printed", _flat(row.printed)), ("derived", row.derived)):
        if text and text not in row.diagnosis:
            lines += _wrapped(f"{label:8} {text}", 2)
    return [*lines, *_wrapped(row.diagnosis, 2), *_wrapped(row.evidence, 2)]


def _row_object(row: Judged) -> dict[str, Any]:
    return {
        "document": row.document,
        "item": row.item,
        "part": row.part,
        "kind": row.kind,
        "role": row.role,
        "printed": row.printed,
        "derived": row.derived,
        "verdict": row.verdict,
        "cause": row.cause or None,
        "weight": row.weight or None,
        "diagnosis": row.diagnosis,
        "evidence": row.evidence,
    }


def _finding_object(finding: Finding) -> dict[str, Any]:
    return {
        "document": finding.document,
        "cause": finding.cause,
        "weight": finding.weight.value,
        "places": [row.key for row in finding.places],
        "spoils": [row.key for row in finding.spoiled],
        "statement": finding.statement,
        "correction": finding.correction,
    }


def items(judged: Sequence[Judged]) -> list[str]:
    """Items, each once; how many rows it has in brackets where there are several."""
    numbers: dict[str, int] = {}
    for row in judged:
        numbers[row.item] = numbers.get(row.item, 0) + 1
    return [f"{item} ({number})" if number > 1 else item for item, number in numbers.items()]


def places(rows: Sequence[Judged]) -> str:
    """Where a finding shows: by name, or by item where there are many."""
    if len(rows) == 1:
        return rows[0].key
    named = items(rows)
    if len(named) <= _PLACES:
        return ", ".join(named)
    rest = len(rows) - sum(row.item in {n.partition(" (")[0] for n in named[: _PLACES - 1]} for row in rows)
    return f"{', '.join(named[: _PLACES - 1])} and {rest} more"


def _at(finding: Finding) -> str:
    return finding.places[0].key


def _first(text: str) -> str:
    """The first sentence, without its end."""
    return re.split(r"\.(?= [A-Z`])", text.strip(), maxsplit=1)[0].rstrip(".").removeprefix("It does not hold: ")


def _quoted(rows: Sequence[Judged]) -> str:
    return "; ".join(f'"{_flat(row.original or row.says or row.printed)}" ({row.key})' for row in rows)


def _counted(weight: Weight, number: int) -> str:
    nouns = {Weight.RESULT: "wrong result", Weight.SLIP: "slip", Weight.IMPRECISE: "imprecise number"}
    noun = nouns.get(weight, "matter of notation")
    if number == 1:
        return noun
    return noun.replace("matter", "matters") if weight is Weight.NOTATION else f"{noun}s"


def _listed(words: Sequence[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def _flat(printed: Any) -> str:
    if isinstance(printed, str):
        return printed
    return f"[{', '.join(map(_flat, printed))}]"


def _wrapped(text: str, depth: int = 1) -> list[str]:
    indent = _INDENT * depth
    return textwrap.wrap(
        printable(text, _LONGEST),
        min(WIDTH, shutil.get_terminal_size((WIDTH, 24)).columns),
        initial_indent=indent,
        subsequent_indent=indent + _INDENT,
        break_on_hyphens=False,
    )
