"""Answers: the results of checking a printed equation against a model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from satsym.auditing.check.derived import Target
from satsym.auditing.check.meanings import Guess

Verdict = Literal["right", "wrong", "undecided"]


@dataclass(frozen=True)
class Fit:
    """An interpretation of a printed equation, with the equation of the model that it is compared with."""

    guess: Guess
    target: Target | None
    free: bool
    likeness: float


@dataclass(frozen=True)
class Answer:
    """The result of checking one printed equation.

    Attributes
    ----------
    formula
        The equation as it was read, in the notation in which it was entered.
    model
        Name of the model.
    letters
        Printed letter -> name in the model, for letters that do not belong to the model's own notation.
    free
        Whether the equation is compared with the uncontrolled motion, in which all controls are zero.
    verdict
        ``right``, ``wrong`` or ``undecided``.
    address
        Address of the equation of the model that the printed one is, or is meant to be. Empty if the printed equation
        only follows from several equations, or if no equation of the model is similar.
    diagnosis
        One sentence that says what is wrong; empty for a right equation.
    correct
        The correct equation in the notation in which it was entered; empty if none is known.
    latex
        The correct equation in LaTeX, for a right equation the equation itself.
    plain
        The correct equation in plain text.
    fit
        How the letters were interpreted, and which equation of the model was compared.
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
    """Return the first wrong answer, otherwise the first undecided answer, otherwise the first answer."""
    return min(answers, key=lambda answer: ("wrong", "undecided", "right").index(answer.verdict))


def as_object(formula: str, answers: Sequence[Answer]) -> dict[str, Any]:
    """Return the JSON object of a checked formula: the worst answer, and all answers if there are several equations."""
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
