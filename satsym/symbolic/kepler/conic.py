"""The path of the motion that a centre attracts: a conic, whose eccentricity vector the motion keeps."""

from __future__ import annotations

from typing import Any

import mpmath as mp
import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.algebra import total_derivative
from satsym.symbolic.checks import Point, compare, numeric
from satsym.symbolic.derivation import Conclusion, Derivation, Equation, Step
from satsym.symbolic.kepler.central_force import inertial_velocity, strength_of
from satsym.symbolic.model import symbols_of


def conic(so_far: Derivation) -> Step | None:
    """The eccentricity vector, its length by energy and angular momentum, and the conic that follows."""
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
        """Length of the vector and its part along the position, against energy and angular momentum."""
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
