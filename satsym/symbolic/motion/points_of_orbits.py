"""The Jacobian at a single point of an orbit, analysed exactly, for models without a cost in a central force.

The eigenvalues there are often mistaken for a verdict on the orbit. They follow in closed form, with the quantities
that they depend on; but no point of an orbit is an equilibrium, as such a verdict would need. The path is a conic, by
the eccentricity vector, which the motion conserves.
"""

from __future__ import annotations

from typing import Any

import mpmath as mp
import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.algebra import total_derivative
from satsym.symbolic.analysis.field import sign_of
from satsym.symbolic.analysis.spectrum import Spectrum, spectrum
from satsym.symbolic.checks import Check, Point, compare, identity, numeric
from satsym.symbolic.derivation import Conclusion, Derivation, Equation, Step
from satsym.symbolic.linear import notation as ln
from satsym.symbolic.linear.matrices import numeric_matrix, numeric_rank
from satsym.symbolic.model import Particle, symbols_of, variables_of
from satsym.symbolic.motion.central_force import inertial_accelerations, inertial_velocity, jacobian_blocks, strength_of


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
