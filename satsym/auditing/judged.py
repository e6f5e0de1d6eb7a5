"""A row (one claim of a document) with its verdict, the result of an audit.

The verdicts are ``confirmed``, ``misprint`` (right elsewhere in the document, or not used by what follows), ``wrong``
(used by what follows, or a false claim), ``unsound`` (a right result by an invalid step), ``artefact`` (produced by the
algorithm, not by the problem), ``unit error``, ``imprecise`` (the last digit is off), ``notation`` (a letter with two
meanings), ``undecided`` and ``illegible``.
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
"""Attributes that a judged row copies from its row in the ledger."""


@dataclass(frozen=True)
class Judged:
    """A row (one claim of a document) with its verdict.

    Attributes
    ----------
    document, item, part, kind, says, where, printed, role, original
        Copied from the ledger.
    derived
        The right formula or value.
    diagnosis, diagnosis_id
        What is wrong, in sentences of a referee, in English and Indonesian; empty for a confirmed row.
    evidence
        Computed numbers, and the command that recomputes them.
    why, why_id
        Explanation of the fault for readers, in English and Indonesian; empty if the ledger has none.
    says_id
        The subject of the row in Indonesian; empty if the ledger does not state it.
    form
        Text that rows with the same fault share: the edit that corrects them, or the form of the claim.
    by_formula
        Whether the row was compared with a formula or number; otherwise it was judged by a proposition.
    vacuous
        Whether the claim is true only because nothing satisfies its condition.
    spoiled_by
        Keys of the faulty rows that the row follows from.
    cause, weight
        Cause and importance of the finding that the row belongs to, filled in after all rows are judged.
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
        """Item and part of the row, which identify it within its document."""
        return f"{self.item} {self.part}".strip()
