"""What typesetting a step of a derivation begins with, what comes of it, and how one equation of it is typeset."""

from __future__ import annotations

from dataclasses import dataclass

from satsym.report.latex import tex
from satsym.report.latex.equations import Row
from satsym.report.texts import Texts
from satsym.symbolic import Derivation, Equation, Step
from satsym.symbolic.latex.typeset import Typesetter


@dataclass(frozen=True)
class Context:
    """What typesetting a step needs besides the step."""

    derivation: Derivation
    texts: Texts
    typeset: Typesetter

    def address(self, step: Step) -> str:
        """The address of a step."""
        return f"{self.derivation.name}:{step.name}"

    def costates(self) -> list[str]:
        """Names of the costates, in the order of the states."""
        return [self.typeset.costate(v.symbol) for v in self.derivation.model.states]


@dataclass(frozen=True)
class Shown:
    """A step's equations in LaTeX, and the addresses of the first and the last that got numbers of their own."""

    body: str
    first: str
    last: str
    appendix: str = ""
    """Equations that are too many for the place of the step, if there are such."""


def numbers_of(first: str, last: str) -> str:
    """The equation number of an address, or the range of two."""
    ends = dict.fromkeys((tex.label(first), tex.label(last)))
    return r"\mbox{--}".join(rf"\eqref{{{label}}}" for label in ends)


def row_of(context: Context, step: Step, equation: Equation, also: str = "", typeset: Typesetter | None = None) -> Row:
    """An equation as it stands, or in the notation of another typesetter."""
    typeset = typeset or context.typeset
    left, right = typeset.terms(equation.lhs), typeset.terms(equation.rhs)
    return Row(f"{context.address(step)}.{equation.name}", left, right, also)
