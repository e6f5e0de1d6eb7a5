"""From Newton's law to equations of motion: every step by differentiation and projection, none typed in."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import mpmath as mp
import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.algebra import tidy, total_derivative
from satsym.symbolic.checks import Point, compare, identity, numeric
from satsym.symbolic.derivation import Derivation, DerivationError, Equation, Step
from satsym.symbolic.model import Newton, symbols_of


def unit_vectors(so_far: Derivation) -> Step:
    """How the directions turn: their rates of change, resolved along themselves."""
    model = _newton(so_far)
    basis = sp.Matrix.hstack(*model.directions.values())
    orthonormal = identity("orthonormal", basis.T * basis - sp.eye(basis.cols))
    if not orthonormal.passed:
        raise DerivationError(f"{model.name}: the directions must have length one and be at right angles")
    rates = [
        Equation(name, sp.Symbol(f"d_{name}"), _resolved(model, total_derivative(vector, model.coordinates)))
        for name, vector in model.directions.items()
    ]
    moving = compare(
        "along a path",
        _path_symbols(model),
        lambda point: (
            _vectors(model, [e.rhs for e in rates], point),
            [c for vector in model.directions.values() for c in _derivative_along_path(model, vector, point, 1)],
        ),
    )
    return Step("unit_vectors", "differentiate directions", tuple(rates), ("directions",), (orthonormal, moving))


def position(so_far: Derivation) -> Step:
    """The position vector, resolved along the directions."""
    model = _newton(so_far)
    resolved = Equation("vector", n.POSITION, _resolved(model, model.position))
    check = compare(
        "same vector",
        _path_symbols(model),
        lambda point: (_vectors(model, [resolved.rhs], point), numeric(list(model.position))(point)),
    )
    return Step("position", "resolve", (resolved,), ("directions", "position"), (check,))


def velocity(so_far: Derivation) -> Step:
    """The first time derivative of the position."""
    model = _newton(so_far)
    return _kinematics(model, "velocity", n.VELOCITY, model.coordinates, ("position", "unit_vectors"), order=1)


def acceleration(so_far: Derivation) -> Step:
    """The second time derivative of the position."""
    return _kinematics(
        _newton(so_far), "acceleration", n.ACCELERATION, _accelerated(so_far), ("velocity", "unit_vectors"), order=2
    )


def forces(so_far: Derivation) -> Step:
    """The sum of the forces per unit mass, resolved along the directions."""
    model = _newton(so_far)
    total = sum(model.forces.values(), sp.zeros(len(model.position), 1))
    resolved = Equation("vector", n.FORCE, _resolved(model, *model.forces.values()))
    check = compare(
        "same vector",
        set(_path_symbols(model)) | total.free_symbols,
        lambda point: (_vectors(model, [resolved.rhs], point), numeric(list(total))(point)),
    )
    return Step("forces", "add forces", (resolved,), ("forces", "directions"), (check,))


def newton(so_far: Derivation) -> Step:
    """Acceleration equals force per unit mass, direction by direction."""
    model = _newton(so_far)
    a, f = (so_far.equation(f"{step}.vector").rhs for step in ("acceleration", "forces"))
    equations = tuple(Equation(name, a.coeff(sp.Symbol(name)), f.coeff(sp.Symbol(name))) for name in model.directions)
    rebuilt = [
        side - sum((getattr(e, which) * sp.Symbol(e.name) for e in equations), sp.Integer(0))
        for side, which in ((a, "lhs"), (f, "rhs"))
    ]
    return Step(
        "newton", "equate components", equations, ("acceleration", "forces"), (identity("components add up", rebuilt),)
    )


def equations_of_motion(so_far: Derivation) -> Step:
    """Newton's law solved for the second derivatives of the coordinates."""
    model = _newton(so_far)
    unknown = [n.acceleration_of(q) for q in model.coordinates]
    law = [e.lhs - e.rhs for e in so_far.step("newton").equations]
    mass, load = sp.linear_eq_to_matrix(law, unknown)
    if mass.rows != mass.cols or sp.simplify(mass.det()) == 0:
        raise DerivationError(f"{model.name}: Newton's law does not determine {', '.join(a.name for a in unknown)}")
    controls = symbols_of(model.controls)
    simple = [sp.simplify(s) for s in mass.LUsolve(load)]
    solved = [min(tidy(s), tidy(s, controls), key=sp.count_ops) for s in simple]
    equations = tuple(
        Equation(q.name, symbol, s) for q, symbol, s in zip(model.coordinates, unknown, solved, strict=True)
    )
    total = sum(model.forces.values(), sp.zeros(len(model.position), 1))
    solution = numeric([e.rhs for e in equations])

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        """Newton's law in inertial components, the motion differentiated numerically."""
        moving = {**point, **dict(zip(unknown, solution(point), strict=True))}
        return _derivative_along_path(model, model.position, moving, 2), numeric(list(total))(point)

    check = compare("Newton in inertial axes", set(_path_symbols(model)) | total.free_symbols, sides)
    return Step("equations_of_motion", "solve for accelerations", equations, ("newton",), (check,))


def first_order(so_far: Derivation) -> Step:
    """The equations of motion as dx/dt = f(t, x, u, p)."""
    model = _newton(so_far)
    rate = dict(model.coordinates)
    for q, q_dot in model.coordinates.items():
        rate[q_dot] = so_far.equation(f"equations_of_motion.{q.name}").rhs
    states = symbols_of(model.states)
    equations = tuple(Equation(s.name, n.rate_of(s), rate[s]) for s in states)
    f = sp.Matrix([e.rhs for e in equations])
    flow = dict(zip(states, f, strict=True))
    second = [total_derivative(total_derivative(q, flow), flow) for q in model.coordinates]
    direct = [so_far.equation(f"equations_of_motion.{q.name}").rhs for q in model.coordinates]
    check = identity("differentiated twice", [a - b for a, b in zip(second, direct, strict=True)])
    return Step("first_order", "order reduction", equations, ("equations_of_motion",), (check,))


def _kinematics(
    model: Newton, name: str, lhs: sp.Symbol, rates: Mapping[sp.Symbol, sp.Expr], source: tuple[str, ...], order: int
) -> Step:
    vector = model.position
    for _ in range(order):
        vector = vector.applyfunc(lambda c: total_derivative(c, rates))
    resolved = Equation("vector", lhs, _resolved(model, vector))
    check = compare(
        "along a path",
        set(_path_symbols(model)) | resolved.rhs.free_symbols - {sp.Symbol(d) for d in model.directions},
        lambda point: (
            _vectors(model, [resolved.rhs], point),
            _derivative_along_path(model, model.position, point, order),
        ),
    )
    return Step(name, "differentiate", (resolved,), source, (check,))


def _newton(so_far: Derivation) -> Newton:
    model = so_far.model
    if not isinstance(model, Newton):
        raise TypeError(f"{model.name} is not stated by Newton's law")
    return model


def _accelerated(so_far: Derivation) -> dict[sp.Symbol, sp.Symbol]:
    """Rates of the coordinates and of their rates."""
    coordinates = _newton(so_far).coordinates
    return {**coordinates, **{q_dot: n.acceleration_of(q) for q, q_dot in coordinates.items()}}


def _resolved(model: Newton, *vectors: sp.Matrix) -> sp.Expr:
    """The sum of some vectors, by its components along the directions."""
    components = {
        name: sp.Add(*(tidy(sp.simplify(vector.dot(e))) for vector in vectors)) for name, e in model.directions.items()
    }
    return sp.Add(*(component * sp.Symbol(name) for name, component in components.items()))


def _vectors(model: Newton, resolved: Sequence[sp.Expr], point: Point) -> list[Any]:
    """Inertial components of resolved vectors, at a point."""
    directions = {name: numeric(list(e))(point) for name, e in model.directions.items()}
    found = []
    for vector in resolved:
        weights = numeric([vector.coeff(sp.Symbol(name)) for name in model.directions])(point)
        for axis in range(len(model.position)):
            found.append(sum(w * e[axis] for w, e in zip(weights, directions.values(), strict=True)))
    return found


def _path_symbols(model: Newton) -> list[sp.Symbol]:
    """Time, coordinates, their rates and accelerations, and what else places the position and the directions."""
    q = model.coordinates
    others = sp.Matrix.hstack(model.position, *model.directions.values()).free_symbols
    return list({n.TIME, *q, *q.values(), *(n.acceleration_of(c) for c in q)} | others)


def _derivative_along_path(model: Newton, vector: sp.Matrix, point: Point, order: int) -> list[Any]:
    """Numeric time derivative of a vector as time passes and the coordinates follow the point's parabola."""
    symbols = list(model.coordinates)
    components = numeric(list(vector))

    def component(axis: int, time: Any) -> Any:
        place = {
            q: point[q] + point[model.coordinates[q]] * time + point[n.acceleration_of(q)] * time**2 / 2
            for q in symbols
        } | {n.TIME: point[n.TIME] + time}
        return components({**point, **place})[axis]

    return [mp.diff(lambda time, axis=axis: component(axis, time), 0, order) for axis in range(len(vector))]
