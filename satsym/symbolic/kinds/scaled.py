"""A motion in nondimensional variables: new time, states and controls, each a multiple of an old one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import mpmath as mp
import sympy as sp

from satsym.spec import Variable
from satsym.symbolic import notation as n
from satsym.symbolic.algebra import definitions_of, tidy
from satsym.symbolic.checks import Point, compare, identity, numeric
from satsym.symbolic.derivation import Check, Derivation, DerivationError, Equation, Step, resolved
from satsym.symbolic.dimension_algebra import Dimension
from satsym.symbolic.factoring import factored
from satsym.symbolic.kinds import stated_as
from satsym.symbolic.kinds.derived import SECOND, SpecialCase, original_equations, there_and_back
from satsym.symbolic.linear.notation import TRANSITION
from satsym.symbolic.model import MaybeStep, Output, Problem, Requirement, symbols_of, t
from satsym.symbolic.motion import steps as motion

ORIGINAL_TIME = sp.Symbol("original_t", real=True)


@dataclass(frozen=True, kw_only=True)
class Scaled(SpecialCase):
    """A motion in nondimensional variables: new states, controls and time, each a multiple of an old one.

    States of the old motion that nothing else depends on may be left out.

    Parameters
    ----------
    of
        The model whose motion this is; without explicit time.
    units
        What the scaling brings along, such as the largest torque.
    unit_of_time
        The time that counts as one, of parameters and `units`.
    scaled
        Each new state and control, in terms of the old ones.
    groups
        Each parameter of this model, in terms of the old parameters and `units`.
    quantities
        What is carried over besides, in terms of the old states, controls and quantities.
    where, along
        See :class:`~satsym.symbolic.kinds.derived.SpecialCase`.
    """

    plain_time: ClassVar[bool] = True

    units: tuple[Variable, ...] = ()
    unit_of_time: sp.Expr
    scaled: Mapping[sp.Symbol, sp.Expr]
    groups: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    quantities: tuple[Output, ...] = ()

    def brings(self) -> tuple[Variable, ...]:
        """Return the units, all variables of the original motion, and the derived quantities."""
        return (*self.units, *super().brings(), *(o.variable for o in self.quantities))

    def steps(self) -> tuple[MaybeStep, ...]:
        """List the steps: new units, the motion in them, and steps for any motion."""
        own = (original_equations, scales, original_states, first_order, quantities)
        return (*own, motion.reference, motion.linearisation)

    def carried(self) -> tuple[Output, ...]:
        """Return the quantities of this model and those of the original motion."""
        return (*self.quantities, *self.of.carried())

    def misfits(self) -> Iterator[str]:
        """Yield complaints about variables without a scale, parameters without a group, and unknown states."""
        if set(self.scaled) != set(symbols_of((*self.states, *self.controls))):
            yield "give exactly one scale for each state and each control"
        if set(self.groups) != set(symbols_of(self.parameters)):
            yield "the parameters must be exactly the dimensionless groups"
        if not set(self.along) <= set(symbols_of(self.of.states)):
            yield f"the keys of `along` must be states of {self.of.name}"

    def stated(self) -> Iterator[tuple[str, Iterable[Any], set[sp.Symbol]]]:
        """Return all scales, groups and quantities, which are stated by the old variables."""
        old = set(symbols_of((*self.of.states, *self.of.controls, *self.of.parameters)))
        constants = set(symbols_of((*self.of.parameters, *self.units)))
        yield from super().stated()
        yield "a scale", self.scaled.values(), old | constants
        yield "the unit of time", [self.unit_of_time], constants
        yield "a group", self.groups.values(), constants
        known = old | constants | set(symbols_of(self.of.brings()))
        yield "a quantity", [o.value for o in self.quantities], known

    def names(self, problem: Problem | None) -> dict[str, str]:
        """Map the names of the new time and of rates by the old and the new time to LaTeX."""
        new = {f"d_{v.symbol}": rf"\frac{{d {v.latex}}}{{d\tau}}" for v in self.states}
        new |= {f"d_lambda_{v.symbol}": rf"\frac{{d \lambda_{{{v.latex}}}}}{{d\tau}}" for v in self.states}
        new |= {"t": r"\tau", "t_f": r"\tau_f", n.RESIDUAL_TIME.name: r"\mathcal{B}_{\tau_f}"}
        new |= {TRANSITION.name: r"e^{A \tau}"}
        return super().names(problem) | new | {ORIGINAL_TIME.name: "t"}

    def enter_dimensions(self, known: dict[str, Dimension | None], require: Requirement) -> None:
        """Enter the dimensions of the old time and the old rates, and refuse scales of other dimensions."""
        known[ORIGINAL_TIME.name] = SECOND
        require("the unit of time", self.unit_of_time, SECOND)
        super().enter_dimensions(known, require)
        for what, stated in (("scaled", self.scaled), ("group", self.groups)):
            for symbol, value in stated.items():
                require(f"the {what} {symbol.name}", value, known[symbol.name])
        for output in self.quantities:
            require(f"the quantity {output.variable.symbol}", output.value, known[output.variable.symbol])


def scales(so_far: Derivation) -> Step:
    """State the new time, states and controls, and the special case."""
    model = stated_as(Scaled, so_far)
    if any(e.rhs.has(t) for e in so_far.step("original_equations").equations):
        raise DerivationError(
            f"{model.name}: the motion of {model.of.name} depends on time; only a motion whose equations do "
            "not depend on time can be scaled"
        )
    special = {**model.where, **model.along}
    equations = [
        Equation("time", t, ORIGINAL_TIME / model.unit_of_time),
        *(Equation(new.name, new, sp.sympify(old)) for new, old in model.scaled.items()),
        *(Equation(symbol.name, symbol, sp.sympify(value)) for symbol, value in special.items()),
        *(Equation(symbol.name, symbol, sp.sympify(value)) for symbol, value in model.groups.items()),
        *(Equation(o.variable.symbol, symbols_of((o.variable,))[0], sp.sympify(o.value)) for o in model.quantities),
    ]
    olds = [*symbols_of(model.of.states), *symbols_of(model.of.controls)]
    multiples = [old - sum(sp.diff(old, x) * x for x in olds) for old in map(sp.sympify, model.scaled.values())]
    proof = identity("multiples of the old ones", multiples)
    if not proof.passed:
        raise DerivationError(f"{model.name}: each scaled variable must be a multiple of an original variable")
    return Step("scales", "new units", tuple(equations), ("original_equations",), (proof,))


def original_states(so_far: Derivation) -> Step:
    """Solve the scales for the old variables."""
    model = stated_as(Scaled, so_far)
    olds = [
        s
        for s in (*symbols_of(model.of.states), *symbols_of(model.of.controls))
        if any(sp.sympify(e).has(s) for e in model.scaled.values())
    ]
    found = sp.solve([sp.sympify(e) - s for s, e in model.scaled.items()], olds, dict=True)
    if len(found) != 1 or set(found[0]) != set(olds):
        raise DerivationError(f"{model.name}: the scaled variables cannot be solved for those of {model.of.name}")
    equations = tuple(Equation(o.name, o, found[0][o]) for o in olds)
    check = there_and_back(model.scaled, equations)
    return Step("original_states", "solve for original states", equations, ("scales",), (check,))


def first_order(so_far: Derivation) -> Step:
    """Rewrite the original motion in the new variables and the new time."""
    model = stated_as(Scaled, so_far)
    states = symbols_of(model.states)
    old_states = symbols_of(model.of.states)
    rates = dict(zip(old_states, so_far.rhs("original_equations"), strict=True))
    equations = []
    for state in states:
        value = sp.sympify(model.scaled[state])
        change = model.unit_of_time * sum(sp.diff(value, x) * rates[x] for x in old_states if value.has(x))
        equations.append(Equation(state.name, n.rate_of(state), _in_new_variables(so_far, change)))
    inverse = {e.lhs: e.rhs for e in so_far.step("original_states").equations}
    special = model.special()
    values = [sp.sympify(model.scaled[s]) for s in states]
    slopes = [rates[x].xreplace(special) for x in old_states]
    groups = {g: sp.sympify(e).xreplace(special) for g, e in model.groups.items()}
    old, new, back = numeric(slopes), numeric(values), numeric(list(inverse.values()))
    unit, group = numeric([sp.sympify(model.unit_of_time)]), numeric(list(groups.values()))
    found = numeric([e.rhs for e in equations])

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        """Differentiate the new states by the new time as the old ones move at their own rates."""
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
        raise DerivationError(
            f"{model.name}: the scaled motion still depends on {odd}; declare a further dimensionless group, or "
            f"choose another scale"
        )
    sources = ("original_equations", "scales", "original_states")
    checks = (check, Check("plain numbers alone", float(len(foreign)), 0.0))
    return Step("first_order", "chain rule in new units", tuple(equations), sources, checks)


def quantities(so_far: Derivation) -> Step | None:
    """Derive the declared quantities in the new variables."""
    model = stated_as(Scaled, so_far)
    if not model.quantities:
        return None
    known = _carried(so_far)
    equations, exact = [], []
    for output in model.quantities:
        (symbol,) = symbols_of((output.variable,))
        value = sp.sympify(output.value).xreplace(known)
        exact.append(value.xreplace(model.special()))
        equations.append(Equation(symbol.name, symbol, _in_new_variables(so_far, value)))
    inverse = {e.lhs: e.rhs for e in so_far.step("original_states").equations}
    groups = {g: sp.sympify(e).xreplace(model.special()) for g, e in model.groups.items()}
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
    """Return the quantities of the original motion, in terms of its states and controls."""
    original = so_far.original
    assert original is not None
    if "quantities" not in original:
        return {}
    return resolved(original.step("quantities").equations)


def _in_new_variables(so_far: Derivation, expression: sp.Expr) -> sp.Expr:
    """Rewrite an expression in the new variables, with groups in place of the parameters they are made of."""
    model = stated_as(Scaled, so_far)
    inverse = {e.lhs: e.rhs for e in so_far.step("original_states").equations}
    value = _reduced(expression.xreplace(model.special()).xreplace(inverse))
    for group, meaning in model.groups.items():
        meant = sp.sympify(meaning).xreplace(model.special())
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
    """Cancel common factors in a rational function of symbols and of their roots."""
    return sp.powdenest(factored(sp.cancel(sp.together(sp.expand(expression)))), force=True)
