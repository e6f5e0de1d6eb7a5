"""Times at which a control reaches or leaves a bound: the zeros of the distance of the unbounded control from it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from satsym.arrays import Array

MOST_STEPS = 100
LAST_DIGITS = 1e-15

STENCIL = 5
"""Number of points of the polynomial that interpolates a function near a zero."""

TURNS, TOWARDS = 8, 0.5
"""Maximum number of parabolas through three points, and the value of a parabola's minimum, relative to the smallest
known value, below which the function may have zeros nearby."""

BEYOND_ZERO = 1e-11
"""Magnitude of a function beyond zero, relative to its largest magnitude, below which it counts as rounding."""


def zeros(times: Array, values: Array) -> list[float]:
    """Return the times at which a function changes its sign, by local interpolation.

    Parameters
    ----------
    times
        Increasing times, shape (M,).
    values
        Values of the function, shape (M,). Exact zeros count if the signs on both sides differ.

    Returns
    -------
    Increasing times, strictly inside the interval.
    """
    sign = np.sign(values)
    found = [float(times[k]) for k in np.flatnonzero(sign[1:-1] == 0) + 1 if sign[k - 1] * sign[k + 1] < 0]
    for k in np.flatnonzero(sign[:-1] * sign[1:] < 0):
        first = int(np.clip(k - STENCIL // 2 + 1, 0, max(len(times) - STENCIL, 0)))
        found.append(_zero(times[first : first + STENCIL], values[first : first + STENCIL], times[k], times[k + 1]))
    return sorted(found)


def beyond(function: Callable[[float], float], times: Array, values: Array) -> list[float]:
    """Return times at which a function briefly has the opposite sign between points where its sign is the same.

    If the function approaches zero and turns, its extremum is searched for by parabolas.

    Parameters
    ----------
    times, values
        Increasing times and the values of the function, shape (M,).
    """
    sign, size = np.sign(values), np.abs(values)
    known = size[np.isfinite(size)]
    floor = BEYOND_ZERO * float(known.max(initial=0.0))
    alike = (sign[:-2] == sign[1:-1]) & (sign[2:] == sign[1:-1]) & (size[1:-1] <= np.minimum(size[:-2], size[2:]))
    found = []
    for k in np.flatnonzero(alike & np.isfinite(size[:-2]) & np.isfinite(size[2:])) + 1:
        points = list(zip(times[k - 1 : k + 2].tolist(), size[k - 1 : k + 2].tolist(), strict=True))
        for _ in range(TURNS):
            vertex = _vertex(points)
            if vertex is None:
                break
            at = float(sign[k]) * function(vertex)
            if at < -floor:
                found.append(vertex)
                break
            points = _around(points, (vertex, at))
    return found


def _vertex(points: list[tuple[float, float]]) -> float | None:
    """Return the minimum point of the parabola through three points; ``None`` if it is far from zero or known."""
    (a, at_a), (b, at_b), (c, at_c) = points
    left, right = (at_a - at_b) / (b - a), (at_c - at_b) / (c - b)
    curved = left + right
    if not curved > 0.0:
        return None
    slope = (right * (b - a) - left * (c - b)) / (c - a)
    move = -slope * (c - a) / (2.0 * curved)
    least = at_b + slope * move / 2.0
    return b + move if least < TOWARDS * at_b and a < b + move < c and move else None


def _around(points: list[tuple[float, float]], new: tuple[float, float]) -> list[tuple[float, float]]:
    """Return three neighbouring points about the smallest one, out of three and a new one."""
    ordered = sorted([*points, new])
    least = min((1, 2), key=lambda k: ordered[k][1])
    return ordered[least - 1 : least + 2]


def enclosed(
    function: Callable[[Array], Array],
    low: Array,
    high: Array,
    at_low: Array,
    at_high: Array,
    within: float = LAST_DIGITS,
) -> Array:
    """Return the zeros of continuous functions in intervals with a change of sign, shape (K,).

    The method uses secant steps that keep each zero enclosed (Anderson and Bjorck), for all functions at once.
    Importing the library function for this purpose would take several times longer than solving.

    Parameters
    ----------
    function
        Function that returns the value of each function at its own time, from shape (K,) to (K,).
    at_low, at_high
        Values of the functions at both ends of the intervals.
    within
        Length of the last step, relative to the time, or absolute below 1; by default rounding.
    """
    left = np.ones(len(low), dtype=bool)
    for _ in range(MOST_STEPS):
        left &= (at_high != 0.0) & (high != low)
        if not left.any():
            break
        rise = np.where(left, at_high - at_low, 1.0)
        between = np.where(left, high - at_high * (high - low) / rise, high)
        value = np.where(left, function(between), at_high)
        crossed = left & (value * at_high < 0.0)
        share = 1.0 - value / np.where(left, at_high, 1.0)
        lessened = at_low * np.where(left, np.where(share > 0.0, share, 0.5), 1.0)
        low, at_low = np.where(crossed, high, low), np.where(crossed, at_high, lessened)
        moved = np.abs(between - high)
        high, at_high = between, value
        left &= moved > within * np.maximum(np.abs(high), 1.0)
    return high


def _zero(times: Array, values: Array, low: float, high: float) -> float:
    """Return the zero in [low, high] of the polynomial through given points; the signs at both ends differ."""
    width = high - low
    nodes = (times - low) / width
    coefficients = np.polynomial.polynomial.polyfit(nodes, values, len(nodes) - 1)
    roots = np.polynomial.polynomial.polyroots(coefficients)
    inside = [r.real for r in roots if abs(r.imag) < 1e-9 and -1e-9 <= r.real <= 1.0 + 1e-9]
    if not inside:
        a, b = np.interp([0.0, 1.0], nodes, values)
        inside = [a / (a - b)]
    return float(low + width * min(max(inside[0], 0.0), 1.0))
