"""A motion in fewer states: the others follow from them, on a set of motions that the motion never leaves."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import sympy as sp

from satsym.spec import Variable
from satsym.symbolic import notation as n
from satsym.symbolic.algebra import tidy, total_derivative
from satsym.symbolic.checks import Point, compare, identity, numeric
from satsym.symbolic.derivation import Check, Derivation, DerivationError, Equation, Step, resolved
from satsym.symbolic.dimension_algebra import Dimension
from satsym.symbolic.kinds import stated_as
from satsym.symbolic.kinds.derived import Derived, original_equations
from satsym.symbolic.model import MaybeStep, Requirement, symbols_of, variables_of
from satsym.symbolic.motion import steps as motion


@dataclass(frozen=True, kw_only=True)
class Reduced(Derived):
    """A motion in some of its states, where the others follow from them, such as a momentum's from its balance.

    States, controls and parameters are those of the motion that are kept.

    Parameters
    ----------
    of
        The model whose motion this is.
    along
        Each state that is left out -> what it is, in terms of the others; proved to stay so.
    where
        Parameters that have special values in this case.
    """

    along: Mapping[sp.Symbol, sp.Expr]
    where: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)

    def brings(self) -> tuple[Variable, ...]:
        """All that the motion has."""
        return variables_of(self.of)

    def steps(self) -> tuple[MaybeStep, ...]:
        """The states that are left out, the motion of the others, and what holds for any motion."""
        return (original_equations, special_case, first_order, quantities, motion.reference, motion.linearisation)

    def misfits(self) -> Iterator[str]:
        """States that are neither kept nor left out, or both, and other controls."""
        states, old = set(symbols_of(self.states)), set(symbols_of(self.of.states))
        if states | set(self.along) != old or states & set(self.along):
            yield "keep or leave out each state once"
        if self.controls != self.of.controls:
            yield f"the controls must be those of {self.of.name}"

    def stated(self) -> Iterator[tuple[str, Iterable[Any], set[sp.Symbol]]]:
        """Special values, by the variables of the motion."""
        old = set(symbols_of((*self.of.states, *self.of.controls, *self.of.parameters)))
        yield "a special value", (*self.where.values(), *self.along.values()), old

    def enter_dimensions(self, known: dict[str, Dimension | None], require: Requirement) -> None:
        """Of the rates of all states; special values must have those of their variables."""
        for symbol, value in {**self.where, **self.along}.items():
            require(f"the special {symbol.name}", value, known[symbol.name])
        super().enter_dimensions(known, require)


def special_case(so_far: Derivation) -> Step:
    """The special values, and the states that follow from the others: once they do, they always do."""
    model = stated_as(Reduced, so_far)
    rates = dict(
        zip(symbols_of(model.of.states), so_far.rhs("original_equations").xreplace(_where(model)), strict=True)
    )
    along = _along(model)
    drifts = [total_derivative(state - value, rates).xreplace(along) for state, value in along.items()]
    proof = identity("holds ever after", drifts)
    if not proof.passed:
        raise DerivationError(f"{model.name}: the states that are left out do not keep following from the others")
    stated = {**_where(model), **along}
    equations = tuple(Equation(symbol.name, symbol, value) for symbol, value in stated.items())
    return Step("special_case", "set of motions", equations, ("original_equations",), (proof,))


def first_order(so_far: Derivation) -> Step:
    """The equations of the states that are kept."""
    model = stated_as(Reduced, so_far)
    states = symbols_of(model.states)
    rates = dict(zip(symbols_of(model.of.states), so_far.rhs("original_equations"), strict=True))
    found = {x: tidy(rates[x].xreplace(_special(model))) for x in states}
    equations = tuple(Equation(x.name, n.rate_of(x), value) for x, value in found.items())
    allowed = {*states, *symbols_of(model.controls), *symbols_of(model.parameters), n.TIME}
    foreign = set().union(*(value.free_symbols for value in found.values())) - allowed
    if foreign:
        raise DerivationError(f"{model.name}: the motion still depends on {', '.join(sorted(s.name for s in foreign))}")
    exact, values = numeric([rates[x] for x in states]), numeric(list(found.values()))
    special = _special(model)
    others = numeric(list(special.values()))

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        return values(point), exact({**point, **dict(zip(special, others(point), strict=True))})

    symbols = set().union(*(e.free_symbols for e in (*rates.values(), *special.values()))) - {*special}
    checks = (compare("same values in the special case", symbols, sides), Check("declared", float(len(foreign)), 0.0))
    return Step("first_order", "put in the special case", equations, ("original_equations", "special_case"), checks)


def quantities(so_far: Derivation) -> Step:
    """The states that were left out, and all that was derived from them."""
    model, original = stated_as(Reduced, so_far), so_far.original
    assert original is not None
    along = _along(model)
    stated = original.step("quantities").equations if "quantities" in original else ()
    known = {state: sp.factor(value) for state, value in along.items()}
    special = dict(_where(model))
    known |= {e.lhs: tidy(e.rhs.xreplace(special)) for e in stated}
    equations = tuple(Equation(symbol.name, symbol, value) for symbol, value in known.items())
    whole = resolved(equations)
    exact, values = numeric([*along.values(), *resolved(stated).values()]), numeric(list(whole.values()))
    special = _special(model)
    others = numeric(list(special.values()))

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        return values(point), exact({**point, **dict(zip(special, others(point), strict=True))})

    symbols = set().union(*(e.free_symbols for e in (*resolved(stated).values(), *special.values())))
    check = compare("same values in the special case", symbols - {*special}, sides)
    return Step("quantities", "put in the special case", equations, ("special_case",), (check,))


def _where(model: Reduced) -> dict[sp.Symbol, sp.Expr]:
    return {symbol: sp.sympify(value) for symbol, value in model.where.items()}


def _along(model: Reduced) -> dict[sp.Symbol, sp.Expr]:
    return {state: sp.sympify(value).xreplace(_where(model)) for state, value in model.along.items()}


def _special(model: Reduced) -> dict[sp.Symbol, sp.Expr]:
    return {**_where(model), **_along(model)}
