"""Claims about satellites of the Earth: where they stand still, how long signals take, what keeps them there."""

from __future__ import annotations

import math

import numpy as np

from satsym.auditing import quantities
from satsym.auditing.constants import PUBLISHED
from satsym.auditing.predicates import Finding, predicate
from satsym.status import BadInput
from satsym.wording import shown

_SAMPLES = 720
_STILL = 1e-9
"""Degrees; less is rounding."""


def published(name: str) -> float:
    """A published constant in SI units."""
    return quantities.in_base_units(PUBLISHED[name].quantity).value


def synchronous_radius() -> float:
    """Radius (m) of a circular orbit whose period is the sidereal day."""
    turn = published("sidereal_day") / (2.0 * math.pi)
    return (published("mu_earth") * turn**2) ** (1.0 / 3.0)


@predicate
def stands_still(inclination: str, eccentricity: str) -> Finding:
    """Whether a synchronous satellite stays over one point of the ground, by Kepler's equation over one day."""
    tilt, e = quantities.in_base_units(inclination).value, float(eccentricity)
    if not 0.0 <= e < 1.0:
        raise BadInput(f"stands_still: eccentricity {shown(eccentricity)}: write one of an ellipse")
    turned = np.linspace(0.0, 2.0 * math.pi, _SAMPLES)
    eccentric = turned.copy()
    for _ in range(50):
        eccentric -= (eccentric - e * np.sin(eccentric) - turned) / (1.0 - e * np.cos(eccentric))
    anomaly = 2.0 * np.arctan2(
        math.sqrt(1.0 + e) * np.sin(eccentric / 2.0), math.sqrt(1.0 - e) * np.cos(eccentric / 2.0)
    )
    latitude = np.degrees(np.arcsin(math.sin(tilt) * np.sin(anomaly)))
    ascension = np.unwrap(np.arctan2(math.cos(tilt) * np.sin(anomaly), np.cos(anomaly)))
    longitude = np.degrees(ascension - turned)
    swing = {"latitude, degrees": float(np.abs(latitude).max()), "longitude, degrees": float(np.ptp(longitude))}
    still = max(swing.values()) < _STILL
    return Finding(still, f"its ground point moves by {max(swing.values()):.2g} degrees in a day", swing)


@predicate
def weightless_place() -> Finding:
    """Whether gravity is absent on the geostationary orbit."""
    gravity = published("mu_earth") / synchronous_radius() ** 2
    share = gravity / published("g_standard")
    return Finding(
        gravity == 0.0,
        f"gravity there is {gravity:.3f} m/s^2, and it is what holds the satellite on its circle",
        {"gravity, m/s^2": gravity, "share of that on the ground": share},
    )
