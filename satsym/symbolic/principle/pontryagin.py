"""The necessary conditions of the minimum principle, from equations of motion and a cost."""

from __future__ import annotations

import random
from collections.abc import Iterable
from typing import Any

import sympy as sp
from sympy.solvers.solveset import NonlinearError

from satsym.symbolic import notation as n
from satsym.symbolic.algebra import gradient, shortest, simplified, simplify, tidy
from satsym.symbolic.checks import Point, compare, identity, never_below, numeric, partial, positive, vanishes
from satsym.symbolic.convention import sign, worded
from satsym.symbolic.derivation import Check, Derivation, DerivationError, Equation, Step
from satsym.symbolic.model import Problem, symbols_of, t
from satsym.symbolic.principle import control_sets
from satsym.symbolic.principle.parts import unsigned

COMPETITORS = 50
"""Number of admissible controls with which the control law is compared at each random point."""


def costates(so_far: Derivation) -> tuple[sp.Symbol, ...]:
    """Return the symbols of the costates, in the order of the states."""
    return tuple(n.costate_of(s) for s in symbols_of(so_far.model.states))


def hamiltonian(so_far: Derivation) -> Step:
    """State H = lambda' f + L, or lambda' f - L with the maximum convention."""
    problem, lam = _problem(so_far), sp.Matrix(costates(so_far))
    f = so_far.rhs("first_order")
    h = sign(problem) * tidy(problem.running_cost) + (lam.T * f)[0]
    value, parts = numeric([h]), numeric([problem.running_cost, *f])

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        cost, *rates = parts(point)
        return value(point), [
            sign(problem) * cost + sum(point[costate] * rate for costate, rate in zip(lam, rates, strict=True))
        ]

    check = compare(worded("sum of parts", problem), h.free_symbols | {*lam}, sides)
    rule = worded("definition of H", problem)
    return Step("hamiltonian", rule, (Equation("H", n.HAMILTONIAN, h),), ("first_order", "cost"), (check,))


def stationarity(so_far: Derivation) -> Step:
    """Derive H_u, which vanishes at an unconstrained minimum, and the controls at which it vanishes."""
    controls = symbols_of(so_far.model.controls)
    h = so_far.equation("hamiltonian.H").rhs
    h_u = [tidy(g, controls) for g in gradient(h, controls)]
    rows, load = _linear_system(so_far, h_u, controls)
    hats = [tidy(simplified(u)) for u in rows.LUsolve(load)]
    conditions = tuple(Equation(u.name, sp.Integer(0), g) for u, g in zip(controls, h_u, strict=True))
    solved = tuple(Equation(f"{u.name}_hat", n.unconstrained(u), hat) for u, hat in zip(controls, hats, strict=True))
    return Step(
        "stationarity",
        "differentiate H by controls",
        (*conditions, *solved),
        ("hamiltonian",),
        (
            numeric_gradient(h, controls, h_u),
            identity("vanishes there", [g.xreplace(dict(zip(controls, hats, strict=True))) for g in h_u]),
        ),
    )


def second_derivative(so_far: Derivation) -> Step:
    """Derive H_uu, and check that it is positive definite (the strict Legendre-Clebsch condition)."""
    problem, controls = _problem(so_far), symbols_of(so_far.model.controls)
    h = so_far.equation("hamiltonian.H").rhs
    hessian = _hessian(so_far)
    equations = tuple(
        Equation(
            f"{a.name}_{b.name}",
            sp.Symbol(f"H_{a.name}_{b.name}", real=True),
            hessian[i, j],
        )
        for i, a in enumerate(controls)
        for j, b in enumerate(controls)
        if i == j or hessian[i, j] != 0
    )
    minors = [(sign(problem) * hessian[:k, :k]).det() for k in range(1, len(controls) + 1)]
    definite = positive(worded("positive minors", problem), h.free_symbols, minors)
    if not definite.passed or any(vanishes(worded("positive minors", problem), m) for m in minors):
        raise DerivationError(
            f"{so_far.name}: H_uu is not {'positive' if sign(problem) > 0 else 'negative'} definite, so H has no "
            f"{problem.convention} in the controls; {unsigned(problem, hessian)}"
        )
    return Step(
        "second_derivative",
        worded("second derivative by controls", problem),
        equations,
        ("stationarity",),
        (_numeric_gradient_of(gradient(h, controls), controls, list(hessian.T)), definite),
    )


def control_law(so_far: Derivation) -> Step:
    """Derive the control that minimises H over the control set by projecting the unconstrained one."""
    model, problem = so_far.model, _problem(so_far)
    controls = symbols_of(model.controls)
    limits = symbols_of(control_sets.bounds(problem.control_set, model.controls))
    hats = [so_far.equation(f"stationarity.{u.name}_hat").rhs for u in controls]
    laws = control_sets.project(problem.control_set, hats, limits, _hessian(so_far))
    equations = tuple(Equation(u.name, n.optimal(u), law) for u, law in zip(controls, laws, strict=True))
    h = so_far.equation("hamiltonian.H").rhs
    value, chosen = numeric([h]), numeric(laws)

    def margins(point: Point, rng: random.Random) -> list[Any]:
        """Return how far the law is inside its bounds, and how much random admissible controls exceed it in H."""
        point = control_sets.ordered(problem.control_set, point, limits)
        law = chosen(point)
        best = value({**point, **dict(zip(controls, law, strict=True))})[0]
        return control_sets.slacks(problem.control_set, point, limits, law) + [
            sign(problem) * (value({**point, **dict(zip(controls, other, strict=True))})[0] - best)
            for other in control_sets.admissible(problem.control_set, point, limits, len(controls), rng, COMPETITORS)
        ]

    competed = "cheapest admissible" if limits else "cheapest of all"
    claim, rule = (worded(key, problem) for key in (competed, f"project on {problem.control_set}"))
    check = never_below(claim, h.free_symbols | {*limits, *controls}, margins)
    return Step("control_law", rule, equations, ("second_derivative",), (check,))


def minimised_hamiltonian(so_far: Derivation) -> Step:
    """Derive H* = H at the unconstrained minimiser or maximiser, as on arcs without active bounds."""
    problem = _problem(so_far)
    controls = symbols_of(so_far.model.controls)
    h = so_far.equation("hamiltonian.H").rhs
    hats = {u: so_far.equation(f"stationarity.{u.name}_hat").rhs for u in controls}
    idle = h.xreplace(dict.fromkeys(controls, sp.Integer(0)))
    h_star = shortest(tidy(h.xreplace(hats)), idle + tidy(simplified(h.xreplace(hats) - idle)))
    value, at_minimum, minimisers = numeric([h]), numeric([h_star]), numeric(list(hats.values()))

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        return at_minimum(point), value({**point, **dict(zip(controls, minimisers(point), strict=True))})

    check = compare("H at the minimiser", h.free_symbols, sides)
    equation = Equation("H_star", n.MINIMISED, h_star)
    name = "minimised_hamiltonian" if problem.convention == "minimum" else "maximised_hamiltonian"
    return Step(name, worded("substitute controls", problem), (equation,), ("hamiltonian", "stationarity"), (check,))


def state_equations(so_far: Derivation) -> Step:
    """Derive dx/dt = H_lambda."""
    h = so_far.equation("hamiltonian.H").rhs
    lam, states = costates(so_far), symbols_of(so_far.model.states)
    rates, f = gradient(h, lam), so_far.rhs("first_order")
    equations = tuple(Equation(s.name, n.rate_of(s), rate) for s, rate in zip(states, f, strict=True))
    return Step(
        "state_equations",
        "differentiate H by costates",
        equations,
        ("hamiltonian",),
        (identity("equal the equations of motion", [slope - rate for slope, rate in zip(rates, f, strict=True)]),),
    )


def costate_equations(so_far: Derivation) -> Step:
    """Derive d lambda/dt = -H_x."""
    h = so_far.equation("hamiltonian.H").rhs
    lam, states = costates(so_far), symbols_of(so_far.model.states)
    rates = [tidy(-g, lam) for g in gradient(h, states)]
    equations = tuple(
        Equation(s.name, n.rate_of(costate), rate) for s, costate, rate in zip(states, lam, rates, strict=True)
    )
    along = dict(zip((*states, *lam), (*so_far.rhs("first_order"), *rates), strict=True))
    drift = sum((sp.diff(h, symbol) * rate for symbol, rate in along.items()), sp.Integer(0))
    return Step(
        "costate_equations",
        "differentiate H by states",
        equations,
        ("hamiltonian",),
        (numeric_gradient(-h, states, rates), identity("H changes only with time", [drift])),
    )


def boundary_conditions(so_far: Derivation) -> Step:
    """State the initial state, and derive transversality at the final time, component by component.

    The equation ``lambda_x`` holds for each state whose final value is free, ``final_time`` if the final time is free.
    """
    problem = _problem(so_far)
    states, lam = symbols_of(so_far.model.states), costates(so_far)
    s = sp.sympify(problem.terminal_cost)
    *s_x, s_t = (tidy(g) for g in gradient(s, (*states, t)))
    equations = (
        *(Equation(x.name, x, n.initial(x)) for x in states),
        *(Equation(costate.name, costate, sign(problem) * g) for costate, g in zip(lam, s_x, strict=True)),
        Equation("final_time", n.HAMILTONIAN + sign(problem) * s_t, sp.Integer(0)),
    )
    slope = numeric([*s_x, s_t])
    cost = numeric([s])
    check = compare(
        "numeric derivative",
        s.free_symbols | {*states, t},
        lambda point: (slope(point), [partial(cost, point, symbol)[0] for symbol in (*states, t)]),
    )
    rule = worded("transversality", problem)
    return Step("boundary_conditions", rule, equations, ("hamiltonian", "cost"), (check,))


def _problem(so_far: Derivation) -> Problem:
    if so_far.problem is None:
        raise TypeError(f"{so_far.name} has no cost")
    return so_far.problem


def _hessian(so_far: Derivation) -> sp.Matrix:
    controls = symbols_of(so_far.model.controls)
    return sp.hessian(so_far.equation("hamiltonian.H").rhs, controls).applyfunc(simplify)


def _linear_system(
    so_far: Derivation, h_u: list[sp.Expr], controls: tuple[sp.Symbol, ...]
) -> tuple[sp.Matrix, sp.Matrix]:
    """Write H_u = 0 as a linear system in the controls."""
    try:
        rows, load = sp.linear_eq_to_matrix(h_u, controls)
    except NonlinearError:
        raise DerivationError(f"{so_far.name}: H is not quadratic in the controls, so H_u = 0 is not linear") from None
    control_sets.refuse_singular(so_far.name, _problem(so_far).control_set, controls, rows)
    return rows, load


def numeric_gradient(function: sp.Expr, symbols: Iterable[sp.Symbol], derived: list[sp.Expr]) -> Check:
    """Check derived derivatives of a function by numeric ones."""
    return _numeric_gradient_of([function], symbols, derived)


def _numeric_gradient_of(functions: list[sp.Expr], symbols: Iterable[sp.Symbol], derived: list[sp.Expr]) -> Check:
    """Compare derived partial derivatives of functions, symbol by symbol, with numeric ones."""
    values, slopes, by = numeric(functions), numeric(derived), list(symbols)
    everything = set(by).union(*(f.free_symbols for f in functions))
    return compare(
        "numeric derivative",
        everything,
        lambda point: (slopes(point), [d for symbol in by for d in partial(values, point, symbol)]),
    )
