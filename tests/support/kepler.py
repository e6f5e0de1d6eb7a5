"""Kepler motion in closed form, from the textbook and from nothing of satsym: what simulations are compared with.

Conventions as in Battin, An Introduction to the Mathematics and Methods of Astrodynamics, chapter 4. The angle counts
turns, so it can be compared as it stands.
"""

from __future__ import annotations

import math
from collections.abc import Callable

State = tuple[float, float, float, float]
"""(r, r_dot, theta, theta_dot) in the plane of the orbit."""

PARABOLIC = 1e-14
"""Energies within this of zero, relative to mu / r, are zero."""


def energy(mu: float, state: State) -> float:
    """Of the unit mass."""
    r, r_dot, _, theta_dot = state
    return 0.5 * (r_dot**2 + (r * theta_dot) ** 2) - mu / r


def angular_momentum(state: State) -> float:
    """Of the unit mass."""
    return state[0] ** 2 * state[3]


def eccentricity(mu: float, state: State) -> float:
    h = angular_momentum(state)
    return math.hypot(h**2 / (mu * state[0]) - 1.0, state[1] * h / mu)


def propagate(mu: float, start: State, duration: float) -> State:
    """The state after a time. The motion must not be radial.

    Parameters
    ----------
    mu
        Gravitational parameter.
    start
        State at the beginning.
    duration
        May be negative.
    """
    r, r_dot, theta, theta_dot = start
    if theta_dot < 0.0:  # its mirror image
        r, r_dot, theta, theta_dot = propagate(mu, (r, r_dot, -theta, -theta_dot), duration)
        return r, r_dot, -theta, -theta_dot
    h = angular_momentum(start)
    binding = 2.0 / r - (r_dot**2 + (r * theta_dot) ** 2) / mu  # 1/a
    if abs(binding) * r <= 2.0 * PARABOLIC:
        r, r_dot, turned = _parabola(mu, h, r * r_dot, duration)
    elif binding > 0.0:
        r, r_dot, turned = _ellipse(mu, h, 1.0 / binding, r, r_dot, duration)
    else:
        r, r_dot, turned = _hyperbola(mu, h, -1.0 / binding, r, r_dot, duration)
    return r, r_dot, theta + turned, h / r**2


def _ellipse(mu: float, h: float, a: float, r: float, r_dot: float, duration: float) -> tuple[float, float, float]:
    e_cos, e_sin = 1.0 - r / a, r * r_dot / math.sqrt(mu * a)
    e, before = math.hypot(e_cos, e_sin), math.atan2(e_sin, e_cos)
    mean = before - e_sin + math.sqrt(mu / a**3) * duration
    after = _root(lambda v: v - e * math.sin(v) - mean, lambda v: 1.0 - e * math.cos(v), mean - e, mean + e)
    r = a * (1.0 - e * math.cos(after))
    beta = e / (1.0 + math.sqrt(h**2 / (mu * a)))

    def true_anomaly(v: float) -> float:
        return v + 2.0 * math.atan2(beta * math.sin(v), 1.0 - beta * math.cos(v))

    return r, math.sqrt(mu * a) * e * math.sin(after) / r, true_anomaly(after) - true_anomaly(before)


def _hyperbola(mu: float, h: float, a: float, r: float, r_dot: float, duration: float) -> tuple[float, float, float]:
    e_sinh = r * r_dot / math.sqrt(mu * a)
    e = math.hypot(1.0, h / math.sqrt(mu * a))
    before = math.asinh(e_sinh / e)
    mean = e_sinh - before + math.sqrt(mu / a**3) * duration
    # e sinh F - F - (e - 1) F grows with F and is odd, hence a bracket; the other side is 0
    far = math.copysign(abs(mean) / (e - 1.0), mean)
    far = math.copysign(min(abs(far), math.asinh((abs(mean) + abs(far)) / e)), mean)
    after = _root(lambda v: e * math.sinh(v) - v - mean, lambda v: e * math.cosh(v) - 1.0, min(0.0, far), max(0.0, far))
    r = a * (e * math.cosh(after) - 1.0)
    slope = math.sqrt((e + 1.0) / (e - 1.0))
    turned = 2.0 * (math.atan(slope * math.tanh(after / 2.0)) - math.atan(slope * math.tanh(before / 2.0)))
    return r, math.sqrt(mu * a) * e * math.sinh(after) / r, turned


def _parabola(mu: float, h: float, r_r_dot: float, duration: float) -> tuple[float, float, float]:
    """By Barker's equation, D + D^3/3 = 2 sqrt(mu / p^3) t with D = tan(true anomaly / 2)."""
    p = h**2 / mu
    before = r_r_dot / h
    mean = before + before**3 / 3.0 + 2.0 * math.sqrt(mu / p**3) * duration
    # D + D^3/3 = m has the one real root 2 sinh(asinh(3 m / 2) / 3)
    after = 2.0 * math.sinh(math.asinh(1.5 * mean) / 3.0)
    r = p / 2.0 * (1.0 + after**2)
    return r, h * after / r, 2.0 * (math.atan(after) - math.atan(before))


def _root(function: Callable[[float], float], slope: Callable[[float], float], low: float, high: float) -> float:
    """The zero of an increasing function: Newton's method, with bisection where that leaves the bracket."""
    guess = 0.5 * (low + high)
    for _ in range(200):
        value = function(guess)
        step = value / slope(guess)
        if abs(step) <= 2e-16 * max(1.0, abs(guess)):
            return guess - step
        low, high = (low, guess) if value > 0.0 else (guess, high)
        guess = guess - step if low < guess - step < high else 0.5 * (low + high)
    return guess
