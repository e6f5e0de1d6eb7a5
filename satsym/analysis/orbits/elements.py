"""Elements of an orbit: its size, shape and attitude, from a position and a velocity.

Energy and the deviation from a circle are differences that may cancel; the first is therefore computed with 32 digits,
and the eccentricity from its components along and across the radius, which are accurate near a parabola. Angles without
a meaning are ``None``; angles from a direction that does not exist are counted from another (see :class:`Elements`).
Formulas: Battin, An Introduction to the Mathematics and Methods of Astrodynamics, chapter 3.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike

from satsym.analysis.orbits import double_double as dd
from satsym.analysis.orbits.states import States, checked
from satsym.arrays import Array
from satsym.status import BadInput

TOLERANCE = 1e-12
"""Largest deviation of circles, parabolas and rectilinear orbits from their definitions.

It limits the eccentricity of a circle, the relative difference of the square of the speed on a parabola from that of
escape, and the angle between velocity and radius of a rectilinear orbit. It is some ten thousand times the rounding
error of the numbers an orbit starts with, and far below what is ever measured. A nearly circular ellipse is an ellipse.
"""


class Conic(str, Enum):
    """The kind of conic section of a path; ``rectilinear`` without angular momentum, whatever the energy."""

    CIRCLE = "circle"
    ELLIPSE = "ellipse"
    PARABOLA = "parabola"
    HYPERBOLA = "hyperbola"
    RECTILINEAR = "rectilinear"


def classify(eccentricity: float, shortfall: float, sine: float) -> Conic:
    """Return the kind of an orbit.

    Parameters
    ----------
    eccentricity
        Eccentricity, not negative.
    shortfall
        Difference of the square of the speed of escape and that of the speed, as a fraction of the former: 1 at rest, 0
        on a parabola, negative on a hyperbola. It is minus the energy in units of mu/r.
    sine
        Sine of the angle between radius and velocity; 0 at rest.
    """
    if sine <= TOLERANCE:
        return Conic.RECTILINEAR
    if abs(shortfall) <= TOLERANCE:
        return Conic.PARABOLA
    if shortfall < 0.0:
        return Conic.HYPERBOLA
    return Conic.CIRCLE if eccentricity <= TOLERANCE else Conic.ELLIPSE


REACH = 100.0
"""Largest power of ten of lengths, speeds and times, up or down, so that their squares are floats."""


@dataclass(frozen=True, eq=False)
class Elements:
    """The elements of an orbit about one centre, in the units of the position, velocity and mu they come from.

    Attributes
    ----------
    position, velocity, mu
        The start, shape (3,) each, and the gravitational parameter.
    conic
        Kind of conic section.
    eccentricity, parameter
        Eccentricity, and semi-latus rectum.
    energy
        Energy per unit mass.
    angular_momentum
        Angular momentum per unit mass, shape (3,).
    semi_major_axis
        Semi-major axis; negative on a hyperbola, ``None`` on a parabola.
    periapsis, apoapsis
        Distances from the centre; the latter ``None`` where there is none.
    period
        Time of a revolution; ``None`` on parabolas, hyperbolas and rectilinear orbits.
    excess_speed
        The speed that remains at infinity; ``None`` on a bound orbit.
    inclination
        Angle to the plane of the first two axes, from 0 to pi; it is above pi/2 for retrograde orbits.
    node
        Longitude of the ascending node, ``None`` on an equatorial orbit.
    periapsis_argument
        Argument of the periapsis, counted from the node along the motion, and on an equatorial orbit from the first
        axis; ``None`` on a circle.
    true_anomaly
        True anomaly of the start, counted from the periapsis; on a circle from the node, or without a node from the
        first axis.
    towards, ahead, normal
        Unit vectors, shape (3,): towards the point of true anomaly zero, along the motion there, and normal to the
        plane of the orbit.

    On a rectilinear orbit all angles are ``None``, and ``towards`` points to the start.
    """

    position: Array
    velocity: Array
    mu: float
    conic: Conic
    eccentricity: float
    parameter: float
    energy: float
    angular_momentum: Array
    semi_major_axis: float | None
    periapsis: float
    apoapsis: float | None
    period: float | None
    excess_speed: float | None
    inclination: float | None
    node: float | None
    periapsis_argument: float | None
    true_anomaly: float | None
    towards: Array
    ahead: Array
    normal: Array

    @property
    def bound(self) -> bool:
        """Tell whether the distance from the centre stays bounded."""
        return self.apoapsis is not None

    @property
    def distance(self) -> float:
        """Return the distance of the start from the centre of attraction."""
        return float(np.linalg.norm(self.position))

    @property
    def mean_motion(self) -> float | None:
        """Return the mean angular velocity, ``None`` for orbits that are not periodic."""
        return None if self.period is None else 2.0 * np.pi / self.period


def elements(position: ArrayLike, velocity: ArrayLike, mu: float) -> Elements:
    """Compute the elements of one orbit.

    Parameters
    ----------
    position, velocity
        Shape (3,), along inertial axes from the centre, in any consistent units.
    mu
        Gravitational parameter of the centre.

    Raises
    ------
    BadInput
        If the position is the centre itself, mu is not positive, or a number is not finite or too large for floats.
    """
    given = checked(position, velocity, mu, 0.0)
    if given.shape:
        raise BadInput(
            f"position, velocity, mu: these arrays describe {given.mu.size} orbits, but only one is allowed; give a "
            "single orbit"
        )
    states, (length,), (speed,) = given.scaled()
    scalars = _scalars(states)
    with np.errstate(over="ignore", divide="ignore"):
        sizes = np.log10([length, speed, length / speed])
    if not (np.isfinite(list(scalars.values())).all() and (np.abs(sizes) < REACH).all()):
        raise BadInput("position, velocity, mu: a result exceeds the range of floating-point numbers; check the units")
    binding, momentum, radius, gravity = (scalars[name] for name in ("binding", "momentum", "radius", "mu"))
    along = momentum * scalars["rate"] / (gravity * radius)  # e sin(true anomaly)
    fraction = scalars["parameter"] / radius - 1.0  # e cos(true anomaly)
    eccentricity = float(np.hypot(along, fraction))
    conic = classify(eccentricity, 0.5 * binding * radius / gravity, scalars["sine"])
    parabolic = abs(0.5 * binding * radius / gravity) <= TOLERANCE
    if conic is Conic.RECTILINEAR:
        eccentricity = 1.0
    axis = None if parabolic else gravity / binding * length
    bound = axis is not None and axis > 0.0
    closed = conic in (Conic.CIRCLE, Conic.ELLIPSE)
    angles = _Attitude.of(states, conic, float(np.arctan2(along, fraction)))
    return Elements(
        position=given.position[:, 0],
        velocity=given.velocity[:, 0],
        mu=float(given.mu[0]),
        conic=conic,
        eccentricity=eccentricity,
        parameter=float(scalars["parameter"] * length),
        energy=float(-0.5 * binding * speed**2),
        angular_momentum=_momentum(states) * (length * speed),
        semi_major_axis=None if axis is None else float(axis),
        periapsis=0.0 if conic is Conic.RECTILINEAR else float(scalars["parameter"] / (1.0 + eccentricity) * length),
        apoapsis=float(axis * (1.0 + eccentricity)) if bound and axis is not None else None,
        period=float(2.0 * np.pi * gravity / binding**1.5 * (length / speed)) if closed else None,
        excess_speed=None if bound else 0.0 if parabolic else float(np.sqrt(-binding) * speed),
        inclination=angles.inclination,
        node=angles.node,
        periapsis_argument=angles.periapsis,
        true_anomaly=angles.anomaly,
        towards=angles.towards,
        ahead=np.cross(angles.normal, angles.towards),
        normal=angles.normal,
    )


def _scalars(states: States) -> dict[str, float]:
    """Return the scalars of a state that determine the shape of its orbit.

    ``binding`` is 2 mu/r - v^2, ``rate`` the scalar product of radius and velocity.
    """
    r, v, mu = states.position[:, 0], states.velocity[:, 0], states.mu[0]
    with np.errstate(all="ignore"):
        radius = dd.root(dd.dot(r, r))
        binding = dd.add(dd.divide((2.0 * mu, np.float64(0.0)), radius), dd.negative(dd.dot(v, v)))
        momentum, speed = np.linalg.norm(_momentum(states)), np.linalg.norm(v)
        return {
            "mu": float(mu),
            "radius": float(radius[0]),
            "binding": float(binding[0]),
            "rate": float(dd.dot(r, v)[0]),
            "momentum": float(momentum),
            "parameter": float(momentum**2 / mu),
            "sine": float(momentum / (radius[0] * speed)) if speed else 0.0,
        }


def _momentum(states: States) -> Array:
    with np.errstate(all="ignore"):
        return dd.cross(states.position[:, 0], states.velocity[:, 0])


@dataclass(frozen=True, eq=False)
class _Attitude:
    inclination: float | None
    node: float | None
    periapsis: float | None
    anomaly: float | None
    towards: Array
    normal: Array

    @classmethod
    def of(cls, states: States, conic: Conic, anomaly: float) -> _Attitude:
        """Return the axes and angles of a body on its conic, from the true anomaly, which a circle does not have."""
        outward = states.position[:, 0] / np.linalg.norm(states.position[:, 0])
        if conic is Conic.RECTILINEAR:
            return cls(None, None, None, None, outward, _across(outward))
        momentum = _momentum(states)
        normal = momentum / np.linalg.norm(momentum)
        tilt = float(np.hypot(normal[0], normal[1]))
        equatorial = tilt <= TOLERANCE
        first = np.array([1.0, 0.0, 0.0]) if equatorial else np.array([-normal[1], normal[0], 0.0]) / tilt
        second = np.cross(normal, first)
        sideways = np.cross(normal, outward)
        if conic is Conic.CIRCLE:
            towards, anomaly = first, float(np.arctan2(outward @ second, outward @ first))
        else:
            towards = np.cos(anomaly) * outward - np.sin(anomaly) * sideways
        return cls(
            float(np.arctan2(tilt, normal[2])),
            None if equatorial else _turn(np.arctan2(normal[0], -normal[1])),
            None if conic is Conic.CIRCLE else _turn(np.arctan2(towards @ second, towards @ first)),
            _turn(anomaly),
            towards,
            normal,
        )


def _turn(angle: float) -> float:
    """Return an angle reduced to the range from 0 to 2 pi."""
    found = float(angle) % (2.0 * np.pi)
    return 0.0 if found == 2.0 * np.pi else found


def _across(direction: Array) -> Array:
    """Return a unit vector at right angles to a direction: any one, where no plane is defined."""
    other = np.zeros(3)
    other[int(np.argmin(np.abs(direction)))] = 1.0
    found = np.cross(direction, other)
    return np.asarray(found / np.linalg.norm(found))
