"""Audits as users meet them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Any

from satsym import auditing
from satsym.auditing import Judged, Ledger, cache
from satsym.front import html
from satsym.front.refusals import in_one_line
from satsym.front.single_threaded import single_threaded
from satsym.report.findings import objects, review
from satsym.report.results.files import to_json
from satsym.report.terminal import audit as reporting


@dataclass(frozen=True, eq=False, repr=False)
class Audit:
    """What documents print, judged row by row.

    Attributes
    ----------
    ledgers
        What they print.
    judged
        Key of a document -> its rows with their verdicts.
    """

    ledgers: tuple[Ledger, ...]
    judged: Mapping[str, Sequence[Judged]]

    @property
    def rows(self) -> list[Judged]:
        """Judged rows of all documents."""
        return list(chain.from_iterable(self.judged.values()))

    @property
    def counts(self) -> dict[str, int]:
        """How many rows have each verdict."""
        return review.counts(self.rows)

    def __iter__(self) -> Iterator[Judged]:
        return iter(self.rows)

    def __len__(self) -> int:
        return len(self.rows)

    def to_dict(self) -> dict[str, Any]:
        """What ``satsym audit --json`` prints."""
        return objects.audit_object(self.rows)

    def to_json(self) -> str:
        """Return the audit as JSON text."""
        return to_json(self.to_dict())

    def latex(self, language: str = "en") -> str:
        """A report for LaTeX."""
        from satsym.report.latex.audit import render

        return render(self.ledgers, self.judged, language)

    def html(self, language: str = "en") -> str:
        """A report as a page of its own."""
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
    """Judge what documents print.

    Parameters
    ----------
    ledgers
        Documents that come with satsym, or paths of ledgers; by default all documents.
    items
        Judge these items alone.
    fresh
        Compute anew, whatever is in the cache.

    Raises
    ------
    BadInput
        If there is no such document or item, or a ledger cannot be used.
    """
    paths = [auditing.locate(str(name)) for name in ledgers] if ledgers else auditing.shipped()
    read = tuple(auditing.read(path) for path in paths)
    auditing.refuse_unknown_items(read, items)
    return Audit(read, {x.document.key: cache.audit(x, items, fresh=fresh) for x in read})
