"""Claims about satellites of the Earth: where they stand still, how long signals take, what keeps them there."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from fractions import Fraction

import numpy as np

from satsym.auditing import quantities
from satsym.auditing.constants import PUBLISHED
from satsym.auditing.predicates import Finding, Question, predicate
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
def signal_delay(printed: str, legs: str) -> Finding:
    """Whether a delay lies between those of a satellite overhead and of one at the horizon.

    Parameters
    ----------
    printed
        The delay.
    legs
        How often the signal crosses between ground and satellite.
    """
    radius, ground, light = synchronous_radius(), published("R_earth"), published("c_light")
    shortest = int(legs) * (radius - ground) / light
    longest = int(legs) * math.sqrt(radius**2 - ground**2) / light
    value = quantities.in_base_units(printed).value
    return Finding(
        shortest <= value <= longest,
        f"{1e3 * shortest:.1f} ms overhead to {1e3 * longest:.1f} ms at the horizon",
        {"overhead, ms": 1e3 * shortest, "at the horizon, ms": 1e3 * longest},
    )


@predicate
def satellites_needed(printed: str) -> Finding:
    """Whether so many geostationary satellites, and no fewer, see every point of the equator."""
    half_width = math.degrees(math.acos(published("R_earth") / synchronous_radius()))
    needed = math.ceil(180.0 / half_width)
    return Finding(
        needed == int(printed),
        f"each sees {2.0 * half_width:.1f} degrees of the equator, so {needed}",
        {"degrees seen": 2.0 * half_width, "needed": needed},
    )


@predicate
def altitude_classes(bounds: tuple[str, ...]) -> Finding:
    """Whether classes of altitude follow each other without gap or overlap, up to the geosynchronous altitude.

    Where low orbits end is a convention; where the class of the geosynchronous ones is, is not.

    Parameters
    ----------
    bounds
        The printed altitudes between the classes, from the lowest.
    """
    radius, mu = published("R_earth"), published("mu_earth")
    heights = [quantities.in_base_units(bound).value for bound in bounds]
    last = quantities.printed_number(bounds[-1])
    margin = float(last.half_unit) * quantities.scale(last.unit)
    joined = all(low < high for low, high in itertools.pairwise(heights))
    synchronous = abs(heights[-1] - (synchronous_radius() - radius)) <= margin
    periods = [2.0 * math.pi * math.sqrt((radius + height) ** 3 / mu) for height in heights]
    return Finding(
        joined and synchronous,
        f"periods at these altitudes: {', '.join(f'{period / 3600.0:.3g} h' for period in periods)}",
        {f"period at {bound}, h": period / 3600.0 for bound, period in zip(bounds, periods, strict=True)},
    )


@predicate
def sees_everything() -> Finding:
    """Whether geostationary satellites, however many, see every point of the Earth."""
    edge = math.acos(published("R_earth") / synchronous_radius())
    hidden = 1.0 - math.sin(edge)
    return Finding(
        hidden == 0.0,
        f"beyond {math.degrees(edge):.1f} degrees of latitude none is above the horizon: {100.0 * hidden:.1f} % of the "
        "surface",
        {"latitude of the horizon, degrees": math.degrees(edge), "share of the surface": hidden},
    )


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


@predicate
def reference_orbit_of_earth(row: Question, length: str, rate: str) -> Finding:
    """Whether printed sigma and omega, in the units stated elsewhere, make an orbit about the Earth.

    With both 1 they are those of a normalised problem; then lengths count in radii of the orbit, and time in
    turns over two pi.
    """
    values = {name: quantities.in_base_units(f"{value} {unit}").value
              for (name, value), unit in zip(row.printed, (length, rate), strict=True)}  # fmt: skip
    sigma, omega = values["sigma"], values["omega"]
    share = sigma**3 * omega**2 / published("mu_earth")
    radius, turn = synchronous_radius(), published("sidereal_day") / (2.0 * math.pi)
    normalised = all(float(value) == 1.0 for _, value in row.printed)
    return Finding(
        abs(share - 1.0) < 0.01,
        f"the geostationary orbit has sigma = {radius / 1e3:.0f} km and omega = {1.0 / turn:.4g} rad/s",
        {
            "sigma^3 omega^2, share of the Earth's": share,
            "unit of length if normalised, km": radius / 1e3,
            "unit of time if normalised, s": turn,
        },
        unit=normalised,
        remark=(
            f"as normalised numbers they are right, but then the unit of length is {radius / 1e3:.0f} km and that of "
            f"time {turn:.0f} s, and 60 of these are {60.0 * turn / 86400.0:.1f} days"
            if normalised
            else ""
        ),
    )


@predicate
def coherent(left: str, right: str) -> Finding:
    """Whether a product of units is the unit that it is equated with."""
    one, other = quantities.in_base_units(f"1 {left}"), quantities.in_base_units(f"1 {right}")
    same = dict(one.dimension) == dict(other.dimension)
    ratio = other.value / one.value
    return Finding(
        same and abs(ratio - 1.0) < 1e-12,
        f"1 {right} = {ratio:.6g} {left}" if same else f"{left} and {right} differ in dimension",
        {"ratio": ratio},
        unit=True,
    )


@predicate
def weight_unit(printed: str, cost: str, control: str, time: str) -> Finding:
    """Whether weights of that unit make the integral of weight times control squared a cost of its unit."""
    weight, total, u, t = (
        dict(quantities.in_base_units(f"1 {unit}").dimension) for unit in (printed, cost, control, time)
    )
    none = Fraction(0)
    bases = sorted({*weight, *total, *u, *t})
    needed = {b: total.get(b, none) - 2 * u.get(b, none) - t.get(b, none) for b in bases}
    needed = {b: power for b, power in needed.items() if power}
    return Finding(
        weight == needed,
        f"a cost in {cost} needs weights in {_written(needed)}; {printed} is {_written(weight)}",
        {"needed": _written(needed), "printed": _written(weight)},
        unit=True,
    )


def _written(dimension: Mapping[str, Fraction]) -> str:
    return quantities.base_unit(dimension).replace("^1*", "*").removesuffix("^1")
