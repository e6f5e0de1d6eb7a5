"""From a motion in units to the same motion in plain numbers: new time, states and controls, each a multiple."""

from __future__ import annotations

from typing import Any

import mpmath as mp
import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.algebra import definitions_of, tidy
from satsym.symbolic.checks import Point, compare, identity, numeric
from satsym.symbolic.derivation import Check, Derivation, DerivationError, Equation, Step
from satsym.symbolic.kinds import rotation_notation as rn
from satsym.symbolic.kinds.gyrostat import resolved
from satsym.symbolic.kinds.rotation_models import Scaled
from satsym.symbolic.model import symbols_of, t


def scales(so_far: Derivation) -> Step:
    """The new time, states and controls, and the special case that is meant."""
    model = _scaled(so_far)
    if any(e.rhs.has(t) for e in so_far.step("original_equations").equations):
        raise DerivationError(f"{model.name}: the motion of {model.of.name} depends on time; only others are scaled")
    special = {**model.where, **model.along}
    equations = [
        Equation("time", t, rn.ORIGINAL_TIME / model.unit_of_time),
        *(Equation(new.name, new, sp.sympify(old)) for new, old in model.scaled.items()),
        *(Equation(symbol.name, symbol, sp.sympify(value)) for symbol, value in special.items()),
        *(Equation(symbol.name, symbol, sp.sympify(value)) for symbol, value in model.groups.items()),
    ]
    olds = [*symbols_of(model.of.states), *symbols_of(model.of.controls)]
    multiples = [old - sum(sp.diff(old, x) * x for x in olds) for old in map(sp.sympify, model.scaled.values())]
    proof = identity("multiples of the old ones", multiples)
    if not proof.passed:
        raise DerivationError(f"{model.name}: each scaled variable must be a multiple of old ones")
    return Step("scales", "new units", tuple(equations), ("original_equations",), (proof,))


def original_states(so_far: Derivation) -> Step:
    """The old variables in terms of the new ones."""
    model = _scaled(so_far)
    olds = [
        s
        for s in (*symbols_of(model.of.states), *symbols_of(model.of.controls))
        if any(sp.sympify(e).has(s) for e in model.scaled.values())
    ]
    found = sp.solve([sp.sympify(e) - s for s, e in model.scaled.items()], olds, dict=True)
    if len(found) != 1 or set(found[0]) != set(olds):
        raise DerivationError(f"{model.name}: the scaled variables cannot be solved for those of {model.of.name}")
    equations = tuple(Equation(o.name, o, found[0][o]) for o in olds)
    there, back = numeric([sp.sympify(e) for e in model.scaled.values()]), numeric([e.rhs for e in equations])

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        return there({**point, **dict(zip(olds, back(point), strict=True))}), [point[s] for s in model.scaled]

    symbols = {*model.scaled}.union(*(sp.sympify(e).free_symbols for e in model.scaled.values()))
    check = compare("there and back", symbols, sides)
    return Step("original_states", "solve for original states", equations, ("scales",), (check,))


def first_order(so_far: Derivation) -> Step:
    """The same motion in the new variables and the new time."""
    model = _scaled(so_far)
    states = symbols_of(model.states)
    old_states = symbols_of(model.of.states)
    rates = dict(zip(old_states, so_far.rhs("original_equations"), strict=True))
    equations = []
    for state in states:
        value = sp.sympify(model.scaled[state])
        change = model.unit_of_time * sum(sp.diff(value, x) * rates[x] for x in old_states if value.has(x))
        equations.append(Equation(state.name, n.rate_of(state), _in_new_variables(so_far, change)))
    inverse = {e.lhs: e.rhs for e in so_far.step("original_states").equations}
    special = _special(model)
    values = [sp.sympify(model.scaled[s]) for s in states]
    slopes = [rates[x].xreplace(special) for x in old_states]
    groups = {g: sp.sympify(e).xreplace(special) for g, e in model.groups.items()}
    old, new, back = numeric(slopes), numeric(values), numeric(list(inverse.values()))
    unit, group = numeric([sp.sympify(model.unit_of_time)]), numeric(list(groups.values()))
    found = numeric([e.rhs for e in equations])

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        """The new states differentiated by the new time as the old ones move at their own rates."""
        here = {**point, **dict(zip(inverse, back(point), strict=True))}
        speeds = dict(zip(old_states, old(here), strict=True))
        (second,) = unit(point)

        def moved(time: Any) -> list[Any]:
            return new({**here, **{s: here[s] + speeds[s] * time * second for s in old_states}})

        there = {**point, **dict(zip(groups, group(point), strict=True))}
        return found(there), [mp.diff(lambda time, k=k: moved(time)[k], 0) for k in range(len(states))]

    symbols = {*model.scaled, *old_states}.union(
        *(e.free_symbols for e in (*slopes, *values, *inverse.values(), *groups.values())),
        sp.sympify(model.unit_of_time).free_symbols,
    ) - {*inverse}
    symbols |= {s for s in old_states if s not in inverse}
    check = compare("along the original motion", symbols, sides)
    plain = {*model.scaled, *symbols_of(model.parameters), *definitions_of(model)}
    foreign = set().union(*(e.rhs.free_symbols for e in equations)) - plain
    if foreign:
        odd = ", ".join(sorted(s.name for s in foreign))
        raise DerivationError(f"{model.name}: the scaled motion still depends on {odd}; state a group or another scale")
    sources = ("original_equations", "scales", "original_states")
    checks = (check, Check("plain numbers alone", float(len(foreign)), 0.0))
    return Step("first_order", "chain rule in new units", tuple(equations), sources, checks)


def quantities(so_far: Derivation) -> Step | None:
    """What is carried over besides."""
    model = _scaled(so_far)
    if not model.quantities:
        return None
    known = _carried(so_far)
    equations, exact = [], []
    for output in model.quantities:
        (symbol,) = symbols_of((output.variable,))
        value = sp.sympify(output.value).xreplace(known)
        exact.append(value.xreplace(_special(model)))
        equations.append(Equation(symbol.name, symbol, _in_new_variables(so_far, value)))
    inverse = {e.lhs: e.rhs for e in so_far.step("original_states").equations}
    groups = {g: sp.sympify(e).xreplace(_special(model)) for g, e in model.groups.items()}
    back, group = numeric(list(inverse.values())), numeric(list(groups.values()))
    old, new = numeric(exact), numeric([e.rhs for e in equations])

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        here = {**point, **dict(zip(inverse, back(point), strict=True))}
        return new({**point, **dict(zip(groups, group(point), strict=True))}), old(here)

    parts = (*exact, *inverse.values(), *groups.values())
    symbols = ({*model.scaled}.union(*(e.free_symbols for e in parts))) - {*inverse}
    check = compare("same values in both units", symbols, sides)
    return Step("quantities", "carry over", tuple(equations), ("scales", "original_states"), (check,))


def _carried(so_far: Derivation) -> dict[sp.Symbol, sp.Expr]:
    """Quantities of the old motion, in terms of its states and controls."""
    original = so_far.original
    assert original is not None
    if "quantities" not in original:
        return {}
    return resolved(original.step("quantities").equations)


def _special(model: Scaled) -> dict[sp.Symbol, sp.Expr]:
    """The special case: parameters with special values, and states that are left out."""
    where = {s: sp.sympify(e) for s, e in model.where.items()}
    return {**where, **{s: sp.sympify(e).xreplace(where) for s, e in model.along.items()}}


def _in_new_variables(so_far: Derivation, expression: sp.Expr) -> sp.Expr:
    """An expression of old variables in the new ones, with the groups in place of the parameters they are made of."""
    model = _scaled(so_far)
    inverse = {e.lhs: e.rhs for e in so_far.step("original_states").equations}
    value = _reduced(expression.xreplace(_special(model)).xreplace(inverse))
    for group, meaning in model.groups.items():
        meant = sp.sympify(meaning).xreplace(_special(model))
        for parameter in sorted(value.free_symbols & meant.free_symbols, key=lambda s: s.name):
            # one that the group is proportional to, or to whose inverse
            if sp.diff(meant * parameter, parameter) == 0:
                value = _reduced(value.xreplace({parameter: meant * parameter / group}))
                break
            if sp.diff(meant / parameter, parameter) == 0:
                value = _reduced(value.xreplace({parameter: group * parameter / meant}))
                break
    return tidy(value)


def _reduced(expression: sp.Expr) -> sp.Expr:
    """A rational function of the symbols and of their roots, without common factors."""
    return sp.powdenest(sp.factor(sp.cancel(sp.together(sp.expand(expression)))), force=True)


def _scaled(so_far: Derivation) -> Scaled:
    model = so_far.model
    if not isinstance(model, Scaled):
        raise TypeError(f"{model.name} is not stated as a scaled motion")
    return model
