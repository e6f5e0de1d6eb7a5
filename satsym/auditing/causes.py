"""Findings of an audit: faulty rows (claims of a document) grouped by their common cause, ordered by importance.

Two rows have one cause if the same edit corrects both, or if claims of one form fail in the same way. A row that
follows from a faulty row is a consequence, not an error of its own, and is counted with the row that it follows from.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum

from satsym.auditing.judged import Judged

SILENT = ("confirmed", "illegible", "undecided")
"""Verdicts that report no fault."""
_FALSE = ("wrong", "artefact", "unit error")
_MILD = {"imprecise", "notation"}


class Weight(str, Enum):
    """Importance of a finding, by what depends on it, in decreasing order."""

    OVERTURNS = "overturns a conclusion"
    RESULT = "wrong result"
    SLIP = "slip"
    IMPRECISE = "imprecise"
    NOTATION = "notation"


@dataclass(frozen=True)
class Finding:
    """Rows of a document that are faulty for one common cause."""

    document: str
    """Key of the document."""
    cause: str
    """Key of the first row that shows the fault; the rows of the finding refer to this key."""
    weight: Weight
    """Importance of the finding."""
    places: tuple[Judged, ...]
    """Rows that contain the fault themselves, in the order of the document."""
    spoiled: tuple[Judged, ...]
    """Rows that are wrong only because they follow from a row that contains the fault."""

    @property
    def statement(self) -> str:
        """Explanation of the fault in the first row that contains it."""
        return next((row.why for row in self.places if row.why), self.places[0].diagnosis)

    @property
    def correction(self) -> str:
        """Correct formula or value for the first row that contains the fault; empty if the correction is neither."""
        return self.places[0].derived

    @property
    def overturned(self) -> tuple[Judged, ...]:
        """Conclusions of the document that are false because of the fault of the finding."""
        return tuple(row for row in (*self.places, *self.spoiled) if _falls(row))


def findings(rows: Sequence[Judged]) -> list[Finding]:
    """Return the findings of a document, the most important first, otherwise in the order of the document."""
    faulty = {row.key: row for row in rows if row.verdict not in SILENT}
    roots = {key: _root(key, faulty) for key in faulty}
    first: dict[tuple[str, str], str] = {}
    for key, root in roots.items():
        if root == key:
            first.setdefault(_fault(faulty[key]), key)
    causes = {key: first[_fault(faulty[root])] for key, root in roots.items()}
    found = []
    for cause in dict.fromkeys(first.values()):
        own = [faulty[key] for key in faulty if causes[key] == cause]
        places = tuple(row for row in own if roots[row.key] == row.key)
        spoiled = tuple(row for row in own if roots[row.key] != row.key)
        found.append(Finding(faulty[cause].document, cause, _weight(places, spoiled), places, spoiled))
    return sorted(found, key=lambda finding: list(Weight).index(finding.weight))


def with_causes(rows: Sequence[Judged]) -> list[Judged]:
    """Return copies of the rows in which each faulty row has the key of its cause and the weight of the finding."""
    of = {row.key: finding for finding in findings(rows) for row in (*finding.places, *finding.spoiled)}
    return [
        replace(row, cause=of[row.key].cause, weight=of[row.key].weight.value) if row.key in of else row for row in rows
    ]


def _fault(row: Judged) -> tuple[str, str]:
    """Return the text that rows with one cause share, with the verdict: form of the fault, or print and correction."""
    printed = f"{row.printed}: {row.derived}" if row.by_formula else row.key
    return row.verdict, row.form or printed


def _root(key: str, faulty: Mapping[str, Judged]) -> str:
    """Return the key of the row where the fault of a row originates, following `spoiled_by` to faulty rows only."""
    seen = [key]
    while True:
        above = [
            k for k in faulty[seen[-1]].spoiled_by if k in faulty and k not in seen and faulty[k].verdict not in _MILD
        ]
        if not above:
            return seen[-1]
        seen.append(above[0])


def _falls(row: Judged) -> bool:
    return row.role == "conclusion" and row.verdict in _FALSE


def _weight(places: Sequence[Judged], spoiled: Sequence[Judged]) -> Weight:
    if any(map(_falls, (*places, *spoiled))):
        return Weight.OVERTURNS
    false = [row for row in (*places, *spoiled) if row.verdict in _FALSE]
    # a formula is wrong, and no misprint, where it is used, if only by rows that are not looked at
    carried_on = any(row.by_formula and row.kind != "number" and row.verdict == "wrong" for row in places)
    if spoiled or carried_on or any(row.role == "result" for row in false):
        return Weight.RESULT
    if all(row.verdict == "notation" for row in places):
        return Weight.NOTATION
    return Weight.IMPRECISE if all(row.verdict == "imprecise" for row in places) else Weight.SLIP
