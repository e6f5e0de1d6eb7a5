"""What comes of checking an equation."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from satsym.auditing.check.derived import Target
from satsym.auditing.check.meanings import Guess

Verdict = Literal["right", "wrong", "undecided"]


@dataclass(frozen=True)
class Fit:
    """A way to understand an equation, with the equation of the model that it comes near."""

    guess: Guess
    target: Target | None
    free: bool
    likeness: float


@dataclass(frozen=True)
class Answer:
    """What comes of checking one equation.

    Attributes
    ----------
    formula
        The equation as it was read, in the notation that it was given in.
    model
        Name of the model.
    letters
        Printed letter -> our name, for letters that are no names of the model's own notation.
    free
        Whether it is right, or meant, for the uncontrolled motion.
    verdict
        ``right``, ``wrong`` or ``undecided``.
    address
        The equation that it is, or is meant to be; empty where it merely follows, or nothing comes near.
    diagnosis
        What is wrong, in a sentence; empty for what is right.
    correct
        The right equation in the notation it was given in; empty where none is known.
    latex
        The right equation in LaTeX; that of a right one is itself.
    plain
        The same in plain notation.
    fit
        How it was understood.
    """

    formula: str
    model: str
    letters: Mapping[str, str]
    free: bool
    verdict: Verdict
    address: str
    diagnosis: str
    correct: str
    latex: str
    plain: str
    fit: Fit | None = field(default=None, repr=False, compare=False)


def worst(answers: Sequence[Answer]) -> Answer:
    """The first that is wrong, else the first that is undecided, else the first."""
    return min(answers, key=lambda answer: ("wrong", "undecided", "right").index(answer.verdict))


def as_object(formula: str, answers: Sequence[Answer]) -> dict[str, Any]:
    """What JSON has of it: the worst answer, and all of them where there are several."""
    found = {"formula": formula, **_object(worst(answers))}
    return found | ({"equations": [{"formula": a.formula, **_object(a)} for a in answers]} if len(answers) > 1 else {})


def _object(answer: Answer) -> dict[str, Any]:
    return {
        "model": answer.model,
        "letters": dict(answer.letters),
        "free": answer.free,
        "verdict": answer.verdict,
        "address": answer.address,
        "diagnosis": str(answer.diagnosis),
        "correct": {"latex": answer.latex, "plain": answer.plain} if answer.verdict != "undecided" else None,
    }
