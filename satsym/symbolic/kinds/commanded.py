"""Declarations of a linear control law that follows a command, and the symbols of its step responses."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import cast

import sympy as sp

from satsym.spec import Variable
from satsym.symbolic.derivation import Derivation
from satsym.symbolic.kinds.derived import Derived
from satsym.symbolic.model import symbols_of
from satsym.symbolic.notation import answer_of, initial, named


@dataclass(frozen=True, kw_only=True)
class Statement(Derived):
    """The declarations of a :class:`~satsym.symbolic.ClosedLoop`.

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
        Parameters that have special values in the closed forms of the step response.
    """

    follows: sp.Symbol
    command: Variable
    gains: tuple[Variable, Variable]
    law: sp.Expr
    damping: Variable
    where: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)

    def brings(self) -> tuple[Variable, ...]:
        """Return the control that the law replaces, and the gains."""
        return (*self.of.controls, *self.gains)

    def misfits(self) -> Iterator[str]:
        """Yield complaints about other states, controls besides the law, or a command that no state follows."""
        states = symbols_of(self.states)
        if self.states != self.of.states:
            yield f"the states must be those of {self.of.name}"
        if len(self.of.controls) != 1:
            yield f"{self.of.name} must have one control"
        if self.controls:
            yield "the law replaces the control, so no controls may be declared"
        if self.follows not in states:
            yield "what follows the command must be a state"
        if not {self.command, self.damping} <= set(self.parameters):
            yield "command and damping must be parameters"


s = sp.Symbol("s")
"""Differentiation with respect to time, or the variable of Laplace transforms."""
COMMAND = sp.Symbol("command", real=True)
"""The symbol of the command that a closed loop follows."""
SECONDS = sp.Symbol("t", positive=True)
"""The symbol of the time after the step of the command."""
POLYNOMIAL = sp.Symbol("closed_loop_polynomial", real=True)
FIRST_REACHED, HIGHEST_AT = sp.Symbol("first_reached", real=True), sp.Symbol("highest_at", real=True)
OVERSHOOT, TOTAL_IMPULSE = sp.Symbol("overshoot", real=True), sp.Symbol("total_impulse", real=True)
SMOOTH_SQUARE = sp.Symbol("smooth_square", real=True)
_FIXED = {
    COMMAND: "c",
    s: "s",
    POLYNOMIAL: r"\Delta(s)",
    FIRST_REACHED: "t_1",
    HIGHEST_AT: "t_2",
    OVERSHOOT: "o",
    TOTAL_IMPULSE: r"\mathcal{I}",
    SMOOTH_SQUARE: r"\mathcal{Q}",
}


transfer_to = named("transfer_{}")
"""The symbol for the transfer function from the command to a state or the control."""
impulse_of = named("{}_impulse")
"""The symbol for the time integral of a control over the moment of the step."""
final_of = named("{}_final")
"""The symbol for the limit of a state."""


def pole(k: int) -> sp.Symbol:
    """Return the symbol of the k-th pole."""
    return sp.Symbol(f"pole_{k}", real=True)


def zero(k: int) -> sp.Symbol:
    """Return the symbol of the k-th zero."""
    return sp.Symbol(f"zero_{k}", real=True)


def names(model: Statement) -> dict[str, str]:
    """Map the names of all symbols of step responses to LaTeX."""
    found = {symbol.name: latex for symbol, latex in _FIXED.items()}
    found |= {pole(k).name: f"s_{k}" for k in (1, 2)} | {zero(k).name: f"z_{k}" for k in (1, 2)}
    variables = (*model.states, *model.of.controls)
    for v, symbol in zip(variables, symbols_of(variables), strict=True):
        found[transfer_to(symbol).name] = rf"G_{{{v.latex}}}(s)"
        found[answer_of(symbol).name] = rf"{v.latex}(t)"
        found[final_of(symbol).name] = rf"{v.latex}(\infty)"
        found[initial(symbol).name] = rf"{v.latex}(0^+)"
        found[impulse_of(symbol).name] = rf"\int_{{0^-}}^{{0^+}} {v.latex} \,dt"
    return found


def control_of(model: Statement) -> sp.Symbol:
    """Return the control that the law replaces."""
    (control,) = symbols_of(model.of.controls)
    return control


def loop_of(so_far: Derivation) -> Statement:
    """Return the declarations of the closed loop of a derivation."""
    return cast(Statement, so_far.model)
