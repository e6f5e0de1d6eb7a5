"""An audit on a terminal: conclusions first, then findings; and the check of one formula."""

from __future__ import annotations

import re
import shutil
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from satsym.auditing import Judged, Ledger
from satsym.auditing.causes import SILENT, Finding
from satsym.auditing.check.answers import Answer
from satsym.auditing.ledger.coverage import KINDS, Coverage
from satsym.auditing.sentences import in_indonesian
from satsym.report.findings.review import (
    IN_FULL,
    ListedReview,
    correction,
    flat,
    is_put_in_words,
    items,
    measured,
    recompute,
    where,
)
from satsym.report.said import language, message, say
from satsym.report.terminal.table import table
from satsym.report.texts import Texts, load
from satsym.wording import printable

if TYPE_CHECKING:
    from satsym.auditing.document.drafting import Draft

WIDTH = 100
_NARROWEST = 40
_INDENT = "  "
_LABEL = 10
_BAR = 24
_CHARTED = 3
"""Number of rows from which a chart is shown."""
_SHORT_FORMULA = 30
"""Largest number of characters of a formula that is printed after its verdict."""
_SEPARABLE = re.compile(r"[^*/+=,;:)(&|-]*[*/+=,;:)(&|-]+|[^*/+=,;:)(&|-]+")
"""Pattern of the parts of a long word, which may be divided between lines after signs."""


def audit_text(
    ledgers: Sequence[Ledger],
    judged: Mapping[str, Sequence[Judged]],
    *,
    rows: bool = False,
    code: bool = False,
    language: str = "en",
) -> str:
    """Return the findings of some documents, for the terminal.

    Parameters
    ----------
    rows
        Whether every row that is not confirmed follows in full.
    code
        Whether what claims were tested as, and what was measured, is given as code, too.
    language
        Of all but what the documents print and of what is measured.
    """
    texts = load(language)
    reviews = [ListedReview.of(ledger, judged[ledger.document.key], texts) for ledger in ledgers]
    return "\n\n".join("\n".join(_document(review, rows, code)) for review in reviews)


def coverage_text(ledgers: Sequence[Ledger], found: Sequence[Coverage | None]) -> str:
    """Return the parts of documents, and of their known texts, that have no row, for the terminal."""
    lines = []
    for ledger, text in zip(ledgers, found, strict=True):
        missing, numbers = ledger.uncovered(), len(ledger.document.numbers)
        if not missing:
            lines.append(f"{ledger.document.key}: each of its {numbers} numbers has a row ({len(ledger.rows)} rows)")
        else:
            lines.append(
                f"{ledger.document.key}: {len(missing)} of {numbers} numbers have no row: {', '.join(missing)}"
            )
        lines += [] if text is None else _of_text(text)
    return "\n".join(lines)


def _of_text(text: Coverage) -> Iterator[str]:
    yield f"{_INDENT}text: sha256 {text.digest}"
    if text.same is False:
        yield f"{_INDENT}the kept list was made from another text; the ledger was compared with this one"
    heads = ("", "in the text", "with a row", "none needed", "missing")
    yield from table([heads, *((kind, *map(str, text.counts(kind))) for kind in KINDS)], right=range(1, 5))
    for kind in KINDS:
        for name in text.missing(kind):
            yield from _wrapped(f"no row: {kind}: {printable(name, 100)}", 1)
    for row, piece in text.unquoted:
        yield from _wrapped(f"not in the text: {row}: {printable(piece, 200)}", 1)


def _document(review: ListedReview, rows: bool, code: bool) -> Iterator[str]:
    texts = review.texts
    by = f" ({review.byline})" if review.byline else ""
    yield from _wrapped(f"{review.key}: {review.ledger.document.title}{by}", hanging=1)
    yield ""
    for said, points in review.summary_points:
        yield from _wrapped(said, 1)
        for point in points:
            yield from _wrapped(f"- {point}", 2, hanging=1)
    if len(review.rows) >= _CHARTED:
        yield from ("", *_chart(review))
    if not review.findings:
        yield from ("", f"{_INDENT}{texts.get('audit', 'nothing')}")
    for weight, group in review.by_weight:
        yield from ("", f"{_INDENT}{texts.get('weights', weight.value)}")
        for number, finding in group:
            if rows or weight in IN_FULL:
                yield from _in_full(review, number, finding, rows, code)
            else:
                yield from _in_brief(review, number, finding)
    if review.open:
        listed = ", ".join(items(review.open))
        yield from ("", f"{_INDENT}{texts.get('audit', 'not_judged')}", *_wrapped(f"{listed}.", 2))
    if rows:
        told = {found.places[0].key for found in review.findings}
        for row in review.rows:
            yield from _row(review, row, code) if row.verdict not in SILENT and row.key not in told else ()
    elif review.findings:
        command = f"satsym audit {review.ledger.name} --rows"
        yield from ("", *_wrapped(texts.get("audit", "every_row", command=command), 1))


def _chart(review: ListedReview) -> Iterator[str]:
    """Return bars of how many rows of each kind are right, wrong and open."""
    keys = ("stood", "fallen", "left_open")
    yield f"{_INDENT}{review.texts.get('audit', 'chart')}"
    widest, said = max(len(name) for name, *_ in review.chart), []
    for _, *counts in review.chart:
        pairs = zip(keys, counts, strict=True)
        said.append(", ".join(review.texts.counted("audit", key, n) for key, n in pairs if n))
    left = _width() - len(_INDENT * 2) - widest - 2 - max(map(len, said))
    whole = max(min(_BAR, left), 3)
    for (name, *counts), text in zip(review.chart, said, strict=True):
        lengths = [-(-count * whole // sum(counts)) if count else 0 for count in counts]
        lengths[0] = whole - lengths[1] - lengths[2]
        bar = "".join(sign * length for sign, length in zip("#x?", lengths, strict=True))
        yield f"{_INDENT * 2}{name:{widest}} {bar} {text}"
    yield from _wrapped(review.items_that_hold, 2) if review.items_that_hold else ()


def _in_full(review: ListedReview, number: int, finding: Finding, rows: bool, code: bool) -> Iterator[str]:
    """Return a finding with the printed content, the true one, and its consequences; among rows, all of its row."""
    row, texts = finding.places[0], review.texts
    stands = f" ({review.placed(where(row))})" if where(row) else ""
    yield from _heading(review.texts, row, f"{number}. {review.places(finding.places)}", stands, 2)
    yield from _facts(review, row, short=not rows, code=code)
    if finding.spoiled:
        yield from _labelled(texts.get("audit", "spoils"), review.spoiled(finding))
    if rows:
        yield from _wrapped(row.evidence if code else recompute(row)[1], 3)


def _in_brief(review: ListedReview, number: int, finding: Finding) -> list[str]:
    """Return a finding in a sentence, without the printed content, which pages and the list of rows have."""
    return _wrapped(f"{number}. {review.places(finding.places)}: {review.brief(finding)}.", 1, hanging=2)


def _row(review: ListedReview, row: Judged, code: bool) -> Iterator[str]:
    """Return a row in full."""
    yield ""
    stands = f" ({review.placed(where(row))})" if where(row) else ""
    yield from _heading(review.texts, row, review.placed(row.key), stands, 1)
    yield from _facts(review, row, code=code)
    yield from _wrapped(row.evidence if code else recompute(row)[1], 3)


def _heading(texts: Texts, row: Judged, named: str, stands: str, hanging: int) -> list[str]:
    """Return a row with its verdict, and its printed content where that is short."""
    heading = f"{named}: {texts.get('verdicts', row.verdict)}{stands}"
    printed = f", {texts.get('audit', 'printed')} {flat(row.printed)}" if _is_short(row) else ""
    return _wrapped(heading + printed, 1, hanging)


def _facts(review: ListedReview, row: Judged, *, short: bool = False, code: bool = False) -> Iterator[str]:
    """Return the printed and the true content, each once, and code where requested."""
    claim, found = row.kind == "claim", measured(row)
    said = row.original or row.says if claim or not row.printed else ""
    facts = {
        "says": said,
        "printed": "" if claim or _is_short(row) else flat(row.printed),
        "in_fact": review.fact(row),
        "measured": "" if short or not found else review.in_words(row),
        "chosen": review.chosen(row),
        "recompute": recompute(row)[1] if short and found else "",
        "right": "" if short and is_put_in_words(row) else correction(row),
        "claims": flat(row.printed) if claim and code else "",
        "code": row.derived if code and not row.by_formula else "",
    }
    for key, text in facts.items():
        if text:
            yield from _labelled(review.texts.get("audit", key), text)


def _is_short(row: Judged) -> bool:
    return row.kind != "claim" and 0 < len(flat(row.printed)) <= _SHORT_FORMULA


def _labelled(label: str, text: str) -> list[str]:
    return _wrapped(f"{label:{_LABEL}}{text}" if len(label) < _LABEL else f"{label}: {text}", 3)


def _wrapped(text: str, depth: int = 0, hanging: int = 1) -> list[str]:
    """Break lines at the width of the terminal; longer words are broken after their signs."""
    indent, further = _INDENT * depth, _INDENT * (depth + hanging)
    width = _width()
    lines, line = [], indent
    for word in printable(text, len(text)).split(" "):
        for place, piece in enumerate(_pieces(word, width - len(further))):
            gap = "" if place or not line.strip() else " "
            if line.strip() and len(line) + len(gap) + len(piece) > width:
                lines.append(line.rstrip())
                line, gap = further, ""
            line += gap + piece
    return [*lines, line.rstrip()] if line.strip() else lines


def _width() -> int:
    return max(_NARROWEST, min(WIDTH, shutil.get_terminal_size((WIDTH, 24)).columns))


def _pieces(word: str, room: int) -> list[str]:
    if len(word) <= room:
        return [word]
    return [part[k : k + room] for part in _SEPARABLE.findall(word) for k in range(0, len(part), room)]


def checked_text(answers: Sequence[Answer]) -> str:
    """Return a line on how unclear letters were interpreted, and one for each equation."""
    understood = dict.fromkeys(filter(None, map(_understood, answers)))
    return "\n".join([*understood, *map(_line, answers)])


def _understood(answer: Answer) -> str:
    letters = ", ".join(f"{printed} = {ours}" for printed, ours in answer.letters.items())
    parts = [letters, say("the uncontrolled motion") if answer.free else ""]
    said = ", ".join(filter(None, parts))
    return say("symbols interpreted as: <letters> (to correct one: --let LETTER=NAME)", letters=said) if said else ""


def _line(answer: Answer) -> str:
    if answer.verdict == "right":
        if answer.address:
            return say("right: <address>", address=answer.address)
        return say("right: it follows from the equations of <model>", model=answer.model)
    if answer.verdict == "undecided":
        return say("undecided: <said_why>", said_why=message(answer.diagnosis))
    why = in_indonesian(answer.diagnosis) if language() == "id" else answer.diagnosis
    if not answer.correct:
        return say("wrong: <diagnosis> (<address>)", diagnosis=why, address=answer.address)
    right = answer.correct
    return say(
        "wrong: <diagnosis>; the correct form is <right> (<address>)",
        diagnosis=why,
        right=right,
        address=answer.address,
    )


def drafted_text(ledger: Path, found: Draft) -> str:
    """Return how many rows were drafted, and what was not read or understood, with the places."""
    counted = Counter(row["verdict"] for row in found.rows)
    lines = [
        say(
            "<ledger>: <rows> ledger rows drafted, <kept> confirmed rows kept",
            ledger=ledger,
            rows=len(found.rows),
            kept=found.kept,
        ),
        say(
            "verdicts before confirmation: <right> right, <wrong> wrong", right=counted["right"], wrong=counted["wrong"]
        ),
    ]
    lines += [say("<place>: not read: <said_why>", place=place, said_why=message(why)) for place, why in found.unread]
    lines += [
        say("<place>: not understood: <said_why>", place=place, said_why=message(why)) for place, why in found.undecided
    ]
    return "\n".join([*lines, say("confirm the rows of the ledger, then: satsym audit <ledger>", ledger=ledger)])
