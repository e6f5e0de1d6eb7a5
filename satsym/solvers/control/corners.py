"""Where a control meets or leaves a bound: the zeros of its distance from the bound, were there none."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from satsym.arrays import Array

MOST_STEPS = 100
LAST_DIGITS = 1e-15

STENCIL = 5
"""Points of the polynomial through which a zero is found."""


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


def zero(function: Callable[[float], float], low: float, high: float) -> float:
    """The zero of a continuous function between two points where its signs differ, to the last digits.

    Secant steps that keep the zero enclosed (the Illinois method). The library function for this would cost an
    import several times longer than solving.
    """
    at_low, at_high = function(low), function(high)
    for _ in range(MOST_STEPS):
        if at_high == 0.0 or high == low:
            break
        between = high - at_high * (high - low) / (at_high - at_low)
        value = function(between)
        if value * at_high < 0.0:
            low, at_low = high, at_high
        else:
            at_low /= 2.0
        moved = abs(between - high)
        high, at_high = between, value
        if moved <= LAST_DIGITS * max(abs(high), 1.0):
            break
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
