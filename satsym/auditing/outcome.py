"""Outcome of judging one row, before the rows of a document are related to each other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from satsym.auditing.comparison.plan import Plan
from satsym.auditing.diagnosis.smallest_edit import Remedy
from satsym.auditing.ledger.contents import Row


@dataclass(frozen=True)
class Outcome:
    """Outcome of judging one row by itself."""

    row: Row
    right: bool | None
    """Whether the row agrees with what it is compared with; ``None`` if it cannot be read or decided."""
    derived: str = ""
    """The right formula or value in the document's symbols."""
    plan: Plan | None = None
    remedy: Remedy | None = None
    """How a formula was compared, and the edits that correct it."""
    sound: bool = True
    vacuous: bool = False
    artefact: bool = False
    unit: bool = False
    near: bool = False
    """Properties of the row: its reason is true (`sound`), nothing satisfies its condition (`vacuous`), the printed
    algorithm produces it (`artefact`), only its unit (`unit`), or only its last digit (`near`), is wrong."""
    remark: str = ""
    """Sentence that becomes part of the diagnosis of the row."""
    lacks: str = ""
    """Dimension by which a wrong unit has to be multiplied."""
    evidence: Mapping[str, object] = field(default_factory=dict)
    """Computed values that decide the outcome, by name."""
