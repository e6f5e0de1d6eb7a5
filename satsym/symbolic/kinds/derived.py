"""What kinds have in common whose motion is derived from that of another model."""

from __future__ import annotations

from dataclasses import dataclass

from satsym.symbolic import notation as n
from satsym.symbolic.derivation import Derivation, Step
from satsym.symbolic.dimension_algebra import Dimension, over
from satsym.symbolic.dimensions import AGREEMENT
from satsym.symbolic.model import Model, Paragraph, Problem, Requirement, symbols_of


@dataclass(frozen=True, kw_only=True)
class Derived(Model):
    """A motion that is derived from the motion of another model.

    Parameters
    ----------
    of
        The model whose motion this is.
    """

    of: Model

    def origin(self) -> Model:
        """The model whose motion this is."""
        return self.of

    def names(self, problem: Problem | None) -> dict[str, str]:
        """The rates of change of the old states."""
        return {f"d_{v.symbol}": rf"\frac{{d {v.latex}}}{{dt}}" for v in self.of.states}

    def enter_dimensions(self, known: dict[str, Dimension | None], require: Requirement) -> None:
        """Of the rates of change of the old states."""
        for state in symbols_of(self.of.states):
            known[n.rate_of(state).name] = over(known[state.name], known[n.TIME.name])

    def statement(self) -> tuple[Paragraph, ...]:
        """Which model's motion it is."""
        return (Paragraph("motion_of", of=self.of),)


def original_equations(so_far: Derivation) -> Step:
    """The first-order form of the motion, from its own derivation, with the checks that it passed there."""
    assert so_far.original is not None
    step = so_far.original.step("first_order")
    checks = tuple(c for c in step.checks if c.claim != AGREEMENT)  # every step gets that one anyway
    return Step("original_equations", "taken over", step.equations, ("motion",), checks)
