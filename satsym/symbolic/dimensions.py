"""Dimensional homogeneity: both sides of an equation, and all terms of a sum, have the same dimension.

Units are those of the declared variables. A model whose variables are all plain numbers is taken as normalised,
so that its time is a plain number, too.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeAlias

import sympy as sp

from satsym import units
from satsym.spec import Variable
from satsym.status import BadInput
from satsym.symbolic import control_sets
from satsym.symbolic import notation as n
from satsym.symbolic.derivation import Check, Derivation, DerivationError, Step
from satsym.symbolic.model import FirstOrder, Newton, Problem, symbols_of

Dimension: TypeAlias = Mapping[str, sp.Expr]
"""Exact exponents of base dimensions, without zeros; empty for plain numbers."""

Known: TypeAlias = Mapping[str, Dimension | None]
"""Name of a symbol -> its dimension; ``None`` for zero, which has every dimension."""

Requirement: TypeAlias = Callable[..., Dimension | None]
"""What is meant, an expression, and the dimension it needs (if that is known) -> the dimension it has."""

PLAIN: Dimension = {}
_SAME = (sp.Add, sp.Max, sp.Min, control_sets.Clip)
"""What needs arguments of one dimension and returns it."""


class Disagreement(Exception):
    """An expression puts together what has different dimensions; the message goes on from "the expression ..."."""


def declared(derivation: Derivation) -> Known:
    """Dimensions of all symbols, from the units of the declared variables.

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
        known[n.rate_of(state).name] = _over(known[state.name], second)
        known[n.initial(state).name] = known[state.name]
        require(f"the reference of {state.name}", model.reference.get(state, 0), known[state.name])
    for row in states:
        for letter, columns in (("A", states), ("B", symbols_of(model.controls))):
            for column in columns:
                known[f"{letter}_{row.name}_{column.name}"] = _over(known[n.rate_of(row).name], known[column.name])
    for control in symbols_of(model.controls):
        known[n.optimal(control).name] = known[n.unconstrained(control).name] = known[control.name]
    if isinstance(model, FirstOrder):
        for state, rate in model.rates.items():
            require(f"the rate of {state.name}", rate, known[n.rate_of(state).name])
    if isinstance(model, Newton):
        _enter_mechanics(known, model, require)
    if derivation.problem:
        _enter_cost(known, derivation.problem, require)
    return known


def extended(known: Known, step: Step) -> Known:
    """The dimensions, and those of symbols that a step defines: a new one alone on the left-hand side."""
    found = dict(known)
    for equation in step.equations:
        if equation.lhs.is_Symbol and equation.lhs.name not in found:
            try:
                found[equation.lhs.name] = dimension_of(_right_side(step, equation.rhs), known)
            except Disagreement:
                continue  # the check counts it
    return found


def agreement(known: Known, step: Step) -> Check:
    """Check that every equation of a step is homogeneous; its error is the number of those that are not."""
    known = extended(known, step)

    def agrees(lhs: sp.Expr, rhs: sp.Expr) -> bool:
        try:
            left, right = dimension_of(lhs, known), dimension_of(rhs, known)
        except Disagreement:
            return False
        return left is None or right is None or left == right

    violations = sum(not agrees(e.lhs, _right_side(step, e.rhs)) for e in step.equations)
    return Check("dimensions agree", float(violations), 0.0)


def dimension_of(expression: Any, known: Known) -> Dimension | None:
    """Dimension of an expression.

    Parameters
    ----------
    expression
        Anything but a matrix.
    known
        Dimensions of its symbols.

    Returns
    -------
    Dimension or None
        ``None`` for zero.

    Raises
    ------
    Disagreement
        If it is not homogeneous.
    """
    e = sp.sympify(expression)
    if e.is_Symbol:
        if e.name not in known:
            raise Disagreement(f"uses {e.name}, whose dimension is not known")
        return known[e.name]
    if e.is_number:
        return None if e == 0 else PLAIN
    if isinstance(e, _SAME):
        return _common(e.args, known)
    if e.is_Mul:
        return _product(dimension_of(a, known) for a in e.args)
    if e.is_Pow:
        _plain(e.exp, known, "an exponent")
        return _power(dimension_of(e.base, known), e.exp)
    if isinstance(e, sp.Abs):
        return dimension_of(e.args[0], known)
    if isinstance(e, sp.Piecewise):
        for comparison in e.atoms(sp.core.relational.Relational):
            _common(comparison.args, known)
        return _common([branch for branch, _ in e.args], known)
    if isinstance(e, control_sets.Shorten):
        norm_squared, limit = e.args
        _common((norm_squared, limit**2), known)
    elif isinstance(e, sp.atan2):
        _common(e.args, known)
    elif not isinstance(e, sp.sign):
        for argument in e.args:
            _plain(argument, known, f"{e.func.__name__} of it")
    return PLAIN


def written(dimension: Dimension | None) -> str:
    """A dimension for people, such as ``[length]/[time]^2``; ``1`` for a plain number."""
    above: list[str] = []
    below: list[str] = []
    for base, exponent in (dimension or PLAIN).items():
        side, size = (below, -exponent) if exponent.could_extract_minus_sign() else (above, exponent)
        side.append(base if size == 1 else f"{base}^{size if size.is_Integer else f'({size})'}")
    return "/".join(["*".join(above) or "1", *below])


def _enter_mechanics(known: dict[str, Dimension | None], model: Newton, require: Requirement) -> None:
    second = known[n.TIME.name]
    for q, q_dot in model.coordinates.items():
        require(f"{q_dot.name}, the rate of {q.name},", q_dot, known[n.rate_of(q).name])
        known[n.acceleration_of(q).name] = _over(known[q_dot.name], second)
    for name, direction in model.directions.items():
        for component in direction:
            require(f"the direction {name}", component, PLAIN)
        known[name], known[f"d_{name}"] = PLAIN, _over(PLAIN, second)
    place = None
    for component in model.position:
        place = require("the position", component, place)
    velocity = _over(place, second)
    acceleration = _over(velocity, second)
    vectors = (n.POSITION, n.VELOCITY, n.ACCELERATION, n.FORCE)
    known.update(zip((v.name for v in vectors), (place, velocity, acceleration, acceleration), strict=True))
    for name, force in model.forces.items():
        for component in force:
            require(f"the force {name!r}, per unit mass,", component, acceleration)


def _enter_cost(known: dict[str, Dimension | None], problem: Problem, require: Requirement) -> None:
    second = known[n.TIME.name]
    running, final = (
        require(f"the {which} cost", cost)
        for which, cost in (("running", problem.running_cost), ("terminal", problem.terminal_cost))
    )
    running = _over(final, second) if running is None else running
    total = _product((running, second))
    require("the terminal cost, beside the integral of the running cost,", problem.terminal_cost, total)
    known.update({s.name: running for s in (n.RUNNING_COST, n.HAMILTONIAN, n.MINIMISED)})
    known[n.TERMINAL_COST.name] = total
    for state in symbols_of(problem.model.states):
        known[n.costate_of(state).name] = _over(total, known[state.name])
        known[n.rate_of(n.costate_of(state)).name] = _over(running, known[state.name])
        known[n.target(state).name] = known[state.name]
        known[n.given(state).name] = known[n.on_reference(state).name] = PLAIN
    for multiplier, constraint in zip(n.multipliers(problem), problem.terminal_constraints, strict=True):
        known[multiplier.name] = _over(total, require("a terminal constraint", constraint))
    for a in problem.model.controls:
        for b in problem.model.controls:
            known[f"H_{a.symbol}_{b.symbol}"] = _over(_over(running, known[a.symbol]), known[b.symbol])


def _of_variables(derivation: Derivation) -> dict[str, Dimension | None]:
    """Dimensions of declared variables, bounds and time."""
    model, problem = derivation.model, derivation.problem
    variables = [*model.states, *model.controls, *model.parameters, *(d.variable for d in model.definitions)]
    if problem:
        variables += control_sets.bounds(problem.control_set, model.controls)
    try:
        known: dict[str, Dimension | None] = {v.symbol: _of_unit(v) for v in variables}
    except BadInput as error:
        raise DerivationError(f"{derivation.name}: {error}") from None
    second = {"[time]": sp.Integer(1)} if any(known.values()) else PLAIN
    return known | {n.TIME.name: second, n.FINAL_TIME.name: second}


def _of_unit(variable: Variable) -> Dimension:
    if variable.unit == "1":
        return PLAIN
    return {base: sp.Rational(exponent) for base, exponent in units.dimension(variable.unit).items()}


def _right_side(step: Step, rhs: sp.Expr) -> sp.Expr:
    """The right-hand side; of a conserved quantity, without the constants that the units in logarithms only shift."""
    return rhs.replace(sp.log, lambda _: sp.Integer(1)) if step.name == "conserved" else rhs


def _require(what: str, expression: Any, known: Known, needed: Dimension | None) -> Dimension | None:
    try:
        found = dimension_of(expression, known)
    except Disagreement as error:
        raise DerivationError(f"{what} {error}") from None
    if found is None or needed is None:
        return needed if found is None else found
    if found != needed:
        raise DerivationError(f"{what} has the dimension {written(found)}, but needs {written(needed)}")
    return found


def _plain(expression: sp.Expr, known: Known, role: str) -> None:
    found = dimension_of(expression, known)
    if found:
        raise Disagreement(f"has {expression} of dimension {written(found)}, but {role} needs a plain number")


def _common(expressions: Iterable[sp.Expr], known: Known) -> Dimension | None:
    """The one dimension of some expressions."""
    first, found = None, None
    for expression in expressions:
        dimension = dimension_of(expression, known)
        if dimension is None:
            continue
        if found is None:
            first, found = expression, dimension
        elif dimension != found:
            one, other = (f"{e} of dimension {written(d)}" for e, d in ((first, found), (expression, dimension)))
            raise Disagreement(f"puts {one} beside {other}")
    return found


def _product(dimensions: Iterable[Dimension | None]) -> Dimension | None:
    total: dict[str, sp.Expr] = {}
    for dimension in dimensions:
        if dimension is None:
            return None
        for base, exponent in dimension.items():
            total[base] = sp.expand(total.get(base, 0) + exponent)
    return {base: total[base] for base in sorted(total) if total[base] != 0}


def _power(dimension: Dimension | None, exponent: sp.Expr) -> Dimension | None:
    if dimension is None:
        return None
    exact = sp.nsimplify(exponent, rational=True)
    return {base: sp.expand(power * exact) for base, power in dimension.items()}


def _over(dimension: Dimension | None, other: Dimension | None) -> Dimension | None:
    return _product((dimension, _power(other, sp.Integer(-1))))
