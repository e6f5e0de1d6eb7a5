"""A motion in fewer states, on a set of motions where the other states follow from the kept ones."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.algebra import tidy, total_derivative
from satsym.symbolic.checks import Point, compare, identity, numeric
from satsym.symbolic.derivation import Check, Derivation, DerivationError, Equation, Step, resolved
from satsym.symbolic.factoring import factored
from satsym.symbolic.kinds import stated_as
from satsym.symbolic.kinds.derived import SpecialCase, original_equations
from satsym.symbolic.model import MaybeStep, symbols_of
from satsym.symbolic.motion import geometry
from satsym.symbolic.motion import steps as motion


@dataclass(frozen=True, kw_only=True)
class Reduced(SpecialCase):
    """A motion in some of its states, of which the others are functions, as a momentum is by its balance.

    States, controls and parameters are those of the original motion that are kept. Each state that is left out must be
    among ``along``; that it keeps its value there is proved.
    """

    def picture(self) -> geometry.Picture | None:
        """Return the picture of the motion that is reduced, which has the same variables."""
        return self.of.picture()

    def steps(self) -> tuple[MaybeStep, ...]:
        """List the steps: the states that are left out, the motion of the others, and steps for any motion."""
        return (original_equations, special_case, first_order, quantities, motion.reference, motion.linearisation)

    def misfits(self) -> Iterator[str]:
        """Yield complaints about states that are neither kept nor left out, or both, and about other controls."""
        states, old = set(symbols_of(self.states)), set(symbols_of(self.of.states))
        if states | set(self.along) != old or states & set(self.along):
            yield "each state of the original model must be either a state of this model or a key of `along`"
        if self.controls != self.of.controls:
            yield f"the controls must be those of {self.of.name}"


def special_case(so_far: Derivation) -> Step:
    """State the special values, and prove that states which follow from the others go on doing so."""
    model = stated_as(Reduced, so_far)
    special = model.special()
    where, along = ({s: special[s] for s in part} for part in (model.where, model.along))
    rates = dict(zip(symbols_of(model.of.states), so_far.rhs("original_equations").xreplace(where), strict=True))
    drifts = [total_derivative(state - value, rates).xreplace(along) for state, value in along.items()]
    proof = identity("holds ever after", drifts)
    if not proof.passed:
        raise DerivationError(f"{model.name}: the other states do not determine the states that are left out")
    equations = tuple(Equation(symbol.name, symbol, value) for symbol, value in special.items())
    return Step("special_case", "set of motions", equations, ("original_equations",), (proof,))


def first_order(so_far: Derivation) -> Step:
    """Derive the equations of the states that are kept."""
    model = stated_as(Reduced, so_far)
    states = symbols_of(model.states)
    rates = dict(zip(symbols_of(model.of.states), so_far.rhs("original_equations"), strict=True))
    found = {x: tidy(rates[x].xreplace(model.special())) for x in states}
    equations = tuple(Equation(x.name, n.rate_of(x), value) for x, value in found.items())
    allowed = {*states, *symbols_of(model.controls), *symbols_of(model.parameters), n.TIME}
    foreign = set().union(*(value.free_symbols for value in found.values())) - allowed
    if foreign:
        raise DerivationError(f"{model.name}: the motion still depends on {', '.join(sorted(s.name for s in foreign))}")
    same = _same_values(model, [*found.values()], [rates[x] for x in states], [*rates.values()])
    checks = (same, Check("declared", float(len(foreign)), 0.0))
    return Step("first_order", "put in the special case", equations, ("original_equations", "special_case"), checks)


def quantities(so_far: Derivation) -> Step:
    """Derive the states that were left out, and all quantities of the original motion."""
    model, original = stated_as(Reduced, so_far), so_far.original
    assert original is not None
    special = model.special()
    where, along = ({s: special[s] for s in part} for part in (model.where, model.along))
    stated = original.step("quantities").equations if "quantities" in original else ()
    known = {state: factored(value) for state, value in along.items()}
    known |= {e.lhs: tidy(e.rhs.xreplace(where)) for e in stated}
    equations = tuple(Equation(symbol.name, symbol, value) for symbol, value in known.items())
    exact = [*resolved(stated).values()]
    check = _same_values(model, [*resolved(equations).values()], [*along.values(), *exact], exact)
    return Step("quantities", "quantities in the special case", equations, ("special_case",), (check,))


def _same_values(model: Reduced, found: list[sp.Expr], general: list[sp.Expr], moving: list[sp.Expr]) -> Check:
    """Check expressions by general ones at points of the special case, with random values of the moving variables."""
    values, exact, special = numeric(found), numeric(general), model.special()
    others = numeric(list(special.values()))

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        return values(point), exact({**point, **dict(zip(special, others(point), strict=True))})

    symbols = set().union(*(e.free_symbols for e in (*moving, *special.values()))) - {*special}
    return compare("same values in the special case", symbols, sides)
