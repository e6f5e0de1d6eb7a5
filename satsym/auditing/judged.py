"""A row with its verdict: what the audit answers.

``confirmed``, ``misprint`` (right elsewhere in the document, or what follows does not use it), ``wrong`` (used by what
follows, or a false claim), ``unsound`` (a right result by an invalid step), ``artefact`` (produced by the algorithm,
not by the problem), ``unit error``, ``imprecise`` (a last digit off), ``notation`` (a letter used for two things),
``undecided``, ``illegible``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, TypeAlias, get_args

Verdict: TypeAlias = Literal[
    "confirmed",
    "misprint",
    "wrong",
    "unsound",
    "artefact",
    "unit error",
    "imprecise",
    "notation",
    "undecided",
    "illegible",
]
VERDICTS: tuple[Verdict, ...] = get_args(Verdict)
AS_STATED = ("item", "part", "kind", "says", "where", "printed", "role", "original")
"""Attributes that a row has from its ledger as they stand there."""


@dataclass(frozen=True)
class Judged:
    """A row with its verdict.

    Attributes
    ----------
    document, item, part, kind, says, where, printed, role, original
        As the ledger has them.
    derived
        What is right.
    diagnosis, diagnosis_id
        A referee's sentences, in English and Indonesian; empty for what is confirmed.
    evidence
        Measured numbers, and the command that recomputes them.
    why, why_id
        Why it is not so, in a sentence for people, in English and Indonesian, where the ledger has one.
    says_id
        What it is about in Indonesian, where the ledger has that.
    form
        What rows with the same fault share: the edit that puts them right, or the form of the claim.
    by_formula
        Whether it was held against a formula or a number, not judged by a proposition.
    vacuous
        Whether it is true only because nothing meets its condition.
    spoiled_by
        Faulty rows that it follows from.
    cause, weight
        Of the finding it belongs to, once rows are looked at together.
    """

    document: str
    item: str
    part: str
    kind: str
    says: str
    where: str
    printed: Any
    derived: str
    verdict: Verdict
    diagnosis: str
    evidence: str
    role: str = ""
    original: str = ""
    why: str = ""
    why_id: str = ""
    diagnosis_id: str = ""
    says_id: str = ""
    form: str = ""
    by_formula: bool = False
    vacuous: bool = False
    spoiled_by: tuple[str, ...] = ()
    cause: str = ""
    weight: str = ""

    @property
    def key(self) -> str:
        """Item and part."""
        return f"{self.item} {self.part}".strip()
