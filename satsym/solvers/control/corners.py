"""Where a control meets or leaves a bound: the zeros of its distance from the bound, were there none."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from satsym.arrays import Array

MOST_STEPS = 100
LAST_DIGITS = 1e-15

STENCIL = 5
"""Points of the polynomial through which a zero is found."""

TURNS, TOWARDS = 8, 0.5
"""Parabolas that are laid through three points at most, and the share of the least value below which one has to lead
for the function to have zeros nearby."""

BEYOND_ZERO = 1e-11
"""Share of the largest value by which a function is beyond zero; less than that is rounding."""


def zeros(times: Array, values: Array) -> list[float]:
    """Times at which a function changes sign, by local interpolation.

    Parameters
    ----------
    times
        Shape (M,), increasing.
    values
        Shape (M,). Exact zeros count where the signs on both sides differ.

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
    """Times between others at which a function is beyond zero for a moment, having the same sign at these others.

    Where it comes near to zero and turns, its extremum is looked for by parabolas.

    Parameters
    ----------
    times, values
        Shape (M,), the former increasing.
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
    """Where the parabola through three points has its least value; ``None`` where that is far from zero, or known."""
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
    """Three points around the least, of three and one more."""
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
    """The zeros of continuous functions between points where the signs of each differ, shape (K,).

    Secant steps that keep each zero enclosed (the method of Anderson and Bjorck), all at once. The library function for
    this would cost an import several times longer than solving.

    Parameters
    ----------
    function
        The value of each at a time of its own, from shape (K,) to (K,).
    at_low, at_high
        Their values at the points.
    within
        Last step, by default in the last digits.
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
    """The zero in [low, high] of the polynomial through the points; the signs at its ends differ."""
    width = high - low
    nodes = (times - low) / width
    coefficients = np.polynomial.polynomial.polyfit(nodes, values, len(nodes) - 1)
    roots = np.polynomial.polynomial.polyroots(coefficients)
    inside = [r.real for r in roots if abs(r.imag) < 1e-9 and -1e-9 <= r.real <= 1.0 + 1e-9]
    if not inside:
        a, b = np.interp([0.0, 1.0], nodes, values)
        inside = [a / (a - b)]
    return float(low + width * min(max(inside[0], 0.0), 1.0))
