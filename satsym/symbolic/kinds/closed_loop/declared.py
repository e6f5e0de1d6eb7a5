"""What may be stated of a linear law that follows a command."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import sympy as sp

from satsym.spec import Variable
from satsym.symbolic.kinds.derived import Derived
from satsym.symbolic.model import symbols_of


@dataclass(frozen=True, kw_only=True)
class Statement(Derived):
    """What a :class:`~satsym.symbolic.ClosedLoop` states.

    Parameters
    ----------
    of
        The model that is controlled by one control; all its states zero is a motion of it.
    follows
        The state that is to follow the command.
    command
        Parameter: the height of the step that is commanded at time 0.
    gains
        Variables K1, K2, which critical damping determines.
    law
        The control, in terms of states, gains, :data:`~satsym.symbolic.s` for differentiation, and
        :data:`~satsym.symbolic.COMMAND`.
    damping
        Parameter: the negative of the double pole.
    where
        Parameters that have special values in the closed forms of the answer to a step.
    """

    follows: sp.Symbol
    command: Variable
    gains: tuple[Variable, Variable]
    law: sp.Expr
    damping: Variable
    where: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)

    def brings(self) -> tuple[Variable, ...]:
        """The control that the law takes the place of, and its gains."""
        return (*self.of.controls, *self.gains)

    def misfits(self) -> Iterator[str]:
        """Other states, controls besides the law, a command that is followed by nothing."""
        states = symbols_of(self.states)
        if self.states != self.of.states:
            yield f"the states must be those of {self.of.name}"
        if len(self.of.controls) != 1:
            yield f"{self.of.name} must have one control"
        if self.controls:
            yield "the law takes the place of the control, so there are none"
        if self.follows not in states:
            yield "what follows the command must be a state"
        if not {self.command, self.damping} <= set(self.parameters):
            yield "command and damping must be parameters"
