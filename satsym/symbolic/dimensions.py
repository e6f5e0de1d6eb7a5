"""Dimensional homogeneity: both sides of an equation, and all terms of a sum, have the same dimension.

Dimensions follow from the units of the declared variables. A model whose variables are all plain numbers is taken as
normalised, so that its time is a plain number, too.
"""

from __future__ import annotations

import itertools
import re
from typing import Any

import sympy as sp

from satsym import units
from satsym.status import BadInput
from satsym.symbolic import notation as n
from satsym.symbolic.derivation import Check, Derivation, DerivationError, Step
from satsym.symbolic.dimension_algebra import (
    PLAIN,
    Dimension,
    Disagreement,
    Known,
    dimension_of,
    over,
    product,
    written,
)
from satsym.symbolic.linear import notation as linear_dimensions
from satsym.symbolic.model import Problem, Requirement, symbols_of, variables_of
from satsym.symbolic.principle import effort as pn
from satsym.symbolic.principle.parts import limits_of
from satsym.symbolic.principle.path import interior
from satsym.symbolic.principle.path import notation as path_notation
from satsym.symbolic.switching import notation as switching_dimensions

AGREEMENT = "dimensions agree"
"""The claim of the check of dimensions that every step has."""


def declared(derivation: Derivation) -> Known:
    """Return the dimensions of all declared symbols, from the units of the variables.

    Parameters
    ----------
    derivation
        One without steps.

    Raises
    ------
    DerivationError
        If what was declared is not homogeneous, or a unit is not readable.
    """
    model = derivation.model
    known = _of_variables(derivation)
    second, states = known[n.TIME.name], symbols_of(model.states)

    def require(what: str, expression: Any, needed: Dimension | None = None) -> Dimension | None:
        return _require(f"{derivation.name}: {what}", expression, known, needed)

    for definition in model.definitions:
        name = definition.variable.symbol
        require(f"the value of {name}", definition.value, known[name])
    for state in states:
        known[n.rate_of(state).name] = over(known[state.name], second)
        known[n.initial(state).name] = known[state.name]
        require(f"the reference of {state.name}", model.reference.get(state, 0), known[state.name])
    for row in states:
        for letter, columns in (("A", states), ("B", symbols_of(model.controls))):
            for column in columns:
                known[f"{letter}_{row.name}_{column.name}"] = over(known[n.rate_of(row).name], known[column.name])
    for control in symbols_of(model.controls):
        known[n.optimal(control).name] = known[n.unconstrained(control).name] = known[control.name]
    model.enter_dimensions(known, require)
    linear_dimensions.declare(known, model, require)
    if derivation.problem:
        _enter_cost(known, derivation.problem, require)
    else:
        linear_dimensions.declare_results(known, model)
    return known


def extended(known: Known, step: Step) -> Known:
    """Return the dimensions with those of symbols that a step defines alone on a left-hand side."""
    found = dict(known)
    for equation in step.equations:
        if equation.lhs.is_Symbol and equation.lhs.name not in found and not equation.rhs.is_Matrix:
            try:
                found[equation.lhs.name] = dimension_of(_right_side(step, equation.rhs), found)
            except Disagreement:
                continue  # the check counts it
    return found


def agreement(known: Known, step: Step) -> Check:
    """Check that every equation of a step is homogeneous; the error counts the equations that are not."""
    known = extended(known, step)

    def agrees(lhs: sp.Expr, rhs: sp.Expr) -> bool:
        if rhs.is_Matrix and lhs.name in known:
            return all(agrees(lhs, entry) for entry in rhs)
        try:
            if rhs.is_Matrix:
                linear_dimensions.require_matrix(rhs, known)
                return True
            left, right = dimension_of(lhs, known), dimension_of(rhs, known)
        except Disagreement:
            return False
        return left is None or right is None or left == right

    violations = sum(not agrees(e.lhs, _right_side(step, e.rhs)) for e in step.equations)
    return Check(AGREEMENT, float(violations), 0.0)


def _enter_cost(known: dict[str, Dimension | None], problem: Problem, require: Requirement) -> None:
    second = known[n.TIME.name]
    running, final = (
        require(f"the {which} cost", cost)
        for which, cost in (("running", problem.running_cost), ("terminal", problem.terminal_cost))
    )
    running = over(final, second) if running is None else running
    total = product((running, second))
    require("the terminal cost, beside the integral of the running cost,", problem.terminal_cost, total)
    if problem.unit and total is not None and total != (needed := _units_dimension(problem)):
        raise DerivationError(
            f"unit: the objective has the dimension {written(total)}, not {written(needed)}", ("unit",)
        )
    known.update({s.name: running for s in (n.RUNNING_COST, n.HAMILTONIAN, n.MINIMISED)})
    known[n.TERMINAL_COST.name] = total
    for state in symbols_of(problem.model.states):
        known[n.costate_of(state).name] = over(total, known[state.name])
        known[n.rate_of(n.costate_of(state)).name] = over(running, known[state.name])
        known[n.target(state).name] = known[state.name]
        known[n.given(state).name] = known[n.on_reference(state).name] = PLAIN
    for multiplier, constraint in zip(n.multipliers(problem), problem.end_conditions, strict=True):
        known[multiplier.name] = over(total, require("a terminal constraint", constraint))
    known[pn.REDUCED_COST.name] = running
    known.update({s.name: total for s in (pn.POTENTIAL, pn.MINIMUM_COST, pn.COST_FROM_REST)})
    for state in symbols_of(problem.model.states):
        known[pn.reduced_costate_of(state).name] = known[n.costate_of(state).name]
    for control in symbols_of(problem.model.controls):
        known[n.answer_of(control).name] = known[pn.peak_of(control).name] = known[control.name]
    switching_dimensions.declare(known, problem, running)
    pn.declare_product(known, problem, running)
    path_notation.declare(known, problem, second, total, require)
    interior.declare(known, problem, total, require)
    for a in problem.model.controls:
        for b in problem.model.controls:
            known[f"H_{a.symbol}_{b.symbol}"] = over(over(running, known[a.symbol]), known[b.symbol])


def _units_dimension(problem: Problem) -> Dimension:
    """Return the dimension of the unit that the problem states for its objective."""
    try:
        return of_unit(problem.unit)
    except BadInput as error:
        raise DerivationError(f"unit: {error}", ("unit",)) from None


def _of_variables(derivation: Derivation) -> dict[str, Dimension | None]:
    """Return the dimensions of declared variables, bounds and time."""
    model, problem = derivation.model, derivation.problem
    variables = list(variables_of(model))
    if problem:
        variables += limits_of(problem)
    known: dict[str, Dimension | None] = {}
    for v in variables:
        try:
            known[v.symbol] = of_unit(v.unit)
        except BadInput as error:
            raise DerivationError(f"{derivation.name}: {v.symbol}: {error}", (v.symbol,)) from None
    second = {"[time]": sp.Integer(1)} if any(known.values()) and not model.plain_time else PLAIN
    return known | {n.TIME.name: second, n.FINAL_TIME.name: second}


def of_unit(unit: str) -> Dimension:
    """Return the dimension of a unit, as pint reads it; ``"1"`` is the unit of a plain number.

    Raises
    ------
    BadInput
        If the unit is not readable or unknown.
    """
    if unit == "1":
        return PLAIN
    return {base: sp.Rational(exponent) for base, exponent in units.dimension(unit).items()}


def _right_side(step: Step, rhs: sp.Expr) -> sp.Expr:
    """Return the right-hand side of an equation whose dimension is checked.

    From a conserved quantity, constants that only shift with the units inside logarithms are left out.
    """
    return rhs.replace(sp.log, lambda _: sp.Integer(1)) if step.name == "conserved" else rhs


def _words(what: str) -> tuple[str, ...]:
    """Return the fields and symbols that a message is about, such as the field rates and x for "the rate of x"."""
    words = re.findall(r"\w+", what.partition(": ")[2])
    both = [*words, *(f"{first}_{second}" for first, second in itertools.pairwise(words))]
    return (*both, *(f"{word}s" for word in both))


def _require(what: str, expression: Any, known: Known, needed: Dimension | None) -> Dimension | None:
    try:
        found = dimension_of(expression, known)
    except Disagreement as error:
        raise DerivationError(f"{what} {error}", _words(what)) from None
    if found is None or needed is None:
        return needed if found is None else found
    if found != needed:
        message = f"{what} has the dimension {written(found)}, but needs {written(needed)}"
        raise DerivationError(message, _words(what))
    return found
