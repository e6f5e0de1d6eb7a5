"""Random conics, and Kepler motion at 50 digits by classical elements: what the closed form is judged by.

Nothing here is shared with satsym: eccentricity vector, Kepler's and Barker's equations in the eccentric anomaly, and
perifocal axes (Battin, An Introduction to the Mathematics and Methods of Astrodynamics, chapter 4).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import mpmath as mp
import numpy as np

DIGITS = 50

Number = Any
Vector = Sequence[Number]


@dataclass(frozen=True)
class Conic:
    """A start, as floats, and how long the motion lasts."""

    kind: str
    position: tuple[float, float, float]
    velocity: tuple[float, float, float]
    mu: float
    duration: float


def exact(position: Vector, velocity: Vector, mu: Number, duration: Number) -> tuple[list[Number], list[Number]]:
    """Position and velocity after the duration, for motion that is not exactly radial."""
    with mp.workdps(DIGITS):
        r, v = [mp.mpf(x) for x in position], [mp.mpf(x) for x in velocity]
        mu, t = mp.mpf(mu), mp.mpf(duration)
        radius = mp.sqrt(_dot(r, r))
        h = _cross(r, v)
        p = _dot(h, h) / mu
        towards = [a / mu - b / radius for a, b in zip(_cross(v, h), r, strict=True)]
        e = mp.sqrt(_dot(towards, towards))
        first = [a / e for a in towards]
        second = _cross([a / mp.sqrt(_dot(h, h)) for a in h], first)
        binding = 2 / radius - _dot(v, v) / mu  # 1/a
        if binding == 0:
            plane = _parabola(mu, p, _dot(r, v), t)
        elif binding > 0:
            plane = _ellipse(mu, p, 1 / binding, radius, _dot(r, v), t, e)
        else:
            plane = _hyperbola(mu, p, -1 / binding, _dot(r, v), t, e)
        x, y, x_dot, y_dot = plane
        place = [x * a + y * b for a, b in zip(first, second, strict=True)]
        return place, [x_dot * a + y_dot * b for a, b in zip(first, second, strict=True)]


def _ellipse(mu: Number, p: Number, a: Number, radius: Number, rate: Number, t: Number, e: Number) -> Vector:
    n = mp.sqrt(mu / a**3)
    before = mp.atan2(rate / mp.sqrt(mu * a), 1 - radius / a)
    mean = before - e * mp.sin(before) + n * t
    mean -= 2 * mp.pi * mp.nint(mean / (2 * mp.pi))
    size = abs(mean)
    # convex left of pi: Newton's method comes down from any upper bound
    upper = min(mp.pi, size + e, mp.cbrt(10 * size) if e > 0.5 else mp.pi)
    after = mp.sign(mean) * _newton(lambda v: v - e * mp.sin(v) - size, lambda v: 1 - e * mp.cos(v), upper)
    b, cos, sin = mp.sqrt(a * p), mp.cos(after), mp.sin(after)
    pace = n / (1 - e * cos)
    return a * (cos - e), b * sin, -a * sin * pace, b * cos * pace


def _hyperbola(mu: Number, p: Number, a: Number, rate: Number, t: Number, e: Number) -> Vector:
    n = mp.sqrt(mu / a**3)
    before = mp.asinh(rate / mp.sqrt(mu * a) / e)
    mean = e * mp.sinh(before) - before + n * t
    size = abs(mean)
    upper = mp.asinh((size + mp.cbrt(6 * size)) / e)
    after = mp.sign(mean) * _newton(lambda v: e * mp.sinh(v) - v - size, lambda v: e * mp.cosh(v) - 1, upper)
    b, cosh, sinh = mp.sqrt(a * p), mp.cosh(after), mp.sinh(after)
    pace = n / (e * cosh - 1)
    return a * (e - cosh), b * sinh, -a * sinh * pace, b * cosh * pace


def _parabola(mu: Number, p: Number, rate: Number, t: Number) -> Vector:
    h = mp.sqrt(mu * p)
    before = rate / h  # tan(true anomaly / 2)
    mean = before + before**3 / 3 + 2 * mp.sqrt(mu / p**3) * t
    after = 2 * mp.sinh(mp.asinh(3 * mean / 2) / 3)
    pace = mu / (h * (1 + after**2))
    return p * (1 - after**2) / 2, p * after, -2 * after * pace, 2 * pace


def _newton(function: Callable[[Number], Number], slope: Callable[[Number], Number], start: Number) -> Number:
    value = start
    for _ in range(200):
        step = function(value) / slope(value)
        value -= step
        if abs(step) <= mp.mpf(10) ** (-DIGITS // 2 - 2) * abs(value):
            return value - function(value) / slope(value)
    raise AssertionError("Newton's method does not end")


def _dot(a: Vector, b: Vector) -> Number:
    return sum(x * y for x, y in zip(a, b, strict=True))


def _cross(a: Vector, b: Vector) -> list[Number]:
    return [a[i] * b[j] - a[j] * b[i] for i, j in ((1, 2), (2, 0), (0, 1))]


def errors(conic: Conic, position: Vector, velocity: Vector) -> tuple[float, float]:
    """Of a result, relative to the sizes of position and velocity."""
    return _apart(exact(conic.position, conic.velocity, conic.mu, conic.duration), (position, velocity))


def half_ulp(conic: Conic) -> tuple[float, float]:
    """The largest change of position and of velocity, relatively, by half a unit in the last place of one input."""
    given = [*conic.position, *conic.velocity, conic.mu, conic.duration]
    base = exact(given[:3], given[3:6], *given[6:])
    changes = []
    with mp.workdps(DIGITS):
        for k, value in enumerate(given):
            moved = [mp.mpf(x) for x in given]
            moved[k] += mp.mpf(float(np.spacing(abs(value)))) / 2
            changes.append(_apart(base, exact(moved[:3], moved[3:6], *moved[6:])))
    return max(c[0] for c in changes), max(c[1] for c in changes)


def _apart(known: Sequence[Vector], found: Sequence[Vector]) -> tuple[float, float]:
    with mp.workdps(DIGITS):
        relative = []
        for a, b in zip(known, found, strict=True):
            difference = [x - mp.mpf(y) for x, y in zip(a, b, strict=True)]
            relative.append(float(mp.sqrt(_dot(difference, difference) / _dot(a, a))))
    return relative[0], relative[1]


def random_conics(count: int, seed: int) -> list[Conic]:
    """Of all kinds in turn, in all units and attitudes, from a ten-millionth of a revolution to several, both ways."""
    rng = np.random.default_rng(seed)
    return [_KINDS[k % len(_KINDS)](rng) for k in range(count)]


def _of_elements(rng: np.random.Generator, kind: str, e: float, anomaly: float, longest: float) -> Conic:
    """From eccentricity and true anomaly; the parameter, mu and the attitude are drawn."""
    p, mu = 10.0 ** rng.uniform(-3.0, 8.0), 10.0 ** rng.uniform(-2.0, 14.0)
    radius = p / (1.0 + e * np.cos(anomaly))
    place = radius * np.array([np.cos(anomaly), np.sin(anomaly), 0.0])
    pace = np.sqrt(mu / p) * np.array([-np.sin(anomaly), e + np.cos(anomaly), 0.0])
    return _turned(rng, kind, place, pace, mu, longest)


def _turned(
    rng: np.random.Generator, kind: str, place: np.ndarray, pace: np.ndarray, mu: float, longest: float
) -> Conic:
    """In a random attitude; ``longest`` is the decade of the longest duration, in times r / v or turns."""
    attitude, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    r, v = attitude @ place, attitude @ pace
    binding = 2.0 / np.linalg.norm(r) - v @ v / mu
    turn = 2.0 * np.pi / np.sqrt(mu * binding**3) if binding > 0.0 else np.inf
    unit = min(np.linalg.norm(r) / np.linalg.norm(v), turn)
    if binding > 0.0 and rng.random() < 0.5:
        duration = turn * rng.uniform(0.0, 5.0)
    else:
        duration = unit * 10.0 ** rng.uniform(-8.0, longest)
    return Conic(kind, tuple(r.tolist()), tuple(v.tolist()), float(mu), float(duration * rng.choice((-1.0, 1.0))))


def _any_ellipse(rng: np.random.Generator) -> Conic:
    return _of_elements(rng, "ellipse", rng.uniform(0.0, 0.95), rng.uniform(-np.pi, np.pi), 1.0)


def _nearly_circular(rng: np.random.Generator) -> Conic:
    return _of_elements(rng, "nearly circular", 10.0 ** rng.uniform(-17.0, -1.0), rng.uniform(-np.pi, np.pi), 1.0)


def _long_ellipse(rng: np.random.Generator) -> Conic:
    """Eccentricity near one, anywhere on it: drawn by the eccentric anomaly."""
    e, half = 1.0 - 10.0 ** rng.uniform(-9.0, -1.0), rng.uniform(-0.5, 0.5) * np.pi
    return _of_elements(rng, "long ellipse", e, 2.0 * np.arctan(np.sqrt((1.0 + e) / (1.0 - e)) * np.tan(half)), 1.0)


def _exact_parabola(rng: np.random.Generator) -> Conic:
    """Whole numbers, so that the energy is zero without any rounding: mu = r v^2 / 2, with r a whole number."""
    quadruples = (
        (3, 4, 0, 5),
        (2, 3, 6, 7),
        (1, 4, 8, 9),
        (2, 10, 11, 15),
        (1, 12, 12, 17),
        (8, 9, 12, 17),
        (1, 2, 2, 3),
    )
    chosen = quadruples[rng.integers(len(quadruples))]
    signs = rng.choice((-1.0, 1.0), size=3)
    place = rng.permutation(np.array(chosen[:3])) * signs * 2.0 ** rng.integers(-10, 20)
    pace = rng.integers(-200, 201, size=3) * 2.0 ** rng.integers(-10, 10)
    pace[0] += 0.5 * (pace == 0.0).all()
    mu = 0.5 * np.linalg.norm(place) * (pace @ pace)
    duration = np.linalg.norm(place) / np.linalg.norm(pace) * 10.0 ** rng.uniform(-8.0, 5.0) * rng.choice((-1.0, 1.0))
    return Conic("parabola", tuple(place.tolist()), tuple(pace.tolist()), float(mu), float(duration))


def _near_parabola(rng: np.random.Generator) -> Conic:
    e = 1.0 + rng.choice((-1.0, 1.0)) * 10.0 ** rng.uniform(-16.0, -3.0)
    return _of_elements(rng, "near a parabola", e, rng.uniform(-3.1, 3.1) if e < 1.0 else rng.uniform(-2.9, 2.9), 4.0)


def _any_hyperbola(rng: np.random.Generator) -> Conic:
    """Also from afar: the distance is drawn by its logarithm."""
    e = 1.0 + 10.0 ** rng.uniform(-3.0, 2.0)
    farther = 10.0 ** rng.uniform(0.0, 6.0)  # 1 + e cos(anomaly) is (1 + e) / farther
    anomaly = rng.choice((-1.0, 1.0)) * np.arccos(((1.0 + e) / farther - 1.0) / e)
    return _of_elements(rng, "hyperbola", e, anomaly, 4.0)


def _near_radial(rng: np.random.Generator) -> Conic:
    """Hardly any angular momentum, with any energy; both ways along the line."""
    mu, radius = 10.0 ** rng.uniform(-2.0, 14.0), 10.0 ** rng.uniform(-3.0, 8.0)
    speed = np.sqrt(2.0 * mu / radius) * rng.choice((rng.uniform(0.05, 0.99), 1.0, rng.uniform(1.01, 5.0)))
    tilt = 10.0 ** rng.uniform(-9.0, -2.0)
    pace = speed * np.array([rng.choice((-1.0, 1.0)) * np.cos(tilt), np.sin(tilt), 0.0])
    return _turned(rng, "nearly radial", np.array([radius, 0.0, 0.0]), pace, mu, 2.0)


_KINDS = (
    *(_any_ellipse, _nearly_circular, _long_ellipse, _exact_parabola),
    *(_near_parabola, _any_hyperbola, _near_radial),
)
