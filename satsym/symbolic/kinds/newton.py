"""Equations of motion of a particle from Newton's law, each step by differentiation and projection."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import mpmath as mp
import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.algebra import constants_of, simplified, tidy, total_derivative, vanishes
from satsym.symbolic.checks import Point, compare, identity, numeric
from satsym.symbolic.derivation import Derivation, DerivationError, Equation, Step
from satsym.symbolic.dimension_algebra import PLAIN, Dimension, over, product
from satsym.symbolic.kinds import stated_as
from satsym.symbolic.model import Line, MaybeStep, Paragraph, Particle, Problem, Requirement, symbols_of
from satsym.symbolic.motion import central_force, geometry
from satsym.symbolic.motion import steps as motion
from satsym.wording import unlike


@dataclass(frozen=True, kw_only=True)
class Newton(Particle):
    """Motion of a particle by Newton's law, all forces per unit mass.

    Parameters
    ----------
    directions
        Name -> unit vector (inertial components) along which vectors are resolved; the name is that of a
        symbol such as ``e_r``. They must be orthonormal, which is checked.
    coordinates, position, forces
        See :class:`~satsym.symbolic.model.Particle`.
    """

    directions: Mapping[str, sp.Matrix]

    def steps(self) -> tuple[MaybeStep, ...]:
        """List the steps: the motion, conserved quantities, and steps for central forces."""
        return (
            *self.motion_steps(),
            central_force.central_force,
            motion.reference,
            motion.conserved,
            central_force.conic,
            motion.linearisation,
            central_force.gravity_gradient,
            central_force.no_equilibrium,
            central_force.point_spectrum,
        )

    def motion_steps(self) -> tuple[MaybeStep, ...]:
        """List the steps from Newton's law to the first-order form, by differentiation and projection."""
        return (unit_vectors, position, velocity, acceleration, forces, newton, equations_of_motion, first_order)

    def misfits(self) -> Iterator[str]:
        """Yield a message for each state that is not a coordinate, and for vectors of different sizes."""
        states, moving = symbols_of(self.states), [*self.coordinates, *self.coordinates.values()]
        if len(moving) != len(states) or set(moving) != set(states):
            odd = unlike(symbols_of(self.states), moving, "neither coordinate nor rate", "no state")
            yield f"the states must be the coordinates and their rates, each once; {odd or 'one of them occurs twice'}"
        vectors = {name: vector for name, vector, _ in self.stated()}
        if others := [name for name, vector in vectors.items() if not isinstance(vector, sp.MatrixBase)]:
            yield f"{others[0]} must be a vector, such as Matrix([x, y])"
        elif {len(vector) for vector in vectors.values()} != {len(self.directions)}:
            yield "a vector must have one component for each direction"

    def stated(self) -> Iterator[tuple[str, sp.Matrix, set[sp.Symbol]]]:
        """Return the stated vectors: positions and directions by coordinates, forces by states and controls."""
        placed = constants_of(self) | set(self.coordinates)
        yield "the position", self.position, placed
        for name, direction in self.directions.items():
            yield f"the direction {name}", direction, placed
        for name, force in self.forces.items():
            yield f"the force {name!r}", force, constants_of(self) | set(symbols_of((*self.states, *self.controls)))

    def motion_stated(self) -> list[sp.Expr]:
        """Return the components of position and forces."""
        return [*self.position, *(c for force in self.forces.values() for c in force)]

    def names(self, problem: Problem | None) -> dict[str, str]:
        """Map the names of accelerations, momenta and unit vectors to LaTeX."""
        latex, found = {v.symbol: v.latex for v in self.states}, {}
        for q in self.coordinates:
            found[f"momentum_{q.name}"] = rf"p_{{{latex[q.name]}}}"
            found[n.acceleration_of(q).name] = n.accented("ddot", latex[q.name])
        for name in self.directions:
            along = name.partition("_")[2] or name  # e_theta is along theta
            found[name] = rf"\mathbf{{e}}_{{{latex.get(along, along)}}}"
            found[f"d_{name}"] = rf"\dot{{\mathbf{{e}}}}_{{{latex.get(along, along)}}}"
        return found

    def accelerations(self) -> tuple[str, ...]:
        """Return the names of the coordinates' accelerations."""
        return tuple(n.acceleration_of(q).name for q in self.coordinates)

    def unit_vectors(self) -> tuple[str, ...]:
        """Return the names of the unit vectors."""
        return tuple(self.directions)

    def enter_dimensions(self, known: dict[str, Dimension | None], require: Requirement) -> None:
        """Enter the dimensions of position, velocity and acceleration, whose components must agree."""
        second = known[n.TIME.name]
        for q, q_dot in self.coordinates.items():
            require(f"{q_dot.name}, the rate of {q.name},", q_dot, known[n.rate_of(q).name])
            known[n.acceleration_of(q).name] = over(known[q_dot.name], second)
        for name, direction in self.directions.items():
            for component in direction:
                require(f"the direction {name}", component, PLAIN)
            known[name], known[f"d_{name}"] = PLAIN, over(PLAIN, second)
        place = None
        for component in self.position:
            place = require("the position", component, place)
        velocity = over(place, second)
        acceleration = over(velocity, second)
        known[n.DISTANCE.name], known[n.OUTER.name] = place, product((place, place))
        known[n.SPEED.name], known[n.ECCENTRICITY_ALONG.name] = velocity, place
        known[n.ALONG.name] = known[n.MOMENTUM.name] = product((place, velocity))
        known.update(dict.fromkeys((s.name for s in (n.IDENTITY, n.ECCENTRICITY, n.ECCENTRICITY_VECTOR)), PLAIN))
        vectors = (n.POSITION, n.VELOCITY, n.ACCELERATION, n.FORCE)
        known.update(zip((v.name for v in vectors), (place, velocity, acceleration, acceleration), strict=True))
        for name, force in self.forces.items():
            for component in force:
                require(f"the force {name!r}, per unit mass,", component, acceleration)

    def picture(self) -> geometry.Picture | None:
        """Draw the position, unit vectors and forces."""
        return geometry.motion(self, self.directions)

    def statement(self) -> tuple[Paragraph, ...]:
        """Return the paragraph that gives directions, position and forces along inertial axes."""
        lines = [Line("directions", sp.Symbol(name), vector) for name, vector in self.directions.items()]
        lines.append(Line("position", n.POSITION, self.position))
        lines += [Line("forces", n.FORCE, vector, index=name) for name, vector in self.forces.items()]
        return (Paragraph("newton", lines=tuple(lines)),)

    def declared(self) -> dict[str, sp.Expr | sp.Matrix]:
        """Return the stated vectors by name."""
        return {
            "position": self.position,
            **{f"directions.{name}": vector for name, vector in self.directions.items()},
            **{f"forces.{name.replace(' ', '_')}": vector for name, vector in self.forces.items()},
        }


def unit_vectors(so_far: Derivation) -> Step:
    """Derive the rates of change of the unit vectors, resolved along these vectors."""
    model = stated_as(Newton, so_far)
    basis = sp.Matrix.hstack(*model.directions.values())
    orthonormal = identity("orthonormal", basis.T * basis - sp.eye(basis.cols))
    if not orthonormal.passed:
        raise DerivationError(f"{model.name}: the directions must be orthonormal")
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
    rule = "fixed directions" if all(e.rhs == 0 for e in rates) else "differentiate directions"
    return Step("unit_vectors", rule, tuple(rates), ("directions",), (orthonormal, moving))


def position(so_far: Derivation) -> Step:
    """Resolve the position vector along the unit vectors."""
    model = stated_as(Newton, so_far)
    resolved = Equation("vector", n.POSITION, _resolved(model, model.position))
    check = compare(
        "same vector",
        _path_symbols(model),
        lambda point: (_vectors(model, [resolved.rhs], point), numeric(list(model.position))(point)),
    )
    return Step("position", "resolve", (resolved,), ("directions", "position"), (check,))


def velocity(so_far: Derivation) -> Step:
    """Derive the first time derivative of the position."""
    model = stated_as(Newton, so_far)
    return _kinematics(model, "velocity", n.VELOCITY, model.coordinates, ("position", "unit_vectors"), order=1)


def acceleration(so_far: Derivation) -> Step:
    """Derive the second time derivative of the position."""
    return _kinematics(
        stated_as(Newton, so_far),
        "acceleration",
        n.ACCELERATION,
        _accelerated(so_far),
        ("velocity", "unit_vectors"),
        order=2,
    )


def forces(so_far: Derivation) -> Step:
    """Resolve the sum of the forces per unit mass along the unit vectors."""
    model = stated_as(Newton, so_far)
    total = sum(model.forces.values(), sp.zeros(len(model.position), 1))
    resolved = Equation("vector", n.FORCE, _resolved(model, *model.forces.values()))
    check = compare(
        "same vector",
        set(_path_symbols(model)) | total.free_symbols,
        lambda point: (_vectors(model, [resolved.rhs], point), numeric(list(total))(point)),
    )
    return Step("forces", "add forces", (resolved,), ("forces", "directions"), (check,))


def newton(so_far: Derivation) -> Step:
    """State Newton's law, acceleration equals force per unit mass, along each unit vector."""
    model = stated_as(Newton, so_far)
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
    """Solve Newton's law for the second derivatives of the coordinates."""
    model = stated_as(Newton, so_far)
    unknown = [n.acceleration_of(q) for q in model.coordinates]
    law = [e.lhs - e.rhs for e in so_far.step("newton").equations]
    mass, load = sp.linear_eq_to_matrix(law, unknown)
    if mass.rows != mass.cols or vanishes(mass.det()):
        raise DerivationError(f"{model.name}: Newton's law does not determine {', '.join(a.name for a in unknown)}")
    controls = symbols_of(model.controls)
    simple = [simplified(s) for s in mass.LUsolve(load)]
    solved = [min(tidy(s), tidy(s, controls), key=sp.count_ops) for s in simple]
    equations = tuple(
        Equation(q.name, symbol, s) for q, symbol, s in zip(model.coordinates, unknown, solved, strict=True)
    )
    total = sum(model.forces.values(), sp.zeros(len(model.position), 1))
    solution = numeric([e.rhs for e in equations])

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        """Evaluate Newton's law in inertial components, with the motion differentiated numerically."""
        moving = {**point, **dict(zip(unknown, solution(point), strict=True))}
        return _derivative_along_path(model, model.position, moving, 2), numeric(list(total))(point)

    check = compare("Newton in inertial axes", set(_path_symbols(model)) | total.free_symbols, sides)
    return Step("equations_of_motion", "solve for accelerations", equations, ("newton",), (check,))


def first_order(so_far: Derivation) -> Step:
    """State the equations of motion as dx/dt = f(t, x, u, p)."""
    model = stated_as(Newton, so_far)
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


def _accelerated(so_far: Derivation) -> dict[sp.Symbol, sp.Symbol]:
    """Map each coordinate and each of its rates to its rate of change."""
    coordinates = stated_as(Newton, so_far).coordinates
    return {**coordinates, **{q_dot: n.acceleration_of(q) for q, q_dot in coordinates.items()}}


def _resolved(model: Newton, *vectors: sp.Matrix) -> sp.Expr:
    """Return the sum of some vectors, by its components along the unit vectors."""
    components = {
        name: sp.Add(*(tidy(simplified(vector.dot(e))) for vector in vectors)) for name, e in model.directions.items()
    }
    return sp.Add(*(component * sp.Symbol(name) for name, component in components.items()))


def _vectors(model: Newton, resolved: Sequence[sp.Expr], point: Point) -> list[Any]:
    """Return the inertial components, at a point, of vectors that are resolved along the unit vectors."""
    directions = {name: numeric(list(e))(point) for name, e in model.directions.items()}
    found = []
    for vector in resolved:
        weights = numeric([vector.coeff(sp.Symbol(name)) for name in model.directions])(point)
        for axis in range(len(model.position)):
            found.append(sum(w * e[axis] for w, e in zip(weights, directions.values(), strict=True)))
    return found


def _path_symbols(model: Newton) -> list[sp.Symbol]:
    """Return time, coordinates, rates and accelerations, with the other symbols that place the position."""
    q = model.coordinates
    others = sp.Matrix.hstack(model.position, *model.directions.values()).free_symbols
    return list({n.TIME, *q, *q.values(), *(n.acceleration_of(c) for c in q)} | others)


def _derivative_along_path(model: Newton, vector: sp.Matrix, point: Point, order: int) -> list[Any]:
    """Differentiate a vector numerically in time, as the coordinates move along a parabola."""
    symbols = list(model.coordinates)
    components = numeric(list(vector))

    def component(axis: int, time: Any) -> Any:
        place = {
            q: point[q] + point[model.coordinates[q]] * time + point[n.acceleration_of(q)] * time**2 / 2
            for q in symbols
        } | {n.TIME: point[n.TIME] + time}
        return components({**point, **place})[axis]

    return [mp.diff(lambda time, axis=axis: component(axis, time), 0, order) for axis in range(len(vector))]
