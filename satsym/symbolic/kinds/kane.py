"""Steps from rigid bodies to a first-order system: kinematics, Kane's equations, and their solution."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import mpmath as mp
import sympy as sp

from satsym.agreement import slopes
from satsym.symbolic import notation as n
from satsym.symbolic.algebra import depends, shortest, simplified
from satsym.symbolic.chain import named_parts, parts_of
from satsym.symbolic.checks import Point, compare, identity, numeric_along, partial
from satsym.symbolic.derivation import Check, Conclusion, Derivation, DerivationError, Equation, Step
from satsym.symbolic.kinds import stated_as
from satsym.symbolic.kinds.bodies import CLOCK, Bodies, axes_of, moving
from satsym.symbolic.model import symbols_of
from satsym.symbolic.motion import steps as motion

if TYPE_CHECKING:
    from sympy.physics.mechanics import RigidBody

MOST_OPERATIONS_UNNAMED = 300
"""Number of operations of the equations above which their common subexpressions receive names."""


def kinematics(so_far: Derivation) -> Step:
    """State the named functions of the coordinates, and derive the rates of change of the coordinates."""
    model = stated_as(Bodies, so_far)
    named = [Equation(s.name, s, sp.sympify(value)) for s, value in model.named.items()]
    rates = [Equation(f"rate_{q.name}", n.rate_of(q), sp.sympify(r)) for q, r in model.coordinates.items()]
    checks: list[Check] = [_turning(model)]
    if model.attitude is not None:
        of = model.attitude.xreplace({e.lhs: e.rhs for e in named})
        checks.insert(0, identity("orthonormal", of * of.T - sp.eye(3)))
    return Step("kinematics", "kinematics", (*named, *rates), ("bodies",), tuple(checks))


def _turning(model: Bodies) -> Check:
    """Check angular velocities of all frames by differentiating their rotation matrices numerically along a path."""
    frames = list(dict.fromkeys(axes_of(body) for body in model.bodies))
    turned = [model.static(e) for frame in frames for e in model.inertial.dcm(frame)]
    rates = [e for frame in frames for e in model.along(frame.ang_vel_in(model.inertial), model.inertial)]
    matrices, spins = _values(model, turned), _values(model, rates)

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        later, path = matrices(point), _path(model, point)
        change = slopes(lambda s: matrices(path(s)))
        expected, found = [], []
        for f in range(len(frames)):
            w = spins(point)[3 * f : 3 * f + 3]
            r = mp.matrix(3, 3)
            for k, value in enumerate(later[9 * f : 9 * f + 9]):
                r[k // 3, k % 3] = value
            cross = mp.matrix([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
            found += list(cross * r)
            expected += change[9 * f : 9 * f + 9]
        return found, expected

    return compare("frames turn so", _symbols(model), sides)


def partial_of(number: int) -> sp.Symbol:
    """Return the matrix of the partial angular velocities of the body with this number."""
    return sp.Symbol(f"partial_rates_{number}")


def label_of(body: RigidBody) -> str:
    """Return the name of a body as LaTeX."""
    return r"\mathrm{" + body.name.replace(" ", r"\ ") + "}"


def partial_velocities(so_far: Derivation) -> Step | None:
    """Derive the derivatives of the bodies' angular velocities by the speeds, if there are several bodies."""
    model = stated_as(Bodies, so_far)
    if len(model.bodies) < 2:
        return None
    spins = [model.spin(body) for body in model.bodies]
    matrices = [sp.ImmutableMatrix([[sp.diff(w, u) for u in model.speeds] for w in spin]) for spin in spins]
    rates = _values(model, [w for spin in spins for w in spin])
    entries = _values(model, [e for matrix in matrices for e in matrix])
    count = len(model.speeds)

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        slopes_by = [partial(rates, point, u) for u in model.speeds]
        return entries(point), [slopes_by[k][i] for i in range(3 * len(spins)) for k in range(count)]

    equations = tuple(Equation(f"body_{k}", partial_of(k), matrix) for k, matrix in enumerate(matrices, 1))
    check = compare("numeric derivative", _symbols(model), sides)
    return Step("partial_velocities", "derivatives by speeds", equations, ("bodies",), (check,))


def _summed(model: Bodies, so_far: Derivation, parts: list[tuple[sp.Symbol, sp.Expr]], mass: sp.Matrix) -> Check:
    """Check that the bodies' inertias, each between the partial velocities of its body, add up to the mass matrix."""
    total = sp.zeros(*mass.shape)
    for body, equation in zip(model.bodies, so_far.step("partial_velocities").equations, strict=True):
        inertia = body.central_inertia.to_matrix(axes_of(body)).applyfunc(model.static)
        total += equation.rhs.T * inertia * equation.rhs
    size = len(mass)
    both = numeric_along((*model.named.items(), *parts), [*mass, *total])[0]
    return compare("inertias add up", _symbols(model), lambda point: (both(point)[:size], both(point)[size:]))


def kane(so_far: Derivation) -> Step:
    """Derive Kane's equations M u' + b = Q, with names for common parts where they are long."""
    from sympy.physics.mechanics import KanesMethod

    model = stated_as(Bodies, so_far)
    symbols = (*symbols_of(model.states), *model.named)
    functions = dict(zip(symbols, moving(symbols), strict=True))
    kinematic = [functions[q].diff(CLOCK) - sp.sympify(r).xreplace(functions) for q, r in model.coordinates.items()]
    method = KanesMethod(
        model.inertial,
        q_ind=[functions[q] for q in model.coordinates],
        u_ind=[functions[u] for u in model.speeds],
        kd_eqs=kinematic,
    )
    active, inertial = method.kanes_equations(list(model.bodies), list(model.loads))
    still = dict.fromkeys((functions[u].diff(CLOCK) for u in model.speeds), sp.Integer(0))
    size = len(model.speeds)
    values: dict[str, sp.Expr] = {
        f"mass_{i + 1}_{k + 1}": _short(model.static(method.mass_matrix[i, k]))
        for i in range(size)
        for k in range(i + 1)
    }
    values |= {f"bias_{i + 1}": _short(model.static((-e).xreplace(still))) for i, e in enumerate(inertial)}
    values |= {f"force_{i + 1}": _short(model.static(e)) for i, e in enumerate(active)}
    parts: list[tuple[sp.Symbol, sp.Expr]] = []
    written = list(values.values())
    if sum(map(sp.count_ops, written)) > MOST_OPERATIONS_UNNAMED:
        names = map(_part, range(1, 10**4))
        found, reduced = sp.cse(written, symbols=names, order="canonical")
        parts, written = named_parts(found, reduced, _part)
    equations = [Equation(s.name, s, value) for s, value in parts]
    equations += [
        Equation(name, sp.Symbol(name, real=True), value)
        for name, value in zip(values, written, strict=True)
        if value != 0 or not name.startswith("mass")
    ]
    known = dict(zip(values, written, strict=True))
    checks = [_newton_euler(model, parts, known)]
    by_bodies = "partial_velocities" in so_far and all(b.masscenter.vel(model.inertial) == 0 for b in model.bodies)
    if by_bodies:
        mass = sp.Matrix(size, size, lambda i, k: known[f"mass_{max(i, k) + 1}_{min(i, k) + 1}"])
        checks.append(_summed(model, so_far, parts, mass))
    rule = f"Kane's equations{', by bodies' if by_bodies else ''}{', in parts' if parts else ''}"
    sources = ("kinematics", "partial_velocities", "bodies") if by_bodies else ("kinematics", "bodies")
    return Step("kane", rule, tuple(equations), sources, tuple(checks))


def _part(k: int) -> sp.Symbol:
    return sp.Symbol(f"part_{k}", real=True)


def first_order(so_far: Derivation) -> Step:
    """Solve Kane's equations for the rates of the speeds: in closed form where that is short."""
    model = stated_as(Bodies, so_far)
    known = {e.name: e.rhs for e in so_far.step("kane").equations}
    size = len(model.speeds)
    entries = [[known.get(f"mass_{max(i, k)}_{min(i, k)}", 0) for k in range(1, size + 1)] for i in range(1, size + 1)]
    mass, load = sp.Matrix(entries), sp.Matrix([known[f"force_{i}"] - known[f"bias_{i}"] for i in range(1, size + 1)])
    short = not any(name.startswith("part_") for name in known)
    solution = list(mass.LUsolve(load)) if short else [n.solved(u) for u in model.speeds]
    if short and any(e.has(sp.zoo, sp.nan) for e in solution):
        raise DerivationError(f"{model.name}: the bodies do not determine {', '.join(u.name for u in model.speeds)}")
    rates = dict(zip(model.speeds, solution, strict=True)) | dict(model.coordinates)
    named = {s: sp.sympify(v) for s, v in model.named.items()} if short else {}
    states = symbols_of(model.states)
    written = {s: sp.sympify(rates[s]).xreplace(named) for s in states}
    turning = {q: written[q] for q in model.coordinates if named}
    written |= {q: shortest(rate, simplified(rate)) for q, rate in turning.items()}
    equations = tuple(Equation(s.name, n.rate_of(s), written[s]) for s in states)
    rule = f"solve for the rates of the speeds{'' if short else ', in parts'}"
    step = Step("first_order", rule, equations, ("kinematics", "kane"), ())
    with_rates = Derivation(so_far.model, so_far.problem, so_far.notation, (*so_far.steps, step))
    found = [e.rhs for e in equations if e.name not in {q.name for q in model.coordinates}]
    chain = parts_of(with_rates) or tuple(model.named.items())
    whole = [*found, *mass, *load, *(written[q] for q in turning), *turning.values()]
    parts = [(s, e) for s, e in _parts(so_far) if s not in dict(chain)]
    evaluate, symbols = numeric_along((*chain, *parts), whole)

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        values = evaluate(point)
        a, m, ends = values[:size], mp.matrix(size, size), len(values) - len(turning)
        shorter, turned = values[ends - len(turning) : ends], values[ends:]
        values = values[: ends - len(turning)]
        for k, value in enumerate(values[size : size + size * size]):
            m[k // size, k % size] = value
        return a + shorter, [*mp.lu_solve(m, mp.matrix(values[size + size * size :])), *turned]

    check = compare("solved by elimination in numbers", symbols, sides)
    return Step(step.name, step.rule, step.equations, step.follows_from, (check,))


def reference(so_far: Derivation) -> Step | None:
    """Prove that the reference curve satisfies Kane's equations, also where these are not solved."""
    model = stated_as(Bodies, so_far)
    if not model.reference or not parts_of(so_far):
        return motion.reference(so_far)
    curve = {s: sp.sympify(e) for s, e in model.reference.items()}
    known = curve | dict.fromkeys(symbols_of(model.controls), sp.Integer(0))
    for symbol, value in (*model.named.items(), *_parts(so_far)):
        known[symbol] = sp.sympify(value).xreplace(known)
    values = {e.name: e.rhs.xreplace(known) for e in so_far.step("kane").equations}
    count = range(1, len(model.speeds) + 1)
    defects = [values[f"force_{i}"] - values[f"bias_{i}"] for i in count]
    defects += [sp.diff(curve[u], n.TIME) for u in model.speeds]
    defects += [sp.diff(curve[q], n.TIME) - sp.sympify(r).xreplace(known) for q, r in model.coordinates.items()]
    proof = identity("satisfies the equations", defects)
    if not proof.passed:
        raise DerivationError(f"{model.name}: the reference does not satisfy the equations of motion")
    equations = tuple(Equation(s.name, s, curve[s]) for s in symbols_of(model.states))
    return Step("reference", "given and proved", equations, ("kane", "first_order"), (proof,))


def invariant_motions(so_far: Derivation) -> Step | None:
    """Prove that the declared states stay zero: no load acts on them, and no inertia couples them."""
    model = stated_as(Bodies, so_far)
    if not model.vanishing:
        return None
    zero = dict.fromkeys(model.vanishing, sp.Integer(0))
    known = dict(zero)
    for symbol, value in (*model.named.items(), *_parts(so_far)):
        known[symbol] = sp.sympify(value).xreplace(known)
    equations = {e.name: sp.expand(e.rhs.xreplace(known)) for e in so_far.step("kane").equations}
    number = {u: i for i, u in enumerate(model.speeds, 1)}
    still, moving = ([i for u, i in number.items() if (u in zero) == kept] for kept in (True, False))
    left = [equations[f"force_{i}"] - equations[f"bias_{i}"] for i in still]
    left += [equations.get(f"mass_{max(i, k)}_{min(i, k)}", sp.Integer(0)) for i in still for k in moving]
    left += [sp.sympify(r).xreplace(known) for q, r in model.coordinates.items() if q in zero]
    pushing = sorted((u for u in symbols_of(model.controls) if any(depends(e, [u]) for e in left)), key=str)
    proof = identity("stay zero", [e.xreplace(dict.fromkeys(pushing, sp.Integer(0))) for e in left])
    rates = tuple(Equation(s.name, n.rate_of(s), sp.Integer(0)) for s in model.vanishing)
    others = sp.Tuple(*(u for u in symbols_of(model.controls) if u not in pushing))
    said = (Conclusion("coupling vanishes", {"controls": others}),) if others else ()
    return Step("invariant_motions", "put in zeros", rates, ("kane", "kinematics"), (proof,), said)


def linearisation(so_far: Derivation) -> Step | None:
    """Derive the Jacobians where the rates have a closed form; those of a chain have too many entries to print."""
    return None if parts_of(so_far) else motion.linearisation(so_far)


def _short(expression: sp.Expr) -> sp.Expr:
    return min((expression, sp.expand(expression), sp.factor_terms(expression)), key=sp.count_ops)


def _parts(so_far: Derivation) -> list[tuple[sp.Symbol, sp.Expr]]:
    return [(e.lhs, e.rhs) for e in so_far.step("kane").equations if e.name.startswith("part_")]


def _symbols(model: Bodies) -> set[sp.Symbol]:
    stated = (e for _, expressions, _ in model.stated() for e in expressions)
    return {n.TIME, *symbols_of(model.states)}.union(*(sp.sympify(e).free_symbols for e in stated)) - set(model.named)


def _values(model: Bodies, expressions: list[sp.Expr]) -> Any:
    """Return a function of a point that evaluates expressions in named functions."""
    return numeric_along(model.named.items(), expressions)[0]


def _path(model: Bodies, point: Point) -> Any:
    """Return the states a little later, to first order: coordinates at their rates, speeds at given rates."""
    rates = _values(model, [sp.sympify(r) for r in model.coordinates.values()])(point)
    slopes = dict(zip(model.coordinates, rates, strict=True)) | {u: point.get(n.rate_of(u), 0) for u in model.speeds}
    slopes[n.TIME] = 1
    return lambda s: {**point, **{x: point[x] + slope * s for x, slope in slopes.items()}}


def _newton_euler(model: Bodies, parts: list[tuple[sp.Symbol, sp.Expr]], values: Mapping[str, sp.Expr]) -> Check:
    """Evaluate the laws of Newton and Euler for each body, differentiated numerically in inertial axes."""
    from sympy.physics.mechanics import ReferenceFrame

    inertial, speeds = model.inertial, model.speeds
    motions, changing, pushes = [], [], []
    for body in model.bodies:
        turn, move = body.frame.ang_vel_in(inertial), body.masscenter.vel(inertial)
        changing += model.along(body.central_inertia.dot(turn), inertial) + model.along(body.mass * move, inertial)
        motions += model.along(turn, inertial) + model.along(move, inertial)
    for place, load in model.loads:
        turns = isinstance(place, ReferenceFrame)
        along = model.along(place.ang_vel_in(inertial) if turns else place.vel(inertial), inertial)
        pushes += [(v, f) for v, f in zip(along, model.along(load, inertial), strict=True)]
    reach = [[sp.diff(v, u) for v in motions] for u in speeds]
    loads = [sp.Add(*(sp.diff(v, u) * f for v, f in pushes)) for u in speeds]
    momenta = _values(model, changing)
    weights = _values(model, [e for row in reach for e in row])
    work = _values(model, loads)
    sizes = range(1, len(speeds) + 1)
    rates = [n.rate_of(u) for u in speeds]
    left = [
        sp.Add(*(values[f"mass_{max(i, k)}_{min(i, k)}"] * a for k, a in zip(sizes, rates, strict=True)))
        + values[f"bias_{i}"]
        - values[f"force_{i}"]
        for i in sizes
    ]
    kept = numeric_along((*model.named.items(), *parts), left)[0]

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        path, count = _path(model, point), len(changing)
        change = slopes(lambda s: momenta(path(s)))
        by = weights(point)
        found = [sum(by[r * count + k] * change[k] for k in range(count)) for r in range(len(speeds))]
        return kept(point), [a - b for a, b in zip(found, work(point), strict=True)]

    return compare("Newton and Euler in inertial axes", _symbols(model) | set(rates), sides)
