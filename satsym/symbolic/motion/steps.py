"""Steps for any first-order form: its reference, conserved quantities, linearisation and outputs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import combinations
from typing import Any

import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.algebra import definitions_of, gradient, simplified, simplify, tidy, total_derivative, vanishes
from satsym.symbolic.checks import Point, agree, compare, first_order_at_zero, identity, numeric, partial
from satsym.symbolic.decimals import as_decimals, as_fractions
from satsym.symbolic.derivation import Check, Conclusion, Derivation, DerivationError, Equation, Step
from satsym.symbolic.model import Particle, symbols_of, t
from satsym.symbolic.motion.central_force import inertial_velocity, uncontrolled_force
from satsym.symbolic.unsupported import unknown_functions

_PLANES = {
    2: {n.ANGULAR_MOMENTUM.name: (0, 1)},
    3: {n.component_of_angular_momentum(n.AXES[k]).name: ((k + 1) % 3, (k + 2) % 3) for k in range(3)},
}
"""Number of inertial components -> angular momenta, each with the two components that a rotation about its axis
mixes."""


def reference(so_far: Derivation) -> Step | None:
    """Prove that the reference curve satisfies the equations without control."""
    model = so_far.model
    if not model.reference:
        return None
    states = symbols_of(model.states)
    curve = {s: sp.sympify(model.reference[s]) for s in states}
    coast = dict.fromkeys(symbols_of(model.controls), sp.Integer(0))
    rates = so_far.rhs("first_order").xreplace(coast).xreplace(curve).xreplace(definitions_of(model))
    proof = identity("satisfies the equations", [sp.diff(curve[s], t) - f for s, f in zip(states, rates, strict=True)])
    if not proof.passed:
        raise DerivationError(f"{model.name}: the reference does not satisfy the equations of motion")
    equations = tuple(Equation(s.name, s, curve[s]) for s in states)
    return Step("reference", "given and proved", equations, ("first_order", "definitions"), (proof,))


def conserved(so_far: Derivation) -> Step | None:
    """Derive the energy and momenta that the uncontrolled motion conserves (Noether), if forces have a potential.

    A coordinate that the Lagrangian does not contain has a constant momentum; a Lagrangian that no turn about an
    inertial axis changes has a constant angular momentum about it; one without explicit time has a constant energy,
    or Jacobi integral where the axes move.
    """
    model = so_far.model.particle()
    if model is None:
        return None
    coordinates = model.coordinates
    coast = dict.fromkeys(symbols_of(model.controls), sp.Integer(0))
    height = potential(model, coast)
    if height is None:
        return None
    speed = inertial_velocity(model)
    kinetic = tidy(simplified(speed.dot(speed) / 2))
    lagrangian = kinetic - height
    momenta = {q: sp.diff(lagrangian, q_dot) for q, q_dot in coordinates.items()}
    found = []
    if not lagrangian.has(t) and not model.position.has(t):
        found.append(("energy", kinetic + height))
    elif not lagrangian.has(t):
        # in a moving frame, what the symmetry in time keeps is not the energy
        kept = sum((p * coordinates[q] for q, p in momenta.items()), -lagrangian)
        found.append(("jacobi_integral", tidy(simplified(kept - height)) + height))
    about_axes = _angular_momenta(model, uncontrolled_force(model), speed)
    angles = {v.symbol for v in model.states if v.kind == "angle"}
    cyclic = [q for q in coordinates if not lagrangian.has(q)]
    for q in cyclic:
        if any(vanishes(momenta[q] - component) for component in about_axes.values()):
            continue  # the turn of that coordinate is one about an axis
        rotation = q.name in angles and len([c for c in cyclic if c.name in angles]) == 1
        found.append(("angular_momentum" if rotation else f"momentum_{q.name}", momenta[q]))
    found += about_axes.items()
    if not found:
        return None
    rates = dict(zip(symbols_of(model.states), so_far.rhs("first_order").xreplace(coast), strict=True))
    proof = identity("constant along the motion", [total_derivative(expression, rates) for _, expression in found])
    equations = tuple(Equation(name, sp.Symbol(name, real=True), expression) for name, expression in found)
    return Step("conserved", "symmetry", equations, ("position", "forces", "first_order"), (proof,))


def _angular_momenta(model: Particle, force: sp.Matrix, velocity: sp.Matrix) -> dict[str, sp.Expr]:
    """Return r x v about each inertial axis about which the forces have no torque; in a plane, about its normal."""
    place = model.position
    planes = _PLANES.get(len(place), {})
    return {
        name: tidy(simplified(place[i] * velocity[j] - place[j] * velocity[i]))
        for name, (i, j) in planes.items()
        if vanishes(place[i] * force[j] - place[j] * force[i])
    }


def linearisation(so_far: Derivation) -> Step:
    """Derive the Jacobians A = f_x and B = f_u along any motion."""
    model = so_far.model
    states, controls, rates = symbols_of(model.states), symbols_of(model.controls), list(so_far.rhs("first_order"))
    equations, check = jacobians(rates, states, {"A": states, "B": controls}, tidy, {})
    norms = _vanishing_divisors([e.rhs for e in equations], controls)
    said = (Conclusion("divided by a norm", {"norms": sp.Tuple(*norms)}),) if norms else ()
    return Step("linearisation", "differentiate rates", equations, ("first_order",), (check,), said)


def _vanishing_divisors(entries: Sequence[sp.Expr], controls: Sequence[sp.Symbol]) -> list[sp.Expr]:
    """Return norms of controls by which entries divide: roots that vanish where the controls do."""
    off = dict.fromkeys(controls, sp.Integer(0))
    bases = {
        power.base
        for entry in entries
        for power in entry.atoms(sp.Pow)
        if power.exp.is_negative and not power.exp.is_integer and power.base.free_symbols & off.keys()
    }
    return sorted((sp.sqrt(base) for base in bases if base.xreplace(off) == 0), key=sp.default_sort_key)


def jacobians(
    values: Sequence[sp.Expr],
    rows: Sequence[sp.Symbol],
    columns: Mapping[str, Sequence[sp.Symbol]],
    written: Callable[[sp.Expr], sp.Expr],
    at: Mapping[sp.Symbol, sp.Expr],
) -> tuple[tuple[Equation, ...], Check]:
    """Differentiate values by the columns of each letter, with entries named ``A_row_column``.

    The rows have the names of the values. ``at`` is the special point where the derivatives are taken, if any;
    ``written`` simplifies an entry.
    """
    equations, pairs = [], []
    for letter, symbols in columns.items():
        for k, row in enumerate(rows):
            for column in symbols:
                name = f"{letter}_{row.name}_{column.name}"
                entry = written(sp.diff(values[k], column).xreplace(at))
                equations.append(Equation(name, sp.Symbol(name, real=True), entry))
                pairs.append((k, column))
    functions, entries = numeric(list(values)), numeric([e.rhs for e in equations])

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        there = {**point, **at}
        slopes = {column: partial(functions, there, column) for symbols in columns.values() for column in symbols}
        return entries(there), [slopes[column][k] for k, column in pairs]

    moving = {column for symbols in columns.values() for column in symbols}
    return tuple(equations), compare("numeric derivative", moving.union(*(v.free_symbols for v in values)), sides)


def output_matrix(so_far: Derivation) -> Step | None:
    """Derive C and D, the derivatives of the outputs by states and controls."""
    model = so_far.model
    if not model.outputs:
        return None
    states, controls = symbols_of(model.states), symbols_of(model.controls)
    linear, constants = "deviations" in so_far, definitions_of(model)
    rest = dict.fromkeys((*states, *controls), sp.Integer(0)) if linear else {}
    values = [g.xreplace(constants) if linear else g for g in _outputs(so_far)]
    names = symbols_of(o.variable for o in model.outputs)
    equations, check = jacobians(values, names, {"C": states, "D": controls}, lambda e: tidy(simplified(e)), rest)
    rule = "differentiate outputs at zero" if linear else "differentiate outputs"
    sources = ("outputs", "original_states") if linear else ("outputs",)
    return Step("output_matrix", rule, equations, sources, (check,))


def output_equations(so_far: Derivation) -> Step | None:
    """State the linear outputs y = C x + D u of a linear model."""
    model = so_far.model
    if "deviations" not in so_far or not model.outputs:
        return None
    states, controls = symbols_of(model.states), symbols_of(model.controls)
    names = symbols_of(o.variable for o in model.outputs)
    entries = [e.rhs for e in so_far.step("output_matrix").equations]
    c = sp.Matrix(len(names), len(states), entries[: len(names) * len(states)])
    d = sp.Matrix(len(names), len(controls), entries[len(names) * len(states) :])
    found = c * sp.Matrix(states) + (d * sp.Matrix(controls) if controls else sp.zeros(len(names), 1))
    equations = tuple(Equation(y.name, y, value) for y, value in zip(names, found, strict=True))
    exact = [g.xreplace(definitions_of(model)) for g in _outputs(so_far)]
    check = first_order_at_zero("first order of the exact outputs", exact, list(found), (*states, *controls))
    return Step("output_equations", "drop higher orders of outputs", equations, ("output_matrix",), (check,))


def _outputs(so_far: Derivation) -> list[sp.Expr]:
    """Return the outputs as functions of the model's own states and controls."""
    values = [sp.sympify(o.value) for o in so_far.model.outputs]
    if "original_states" not in so_far:
        return values
    inverse = {e.lhs: e.rhs for e in so_far.step("original_states").equations}
    return [g.xreplace(inverse) for g in values]


def potential(model: Particle, coast: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr | None:
    """Return the potential of generalised forces, proved by differentiation.

    A general integrator may search for minutes, and splits cases that do not matter here. Forces of physics are mostly
    powers of a distance: one substitution, read off the expression itself, integrates them at once.

    Parameters
    ----------
    model
        Where the position and the forces are stated.
    coast
        Control -> its value in the uncontrolled motion.

    Returns
    -------
    Expr or None
        ``None`` if a force depends on velocities or has no potential that was found.
    """
    total = sp.Integer(0)
    for force in model.forces.values():
        along = {q: simplify(force.xreplace(dict(coast)).dot(sp.diff(model.position, q))) for q in model.coordinates}
        if any(component.has(*model.coordinates.values()) for component in along.values()):
            return None
        found = _of(along)
        if found is None:
            return None
        total += found
    return total


def _of(generalised: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr | None:
    """Return the potential of one generalised force."""
    crossed = [(sp.diff(generalised[p], q), sp.diff(generalised[q], p)) for p, q in combinations(generalised, 2)]
    one, other = (numeric([pair[k] for pair in crossed]) for k in range(2))
    moving = set(generalised).union(*(f.free_symbols for f in generalised.values()))
    if crossed and not agree("curl", moving, lambda point: (one(point), other(point))):
        return None
    # an antiderivative that holds for positive coordinates holds for all, which the comparison below confirms
    positive = {q: sp.Dummy(q.name, positive=True) for q in generalised}
    found = sp.Integer(0)
    for q, force in generalised.items():
        rest = simplify(force.xreplace(positive) + sp.diff(found, positive[q]))
        part = _antiderivative(rest, positive[q])
        if part is None:
            return None
        found -= part
    found = found.xreplace({dummy: q for q, dummy in positive.items()})
    forces, slopes = numeric(list(generalised.values())), numeric(gradient(-found, generalised))
    symbols = set(generalised).union(found.free_symbols, *(f.free_symbols for f in generalised.values()))
    check = compare("gradient of the potential", symbols, lambda point: (slopes(point), forces(point)))
    return tidy(found) if check.passed else None


def _antiderivative(function: sp.Expr, by: sp.Symbol) -> sp.Expr | None:
    """Return an antiderivative in closed form, by substitution of a part w of the function: ∫ h(w) w' = ∫ h dw."""
    parts = [part for part in sp.preorder_traversal(function) if part.has(by) and not part.is_Add]
    inner = {argument for part in parts for argument in part.args if argument.is_Add and argument.has(by)}
    for w in (*sorted(inner, key=sp.default_sort_key), by):
        new = sp.Dummy("w", positive=True)
        quotient = simplify(function / sp.diff(w, by)).subs(w, new)
        if not quotient.has(by):
            outer = sp.integrate(as_fractions(quotient), new)  # of decimals sympy cannot tell which coefficients vanish
            # sympy answers by functions such as expint, of which nothing here makes numbers
            if outer.has(sp.Integral) or unknown_functions(outer):
                return None
            return (as_decimals(outer) if quotient.has(sp.Float) else outer).xreplace({new: w})
    if function.is_Add:
        terms = [_antiderivative(term, by) for term in function.args]
        return None if None in terms else sp.Add(*terms)
    return None
