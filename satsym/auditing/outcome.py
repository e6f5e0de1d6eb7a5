"""What judging a row found, before rows are looked at together."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from satsym.auditing.comparison.plan import Plan
from satsym.auditing.diagnosis.smallest_edit import Remedy
from satsym.auditing.ledger.contents import Row


@dataclass(frozen=True)
class Outcome:
    """One row, judged by itself."""

    row: Row
    right: bool | None
    """Whether it equals what it is held against; ``None`` where it cannot be read or decided."""
    derived: str = ""
    """What is right, in the document's symbols."""
    plan: Plan | None = None
    remedy: Remedy | None = None
    """How a formula was compared, and what puts it right."""
    sound: bool = True
    vacuous: bool = False
    artefact: bool = False
    unit: bool = False
    near: bool = False
    """Whether its reason holds; whether nothing meets its condition; whether the printed algorithm produces it;
    whether only its unit is wrong; whether it fails by a last digit alone."""
    remark: str = ""
    """A sentence for the diagnosis."""
    lacks: str = ""
    """The dimension that a wrong unit has to be multiplied by."""
    evidence: Mapping[str, object] = field(default_factory=dict)
    """Measured numbers."""
