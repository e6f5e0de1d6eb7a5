"""Earth satellites: physical constants and quantities with units, orbits, and their motion as seen from the ground."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction
from typing import Any

import numpy as np

from satsym.analysis.orbits.kepler import propagate
from satsym.arrays import Array, kept
from satsym.auditing import quantities
from satsym.auditing.constants import PUBLISHED
from satsym.auditing.propositions.values import Family, Record
from satsym.auditing.quantities import Quantity
from satsym.wording import refuse_unknown

_MOMENTS = 360
_STATION = math.radians(30.0), math.radians(20.0)
"""Latitude of a ground station, and its longitude east of the initial point below the satellite, both in radians."""
_SEED = 11


def quantity(text: str) -> Quantity:
    """Return a number with its unit, taken as exact."""
    return quantities.in_base_units(text)


def constant(name: str) -> Quantity:
    """Return a published constant, such as ``mu_earth``."""
    refuse_unknown("there is no published constant", name, PUBLISHED)
    return quantities.in_base_units(PUBLISHED[name])


def orbits() -> Family:
    """Return a family of Earth orbits: periods of half, one and two sidereal days, several shapes and inclinations."""
    day, rng = constant("sidereal_day").value, np.random.default_rng(_SEED)
    plain = itertools.product((0.5, 1.0, 2.0), (0.0, 0.1, 0.4), (0.0, 28.5, 63.4, 180.0), (0.0, 270.0))
    random = rng.uniform((0.2, 0.0, 0.0, 0.0), (3.0, 0.6, 180.0, 360.0), (8, 4))
    return Family("ORBITS", "orbits", tuple(_orbit(p * day, *rest) for p, *rest in (*plain, *random.tolist())))


def geostationary() -> Record:
    """Return the circular equatorial orbit whose period is the sidereal day."""
    return _orbit(constant("sidereal_day").value)


def circular(altitude: str) -> Record:
    """Return the circular equatorial orbit at an altitude."""
    radius = quantity(altitude).value + constant("R_earth").value
    return _orbit(2.0 * math.pi * math.sqrt(radius**3 / constant("mu_earth").value))


def gravity(orbit: Record) -> Quantity:
    """Return the gravitational acceleration at a distance equal to the semi-major axis of an orbit."""
    return constant("mu_earth") / orbit.part("axis") ** 2


def ground_swing(orbit: Record) -> float:
    """Return the largest angle (degrees) that the point below a satellite moves over the Earth in a day."""
    return _swing(_fixed(orbit))


def antenna_swing(orbit: Record) -> float:
    """Return the largest angle (degrees) by which a ground antenna must turn in a day to follow a satellite."""
    latitude, east = _STATION
    station = np.array([math.cos(latitude) * math.cos(east), math.cos(latitude) * math.sin(east), math.sin(latitude)])
    return _swing(_fixed(orbit) - station[:, None] * constant("R_earth").value)


def signal_time(orbit: Record, legs: int, elevation: float) -> Quantity:
    """Return the time of a signal for `legs` paths between ground and circular orbit at an elevation (degrees)."""
    ground, axis = constant("R_earth").value, orbit.part("axis").value
    up = ground * math.sin(math.radians(elevation))
    return Quantity(legs * (math.sqrt(axis**2 - ground**2 + up**2) - up), {"[length]": Fraction(1)}) / constant(
        "c_light"
    )


@kept
def distance_after(orbit: Record, share: float) -> Quantity:
    """Return the distance from the Earth's centre after a fraction of a revolution from the periapsis."""
    place = _places(orbit, np.array([share * orbit.part("period").value]))
    return Quantity(float(np.linalg.norm(place)), orbit.part("axis").dimension)


def seen_latitude(orbit: Record) -> float:
    """Return the latitude (degrees) up to which a satellite in a circular equatorial orbit is above the horizon."""
    return math.degrees(math.acos(constant("R_earth").value / orbit.part("axis").value))


def _orbit(period: float, eccentricity: float = 0.0, inclination: float = 0.0, perigee: float = 0.0) -> Record:
    """Return an orbit with the given elements, angles in degrees."""
    mu, ground = constant("mu_earth"), constant("R_earth")
    length, time = ground.dimension, constant("sidereal_day").dimension
    axis = Quantity((mu.value * (period / (2.0 * math.pi)) ** 2) ** (1.0 / 3.0), length)
    name = f"period {period / 3600.0:.3g} h, eccentricity {eccentricity:.2g}, inclination {inclination:.3g} degrees"
    shape: dict[str, Any] = {"eccentricity": eccentricity, "inclination": inclination, "perigee": perigee}
    return Record(name, {"period": Quantity(period, time), "axis": axis, "altitude": axis - ground, **shape})


def _places(orbit: Record, times: Array) -> Array:
    """Return positions at times after the periapsis, with the x axis towards the periapsis, shape (3, times)."""
    e, axis, mu = orbit.part("eccentricity"), orbit.part("axis").value, constant("mu_earth").value
    speed = math.sqrt(mu / axis * (1.0 + e) / (1.0 - e))
    return propagate([[axis * (1.0 - e)], [0.0], [0.0]], [[0.0], [speed], [0.0]], mu, times)[0]


def _fixed(orbit: Record) -> Array:
    """Return positions over a day in axes that rotate with the Earth, shape (3, moments)."""
    tilt, perigee = np.radians([orbit.part("inclination"), orbit.part("perigee")])
    share = np.linspace(0.0, 1.0, _MOMENTS)
    x, y, _ = _places(orbit, share * constant("sidereal_day").value)
    along = np.array([x * math.cos(perigee) - y * math.sin(perigee), x * math.sin(perigee) + y * math.cos(perigee)])
    turned = 2.0 * math.pi * share
    across = along[1] * math.cos(tilt)
    fixed = [along[0] * np.cos(turned) + across * np.sin(turned), across * np.cos(turned) - along[0] * np.sin(turned)]
    return np.array([*fixed, along[1] * math.sin(tilt)])


def _swing(vectors: Array) -> float:
    """Return the largest angle (degrees) between the first vector and any other vector."""
    directions = vectors / np.linalg.norm(vectors, axis=0)
    gaps = np.linalg.norm(directions - directions[:, :1], axis=0)
    return float(np.degrees(2.0 * np.arcsin(np.minimum(1.0, gaps / 2.0))).max())
