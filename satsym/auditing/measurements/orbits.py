"""Motions in a central gravitational field: their orbits, positions, neighbouring motions and time derivatives.

A motion is given as the name of an instance, or as a record of position, velocity and mu, such as a member of a family.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from satsym import kernels
from satsym.analysis.orbits.elements import elements
from satsym.analysis.orbits.kepler import propagate
from satsym.arrays import Array
from satsym.auditing.measurements import motion
from satsym.auditing.propositions.values import Family, Record, numbers
from satsym.status import BadInput
from satsym.wording import refuse_unknown, shown

_SEED = 47
_PLACES = 400


def motions() -> Family:
    """Return a family of motions about a centre: circle, ellipses, parabola, hyperbolas, and random motions."""
    rng, across = np.random.default_rng(_SEED), (0.0, 1.0, 0.0)
    starts: dict[str, tuple[Sequence[float] | Array, Sequence[float] | Array, float]] = {
        "circle": ((1.0, 0.0, 0.0), across, 1.0),
        "ellipse from its periapsis": ((1.0, 0.0, 0.0), (0.0, 1.2, 0.0), 1.0),
        "ellipse from its apoapsis": ((1.0, 0.0, 0.0), (0.0, 0.8, 0.0), 1.0),
        "inclined ellipse": ((1.0, 0.2, -0.3), (-0.3, 0.7, 0.4), 1.0),
        "retrograde ellipse": ((0.0, 1.5, 0.0), (0.9, 0.1, 0.0), 1.3),
        "parabola": ((1.0, 0.0, 0.0), (0.0, math.sqrt(2.0), 0.0), 1.0),
        "hyperbola": ((1.0, 0.0, 0.0), (0.0, 1.6, 0.0), 1.0),
        "inclined hyperbola": ((0.4, -0.8, 0.5), (1.1, 1.0, -0.6), 0.9),
    }
    for k in range(4):
        starts[f"random motion {k + 1}"] = (rng.normal(size=3), rng.normal(size=3), float(rng.uniform(0.5, 2.0)))
    return Family("MOTIONS", "motions about a centre", tuple(_motion(name, *start) for name, start in starts.items()))


def orbit(of: Any, velocity: ArrayLike | None = None, mu: float | None = None) -> Record:
    """Return the orbit of a motion, or of a position, velocity and mu.

    Its parts are the conic, eccentricity, energy and angular momentum, and as far as they exist the period, semi-major
    axis, periapsis, apoapsis and speed at infinity.
    """
    found = elements(*_start(of, velocity, mu))
    parts = {name: getattr(found, name) for name in ("eccentricity", "energy", "angular_momentum", "periapsis")}
    optional = {name: getattr(found, name) for name in ("period", "semi_major_axis", "apoapsis", "excess_speed")}
    there = {name: size for name, size in optional.items() if size is not None}
    return Record(f"the orbit, {found.conic.value}", {"conic": found.conic.value, **parts, **there})


def coasted(of: Any, t: Any, velocity: ArrayLike | None = None, mu: float | None = None) -> Array:
    """Return position and velocity after a time, or at many times as columns, by the closed-form solution."""
    position, speed, pull = _start(of, velocity, mu)
    if np.ndim(t) == 0:
        return np.concatenate([np.ravel(p) for p in propagate(position, speed, pull, float(t))])
    return np.vstack([np.asarray(p) for p in propagate(position[:, None], speed[:, None], pull, np.asarray(t))])


def turned(of: Any, t: float, velocity: ArrayLike | None = None, mu: float | None = None) -> float:
    """Return the angle by which the position turns within a time."""
    start = _start(of, velocity, mu)
    places = coasted(start[0], np.linspace(0.0, t, _PLACES), start[1], start[2])[:3]
    one, next_ = places[:, :-1], places[:, 1:]
    across = np.linalg.norm(np.cross(one, next_, axis=0), axis=0)
    return float(np.arctan2(across, (one * next_).sum(axis=0)).sum())


def rates_at(of: Any, x: ArrayLike, controls: Sequence[float] = (), **parameters: float) -> Array:
    """Return the time derivatives of a model, by default uncontrolled, or of a member of a family, at a state."""
    if isinstance(of, Record):
        if "formulas" not in of.parts:
            return numbers(of.part("A")) @ np.asarray(x, dtype=float)
        return np.array(of.part("formulas")(*np.asarray(x, dtype=float)))
    model, p = _model(of, parameters)
    u = tuple(map(float, controls or (0.0,) * len(model.spec.controls)))
    return np.array(model.dynamics(0.0, tuple(np.asarray(x, dtype=float)), u, p))


def jacobian_at(of: Any, x: ArrayLike, **parameters: float) -> Array:
    """Return the Jacobian of the time derivatives with respect to the states, at a state."""
    if isinstance(of, Record):
        if "slopes" not in of.parts:
            return numbers(of.part("A"))
        return np.array(of.part("slopes")(*np.asarray(x, dtype=float))).reshape(2, 2)
    model, p = _model(of, parameters)
    n = len(model.spec.states)
    found = model.jacobian_x(0.0, tuple(np.asarray(x, dtype=float)), (0.0,) * len(model.spec.controls), p)
    return np.array(found).reshape(n, n)


def approaching(x: ArrayLike) -> list[Array]:
    """Return two points that approach a point, the second at half the distance of the first."""
    centre = np.asarray(x, dtype=float)
    way = np.random.default_rng(_SEED).normal(size=centre.shape)
    size = max(1.0, float(np.abs(centre).max())) / float(np.linalg.norm(way))
    return [centre + size * h * way for h in (2e-3, 1e-3)]


def _motion(name: str, position: ArrayLike, velocity: ArrayLike, mu: float) -> Record:
    r, v = np.array(position), np.array(velocity)
    return Record(name, {"called": name, "position": r, "velocity": v, "mu": mu, "x": np.concatenate([r, v])})


def _start(of: Any, velocity: ArrayLike | None, mu: float | None) -> tuple[Array, Array, float]:
    if isinstance(of, str):
        return _of_instance(of)
    if isinstance(of, Record):
        return of.part("position"), of.part("velocity"), of.part("mu")
    if velocity is None or mu is None:
        raise BadInput("name a motion, or give a position, a velocity and mu")
    return np.asarray(of, dtype=float), np.asarray(velocity, dtype=float), float(mu)


@cache
def _of_instance(name: str) -> tuple[Array, Array, float]:
    case = motion.loaded(name)
    if not case.model.spec.keplerian:
        raise BadInput(f"{shown(name)} is not a motion about a centre; name an instance such as itb-earth")
    state = case.model.inertial_state(case.t0, case.initial, case.parameters)
    return np.asarray(state[:3]), np.asarray(state[3:6]), float(state[6])


def _model(name: str, parameters: dict[str, float]) -> tuple[Any, tuple[float, ...]]:
    model = kernels.load(name)
    known = {v.symbol: float(v.default) if v.default is not None else 1.0 for v in model.spec.parameters}
    for other in parameters:
        refuse_unknown(f"{name} has no parameter", other, known)
    return model, tuple(float(v) for v in (known | parameters).values())
