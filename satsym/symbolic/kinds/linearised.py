"""The linear model of deviations from a motion, derived by a change of variables.

The equations of the motion are derived anew as far as their first-order form; a reference is found to solve them,
and under which condition; then come the exact equations in the deviations, and their first order at zero.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import mpmath as mp
import sympy as sp

from satsym.spec import Variable
from satsym.symbolic import notation as n
from satsym.symbolic.algebra import constants_of, definitions_of, simplified, simplify, tidy, total_derivative, vanishes
from satsym.symbolic.checks import Point, compare, first_order_at_zero, identity, numeric
from satsym.symbolic.derivation import Check, Derivation, DerivationError, Equation, Step
from satsym.symbolic.dimension_algebra import Dimension
from satsym.symbolic.factoring import factored
from satsym.symbolic.kinds import stated_as
from satsym.symbolic.kinds.derived import Derived, original_equations, there_and_back
from satsym.symbolic.linear.notation import results
from satsym.symbolic.model import Line, MaybeStep, Paragraph, Problem, Requirement, symbols_of, t
from satsym.symbolic.motion import geometry
from satsym.symbolic.motion.steps import jacobians


@dataclass(frozen=True, kw_only=True)
class Linearised(Derived):
    """Small deviations from a motion, to first order: x' = A x + B u, y = C x + D u.

    The states are the deviations, stated as a change of variables, and so are the controls that the motion needs.
    Everything else is declared as for any model; parameters and definitions are those of the motion, as far as it
    needs them. The outputs are functions of the states and controls of the motion, and stand for their deviations
    from what they are along it.

    Parameters
    ----------
    of
        The model whose motion this is.
    about
        Each of its states, and each control that is not zero, along the motion: functions of time and parameters.
        They must solve its equations, which is proved.
    deviations
        Each state of this model, as a function of time and of the states of ``of``; and each control that is not one
        of ``of``, as a function of these and the controls. They vanish along the motion, and there must be as many as
        they replace.
    """

    about: Mapping[sp.Symbol, sp.Expr]
    deviations: Mapping[sp.Symbol, sp.Expr]

    def steps(self) -> tuple[MaybeStep, ...]:
        """List the steps, which end with the first-order form."""
        return self.motion_steps()

    def motion_steps(self) -> tuple[MaybeStep, ...]:
        """List the steps: the reference, the change of variables, the exact equations and their first order."""
        exact = (original_equations, reference_condition, reference, deviations, original_states, deviation_equations)
        return (*exact, linearisation, first_order)

    def replaced_states(self) -> tuple[Variable, ...]:
        """Return all states of the original motion."""
        return self.of.states

    def replaced_controls(self) -> tuple[Variable, ...]:
        """Return the controls of the original motion that have deviations."""
        kept = {v.symbol for v in self.controls}
        return tuple(v for v in self.of.controls if v.symbol not in kept)

    def measured(self) -> tuple[Variable, ...]:
        """Return the variables of the original motion, of which outputs are functions."""
        return (*self.of.states, *self.of.controls)

    def picture(self) -> geometry.Picture | None:
        """Draw where the deviations move a particle."""
        particle = self.of.particle()
        return geometry.deviations(self, particle, self.about, self.deviations) if particle else None

    def misfits(self) -> Iterator[str]:
        """Yield complaints about variables that do not replace those of the original motion one by one."""
        of, old_controls = self.of, symbols_of(self.of.controls)
        states, controls = symbols_of(self.states), symbols_of(self.controls)
        new = [u for u in controls if u not in old_controls]
        if len(states) != len(of.states) or len(new) != len(self.replaced_controls()):
            yield f"give a replacement for each state and each control of {of.name}"
        if missing := [s.name for s in symbols_of(of.states) if s not in self.about]:
            yield f"the reference motion is incomplete: it has no value for {', '.join(missing)}"
        if kept := [u.name for u in old_controls if u in controls and self.about.get(u, 0) != 0]:
            yield f"{', '.join(kept)} is not zero along the reference motion; give the deviation a different name"
        if set(self.deviations) != {*states, *new}:
            yield "give exactly one deviation for each state and each new control"
        if self.definitions != of.definitions:
            yield f"the definitions must be exactly those of {of.name}"

    def stated(self) -> Iterator[tuple[str, Iterable[Any], set[sp.Symbol]]]:
        """Return the reference, stated by constants and time, the deviations, and the outputs."""
        constants = constants_of(self)
        everything = constants | set(symbols_of(self.measured()))
        yield "the motion it is linearised about", self.about.values(), constants
        yield "a deviation", self.deviations.values(), everything
        yield f"the motion {self.of.name}", self.of.motion_stated(), everything

    def names(self, problem: Problem | None) -> dict[str, str]:
        """Map the names of what linear theory finds, and of the rates of the original states, to LaTeX."""
        return super().names(problem) | ({} if problem else results(self))

    def enter_dimensions(self, known: dict[str, Dimension | None], require: Requirement) -> None:
        """Enter the dimensions of the old rates, and refuse a reference or deviations of other dimensions."""
        super().enter_dimensions(known, require)
        for symbol, curve in self.about.items():
            require(f"the reference of {symbol.name}", curve, known[symbol.name])
        for symbol, deviation in self.deviations.items():
            require(f"the deviation {symbol.name}", deviation, known[symbol.name])

    def statement(self) -> tuple[Paragraph, ...]:
        """Return the paragraph that gives the reference about which the motion is linearised."""
        about = (Line("reference", s, curve, f"reference.{s.name}") for s, curve in self.about.items())
        return (Paragraph("linearised", self.of, tuple(about)),)


def reference_condition(so_far: Derivation) -> Step | None:
    """Derive the values of named constants with which, and only which, the reference solves the equations."""
    model = stated_as(Linearised, so_far)
    constants = definitions_of(model)
    defects = [simplify(d) for d in _defects(so_far)]
    unknown = sorted(set(constants) & set().union(*(d.free_symbols for d in defects)), key=lambda s: s.name)
    if not unknown:
        return None
    found = sp.solve([d for d in defects if d != 0], unknown, dict=True)
    if len(found) != 1 or set(found[0]) != set(unknown):
        names = ", ".join(s.name for s in unknown)
        raise DerivationError(
            f"{model.name}: the reference does not determine {names}; it might not be a motion of the model"
        )
    for symbol, value in found[0].items():
        if not vanishes(value - constants[symbol]):
            raise DerivationError(
                f"{model.name}: the reference satisfies the equations of motion if and only if {symbol} = "
                f"{value}, but {symbol} is defined as {constants[symbol]}"
            )
    equations = tuple(Equation(s.name, s, tidy(found[0][s])) for s in unknown)
    values, equal = numeric([e.rhs for e in equations]), numeric(defects)

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        """Solve the defects of the equations by Newton's method from a random start."""
        start = [point[s] for s in unknown]
        square = [k for k, d in enumerate(defects) if d != 0][: len(unknown)]

        def residual(*numbers: Any) -> list[Any]:
            defect = equal({**point, **dict(zip(unknown, numbers, strict=True))})
            return [defect[k] for k in square]

        return values(point), list(mp.findroot(residual, start))

    symbols = set(unknown).union(*(d.free_symbols for d in defects))
    checks = (
        compare("solved numerically", symbols, sides),
        identity("vanish with these values", [d.xreplace({e.lhs: e.rhs for e in equations}) for d in defects]),
    )
    return Step("reference_condition", "solve for constants", equations, ("reference", "original_equations"), checks)


def reference(so_far: Derivation) -> Step:
    """Prove that the reference satisfies the equations of motion with its controls."""
    model = stated_as(Linearised, so_far)
    defects = [d.xreplace(definitions_of(model)) for d in _defects(so_far)]
    proof = identity("satisfies the equations with its controls", defects)
    if not proof.passed:
        raise DerivationError(f"{model.name}: the reference of the linearisation is not a motion of {model.of.name}")
    states, about = symbols_of(model.of.states), _about(model)
    controls = [u for u in symbols_of(model.of.controls) if about[u] != 0]
    equations = tuple(Equation(s.name, s, about[s]) for s in (*states, *controls))
    condition = ("reference_condition",) if "reference_condition" in so_far else ()
    sources = ("original_equations", *condition)
    return Step("reference", "given and proved with controls", equations, sources, (proof,))


def deviations(so_far: Derivation) -> Step:
    """State the deviations, which vanish on the reference."""
    model = stated_as(Linearised, so_far)
    stated = _stated(model)
    proof = identity("vanish on the reference", [d.xreplace(_about(model)) for d in stated.values()])
    if not proof.passed:
        raise DerivationError(f"{model.name}: some deviations do not vanish on the reference")
    equations = tuple(Equation(s.name, s, d) for s, d in stated.items())
    return Step("deviations", "change of variables", equations, ("reference",), (proof,))


def original_states(so_far: Derivation) -> Step:
    """Solve the deviations for the original variables."""
    model = stated_as(Linearised, so_far)
    stated, old = _stated(model), symbols_of((*model.replaced_states(), *model.replaced_controls()))
    try:
        solutions = sp.solve([d - s for s, d in stated.items()], old, dict=True)
    except NotImplementedError:
        solutions = []
    zero, about = dict.fromkeys(stated, sp.Integer(0)), _about(model)
    fitting = [
        s for s in solutions if set(s) == set(old) and all(vanishes(s[o].xreplace(zero) - about[o]) for o in old)
    ]
    if len(fitting) != 1:
        raise DerivationError(f"{model.name}: the deviations cannot be solved for the variables of {model.of.name}")
    equations = tuple(Equation(o.name, o, tidy(fitting[0][o])) for o in old)
    check = there_and_back(stated, equations)
    return Step("original_states", "solve for original states", equations, ("deviations",), (check,))


def deviation_equations(so_far: Derivation) -> Step:
    """Derive the exact equations of the deviations, by the chain rule."""
    model = stated_as(Linearised, so_far)
    old_states, stated = symbols_of(model.of.states), _stated(model)
    motion = dict(zip(old_states, so_far.rhs("original_equations"), strict=True))
    inverse = {e.lhs: e.rhs for e in so_far.step("original_states").equations}
    rates = [_shorter(total_derivative(stated[s], motion).xreplace(inverse)) for s in symbols_of(model.states)]
    equations = tuple(Equation(s.name, n.rate_of(s), f) for s, f in zip(symbols_of(model.states), rates, strict=True))
    new, back = numeric([stated[s] for s in symbols_of(model.states)]), numeric(list(inverse.values()))
    old_rates, found = numeric(list(motion.values())), numeric(rates)

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        """Differentiate the deviations numerically as the original variables move at their own rates."""
        here = {**point, **dict(zip(inverse, back(point), strict=True))}
        slopes = dict(zip(old_states, old_rates(here), strict=True))

        def moved(time: Any) -> list[Any]:
            return new({**here, **{s: here[s] + slopes[s] * time for s in old_states}, t: here[t] + time})

        return found(point), [mp.diff(lambda time, k=k: moved(time)[k], 0) for k in range(len(rates))]

    symbols = {t, *stated}.union(*(e.free_symbols for e in (*motion.values(), *inverse.values(), *rates)))
    check = compare("along the original motion", symbols, sides)
    sources = ("deviations", "original_equations", "original_states")
    return Step("deviation_equations", "chain rule", equations, sources, (check,))


def linearisation(so_far: Derivation) -> Step:
    """Derive A and B: the derivatives of the exact equations by the deviations, at zero."""
    model = stated_as(Linearised, so_far)
    states, controls = symbols_of(model.states), symbols_of(model.controls)
    constants = definitions_of(model)
    exact = [f.xreplace(constants) for f in so_far.rhs("deviation_equations")]
    rest = dict.fromkeys((*states, *controls), sp.Integer(0))
    equations, check = jacobians(exact, states, {"A": states, "B": controls}, lambda e: tidy(simplified(e)), rest)
    checks = (check, _transformed(so_far, [e.rhs for e in equations]))
    sources = ("deviation_equations", "definitions")
    return Step("linearisation", "differentiate at zero", equations, sources, checks)


def first_order(so_far: Derivation) -> Step:
    """State the linear equations x' = A x + B u."""
    model = stated_as(Linearised, so_far)
    states, controls = symbols_of(model.states), symbols_of(model.controls)
    entries = [e.rhs for e in so_far.step("linearisation").equations]
    a = sp.Matrix(len(states), len(states), entries[: len(states) ** 2])
    b = sp.Matrix(len(states), len(controls), entries[len(states) ** 2 :])
    rates = a * sp.Matrix(states) + (b * sp.Matrix(controls) if controls else sp.zeros(len(states), 1))
    equations = tuple(Equation(s.name, n.rate_of(s), f) for s, f in zip(states, rates, strict=True))
    constants = definitions_of(model)
    exact = [f.xreplace(constants) for f in so_far.rhs("deviation_equations")]
    check = first_order_at_zero("first order of the exact equations", exact, list(rates), (*states, *controls))
    return Step("first_order", "drop higher orders", equations, ("linearisation",), (check,))


def _about(model: Linearised) -> dict[sp.Symbol, sp.Expr]:
    """Return states and controls of the original motion along the reference."""
    symbols = (*symbols_of(model.of.states), *symbols_of(model.of.controls))
    return {s: sp.sympify(model.about.get(s, 0)) for s in symbols}


def _stated(model: Linearised) -> dict[sp.Symbol, sp.Expr]:
    """Return the deviations in the order of states and controls."""
    symbols = (*symbols_of(model.states), *symbols_of(model.controls))
    return {s: sp.sympify(model.deviations[s]) for s in symbols if s in model.deviations}


def _defects(so_far: Derivation) -> list[sp.Expr]:
    """Return the residuals of the equations of motion along the reference, with named constants kept."""
    model = stated_as(Linearised, so_far)
    about, states = _about(model), symbols_of(model.of.states)
    rates = so_far.rhs("original_equations").xreplace(about)
    return [sp.diff(about[s], t) - f for s, f in zip(states, rates, strict=True)]


def _transformed(so_far: Derivation, entries: list[sp.Expr]) -> Check:
    """Check A and B by transforming the Jacobians of the original equations along the reference."""
    model = stated_as(Linearised, so_far)
    constants, about, stated = definitions_of(model), _about(model), _stated(model)
    states, old = symbols_of(model.states), sp.Matrix(symbols_of(model.of.states))
    rates, controls = so_far.rhs("original_equations"), sp.Matrix(symbols_of(model.of.controls))
    change = sp.Matrix([stated[s] for s in states]).jacobian(old)
    along = dict(zip(old, rates, strict=True))
    moved = (change * rates.jacobian(old) + total_derivative(change, along)).row_join(change * rates.jacobian(controls))
    whole = sp.Matrix([*(stated[s] for s in states), *(stated.get(u, u) for u in symbols_of(model.controls))])
    both = (moved * whole.jacobian([*old, *controls]).inv()).xreplace(about)
    found = [*both[:, : len(states)], *both[:, len(states) :]]
    return identity("transformed Jacobians", [(x - y).xreplace(constants) for x, y in zip(found, entries, strict=True)])


def _shorter(expression: sp.Expr) -> sp.Expr:
    """Return the shortest of some ways to write a rate."""
    return min((expression, tidy(expression), factored(expression)), key=sp.count_ops)
