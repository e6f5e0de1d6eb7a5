"""Kepler motion in closed form, on every conic, by which integrators are checked.

With the universal anomaly s, dt = r ds, the equations become linear (Levi-Civita, Sundman). In the plane of the orbit,
position and velocity are z^2 and 2 z z'/|z|^2 of a complex z(s) that swings at half the frequency w = sqrt(binding),
binding = 2 mu/r - v^2. One formula serves ellipse, parabola and hyperbola, and |z|^2 = r: nothing cancels in z^2 as it
does in the f and g of textbooks (Battin, An Introduction to the Mathematics and Methods of Astrodynamics, 4.5-4.6,
whose U functions at s/2 are ``cosine`` and ``sine`` here). Kepler's equation is solved by Laguerre's iteration (Conway,
Celestial Mechanics 39, 1986) within a bracket. Where the motion first goes inward from afar, s counts from periapsis,
for from the start its terms would cancel. Energy, momentum and whole revolutions are computed with 32 digits.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from math import factorial
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from satsym.analysis.orbits import double_double as dd
from satsym.analysis.orbits.states import States, checked, refuse_first
from satsym.arrays import Array

BLOCK = 4096
"""Number of columns computed at a time, so that intermediate arrays stay in the cache."""

SERIES = tuple(1.0 / factorial(2 * k + 3) for k in range(11))
SERIES_REACH = 4.0
"""Largest (w s)^2 for which the power series is used: its next term is below 1e-17 of the first."""

MOST_ITERATIONS = 60
LAST_CHANGE = 1e-7
"""Relative change after which the iteration ends, since the next one, of third order, is below rounding."""
SLACK = 1.0 + 1e-9
"""Factor by which upper bounds are increased, because they are computed with rounding."""
INNER = 0.5
"""Fraction of mu above which mu - binding r makes inward motion count from periapsis: r < a/2, or no ellipse."""

PI = (np.pi, 1.2246467991473532e-16)
"""The number pi with 32 digits, as head and tail."""

Bools: TypeAlias = NDArray[np.bool_]
Complex: TypeAlias = NDArray[np.complex128]


def propagate(position: ArrayLike, velocity: ArrayLike, mu: ArrayLike, duration: ArrayLike) -> tuple[Array, Array]:
    """Compute position and velocity after a time, in closed form.

    Parameters
    ----------
    position, velocity
        Shape (3, ...), in any consistent units, such as km and km/s.
    mu
        Gravitational parameter of the centre, such as in km**3/s**2; shape (...).
    duration
        Length of time, which may be negative, or many revolutions; shape (...). All trailing shapes are broadcast.

    Returns
    -------
    position, velocity : arrays of shape (3, ...)

    Raises
    ------
    BadInput
        Where the start is the centre itself, mu is not positive, a number is not finite, or the motion is exactly
        radial and meets the centre within the duration. For arrays the message names the first such index.

    Examples
    --------
    >>> position, velocity = propagate((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), 1.0, np.pi)
    >>> position.round(12) + 0.0
    array([-1.,  0.,  0.])
    """
    given = checked(position, velocity, mu, duration)
    states, length, speed = given.scaled()
    positions, velocities = np.empty(states.position.shape), np.empty(states.velocity.shape)
    collides = np.zeros(states.mu.shape, bool)
    with np.errstate(all="ignore"):
        for begin in range(0, states.mu.size, BLOCK):
            part = slice(begin, begin + BLOCK)
            positions[:, part], velocities[:, part], collides[part] = _block(states.part(part))
        positions, velocities = positions * length, velocities * speed
    refuse_first(collides, given.shape, "the motion is radial and meets the centre; shorten the duration")
    lost = ~(np.isfinite(positions).all(axis=0) & np.isfinite(velocities).all(axis=0))
    refuse_first(
        lost, given.shape, "the motion exceeds the range of floating-point numbers; check the units and the duration"
    )
    return positions.reshape(3, *given.shape), velocities.reshape(3, *given.shape)


@dataclass(frozen=True, eq=False)
class _Motion:
    """The scalars of the start of a Kepler motion, shape (N,), and the time to propagate."""

    radius: Array
    rate: Array
    """Distance r, and r r_dot: the scalar product of position and velocity."""
    momentum: Array
    """Size of the angular momentum."""
    binding: Array
    """The number 2 mu/r - v^2: minus twice the energy."""
    mu: Array
    duration: Array

    def part(self, chosen: Bools) -> _Motion:
        return _Motion(*(getattr(self, f.name)[chosen] for f in fields(self)))


def _block(given: States) -> tuple[Array, Array, Bools]:
    """Return position and velocity after a time, and whether they lie behind a collision with the centre."""
    r, v, mu = given.position, given.velocity, given.mu
    zero = np.zeros_like(mu)
    radius = dd.root(dd.dot(r, r))
    binding = dd.add(dd.divide((2.0 * mu, zero), radius), dd.negative(dd.dot(v, v)))
    momentum = dd.cross(r, v)
    size = np.hypot(np.hypot(momentum[0], momentum[1]), momentum[2])
    duration, turned = _within_a_turn(given.duration, mu, binding)
    motion = _Motion(radius[0], dd.dot(r, v)[0], size, binding[0], mu, duration)

    place, pace = np.empty(mu.shape, complex), np.empty(mu.shape, complex)
    collides = np.zeros(mu.shape, bool)
    elliptic = binding[0] > 0.0
    for chosen, waves in ((elliptic, _circular), (~elliptic, _hyperbolic)):
        if chosen.any():
            place[chosen], pace[chosen], collides[chosen] = _fly(motion.part(chosen), waves)
    collides = (size == 0.0) & (collides | turned)
    outward = r / radius[0]
    normal = momentum / np.where(size > 0.0, size, 1.0)
    across = np.cross(normal, outward, axis=0)
    still = given.duration == 0.0
    return (
        np.where(still, r, place.real * outward + place.imag * across),
        np.where(still, v, pace.real * outward + pace.imag * across),
        collides & ~still,
    )


def _within_a_turn(duration: Array, mu: Array, binding: dd.Pair) -> tuple[Array, Bools]:
    """Reduce a duration by whole revolutions to at most half of one, and tell whether there were any."""
    zero = np.zeros_like(mu)
    period = dd.divide(dd.multiply((2.0 * PI[0], 2.0 * PI[1]), (mu, zero)), dd.multiply(binding, dd.root(binding)))
    turns = np.where(binding[0] > 0.0, np.rint(duration / period[0]), 0.0)
    turned = np.isfinite(turns) & (turns != 0.0)
    whole = dd.multiply((turns, zero), period)
    return np.where(turned, dd.add((duration, zero), dd.negative(whole))[0], duration), turned


Waves: TypeAlias = Callable[[Array, Array], tuple[Array, Array]]
"""Functions from w and s to cos(w s/2) and sin(w s/2)/w, or to the hyperbolic ones: U functions of half the anomaly."""


def _circular(w: Array, s: Array) -> tuple[Array, Array]:
    half = 0.5 * s
    return np.cos(w * half), np.sin(w * half) / w


def _hyperbolic(w: Array, s: Array) -> tuple[Array, Array]:
    half = 0.5 * s
    return np.cosh(w * half), np.where(w > 0.0, np.sinh(w * half) / w, half)


def _fly(start: _Motion, waves: Waves) -> tuple[Complex, Complex, Bools]:
    """Return position and velocity in the plane of the orbit, and which motions meet the centre.

    Real parts are along the radius of the start. Only radial motions meet the centre.
    """
    mu, binding, duration = start.mu, start.binding, start.duration
    w = np.sqrt(np.abs(binding))
    excess = mu - binding * start.radius  # mu e cos E
    parameter = start.momentum**2 / mu
    if waves is _circular:
        e = np.hypot(excess, w * start.rate) / mu
        since = np.arctan2(w * start.rate, excess) / w
        period = 2.0 * np.pi * mu / w**3
    else:
        e = np.sqrt(1.0 + w**2 * parameter / mu)
        steep = start.rate / (mu * e)
        since = np.where(w > 0.0, np.arcsinh(w * steep) / w, steep)
        period = np.full_like(w, np.inf)
    periapsis = parameter / (1.0 + e)
    then_cosine, then_sine = waves(w, since)
    time = periapsis * since + mu * e * _third(binding, since, then_cosine, then_sine)

    inward = (start.rate * duration < 0.0) & (excess > INNER * mu)
    left = np.where(inward, time + duration, duration)
    left = np.where(np.abs(left) > 0.5 * period, left - np.copysign(period, left), left)
    base = _Motion(
        np.where(inward, periapsis, start.radius),
        np.where(inward, 0.0, start.rate),
        start.momentum,
        binding,
        mu,
        np.abs(left),
    )
    sense = np.where(left < 0.0, -1.0, 1.0)
    s = sense * _anomaly(base, sense * base.rate, w, waves)

    along = np.sqrt(base.radius)
    swing = np.where(inward, 0.0, start.rate / along)
    sideways = np.where(inward, np.sqrt(mu * (1.0 + e)), start.momentum / along)
    cosine, sine = waves(w, s)
    z = along * cosine + swing * sine + 1j * (sideways * sine)
    z_rate = 0.5 * (swing * cosine - binding * along * sine + 1j * (sideways * cosine))
    z_start = along * then_cosine + 1j * (sideways * then_sine)
    back: Complex = np.where(inward, z_start.conj() ** 2 / _square(z_start), 1.0)

    ahead = -time if waves is _hyperbolic else np.where(time * duration < 0.0, -time, np.copysign(period, time) - time)
    meets = (ahead * duration >= 0.0) & (np.abs(duration) >= np.abs(ahead))
    return back * z**2, back * (2.0 * z * z_rate / _square(z)), meets


def _square(z: Complex) -> Array:
    return z.real**2 + z.imag**2


def _third(binding: Array, s: Array, cosine: Array, sine: Array) -> Array:
    """Return the universal function U3: (w s - sin(w s)) / w^3, (sinh(w s) - w s) / w^3, or s^3 / 6 between them."""
    square = binding * s * s
    value = np.full_like(s, SERIES[-1])
    for term in SERIES[-2::-1]:
        value = term - square * value
    return np.where(np.abs(square) < SERIES_REACH, s * s * s * value, (s - 2.0 * sine * cosine) / binding)


def _anomaly(start: _Motion, rate: Array, w: Array, waves: Waves) -> Array:
    """Return the s >= 0 at which radius U1 + rate U2 + mu U3 is the duration, which is not negative."""
    radius, mu, binding, duration = start.radius, start.mu, start.binding, start.duration
    low, (s, high) = np.zeros_like(mu), (_bounds if waves is _circular else _open_bounds)(start, rate, w)
    for _ in range(MOST_ITERATIONS):
        cosine, sine = waves(w, s)
        first, second = 2.0 * sine * cosine, 2.0 * sine * sine
        zeroth = 1.0 - binding * second
        excess = radius * first + rate * second + mu * _third(binding, s, cosine, sine) - duration
        slope = radius * zeroth + rate * first + mu * second
        bend = rate * zeroth + (mu - binding * radius) * first
        step = 5.0 * excess / (slope + np.sqrt(np.abs(16.0 * slope * slope - 20.0 * excess * bend)))
        low, high = np.where(excess < 0.0, s, low), np.where(excess > 0.0, s, high)
        moved = s - step
        safe = (moved >= low) & (moved <= high)
        settled = np.abs(step) <= LAST_CHANGE * s
        s = np.where(safe | settled, moved, 0.5 * (low + high))
        if settled.all():
            break
    return s


def _bounds(start: _Motion, rate: Array, w: Array) -> tuple[Array, Array]:
    """Return the initial guess of Kepler's equation on an ellipse, for at most half a revolution, and an upper bound.

    Outward from the start, no term of Kepler's equation is negative, and w s is at most half a turn. There each of the
    three bounds s; together they leave a factor of a few.
    """
    mu, duration, axis = start.mu, start.duration, start.mu / start.binding
    least = np.minimum(duration / np.minimum(start.radius, axis), np.cbrt(np.pi**2 * duration / mu))
    least = np.minimum(least, np.pi / w)
    outward = SLACK * np.where(rate > 0.0, np.minimum(least, np.pi * np.sqrt(0.5 * duration / rate)), least)
    inward = (w**3 * duration / mu + 2.0) / w
    return np.where(rate < 0.0, duration / start.radius, outward), np.where(rate < 0.0, inward, outward)


def _open_bounds(start: _Motion, rate: Array, w: Array) -> tuple[Array, Array]:
    """Return the initial guess of Kepler's equation on an open orbit, outward, and an upper bound by its terms."""
    duration, mean = start.duration, w**3 * start.duration / start.mu
    cubic = np.cbrt(6.0 * duration / start.mu)
    flat = np.minimum(duration / start.radius, cubic)
    steep = np.minimum(np.arcsinh(w * duration / start.radius), np.arcsinh(mean + np.cbrt(6.0 * mean)))
    bound = np.where(w > 0.0, np.minimum(steep / w, cubic), flat)
    root = np.sqrt(0.5 * duration / rate)
    quadratic = np.where(w > 0.0, 2.0 * np.arcsinh(w * root) / w, 2.0 * root)
    bound = SLACK * np.where(rate > 0.0, np.minimum(bound, quadratic), bound)
    return bound, bound
