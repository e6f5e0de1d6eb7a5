"""Findings: rows that go wrong for one reason, together with what they spoil, and how much depends on them.

Two rows have one cause where the same edit puts both right, or where claims of one form fail in one way. A row that
follows from what is wrong is a consequence and no slip of its own: it is counted with what spoils it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum

from satsym.auditing.judged import Judged

SILENT = ("confirmed", "illegible", "undecided")
"""Verdicts that find no fault."""
_FALSE = ("wrong", "artefact", "unit error")
_MILD = {"imprecise", "notation"}


class Weight(str, Enum):
    """How much depends on a finding, the most first."""

    OVERTURNS = "overturns a conclusion"
    RESULT = "wrong result"
    SLIP = "slip"
    IMPRECISE = "imprecise"
    NOTATION = "notation"


@dataclass(frozen=True)
class Finding:
    """One cause."""

    document: str
    """Key of the document."""
    cause: str
    """Key of the row where it shows first; rows of this cause name it."""
    weight: Weight
    """How much depends on it."""
    places: tuple[Judged, ...]
    """Rows that have the fault themselves, the first first."""
    spoiled: tuple[Judged, ...]
    """Rows that are wrong because they follow from those."""

    @property
    def statement(self) -> str:
        """What is wrong, of the first place."""
        return next((row.why for row in self.places if row.why), self.places[0].diagnosis)

    @property
    def correction(self) -> str:
        """What is right there; empty where that is no formula or value."""
        return self.places[0].derived

    @property
    def overturned(self) -> tuple[Judged, ...]:
        """Conclusions that fall with it."""
        return tuple(row for row in (*self.places, *self.spoiled) if _falls(row))


def findings(rows: Sequence[Judged]) -> list[Finding]:
    """The findings of a document, those on which most depends first, else in the order of the document."""
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
    """The rows, each with its cause and the weight of that."""
    of = {row.key: finding for finding in findings(rows) for row in (*finding.places, *finding.spoiled)}
    return [
        replace(row, cause=of[row.key].cause, weight=of[row.key].weight.value) if row.key in of else row for row in rows
    ]


def _fault(row: Judged) -> tuple[str, str]:
    """What rows with one cause share: the edit or form, or what is printed and what it should be."""
    printed = f"{row.printed}: {row.derived}" if row.by_formula else row.key
    return row.verdict, row.form or printed


def _root(key: str, faulty: Mapping[str, Judged]) -> str:
    """Where the fault of a row comes from: up along what it follows from, as long as that is faulty itself."""
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
