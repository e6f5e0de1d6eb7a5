"""Claims about satellites at some altitude: periods, delays, what they see, and words for their orbits."""

from __future__ import annotations

import math

import numpy as np

from satsym.auditing import quantities
from satsym.auditing.constants import PUBLISHED
from satsym.auditing.predicates import Finding, Question, predicate
from satsym.auditing.predicates.motion import stays_without_thrust
from satsym.auditing.predicates.orbits import published, synchronous_radius
from satsym.status import BadInput

_OLD = 1e-3
"""Values of the constant of gravitation measured in the last hundred years differ by less than this."""


def _radii(altitudes: tuple[str, ...]) -> list[float]:
    return [published("R_earth") + quantities.in_base_units(altitude).value for altitude in altitudes]


def _interval(printed: tuple[str, ...]) -> tuple[float, float]:
    """What one or two printed numbers allow, in base units."""
    numbers = [quantities.printed_number(text) for text in printed]
    ends = [(float(n.value - n.half_unit), float(n.value + n.half_unit), quantities.scale(n.unit)) for n in numbers]
    return ends[0][0] * ends[0][2], ends[-1][1] * ends[-1][2]


def _period(radius: float) -> float:
    return 2.0 * math.pi * math.sqrt(radius**3 / published("mu_earth"))


@predicate
def periods(printed: tuple[str, ...], altitudes: tuple[str, ...]) -> Finding:
    """Whether circular orbits at these altitudes have the printed periods.

    One printed number must be the period of some altitude between the two, two numbers must hold those of all.
    """
    low, high = _interval(printed)
    found = [_period(radius) for radius in _radii(altitudes)]
    right = low <= found[-1] and found[0] <= high if len(printed) == 1 else low <= found[0] and found[-1] <= high
    written = [f"{value / 60.0:.0f} min" if value < 7200.0 else f"{value / 3600.0:.2f} h" for value in found]
    return Finding(
        right,
        f"{written[0]} at {altitudes[0]} to {written[-1]} at {altitudes[-1]}",
        {f"period at {a}, s": value for a, value in zip(altitudes, found, strict=True)},
    )


@predicate
def delays(printed: tuple[str, ...], altitudes: tuple[str, ...], legs: int) -> Finding:
    """Whether a satellite at either altitude, somewhere between overhead and the horizon, has a printed delay."""
    low, high = _interval(printed)
    ground, light = published("R_earth"), published("c_light")
    found = [
        (legs * (radius - ground) / light, legs * math.sqrt(radius**2 - ground**2) / light)
        for radius in _radii(altitudes)
    ]
    return Finding(
        all(shortest <= high and low <= longest for shortest, longest in found),
        "; ".join(
            f"{1e3 * shortest:.1f} ms overhead to {1e3 * longest:.1f} ms at the horizon from {altitude}"
            for altitude, (shortest, longest) in zip(altitudes, found, strict=True)
        ),
        {f"overhead at {a}, ms": 1e3 * shortest for a, (shortest, _) in zip(altitudes, found, strict=True)},
    )


@predicate
def visible(printed: str, altitudes: tuple[str, ...]) -> Finding:
    """Whether satellites at these altitudes, passing overhead, are above the horizon for that time or longer."""
    wanted, _ = _interval((printed,))
    ground = published("R_earth")
    found = [_period(radius) * math.acos(ground / radius) / math.pi for radius in _radii(altitudes)]
    return Finding(
        min(found) >= wanted,
        f"{found[0] / 3600.0:.2f} h from {altitudes[0]}, {found[-1] / 3600.0:.2f} h from {altitudes[-1]}",
        {f"above the horizon at {a}, h": value / 3600.0 for a, value in zip(altitudes, found, strict=True)},
    )


@predicate
def stays_over(printed: str, above: bool = False) -> Finding:
    """Whether a satellite at that altitude (or 1000 km ``above`` it) keeps over its place on the equator."""
    higher = 1e6 if above else 0.0
    radius, day = _radii((printed,))[0] + higher, published("sidereal_day")
    number = quantities.printed_number(printed)
    half = float(number.half_unit) * quantities.scale(number.unit)
    drift, slack = (360.0 * (day / _period(r) - 1.0) for r in (radius, synchronous_radius() - half))
    return Finding(
        abs(drift) <= abs(slack),
        f"{'1000 km above ' if above else 'at '}{printed} it drifts by {drift:.3g} degrees a day",
        {"drift, degrees a day": drift},
        remark="geostationary is the one altitude whose period is that of the Earth's rotation" if above else "",
    )


@predicate
def sense_is_speed() -> Finding:
    """Whether the larger of two angular speeds always belongs to the orbit that goes round with the Earth."""
    rate = {radius: math.sqrt(published("mu_earth") / radius**3) for radius in _radii(("500 km", "35786 km"))}
    low, high = rate.values()
    orbits = [(low, math.pi), (high, 0.0)]  # a low orbit against the Earth's rotation, a high one with it
    momenta = [speed * math.cos(inclination) for speed, inclination in orbits]
    fastest_is_prograde = momenta[int(np.argmax([speed for speed, _ in orbits]))] > 0.0
    return Finding(
        fastest_is_prograde,
        f"a low retrograde orbit ({low:.2g} rad/s) is faster than a high prograde one ({high:.2g} rad/s)",
        {"low, retrograde, rad/s": low, "high, prograde, rad/s": high},
        remark="prograde is an orbit with the rotation of the Earth, retrograde one against it",
    )


@predicate
def apsides_are_extremes() -> Finding:
    """Whether the distance is least at the perigee and largest at the apogee, along an ellipse."""
    anomaly, a, e = np.linspace(0.0, 2.0 * math.pi, 721), 1.0, 0.3
    distance = a * (1.0 - e**2) / (1.0 + e * np.cos(anomaly))
    return Finding(
        int(distance.argmin()) in (0, 720) and int(distance.argmax()) == 360,
        f"the distance is least, {distance.min():.2g}, at the perigee and largest, {distance.max():.2g}, at the apogee",
        {"least": float(distance.min()), "largest": float(distance.max())},
    )


@predicate
def circle_needs_thrust(instance: str) -> Finding:
    """Whether a satellite leaves its circle where nothing thrusts."""
    found = stays_without_thrust(instance)
    return Finding(
        not found.holds,
        "without any thrust the satellite stays on its circle; gravity alone bends its path",
        found.evidence,
    )


@predicate
def of_other_units(row: Question, constant: str, unit: str) -> Finding:
    """Whether a printed constant has the published value; if not, whether its number is that in another unit."""
    if constant not in PUBLISHED:
        raise BadInput(f"of_other_units: no constant {constant}; the published ones are {', '.join(PUBLISHED)}")
    printed = quantities.printed_number(str(row.printed))
    value = published(constant) / quantities.scale(printed.unit)
    other = published(constant) / quantities.scale(unit)
    near = abs(other / float(printed.value) - 1.0) < _OLD
    return Finding(
        abs(value - float(printed.value)) <= float(printed.half_unit),
        f"{value:.5g} {printed.unit}",
        {"in the printed unit": value, f"in {unit}": other},
        unit=near,
        remark=f"the number is that of {unit}, {other:.5g} as measured today" if near else "",
    )
