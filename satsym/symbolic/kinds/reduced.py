"""A motion in fewer states: the others follow from them, on a set of motions that the motion never leaves."""

from __future__ import annotations

from typing import Any

import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.algebra import tidy, total_derivative
from satsym.symbolic.checks import Point, compare, identity, numeric
from satsym.symbolic.derivation import Check, Derivation, DerivationError, Equation, Step
from satsym.symbolic.kinds.gyrostat import resolved
from satsym.symbolic.kinds.rotation_models import Reduced
from satsym.symbolic.model import symbols_of


def special_case(so_far: Derivation) -> Step:
    """The special values, and the states that follow from the others: once they do, they always do."""
    model = _reduced(so_far)
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
    model = _reduced(so_far)
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
    model, original = _reduced(so_far), so_far.original
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


def _reduced(so_far: Derivation) -> Reduced:
    model = so_far.model
    if not isinstance(model, Reduced):
        raise TypeError(f"{model.name} is not stated as a motion in fewer states")
    return model
