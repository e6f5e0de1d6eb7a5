"""The meaning of "equal": two routes lead to the same number, however many digits are computed.

Rounding leaves two numbers that are equal a small distance apart. How small depends on the terms that cancel on the
way, so that no fixed limit tells it from a mistake. It does shrink with the digits of the computation, and a mistake
does not. Numbers that agree to 40 of 60 digits are equal. Any others are computed again with twice the digits:

- they differ if their difference stays what it was;
- they are equal as soon as they agree to 40 digits, or both vanish as the digits grow;
- as long as neither is the case, the digits are doubled, up to :data:`MOST_DIGITS`: the distance shrinks, or rounding
  made it small by chance the time before.

A mistake is seen if it changes the result by more than 1e-40 of it. That many digits are needed: a term may be 1e-9 of
its sum, be wrong by 1e-6 of itself, and act on the result by the square of that, as a control does on the Hamiltonian
that it minimises. Symbolic steps and generated text are held to this rule.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any, TypeAlias

DIGITS = 60
"""Decimal digits with which numbers are computed first."""

MOST_DIGITS = 4 * DIGITS
"""Most decimal digits with which numbers are computed."""

LIMIT = 1e-40
"""Largest distance of equal numbers, relative to the larger one: two thirds of the digits."""

NEGLIGIBLE_FRACTION, NEGLIGIBLE_SIZE = 1e-60, 1e-240
"""Numbers below the first, times the largest number beside them, or below the second count as zero.

Differences do not resolve the one, and decimals that cancel leave the other.
"""

SIZE_DECAY, DIFFERENCE_DECAY = 0.4, 1.0 / 6.0
"""Least powers of ten, as shares of the digits, by which rounding shrinks when the digits have been doubled.

They are half of them in arithmetic, and a third of that in routes that lose digits as they gain some.
"""

SETTLED_CHANGE = 1e-2
"""Largest share of itself by which a difference that is no rounding changes when the digits are doubled."""

LARGEST_SIZE = 3000
"""Most digits before the decimal point of numbers that are differentiated."""

Sides: TypeAlias = tuple[Sequence[Any], Sequence[Any]]


def disagreement(sides: Callable[[int], Sides]) -> float:
    """Return how far the numbers of two routes are apart, relative to their size.

    It is at most :data:`LIMIT` where all are equal.

    Parameters
    ----------
    sides
        Digits -> the numbers of both routes, computed with these digits from the same exact arguments.

    Returns
    -------
    The largest relative distance; NaN where a number is none.
    """
    digits, worst = DIGITS, 0.0
    before: dict[int, tuple[Any, Any]] | None = None  # difference and size
    while True:
        pairs = list(zip(*sides(digits), strict=True))
        faint = max(NEGLIGIBLE_FRACTION * max((_size(*pair) for pair in pairs), default=0), NEGLIGIBLE_SIZE)
        still: dict[int, tuple[Any, Any]] = {}
        for k in range(len(pairs)) if before is None else before:
            difference, size = pairs[k][0] - pairs[k][1], _size(*pairs[k])
            gap = abs(difference)
            if not gap < math.inf:
                return math.nan
            if gap <= faint:
                continue
            if gap <= LIMIT * size:
                worst = max(worst, float(gap / size))
            elif before is None:
                still[k] = difference, size
            elif gap > abs(before[k][0]) * 10.0 ** (-DIFFERENCE_DECAY * digits):
                if digits >= MOST_DIGITS or abs(difference - before[k][0]) <= SETTLED_CHANGE * gap:
                    return float(gap / size)
                still[k] = difference, size
            elif size > before[k][1] * 10.0 ** (-SIZE_DECAY * digits):
                still[k] = difference, size
        if not still or digits >= MOST_DIGITS:
            return worst
        before, digits = still, 2 * digits


def equal(sides: Callable[[int], Sides]) -> bool:
    """Tell whether two routes lead to the same numbers."""
    return disagreement(sides) <= LIMIT


def slopes(function: Callable[[Any], Sequence[Any]]) -> list[Any]:
    """Return numeric derivatives at zero of a vector function of one number, by central differences.

    Where the function is large, more digits are used. NaN where it is so large that rounding hides its changes.
    """
    import mpmath as mp

    digits = mp.mp.dps
    with mp.workdps(3 * digits):
        h = mp.mpf(10) ** (-digits)
        sides = [function(h), function(-h)]
        extra = max((mp.mag(v) for side in sides for v in side if mp.isfinite(v) and v), default=0) * 3 // 10
    if digits < extra < LARGEST_SIZE:
        with mp.workdps(3 * digits + extra):
            sides = [function(h), function(-h)]
    most = mp.mpf(10) ** (digits + digits // 3 + (extra if extra < LARGEST_SIZE else 0))
    with mp.workdps(3 * digits):
        return [(a - b) / (2 * h) if abs(a) < most else mp.nan for a, b in zip(*sides, strict=True)]


def finite(values: Iterable[Any]) -> bool:
    """Tell whether all of these are finite numbers."""
    return all(abs(value) < math.inf for value in values)


def _size(one: Any, other: Any) -> Any:
    """Return the magnitude of the larger one of two numbers."""
    return max(abs(one), abs(other))
