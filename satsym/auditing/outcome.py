"""What judging a row found, before rows are looked at together."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from satsym.auditing.diagnosis.smallest_edit import Remedy
from satsym.auditing.judge.plan import Plan
from satsym.auditing.ledger.contents import Row


@dataclass(frozen=True)
class Outcome:
    """One row, judged by itself.

    Attributes
    ----------
    right
        Whether it equals what it is held against; ``None`` where it cannot be read or decided.
    derived
        What is right, in the document's symbols.
    plan, remedy
        Of a formula: how it was compared, and what puts it right.
    sound, vacuous, artefact, unit, near
        Whether its reason holds; whether nothing meets its condition; whether the printed algorithm produces it;
        whether only its unit is wrong; whether it fails by a last digit alone.
    remark
        A sentence for the diagnosis.
    lacks
        Of a unit, the dimension that it has to be multiplied by.
    evidence
        Measured numbers.
    """

    row: Row
    right: bool | None
    derived: str = ""
    plan: Plan | None = None
    remedy: Remedy | None = None
    sound: bool = True
    vacuous: bool = False
    artefact: bool = False
    unit: bool = False
    near: bool = False
    remark: str = ""
    lacks: str = ""
    evidence: Mapping[str, object] = field(default_factory=dict)
