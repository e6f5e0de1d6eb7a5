"""Audits of documents, and checks of single formulas, in Python."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Any

from satsym import auditing
from satsym.auditing import Judged, Ledger, cache
from satsym.auditing.check import answers as checking
from satsym.auditing.check.answer import check_in
from satsym.auditing.check.answers import Answer, Verdict
from satsym.front import html
from satsym.front.calls import in_one_line, single_threaded
from satsym.report.findings import objects, review
from satsym.report.results.files import to_json
from satsym.report.terminal import audit as reporting
from satsym.report.terminal.audit import checked_text


@dataclass(frozen=True, eq=False, repr=False)
class Audit:
    """The audit of documents: each claim (row) of each document with its verdict.

    Attributes
    ----------
    ledgers
        The ledgers of the documents. A ledger lists the claims made in a document.
    judged
        Key of a document -> its judged rows.
    """

    ledgers: tuple[Ledger, ...]
    judged: Mapping[str, Sequence[Judged]]

    @property
    def rows(self) -> list[Judged]:
        """Return the judged rows of all documents."""
        return list(chain.from_iterable(self.judged.values()))

    @property
    def counts(self) -> dict[str, int]:
        """Return the number of rows with each verdict."""
        return review.counts(self.rows)

    def __iter__(self) -> Iterator[Judged]:
        return iter(self.rows)

    def __len__(self) -> int:
        return len(self.rows)

    def to_dict(self) -> dict[str, Any]:
        """Return the object that ``satsym audit --json`` prints."""
        return objects.audit_object(self.rows)

    def to_json(self) -> str:
        """Return the audit as JSON text."""
        return to_json(self.to_dict())

    def latex(self, language: str = "en") -> str:
        """Return the report of the audit as LaTeX, in English (``"en"``) or Indonesian (``"id"``)."""
        from satsym.report.latex.audit import render

        return render(self.ledgers, self.judged, language)

    def html(self, language: str = "en") -> str:
        """Return the report of the audit as a self-contained page, in English (``"en"``) or Indonesian (``"id"``)."""
        from satsym.report.html.audit import render

        return render(self.ledgers, self.judged, language)

    def __repr__(self) -> str:
        return reporting.audit_text(self.ledgers, self.judged)

    def _repr_html_(self) -> str:
        found = [(row.document, row.key, row.verdict, row.diagnosis) for row in self.rows if row.verdict != "confirmed"]
        named = ", ".join(ledger.document.key for ledger in self.ledgers)
        counted = [", ".join(f"{number} {verdict}" for verdict, number in self.counts.items())]
        return html.page(f"audit of {named}", counted, html.table(("document", "item", "verdict", "diagnosis"), found))


@single_threaded()
@in_one_line
def audit(*ledgers: str | Path, items: Sequence[str] = (), fresh: bool = False) -> Audit:
    """Check each claim (row) that a document makes against what satsym derives, and return a verdict for each.

    Parameters
    ----------
    ledgers
        Keys of documents that are shipped with satsym, or paths of ledgers, the files that list the claims of a
        document; by default all shipped documents.
    items
        Numbers of equations, tables etc. whose rows are checked; by default all.
    fresh
        Whether to recompute all verdicts instead of using cached ones.

    Returns
    -------
    Audit
        The verdicts on all rows, with a report.

    Raises
    ------
    BadInput
        If there is no such document or item, or if a ledger cannot be used.
    """
    paths = [auditing.locate(str(name)) for name in ledgers] if ledgers else auditing.shipped()
    read = tuple(auditing.read(path) for path in paths)
    auditing.refuse_unknown_items(read, items)
    return Audit(read, {x.document.key: cache.audit(x, items, fresh=fresh) for x in read})


@dataclass(frozen=True, eq=False, repr=False)
class Checked:
    """The result of checking a printed formula.

    Attributes
    ----------
    formula
        The formula as it was entered.
    answers
        One answer for each equation in the formula.
    """

    formula: str
    answers: tuple[Answer, ...]

    @property
    def verdict(self) -> Verdict:
        """Return ``right``, ``wrong`` or ``undecided``; for a formula with several equations, the worst of them."""
        return checking.worst(self.answers).verdict

    @property
    def address(self) -> str:
        """Return the address of the equation of the model that the formula states, or is most similar to."""
        return checking.worst(self.answers).address

    @property
    def diagnosis(self) -> str:
        """Return what is wrong with the formula; empty for a right formula."""
        return checking.worst(self.answers).diagnosis

    @property
    def correct(self) -> str:
        """Return the correct equation in the notation of the formula.

        It is empty for a right formula, or if none is known.
        """
        return checking.worst(self.answers).correct

    @property
    def letters(self) -> Mapping[str, str]:
        """Return printed letters -> names of the model, for letters whose meaning was given or guessed."""
        return {printed: ours for answer in self.answers for printed, ours in answer.letters.items()}

    def __bool__(self) -> bool:
        return self.verdict == "right"

    def to_dict(self) -> dict[str, Any]:
        """Return the object that ``satsym check --json`` prints."""
        return checking.as_object(self.formula, self.answers)

    def __repr__(self) -> str:
        return checked_text(self.answers)

    def _repr_latex_(self) -> str:
        lines = [rf"{answer.latex} &\quad\text{{{_said(answer)}}}" for answer in self.answers]
        return r"$$\begin{aligned} " + r" \\ ".join(lines) + r" \end{aligned}$$"


def _said(answer: Answer) -> str:
    """Return the verdict on one equation of a formula as text."""
    said = "is right" if answer.verdict == "wrong" and answer.correct else answer.verdict
    return f"{said}: {answer.address}".replace("_", r"\_") if answer.address else said


@in_one_line
def check(formula: str, model: str, let: str | Sequence[str] | Mapping[str, str] = (), free: bool = False) -> Checked:
    """Check whether a printed formula is right, and say what is wrong with it.

    Parameters
    ----------
    formula
        The formula in LaTeX or plain notation; its text is never evaluated.
    model
        Name of a shipped model, or ``"DIR/NAME"`` after ``satsym derive --out DIR``.
    let
        Meanings of printed letters: ``{"n": "omega"}``, or ``"n=omega"``.
    free
        Whether the formula describes the uncontrolled motion.

    Returns
    -------
    Checked
        The verdict, with a diagnosis and the correct equation if the formula is wrong.

    Raises
    ------
    BadInput
        If the formula cannot be parsed (the message gives the position), or if there is no such model or name.
    """
    told = [f"{printed}={ours}" for printed, ours in let.items()] if isinstance(let, Mapping) else let
    found = check_in(formula, model, Path(), [told] if isinstance(told, str) else list(told), free)
    return Checked(formula, tuple(found))
