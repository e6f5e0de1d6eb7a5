"""The review of one judged document: findings numbered by weight, and sentences on what is wrong and what is right."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

from satsym.auditing import VERDICTS, Judged, Ledger
from satsym.auditing.causes import Finding, Weight, findings
from satsym.auditing.sentences import say
from satsym.report.findings import terms
from satsym.report.texts import Texts

IN_FULL = (Weight.OVERTURNS, Weight.RESULT)
"""Weights of findings that are described in full; others are described in one sentence."""
OPEN = ("undecided", "illegible")
"""Verdicts of rows that could not be judged."""
_PLACES, _ITEMS = 3, 6
"""Largest numbers of rows, and of items, that are named; further ones are only counted."""
_QUOTES = 5
"""Largest number of correct conclusions that are quoted; if there are more, only their names are given."""
STANDS = ("confirmed", "imprecise", "notation", "unsound")
"""Verdicts on rows that are essentially right: exactly, up to the last digits or the notation, or for another
reason."""
KINDS = ("equation", "matrix", "algorithm", "number", "unit", "table", "claim")
_PLACE_WORD = re.compile(r"[a-z]{3,}")
_END = re.compile(r"[.](?=\s+[`A-Z0-9])")


@dataclass(frozen=True)
class Review:
    """A judged document with its findings.

    Attributes
    ----------
    ledger, rows
        What it prints, and how that was judged.
    texts
        Of the language of the report.
    """

    ledger: Ledger
    rows: Sequence[Judged]
    texts: Texts

    @classmethod
    def of(cls, ledger: Ledger, rows: Sequence[Judged], texts: Texts) -> Self:
        """Make the review of a judged document, in a language as far as its words are known in it."""
        if texts.language == "id":
            rows = [_in_indonesian(row) for row in rows]
        return cls(ledger, rows, texts)

    def translated(self, row: Judged) -> bool:
        """Tell whether the subject of a row is in the language of the report; ledgers may have only English."""
        return self.texts.language == "en" or (self.texts.language == "id" and bool(row.says_id))

    @property
    def key(self) -> str:
        """Return the key of the document."""
        return self.ledger.document.key

    @property
    def byline(self) -> str:
        """Return authors and year."""
        document = self.ledger.document
        return ", ".join(filter(None, [document.authors, str(document.year or "")]))

    @cached_property
    def findings(self) -> list[Finding]:
        """Return the findings, those on which most depends first."""
        return findings(self.rows)

    @cached_property
    def number_of(self) -> dict[str, int]:
        """Map the key of each faulty row to the number of its finding."""
        return {
            row.key: number
            for number, found in enumerate(self.findings, start=1)
            for row in (*found.places, *found.spoiled)
        }

    @property
    def by_weight(self) -> Iterable[tuple[Weight, list[tuple[int, Finding]]]]:
        """Return the numbered findings by weight, without weights that have none."""
        numbered = list(enumerate(self.findings, start=1))
        groups = [(weight, [entry for entry in numbered if entry[1].weight is weight]) for weight in Weight]
        return [(weight, group) for weight, group in groups if group]

    @property
    def counts(self) -> dict[str, int]:
        """Return the number of rows with each verdict."""
        return counts(self.rows)

    @property
    def chart(self) -> list[tuple[str, int, int, int]]:
        """Count the rows that stand, fall and could not be judged: the conclusions, then the others by kind."""
        groups = [("conclusion", [row for row in self.rows if row.role == "conclusion"])]
        groups += [(kind, [r for r in self.rows if r.kind == kind and r.role != "conclusion"]) for kind in KINDS]
        counted = []
        for name, rows in groups:
            stand, undecided = (sum(r.verdict in verdicts for r in rows) for verdicts in (STANDS, OPEN))
            if rows:
                named = self.texts.get("row_kinds", name)
                counted.append((named, stand, len(rows) - stand - undecided, undecided))
        return counted

    @property
    def items_that_hold(self) -> str:
        """Return which verdicts are among the rows that stand; empty if all of them are confirmed."""
        found = {verdict: self.counts[verdict] for verdict in STANDS if verdict in self.counts}
        if found.keys() <= {"confirmed"}:
            return ""
        listed = [f"{number} {self.texts.get('verdicts', verdict)}" for verdict, number in found.items()]
        return self._say("held", sum(found.values()), listed=self.texts.listed(listed))

    @cached_property
    def formulas(self) -> dict[str, Any]:
        """Map the keys of rows to the formulas or matrices that they print."""
        return {row.key: row.printed for row in self.ledger.rows if row.printed is not None}

    @property
    def open(self) -> list[Judged]:
        """Return the rows that could not be judged."""
        return [row for row in self.rows if row.verdict in OPEN]

    @property
    def confirmed_items(self) -> list[str]:
        """Return the items all of whose parts are confirmed."""
        other = {row.item for row in self.rows if row.verdict != "confirmed"}
        return items([row for row in self.rows if row.item not in other])

    def places(self, rows: Sequence[Judged]) -> str:
        """Return the places where a finding occurs; of many, the first."""
        return self._named([self.placed(row.key) for row in rows])

    def spoiled(self, found: Finding) -> str:
        """Return, by item, what is wrong because of a finding."""
        return self._named([self.placed(name) for name in items(found.spoiled)], _ITEMS)

    def _named(self, names: Sequence[str], most: int = _PLACES) -> str:
        if len(names) <= most:
            return self.texts.listed(list(names))
        first = ", ".join(names[: most - 1])
        return self.texts.counted("audit", "more", len(names) - most + 1, listed=first)

    def fact(self, row: Judged) -> str:
        """Return what is true instead of a wrong claim: a readable sentence if there is one, else the diagnosis."""
        if row.why and not (row.by_formula and row.form):
            return row.why
        denied = say("denied")
        said = row.diagnosis.removeprefix(f"{denied}: ").removeprefix(f"{denied.indonesian}: ")
        if not row.by_formula and row.derived and row.verdict not in OPEN:
            words = self.in_words(row)
            said = said if words else row.diagnosis
            said = said.replace(f": {row.derived}", f". {words}".rstrip(". ")).replace(row.derived, words.rstrip("."))
        return f"{said} {row.why}".rstrip()

    def in_words(self, row: Judged) -> str:
        """Return the measured values of a row as sentences; empty where they have none."""
        return terms.sentences(row.derived, self.texts, flat(row.printed) if row.kind == "claim" else "")

    def chosen(self, row: Judged) -> str:
        """Return the named numbers that the auditor chose for judging a row; empty where there are none."""
        code = f"{flat(row.printed) if row.kind == 'claim' else ''} {row.evidence}"
        return "; ".join(terms.chosen(code, self.texts))

    def placed(self, name: str) -> str:
        """Return the name of a place in the language of the report: "section 4.2" as "bagian 4.2"."""
        if self.texts.language == "en":
            return name
        return _PLACE_WORD.sub(lambda word: self.texts.find("places", word[0]) or word[0], name)

    def brief(self, found: Finding) -> str:
        """Return the first sentence of a diagnosis without its full stop; for a few differing places, that of each."""
        said = list(dict.fromkeys(_first_sentence(row.why) for row in found.places if row.why))
        if len(said) > _PLACES:
            return said[0]
        return ". ".join(said) or _first_sentence(self.fact(found.places[0]))

    @cached_property
    def summary(self) -> list[str]:
        """Summarise in at most six sentences which conclusions are wrong or right, and why."""
        right, total = sum(row.verdict == "confirmed" for row in self.rows), len(self.rows)
        rest = self._say("rest", len(self.findings)) if self.findings and total > 1 else ""
        how = {0: "right_none", total: "right_all"}.get(right, "right_some")
        confirmed = self._say(how, right if how == "right_some" else total)
        sentences = [self._say("checked", total, right=confirmed, rest=rest), *self._conclusions()]
        overturns = any(found.weight is Weight.OVERTURNS for found in self.findings)
        if self.findings and not overturns:
            first = self.findings[0]
            heaviest = self._say("heaviest", 1, place=self.places(first.places), statement=self.brief(first))
            sentences.append(heaviest)
        listed = [
            self.texts.counted("weights_counted", weight.value, len(group))
            for weight, group in self.by_weight
            if weight is not Weight.OVERTURNS
        ]
        if listed:
            sentences.append(self._say("besides" if overturns else "findings", 1, listed=self.texts.listed(listed)))
        if self.open:
            sentences.append(self._say("open", len(self.open)))
        return sentences

    def _conclusions(self) -> list[str]:
        """State which conclusions are wrong, with the reason of each, and which are right."""
        conclusions = [row for row in self.rows if row.role == "conclusion" and row.verdict not in OPEN]
        causes = [(number, found) for number, found in enumerate(self.findings, start=1) if found.overturned]
        falling = {row.key for _, found in causes for row in found.overturned}
        standing = [row for row in conclusions if row.key not in falling]
        said, total = [], len(conclusions)
        if causes:
            reasons = self.points([f"({number}) {self._fallen(found)}" for number, found in causes])
            falls = self._say("falls", len(falling))
            said.append(self._say("fall", total, reasons=reasons, falling=falls))
        if standing:
            keys = [self.placed(row.key) for row in standing]
            quoted = len(standing) <= _QUOTES
            named = [f"{_quoted(row)} ({key})" if quoted else key for row, key in zip(standing, keys, strict=True)]
            parts = [f"{name}{self._reserve(row)}" for name, row in zip(named, standing, strict=True)]
            key, number = ("stand", len(standing)) if causes else ("all_stand", total)
            said.append(self._say(key, number, quoted=self.points(parts)))
        return said

    def points(self, parts: Sequence[str]) -> str:
        """Return the points of a sentence of the summary as one text."""
        return "; ".join(parts)

    def _reserve(self, row: Judged) -> str:
        """State the reserve with which a conclusion is right."""
        if row.verdict != "unsound":
            return ""
        return f", {self.texts.get('audit', 'of_nothing' if row.vacuous else 'other_reason')}"

    def _fallen(self, found: Finding) -> str:
        """State the conclusions that a finding overturns, where they are, and why."""
        first = found.overturned[0]
        places = "; ".join(self.placed(row.key) for row in found.overturned)
        why = _first_sentence(self.fact(first)) if first.why else self.brief(found)
        if not first.why and first not in found.places and not any(row.why for row in found.places):
            why = self._say("because", 1, place=self.placed(found.places[0].key), statement=why)
        return f"{_quoted(first)} ({places}): {why}"

    def _say(self, key: str, number: int, **fill: str) -> str:
        return self.texts.counted("audit", key, number, **fill)


class ListedReview(Review):
    """A review for pages and terminals, where the points of a sentence of the summary are a list."""

    def points(self, parts: Sequence[str]) -> str:
        """Return the points of a sentence on lines of their own; a single one stays in it."""
        return "\n".join(["", *parts]) if len(parts) > 1 else super().points(parts)

    @property
    def summary_points(self) -> Iterator[tuple[str, list[str]]]:
        """Return each sentence of the summary with its points, which are sentences as well."""
        for text in self.summary:
            sentence, *points = text.split("\n")
            yield sentence.rstrip(), [f"{point.rstrip('.')}." for point in points]


def title(reviews: Sequence[Review]) -> str:
    """Return the title of a report."""
    texts, documents = reviews[0].texts, reviews[0].ledger.document.title
    return texts.counted("audit", "title", len(reviews), documents=documents)


def where(row: Judged) -> str:
    """Return the place of a finding, unless its name contains it."""
    return "" if row.key.startswith(row.where) else row.where


def _first_sentence(text: str) -> str:
    return _END.split(text.strip(), maxsplit=1)[0].rstrip(".")


def _quoted(row: Judged) -> str:
    return f'"{row.original or row.says or flat(row.printed)}"'


def counts(judged: Sequence[Judged]) -> dict[str, int]:
    """Return the number of rows with each verdict, without verdicts that no row has."""
    found = {verdict: sum(row.verdict == verdict for row in judged) for verdict in VERDICTS}
    return {verdict: number for verdict, number in found.items() if number}


def items(judged: Sequence[Judged]) -> list[str]:
    """Return items, each once; with the number of rows in brackets where there are several."""
    numbers: dict[str, int] = {}
    for row in judged:
        numbers[row.item] = numbers.get(row.item, 0) + 1
    return [f"{item} ({number})" if number > 1 else item for item, number in numbers.items()]


def _in_indonesian(row: Judged) -> Judged:
    texts = {name: getattr(row, f"{name}_id") or getattr(row, name) for name in ("says", "why", "diagnosis")}
    return replace(row, **texts)


def quote(row: Judged) -> tuple[str, str]:
    """Return what a row prints, in the document's words or as its formula, or its subject, after its label."""
    if row.original:
        return "says", row.original
    if row.kind != "claim" and row.printed:
        return "printed", flat(row.printed)
    return "about", row.says


def measured(row: Judged) -> str:
    """Return the measured values, if the sentence for people does not contain them."""
    return row.derived if row.why and not row.by_formula and row.derived not in row.why else ""


def correction(row: Judged) -> str:
    """Return the right formula of a judged row; empty where its explanation already contains it."""
    said = row.why or row.diagnosis
    return "" if (row.why and not row.by_formula) or row.derived in said else row.derived


def is_put_in_words(row: Judged) -> bool:
    """Tell whether the diagnosis of a formula is the edit that corrects it."""
    return row.kind != "claim" and bool(row.form)


def is_mathematical(row: Judged) -> bool:
    """Tell whether the correct content of a row is a formula or a matrix."""
    return row.kind in ("equation", "matrix", "algorithm")


def recompute(row: Judged) -> tuple[str, str]:
    """Return the measured numbers, and the command that computes them again."""
    numbers, _, command = row.evidence.rpartition("; satsym ")
    return (numbers, f"satsym {command}") if numbers else ("", row.evidence)


def flat(printed: Any) -> str:
    """Return the printed content on one line."""
    return printed if isinstance(printed, str) else f"[{', '.join(map(flat, printed))}]"
