"""Models whose equations of motion are given in first-order form."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.algebra import constants_of
from satsym.symbolic.derivation import Check, Derivation, Equation, Step
from satsym.symbolic.dimension_algebra import Dimension
from satsym.symbolic.kinds import stated_as
from satsym.symbolic.model import MaybeStep, Model, Requirement, symbols_of
from satsym.symbolic.motion import steps as motion
from satsym.wording import unlike


@dataclass(frozen=True, kw_only=True)
class FirstOrder(Model):
    """Equations of motion given in first-order form.

    Parameters
    ----------
    rates
        State -> its rate of change f(t, x, u, p).
    """

    rates: Mapping[sp.Symbol, sp.Expr]

    def steps(self) -> tuple[MaybeStep, ...]:
        """List the steps that follow from any motion."""
        return (*self.motion_steps(), motion.reference, motion.linearisation)

    def motion_steps(self) -> tuple[MaybeStep, ...]:
        """List the single step that states the given rates."""
        return (given_rates,)

    def misfits(self) -> Iterator[str]:
        """Yield a message for each state without a rate, and for each rate of a symbol that is not a state."""
        if set(symbols_of(self.states)) != set(self.rates):
            odd = unlike(symbols_of(self.states), self.rates, "without a rate", "no state")
            yield f"give one rate for each state; {odd or 'take the symbols from symbols_of'}"

    def stated(self) -> Iterator[tuple[str, list[sp.Expr], set[sp.Symbol]]]:
        """Return the rates, which are functions of states and controls."""
        for state, rate in self.rates.items():
            yield f"the rate of {state}", [rate], _declared(self)

    def motion_stated(self) -> list[sp.Expr]:
        """Return the rates, which define the motion completely."""
        return list(self.rates.values())

    def enter_dimensions(self, known: dict[str, Dimension | None], require: Requirement) -> None:
        """Check that each rate has the dimension of its state divided by time; no new symbols are added."""
        for state, rate in self.rates.items():
            require(f"the rate of {state.name}", rate, known[n.rate_of(state).name])


def given_rates(so_far: Derivation) -> Step:
    """Return the first-order form as the model states it."""
    model = stated_as(FirstOrder, so_far)
    equations = tuple(Equation(s.name, n.rate_of(s), sp.sympify(model.rates[s])) for s in symbols_of(model.states))
    unknown = set().union(*(e.rhs.free_symbols for e in equations)) - _declared(model)
    return Step("first_order", "given", equations, ("rates",), (Check("declared", float(len(unknown)), 0.0),))


def _declared(model: FirstOrder) -> set[sp.Symbol]:
    return constants_of(model) | set(symbols_of((*model.states, *model.controls)))
