"""Central forces, recognised in a derived motion: Kepler's law, the gradient of gravity, and points of orbits.

No declaration names gravity. The sum of the forces without control is compared with the position, and the law that is
found must hold identically.

For models without a cost, the path is a conic, by the eccentricity vector, which the motion conserves, and the Jacobian
at a single point of an orbit is analysed exactly. The eigenvalues there are often mistaken for a verdict on the orbit.
They follow in closed form, with the quantities that they depend on; but no point of an orbit is an equilibrium, as such
a verdict would need.
"""

from __future__ import annotations

import random
from dataclasses import dataclass
from typing import Any

import mpmath as mp
import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.algebra import definitions_of, simplify, total_derivative
from satsym.symbolic.analysis.field import sign_of
from satsym.symbolic.analysis.spectrum import Spectrum, spectrum
from satsym.symbolic.checks import Check, Point, agree, compare, identity, numeric, partial, random_point
from satsym.symbolic.derivation import Conclusion, Derivation, Equation, Step
from satsym.symbolic.linear import notation as ln
from satsym.symbolic.linear.matrices import numeric_matrix, numeric_rank
from satsym.symbolic.model import Particle, symbols_of, variables_of


@dataclass(frozen=True)
class CentralForce:
    """An uncontrolled acceleration -k r / |r|^3 towards a fixed centre."""

    strength: sp.Expr
    """The strength k: a positive function of parameters and named constants."""
    distance: sp.Expr
    """The distance |r|, as a function of the coordinates."""


def uncontrolled_force(model: Particle) -> sp.Matrix:
    """Return the inertial components of the sum of the forces per unit mass with all controls zero."""
    coast = dict.fromkeys(symbols_of(model.controls), sp.Integer(0))
    return sum(model.forces.values(), sp.zeros(len(model.position), 1)).xreplace(coast)


def inertial_velocity(model: Particle) -> sp.Matrix:
    """Return the inertial components of the rate of change of the position vector."""
    return model.position.applyfunc(lambda c: total_derivative(c, model.coordinates))


def central_force(so_far: Derivation) -> Step | None:
    """Show that the motion without control is Kepler's: acceleration -k r / |r|^3 with a constant k."""
    model = so_far.model.particle()
    if model is None or (found := recognised(model)) is None:
        return None
    law = -found.strength * n.POSITION / n.DISTANCE**3
    force, place, size = uncontrolled_force(model), model.position, numeric([found.distance])
    law_by_components = [law.xreplace({n.POSITION: c, n.DISTANCE: found.distance}) for c in place]
    proof = identity("points to the centre", [f - c for f, c in zip(force, law_by_components, strict=True)])
    derived = inertial_accelerations(so_far)
    accelerations, strength, components = map(numeric, (derived, [found.strength], list(place)))

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        """Differentiate the position twice along the equations of motion, beside the law."""
        (k,), (distance,) = strength(point), size(point)
        return accelerations(point), [-k * c / distance**3 for c in components(point)]

    symbols = set(symbols_of(model.states)) | {n.TIME} | found.strength.free_symbols | force.free_symbols
    symbols |= place.free_symbols.union(*(a.free_symbols for a in derived))
    equations = (
        Equation("distance", n.DISTANCE, found.distance),
        Equation("law", n.ACCELERATION, law),
    )
    checks = (proof, compare("along the equations of motion", symbols, sides))
    return Step("central_attraction", "attraction", equations, ("position", "forces", "first_order"), checks)


def gravity_gradient(so_far: Derivation) -> Step | None:
    """Derive the Jacobian along inertial axes: A = (0, I; G, 0), with G = k (3 r r' / |r|^5 - I / |r|^3).

    G is read off the derived entries: one number each that multiplies r r' and I, as functions of the distance alone.
    """
    model, strength = so_far.model.particle(), strength_of(so_far)
    if model is None or strength is None:
        return None
    place = model.position
    if not place.jacobian(list(model.coordinates)).is_Identity:
        return None
    still, carried, gradient, damping = jacobian_blocks(so_far)
    if len(place) < 2 or not (still.is_zero_matrix and carried.is_Identity and damping.is_zero_matrix):
        return None
    distance = so_far.equation("central_attraction.distance").rhs
    outer = simplify(gradient[0, 1] / (place[0] * place[1]))
    rest = simplify(gradient[0, 0] - outer * place[0] ** 2)
    by_distance = [e.xreplace({distance**2: n.DISTANCE**2}) for e in (outer, rest)]
    if any(e.has(*place) for e in by_distance):
        return None
    whole = sp.expand((by_distance[0] * n.OUTER + by_distance[1] * n.IDENTITY) / strength)
    entries = by_distance[0] * place * place.T + by_distance[1] * sp.eye(len(place))
    back = entries.xreplace({n.DISTANCE: distance})
    force = numeric(list(uncontrolled_force(model)))
    slopes = numeric(list(back))

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        columns = [partial(force, point, q) for q in model.coordinates]
        return slopes(point), [column[row] for row in range(len(place)) for column in columns]

    checks = (
        identity("entry by entry", gradient - back),
        compare("numeric gradient of the force", set(model.coordinates) | back.free_symbols, sides),
    )
    equations = (
        Equation("A", n.JACOBIAN, sp.ImmutableMatrix([[0, n.IDENTITY], [n.GRADIENT, 0]])),
        Equation("G", n.GRADIENT, strength * whole),
    )
    return Step("gravity_gradient", "blocks", equations, ("linearisation", "central_attraction"), checks)


def jacobian_blocks(so_far: Derivation) -> list[sp.Matrix]:
    """Return the uncontrolled Jacobian in blocks: rates of coordinates and of velocities, by either."""
    model = so_far.model.particle()
    assert model is not None
    coast = dict.fromkeys(symbols_of(model.controls), sp.Integer(0))
    entries = {e.name: e.rhs.xreplace(coast) for e in so_far.step("linearisation").equations}
    groups = (list(model.coordinates), list(model.coordinates.values()))
    return [
        sp.Matrix([[entries[f"A_{row.name}_{column.name}"] for column in columns] for row in rows])
        for rows in groups
        for columns in groups
    ]


def strength_of(so_far: Derivation) -> sp.Expr | None:
    """Return k of the derived law; ``None`` where the uncontrolled motion is not Kepler's."""
    if "central_attraction" not in so_far:
        return None
    law = so_far.equation("central_attraction.law").rhs
    return -law.coeff(n.POSITION) * n.DISTANCE**3


def inertial_state(model: Particle, strength: sp.Expr) -> sp.Matrix:
    """Return position, velocity and k as a column of seven, with zeros for components outside a plane or a line."""
    missing = sp.zeros(len(n.AXES) - len(model.position), 1)
    return sp.Matrix.vstack(model.position, missing, inertial_velocity(model), missing, sp.Matrix([strength]))


def recognised(model: Particle) -> CentralForce | None:
    """Return the central force of a model, if it appears to have one; the step then proves it."""
    place, force = model.position, uncontrolled_force(model)
    moving = {n.TIME, *symbols_of(model.states)}
    if not _looks_central(place, force, moving):
        return None
    distance = sp.sqrt(simplify(place.dot(place)))
    strength = simplify(-force.dot(place) * distance)
    if strength.free_symbols & moving or not strength.xreplace(definitions_of(model)).is_positive:
        return None
    across = [simplify(f * distance**3 + strength * c) for f, c in zip(force, place, strict=True)]
    return None if any(across) else CentralForce(strength, distance)


def _looks_central(place: sp.Matrix, force: sp.Matrix, moving: set[sp.Symbol]) -> bool:
    """Tell, by numbers, whether F = -k r / |r|^3 with one k for all states and times.

    For other forces sympy would take up to minutes to simplify the difference.
    """
    values, size = numeric([*place, *force]), len(place)

    def factor(point: Point) -> tuple[Any, list[Any], list[Any]]:
        """Return k, the position and the force at a point."""
        found = values(point)
        r, f = found[:size], found[size:]
        product = sum(a * b for a, b in zip(r, f, strict=True))
        return -product * mp.sqrt(sum(c**2 for c in r)), r, f

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        elsewhere = {**point, **random_point(moving, random.Random("elsewhere"))}
        (k, r, f), (other, *_) = factor(point), factor(elsewhere)
        cubed = mp.sqrt(sum(c**2 for c in r)) ** 3
        return [k, *(c * cubed for c in f)], [other, *(-k * c for c in r)]

    return agree("one strength", moving | place.free_symbols | force.free_symbols, sides)


def inertial_accelerations(so_far: Derivation) -> list[sp.Expr]:
    """Return the second derivative of the position along the uncontrolled first-order equations."""
    model = so_far.model.particle()
    assert model is not None
    coast = dict.fromkeys(symbols_of(model.controls), sp.Integer(0))
    rates = dict(zip(symbols_of(model.states), so_far.rhs("first_order").xreplace(coast), strict=True))
    return [total_derivative(total_derivative(c, rates), rates) for c in model.position]


def conic(so_far: Derivation) -> Step | None:
    """Derive the eccentricity vector, its length by energy and angular momentum, and the conic of the orbit."""
    model, k = so_far.model.particle(), strength_of(so_far)
    if k is None or so_far.problem is not None or model is None or "conserved" not in so_far:
        return None
    kept = {e.name: e.rhs for e in so_far.step("conserved").equations}
    if "energy" not in kept:
        return None
    place, velocity = model.position, inertial_velocity(model)
    distance = so_far.equation("central_attraction.distance").rhs
    values = {n.DISTANCE: distance, n.SPEED: sp.sqrt(velocity.dot(velocity)), n.ALONG: place.dot(velocity)}
    on_place, on_velocity = n.SPEED**2 / k - 1 / n.DISTANCE, -n.ALONG / k
    vector = (on_place * place + on_velocity * velocity).xreplace(values)
    coast = dict.fromkeys(symbols_of(model.controls), sp.Integer(0))
    rates = dict(zip(symbols_of(model.states), so_far.rhs("first_order").xreplace(coast), strict=True))
    slopes = numeric([total_derivative(c, rates) for c in vector])
    size = 1 + 2 * n.ENERGY * n.MOMENTUM**2 / k**2
    parameter = n.MOMENTUM**2 / k
    energy, expected = numeric([kept["energy"]]), numeric([size, parameter])
    vectors = [numeric(list(v)) for v in (place, velocity, vector)]

    def predicted(point: Point) -> tuple[list[Any], list[Any]]:
        """Return the length of the vector and its part along the position, by energy and angular momentum."""
        r, v, e = (function(point) for function in vectors)
        momentum = mp.sqrt(mp.fdot(r, r) * mp.fdot(v, v) - mp.fdot(r, v) ** 2)
        known = {n.ENERGY: energy(point)[0], n.MOMENTUM: momentum, **{s: point[s] for s in k.free_symbols}}
        return [mp.fdot(e, e), mp.norm(r) + mp.fdot(e, r)], expected(known)

    symbols = {n.TIME, *symbols_of(model.states)}.union(*(r.free_symbols for r in (*rates.values(), *vector)))
    equations = (
        Equation("eccentricity_vector", n.ECCENTRICITY_VECTOR, on_place * n.POSITION + on_velocity * n.VELOCITY),
        Equation("eccentricity", n.ECCENTRICITY**2, size),
        Equation("path", n.DISTANCE + n.ECCENTRICITY_ALONG, parameter),
    )
    return Step(
        "conic",
        "eccentricity vector",
        equations,
        ("central_attraction", "first_order", "conserved"),
        (
            compare("constant along the motion", symbols, lambda point: (slopes(point), [0] * len(vector))),
            compare("by energy and angular momentum", symbols, predicted),
        ),
        (Conclusion("bounded by energy", {"energy": n.ENERGY, "eccentricity": n.ECCENTRICITY}),),
    )


def no_equilibrium(so_far: Derivation) -> Step | None:
    """Show that the uncontrolled acceleration vanishes at no distance, so that no point is an equilibrium."""
    strength = strength_of(so_far)
    if strength is None or so_far.problem is not None:
        return None
    distance, accelerations = so_far.equation("central_attraction.distance").rhs, inertial_accelerations(so_far)
    law = so_far.equation("central_attraction.law").rhs
    pull = -law.coeff(n.POSITION) * n.DISTANCE
    if sign_of(pull) != 1:
        return None
    size, components = numeric([pull.xreplace({n.DISTANCE: distance})]), numeric(accelerations)
    symbols = set(symbols_of(so_far.model.states)) | {n.TIME} | set().union(*(a.free_symbols for a in accelerations))
    checks = (
        compare(
            "length of the acceleration",
            symbols | strength.free_symbols,
            lambda point: (size(point), [mp.norm(components(point))]),
        ),
        identity("vanishes at infinity only", [sp.limit(pull, n.DISTANCE, sp.oo)]),
    )
    return Step(
        "no_equilibrium",
        "pull of the centre",
        (Equation("acceleration", n.PULL, pull),),
        ("central_attraction",),
        checks,
        (Conclusion("no equilibrium", {"pull": n.PULL, "distance": n.DISTANCE}),),
    )


def point_spectrum(so_far: Derivation) -> Step | None:
    """Derive the eigenvalues of the Jacobian at any point, what they depend on, and what their signs can tell."""
    model = so_far.model.particle()
    if "gravity_gradient" not in so_far or so_far.problem is not None or model is None:
        return None
    if {v.symbol for v in variables_of(model)} & set(ln.results(model)):
        return None
    a = _whole(so_far)
    of = spectrum(_on_a_sphere(a, model))
    found = of.eigenvalues
    if not of.closed_form or of.polynomial.free_symbols - _constants(so_far) - {ln.LAMBDA, n.DISTANCE}:
        return None
    rows = {
        "distinct": (ln.DISTINCT, [e.value for e in found]),
        "algebraic": (ln.ALGEBRAIC, [e.algebraic for e in found]),
        "geometric": (ln.GEOMETRIC, [e.geometric for e in found]),
    }
    equations = [Equation("characteristic_polynomial", ln.CHARACTERISTIC, of.polynomial)]
    equations += [Equation(name, lhs, sp.ImmutableMatrix([row])) for name, (lhs, row) in rows.items()]
    velocities = list(model.coordinates.values())
    checks = (
        *_checks(so_far, a, of),
        identity("free of the velocity", [sp.diff(entry, v) for entry in a for v in velocities]),
    )
    return Step(
        "point_spectrum",
        "roots of the determinant at a point",
        tuple(equations),
        ("linearisation", "gravity_gradient"),
        checks,
        tuple(_conclusions(of)),
    )


def _whole(so_far: Derivation) -> sp.Matrix:
    """Return the uncontrolled Jacobian, with coordinates first and velocities second."""
    blocks = jacobian_blocks(so_far)
    return sp.Matrix(sp.BlockMatrix([blocks[:2], blocks[2:]]))


def _constants(so_far: Derivation) -> set[sp.Symbol]:
    """Return the symbols of parameters and named constants."""
    model = so_far.model
    return set(symbols_of((*model.parameters, *(d.variable for d in model.definitions))))


def _on_a_sphere(a: sp.Matrix, model: Particle) -> sp.Matrix:
    """Return a matrix at all points of equal distance, as rational functions of stereographic coordinates."""
    place = list(model.position)
    chart = [sp.Dummy(f"s{k}", real=True) for k in range(len(place) - 1)]
    square = sum(s**2 for s in chart)
    direction = [*(2 * s / (1 + square) for s in chart), (1 - square) / (1 + square)]
    distant = a.xreplace({sum(c**2 for c in place): n.DISTANCE**2})
    return distant.xreplace({c: n.DISTANCE * e for c, e in zip(place, direction, strict=True)})


def _checks(so_far: Derivation, a: sp.Matrix, of: Spectrum) -> list[Check]:
    """Check polynomial and eigenvalues against determinants, and eigenvectors against singular values."""
    distance = {n.DISTANCE: so_far.equation("central_attraction.distance").rhs}
    product = sp.Mul(*((ln.LAMBDA - e.value) ** e.algebraic for e in of.eigenvalues))
    forms = numeric([of.polynomial.xreplace(distance), product.xreplace(distance)])
    roots = numeric([e.value.xreplace(distance) for e in of.eigenvalues])
    matrix, size, symbols = numeric_matrix(a), a.rows, a.free_symbols | of.polynomial.free_symbols - {n.DISTANCE}

    def determinants(point: Point) -> tuple[list[Any], list[Any]]:
        value = mp.det(mp.eye(size) * point[ln.LAMBDA] - matrix(point))
        return forms(point), [value, value]

    def ranks(point: Point) -> tuple[list[Any], list[Any]]:
        at = matrix(point)
        independent = [size - numeric_rank(mp.eye(size) * root - at) for root in roots(point)]
        return [e.geometric for e in of.eigenvalues], independent

    return [
        compare("determinant", symbols | {ln.LAMBDA}, determinants),
        compare("numeric rank", symbols, ranks),
    ]


def _conclusions(of: Spectrum) -> list[Conclusion]:
    """Return what the eigenvalues depend on, and that the signs of their real parts distinguish no orbits."""
    depends = sorted(of.polynomial.free_symbols - {ln.LAMBDA}, key=lambda s: s.name)
    found = [Conclusion("same at a distance", {"quantities": sp.Tuple(*depends)})]
    growing = [root for f in of.factors if f.right for root in f.roots if sp.re(root).is_positive]
    if growing:
        found.append(Conclusion("rule of the signs", {"eigenvalues": sp.Tuple(*growing)}))
    return found
