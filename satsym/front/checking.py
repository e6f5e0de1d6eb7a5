"""One printed formula, checked, as users meet it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from satsym.auditing.check import answers as checking
from satsym.auditing.check.answer import check_in
from satsym.auditing.check.answers import Answer, Verdict
from satsym.front.refusals import in_one_line
from satsym.report.terminal.checked import checked_text


@dataclass(frozen=True, eq=False, repr=False)
class Checked:
    """Whether a formula is right.

    Attributes
    ----------
    formula
        As it was given.
    answers
        One for each equation in it.
    """

    formula: str
    answers: tuple[Answer, ...]

    @property
    def verdict(self) -> Verdict:
        """``right``, ``wrong`` or ``undecided``; of several equations the worst."""
        return checking.worst(self.answers).verdict

    @property
    def address(self) -> str:
        """The equation that it is, or is meant to be."""
        return checking.worst(self.answers).address

    @property
    def diagnosis(self) -> str:
        """What is wrong; empty where nothing is."""
        return checking.worst(self.answers).diagnosis

    @property
    def correct(self) -> str:
        """The right equation in the notation of the formula; empty where it is right, or none is known."""
        return checking.worst(self.answers).correct

    @property
    def letters(self) -> Mapping[str, str]:
        """Printed letter -> name of the model, where there was a doubt."""
        return {printed: ours for answer in self.answers for printed, ours in answer.letters.items()}

    def __bool__(self) -> bool:
        return self.verdict == "right"

    def to_dict(self) -> dict[str, Any]:
        """What ``satsym check --json`` prints."""
        return checking.as_object(self.formula, self.answers)

    def __repr__(self) -> str:
        return checked_text(self.answers)

    def _repr_latex_(self) -> str:
        lines = [rf"{answer.latex} &\quad\text{{{_said(answer)}}}" for answer in self.answers]
        return r"$$\begin{aligned} " + r" \\ ".join(lines) + r" \end{aligned}$$"


def _said(answer: Answer) -> str:
    """The verdict in a formula."""
    said = "is right" if answer.verdict == "wrong" and answer.correct else answer.verdict
    return f"{said}: {answer.address}".replace("_", r"\_") if answer.address else said


@in_one_line
def check(formula: str, model: str, let: str | Sequence[str] | Mapping[str, str] = (), free: bool = False) -> Checked:
    """Say whether a printed formula is right, and if not, what is wrong.

    Parameters
    ----------
    formula
        LaTeX, or plain notation; nothing of it is evaluated.
    model
        A shipped model, or ``"DIR/NAME"`` after ``satsym derive --out DIR``.
    let
        What printed letters mean: ``{"n": "omega"}``, or ``"n=omega"``.
    free
        Whether the uncontrolled motion is meant.

    Raises
    ------
    BadInput
        If the formula cannot be read, with the place, or there is no such model or name.
    """
    told = [f"{printed}={ours}" for printed, ours in let.items()] if isinstance(let, Mapping) else let
    found = check_in(formula, model, Path(), [told] if isinstance(told, str) else list(told), free)
    return Checked(formula, tuple(found))
