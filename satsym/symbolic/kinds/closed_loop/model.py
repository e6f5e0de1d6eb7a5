"""A linear law that follows a command: what may be stated, and what is derived from it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.dimension_algebra import PLAIN, Dimension, over, power_of, product
from satsym.symbolic.kinds.closed_loop import answers, steps
from satsym.symbolic.kinds.closed_loop import names as cn
from satsym.symbolic.kinds.closed_loop.declared import Statement
from satsym.symbolic.kinds.derived import original_equations
from satsym.symbolic.model import MaybeStep, Problem, Requirement, symbols_of
from satsym.symbolic.motion import steps as motion


@dataclass(frozen=True, kw_only=True)
class ClosedLoop(Statement):
    """Small motions about rest under a linear law that follows a command, critically damped.

    Its controls are none: the law takes their place. Its states are those of the motion.
    What is stated of it: :class:`~satsym.symbolic.kinds.closed_loop.declared.Statement`.
    """

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

    def stated(self) -> Iterator[tuple[str, list[sp.Expr], set[sp.Symbol]]]:
        """The law, by states and gains."""
        known = set(symbols_of((*self.states, *self.parameters, *self.gains)))
        yield "the law", [self.law], known | {cn.s, cn.COMMAND}

    def names(self, problem: Problem | None) -> dict[str, str]:
        """Transfer functions, poles and answers; time is the old one."""
        return cn.names(self)

    def enter_dimensions(self, known: dict[str, Dimension | None], require: Requirement) -> None:
        """Enter the dimensions of transforms and answers, and refuse a law, command or damping that has others."""
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
