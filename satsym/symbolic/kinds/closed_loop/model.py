"""A linear law that follows a command: what may be stated, and what is derived from it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import sympy as sp

from satsym.spec import Variable
from satsym.symbolic import notation as n
from satsym.symbolic.dimension_algebra import PLAIN, Dimension, over, power_of, product
from satsym.symbolic.kinds.closed_loop import answers, steps
from satsym.symbolic.kinds.closed_loop import names as cn
from satsym.symbolic.kinds.derived import Derived, original_equations
from satsym.symbolic.model import MaybeStep, Problem, Requirement, symbols_of
from satsym.symbolic.motion import steps as motion


@dataclass(frozen=True, kw_only=True)
class ClosedLoop(Derived):
    """Small motions about rest under a linear law that follows a command, critically damped.

    Its controls are none: the law takes their place. Its states are those of the motion.

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

    def steps(self) -> tuple[MaybeStep, ...]:
        """Small motions, the law, transfer functions, and the answer to a step."""
        return (
            original_equations,
            steps.linearised_about_rest,
            steps.control_law,
            steps.transfer_functions,
            steps.poles_and_zeros,
            steps.critical_damping,
            answers.step_response,
            answers.control_response,
            answers.extremes,
            steps.first_order,
            motion.linearisation,
        )

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

    def stated(self) -> Iterator[tuple[str, list[sp.Expr], set[sp.Symbol]]]:
        """The law, by states and gains."""
        known = set(symbols_of((*self.states, *self.parameters, *self.gains)))
        yield "the law", [self.law], known | {cn.s, cn.COMMAND}

    def names(self, problem: Problem | None) -> dict[str, str]:
        """Transfer functions, poles and answers; time is the old one."""
        return cn.names(self)

    def enter_dimensions(self, known: dict[str, Dimension | None], require: Requirement) -> None:
        """Of transforms and answers; law, command and damping must have those of what they stand for."""
        super().enter_dimensions(known, require)
        second, control = known[n.TIME.name], cn.control_of(self)
        known[cn.COMMAND.name] = known[self.follows.name]
        known[cn.s.name] = over(PLAIN, second)
        require("the command", symbols_of((self.command,))[0], known[self.follows.name])
        require("the damping", symbols_of((self.damping,))[0], known[cn.s.name])
        require("the law", self.law, known[control.name])
        for symbol in (*symbols_of(self.states), control):
            known[cn.transfer_to(symbol).name] = over(known[symbol.name], known[cn.COMMAND.name])
            known[n.answer_of(symbol).name] = known[cn.final_of(symbol).name] = known[symbol.name]
            known[n.initial(symbol).name] = known[symbol.name]
        impulse = product((known[control.name], second))
        known[cn.impulse_of(control).name] = known[cn.TOTAL_IMPULSE.name] = impulse
        known[cn.SMOOTH_SQUARE.name] = product((impulse, known[control.name]))
        known[cn.FIRST_REACHED.name] = known[cn.HIGHEST_AT.name] = second
        known[cn.OVERSHOOT.name] = PLAIN
        known[cn.POLYNOMIAL.name] = power_of(known[cn.s.name], sp.Integer(2))
        for k in (1, 2):
            known[cn.pole(k).name] = known[cn.zero(k).name] = known[cn.s.name]
