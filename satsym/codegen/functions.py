"""The functions of a generated module: their arguments, results, and the expressions behind them."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from satsym.codegen import switching
from satsym.codegen.laws import law_parts
from satsym.spec import Variable, names
from satsym.symbolic.algebra import gradient, tidy
from satsym.symbolic.chain import Assignment, jacobians, parts_of
from satsym.symbolic.derivation import Derivation, resolved
from satsym.symbolic.linear.notation import matrix_symbols
from satsym.symbolic.model import symbols_of, t
from satsym.symbolic.motion.central_force import inertial_state, strength_of
from satsym.symbolic.notation import costate_of, given, multipliers, on_reference, target
from satsym.symbolic.principle import product, set_laws
from satsym.symbolic.principle.parts import FRACTION, SMOOTHING, limits_of, minimum_norm_of
from satsym.symbolic.principle.path import interior, mixed_constraints, path_constraints
from satsym.symbolic.principle.path import notation as path_notation
from satsym.symbolic.switching.notation import REGULARISED

ARGUMENTS = tuple("t x original u lam nu gain riccati state_weight control_weight p bounds final".split())
"""Names of arguments, in the order in which every function takes those it has."""


@dataclass(frozen=True)
class Function:
    """One function of a generated module."""

    name: str
    summary: str
    """Name of the function, and the first line of its docstring."""
    arguments: tuple[str, ...]
    """The arguments of the function, from :data:`ARGUMENTS` and in their order."""
    value: sp.Matrix
    """The returned expression or matrix; a column is returned as a vector."""
    kind: str
    """``"scalar"``, ``"vector"`` or ``"matrix"``."""
    hints: tuple[str, ...] = ()
    """Names for the outputs, where they have any."""
    over_parameters: bool = False
    """Whether each parameter may be an array in the batch form."""

    @property
    def outputs(self) -> list[sp.Expr]:
        """Return the expressions of the results, row by row."""
        return list(self.value)


@dataclass(frozen=True)
class Symbols:
    """The symbols behind each argument of generated functions."""

    t: sp.Symbol
    x: tuple[sp.Symbol, ...]
    u: tuple[sp.Symbol, ...]
    lam: tuple[sp.Symbol, ...]
    nu: tuple[sp.Symbol, ...]
    p: tuple[sp.Symbol, ...]
    bounds: tuple[sp.Symbol, ...]
    final: tuple[sp.Symbol, ...]
    original: tuple[sp.Symbol, ...]
    gain: tuple[sp.Symbol, ...]
    riccati: tuple[sp.Symbol, ...]
    state_weight: tuple[sp.Symbol, ...]
    control_weight: tuple[sp.Symbol, ...]

    def of(self, argument: str) -> tuple[sp.Symbol, ...]:
        """Return the symbols of an argument; time alone is not a tuple."""
        found = getattr(self, argument)
        return found if isinstance(found, tuple) else (found,)


def symbols(derivation: Derivation) -> Symbols:
    """Return the symbols of a derivation, argument by argument."""
    model, problem = derivation.model, derivation.problem
    states = symbols_of(model.states)
    n, m = len(states), len(model.controls)
    return Symbols(
        t=t,
        x=states,
        u=symbols_of(model.controls),
        lam=tuple(costate_of(s) for s in states) if problem else (),
        nu=multipliers(problem) if problem else (),
        p=symbols_of(model.parameters),
        bounds=symbols_of(_bounds(derivation)),
        final=tuple(kind(s) for kind in (given, on_reference, target) for s in states) if problem else (),
        original=symbols_of(model.replaced_states()),
        gain=tuple(matrix_symbols("K", m, n)),
        riccati=tuple(matrix_symbols("P", n, n)),
        state_weight=tuple(matrix_symbols("Q", n, n)),
        control_weight=tuple(matrix_symbols("R", m, m)),
    )


def functions(derivation: Derivation) -> list[Function]:
    """Return every function that follows from a derivation, in the order of a module."""
    a, b = _jacobians(derivation)
    found = [
        _vector("dynamics", "Rates of change of the states, f(t, x, u).", "t x u p", derivation.rhs("first_order")),
        _matrix("jacobian_x", "A = df/dx, row by row.", "t x u p", a),
        _matrix("jacobian_u", "B = df/du, row by row.", "t x u p", b),
    ]
    if derivation.model.reference:
        found.append(_vector("reference", "The reference curve c(t).", "t p", derivation.rhs("reference")))
    if "conserved" in derivation:
        summary = "Conserved quantities of the uncontrolled motion."
        found.append(_vector("invariants", summary, "t x p", derivation.rhs("conserved")))
    particle, strength = derivation.model.particle(), strength_of(derivation)
    if particle:
        found.append(_vector("position", "Inertial components of the position vector.", "t x p", particle.position))
    if particle and strength is not None:
        summary = "Position and velocity along inertial axes, three numbers each, and the gravitational parameter."
        found.append(_vector("inertial_state", summary, "t x p", inertial_state(particle, strength)))
    if "quantities" in derivation:
        known = resolved(derivation.step("quantities").equations)
        summary = "Further quantities, derived along the motion."
        found.append(_vector("quantities", summary, "t x u p", sp.Matrix(list(known.values()))))
    if "balance" in derivation:
        kept, rates = derivation.step("momenta").equations[-1:], derivation.step("balance").equations
        pairs = sp.Matrix([side for e, rate in zip(kept, rates, strict=True) for side in (e.rhs, rate.rhs)])
        summary = "Quantities that only external influences change, each followed by its rate of change."
        found.append(_vector("balances", summary, "t x u p", pairs))
    return found + (_cost_functions(derivation) if derivation.problem else [])


def _bounds(derivation: Derivation) -> tuple[Variable, ...]:
    """Return the symbols in the argument ``bounds``."""
    problem = derivation.problem
    found = limits_of(problem) if problem else ()
    if "smoothed_law" in derivation and product.STEP in derivation:
        parts = [one.part for one in set_laws.throttled(derivation)]
        least = (minimum_norm_of(part) for part in parts if part.kind == "ball")
        return (*found, SMOOTHING, *((FRACTION,) if parts else ()), *least)
    return found + (REGULARISED if switching.switches(derivation) else ())


def chain_of(derivation: Derivation) -> tuple[Assignment, ...]:
    """Return the named parts of functions without closed form, and of their derivatives."""
    return jacobians(derivation)[0] if parts_of(derivation) else law_parts(derivation).parts


def _jacobians(derivation: Derivation) -> tuple[sp.Matrix, sp.Matrix]:
    """Return A and B."""
    if parts_of(derivation):
        return jacobians(derivation)[1:]
    n, m = len(derivation.model.states), len(derivation.model.controls)
    entries = [e.rhs for e in derivation.step("linearisation").equations]
    return sp.Matrix(n, n, entries[: n * n]), sp.Matrix(n, m, entries[n * n :])


def _cost_functions(derivation: Derivation) -> list[Function]:
    problem = derivation.problem
    assert problem is not None
    n = len(derivation.model.states)
    conditions = derivation.step("boundary_conditions").equations
    return [
        _scalar("running_cost", "Integrand L of the cost.", "t x u p", problem.running_cost),
        _scalar("terminal_cost", "Terminal cost S.", "t x p", problem.terminal_cost),
        _vector(
            "terminal_gradient",
            "S_x, the costates at the final time for states whose final values are free.",
            "t x p",
            sp.Matrix([e.rhs for e in conditions[n : 2 * n]]),
        ),
        _scalar("hamiltonian", "H = L + lam' f.", "t x u lam p", derivation.equation("hamiltonian.H").rhs),
        *(_switching_laws(derivation) if switching.switches(derivation) else _regular_law(derivation)),
        _vector(
            "costate_rate",
            "Rates of change of the costates, -H_x.",
            "t x u lam p",
            derivation.rhs("costate_equations"),
        ),
        *_of_path_constraints(derivation),
        *_of_interior(derivation),
    ]


def _of_interior(derivation: Derivation) -> list[Function]:
    """Return the functions of points on the way, with a row for each condition."""
    if interior.STEP not in derivation or derivation.problem is None:
        return []
    stated = sp.Matrix(list(interior.named(derivation.problem).values()))
    by_state = stated.jacobian(symbols_of(derivation.model.states))
    return [
        _vector(
            "interior", "Expressions that vanish at the waypoints, in the order of the waypoints.", "t x p", stated
        ),
        _matrix(
            "interior_gradient",
            "Derivatives of the expressions at the waypoints with respect to the states, row by row.",
            "t x p",
            by_state,
        ),
        _vector(
            "interior_drift",
            "Derivatives of the expressions at the waypoints with respect to time.",
            "t x p",
            stated.diff(t),
        ),
    ]


def _of_path_constraints(derivation: Derivation) -> list[Function]:
    """Return the functions of path constraints, with a row for each constraint."""
    if not (found := mixed_constraints.every(derivation)):
        return []
    states, controls = symbols_of(derivation.model.states), symbols_of(derivation.model.controls)
    steps = [
        name for name in ("constraint_multiplier", "boundary_control", mixed_constraints.STEP) if name in derivation
    ]
    stated = {e.name: e.rhs for name in steps for e in derivation.step(name).equations}
    rates = [[*one.rates[1:], *(sp.Integer(0),) * 2][:2] for one in found]
    vanishing = [
        [stated.get(path_notation.vanishing_entry(one.name, k), (one.rates[0], 0)[k]) for k in range(2)]
        for one in found
    ]
    multiplier = sp.Matrix([stated.get(f"{one.name}_eta", sp.Integer(0)) for one in found])
    g = sp.Matrix([one.rates[0] for one in found])
    on_boundary = "t x u lam p bounds"
    return [
        _vector("path_constraints", "Path constraints: expressions that must not be positive.", "t x u p bounds", g),
        _matrix(
            "path_gradient",
            "Derivatives of the path constraints with respect to the states, row by row.",
            "t x u p",
            g.jacobian(states),
        ),
        _matrix(
            "path_effect",
            "Derivatives of the path constraints with respect to the controls, row by row.",
            "t x u p",
            g.jacobian(controls),
        ),
        _matrix(
            "path_rates",
            "First and second rates of change of the path constraints; 0 beyond the order of each.",
            "t x u p",
            sp.Matrix(rates),
        ),
        _matrix(
            "path_vanishing",
            "Further expressions that vanish on the boundary, or at its entry and exit, with their rates, row by row.",
            on_boundary,
            sp.Matrix(vanishing),
        ),
        _vector(
            "path_multiplier",
            "The multiplier of each path constraint while the motion is on its boundary.",
            on_boundary,
            multiplier,
        ),
        *([] if path_constraints.stationary(derivation) else [_boundary_control(derivation, found, stated)]),
    ]


def _boundary_control(
    derivation: Derivation, found: list[path_constraints.Constraint], stated: dict[str, sp.Expr]
) -> Function:
    """Return the law on boundaries in closed form; where one control stays on a boundary, others are 0."""
    controls = symbols_of(derivation.model.controls)
    if switching.switches(derivation):
        bounds = (one for one in found if not one.order)
        kept = [
            (one.name, u, -one.rates[0] / sp.diff(one.rates[0], u))
            for one in bounds
            for u in controls
            if one.rates[0].has(u)
        ]
        none = {f"{one.name}_{u.name}": sp.Integer(0) for one in found for u in controls}
        stated = (
            none | {f"{name}_{u.name}": tidy(value.xreplace({u: sp.Integer(0)})) for name, u, value in kept} | stated
        )
    laws = [[stated[f"{one.name}_{u.name}"] for u in controls] for one in found]
    summary = "The controls on the boundary of each path constraint, row by row."
    return _matrix("boundary_control", summary, "t x lam p bounds", sp.Matrix(laws))


def _switching_laws(derivation: Derivation) -> list[Function]:
    return [
        *(
            Function(f.name, f.summary, tuple(f.arguments.split()), f.value, "vector", f.hints)
            for f in switching.vectors(derivation)
        ),
        _matrix(
            "extremal_jacobian",
            "Derivatives of the rates of states and costates with respect to these, at fixed controls, row by row.",
            "t x u lam p",
            switching.extremal_jacobian(derivation),
        ),
        *(
            Function(f.name, f.summary, tuple(f.arguments.split()), f.value, "vector" if f.hints else "scalar", f.hints)
            for f in switching.curve(derivation)
        ),
    ]


def _regular_law(derivation: Derivation) -> list[Function]:
    controls, law = symbols_of(derivation.model.controls), _law(derivation)
    if product.STEP in derivation:
        h = derivation.equation("hamiltonian.H").rhs
        h_u, law = [tidy(g, controls) for g in gradient(h, controls)], set_laws.written_out(derivation, law)
        law = sp.Matrix(set_laws.with_minimum_norms(derivation, law))
        stated = law_parts(derivation).values
        law = sp.Matrix([stated.get(u, value) for u, value in zip(controls, law, strict=True)])
    else:
        h_u = [e.rhs for e in derivation.step("stationarity").equations if e.lhs == 0]
    found = [
        _vector("stationarity", "H_u.", "t x u lam p", sp.Matrix(h_u)),
        _matrix(
            "control_hessian",
            "H_uu, row by row.",
            "t x u lam p",
            sp.Matrix(h_u).jacobian(controls),
        ),
        Function(
            "control_law",
            "The controls that minimise H over the control set.",
            ("t", "x", "lam", "p", "bounds"),
            law,
            "vector",
            names(derivation.model.controls),
        ),
    ]
    if product.STEP in derivation and "smoothed_law" in derivation:
        found.append(_regularised_cost(derivation))
        if slopes := set_laws.throttle_slopes(derivation):
            summary = "Derivative of H with respect to the norm of each vector that may be zero, in its best direction."
            found.append(_vector("throttle_slope", summary, "t x lam p bounds", sp.Matrix(slopes)))
    return found


def _law(derivation: Derivation) -> sp.Matrix:
    """Return the stated law of each control, without named parts; for directions, the regularised law."""
    if product.STEP in derivation:
        problem, every = set_laws.problem_of(derivation), set_laws.found(derivation)
        pairs = [zip(one.part.symbols, set_laws.continuous_law(problem, one), strict=True) for one in every]
        laws = {u: law for pair in pairs for u, law in pair}
        return sp.Matrix([laws[u] for u in symbols_of(derivation.model.controls)])
    return sp.Matrix([derivation.equation(f"control_law.{v.symbol}").rhs for v in derivation.model.controls])


def _regularised_cost(derivation: Derivation) -> Function:
    """Return the running cost of the regularised problem under its law."""
    assert derivation.problem is not None
    (cost,) = set_laws.relaxed(derivation, [sp.sympify(derivation.problem.running_cost)])
    value = (cost + set_laws.effort(derivation)).xreplace(set_laws.regularised_law(derivation))
    return _scalar("regularised_cost", "Integrand of the cost of the regularised problem.", "t x lam p bounds", value)


def _scalar(name: str, summary: str, arguments: str, value: sp.Expr) -> Function:
    return Function(name, summary, tuple(arguments.split()), sp.Matrix([value]), "scalar")


def _vector(name: str, summary: str, arguments: str, value: sp.Matrix) -> Function:
    return Function(name, summary, tuple(arguments.split()), value, "vector")


def _matrix(name: str, summary: str, arguments: str, value: sp.Matrix) -> Function:
    return Function(name, summary, tuple(arguments.split()), value, "matrix")
