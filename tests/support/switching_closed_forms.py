"""What is known in closed form about a body on a line with bounded acceleration; its shipped instances, changed."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from satsym import instance
from satsym.instance import Instance

TIME, FUEL = "double-integrator-time", "double-integrator-fuel"


def case(name: str, **changes: Any) -> Instance:
    """A shipped instance with other numbers."""
    return replace(instance.load(name), **changes)


def starts(count: int) -> list[tuple[float, float]]:
    """Random initial states."""
    rows: list[list[float]] = np.random.default_rng(7).uniform(-5.0, 5.0, (1000, 2)).tolist()
    return [(q, v) for q, v in rows[:count]]


@dataclass(frozen=True)
class Known:
    """An optimum.

    Attributes
    ----------
    cost, duration
        Its cost and how long it takes.
    switches
        When the control changes.
    levels
        Its values one after the other.
    """

    cost: float
    duration: float
    switches: tuple[float, ...]
    levels: tuple[float, ...]


def minimum_time(q: float, v: float) -> Known:
    """To rest at the origin with |u| <= 1.

    Above the curve q = -v|v|/2, on which one arc leads to the origin, the control is -1 until the curve is met.
    There q + v t - t^2/2 = (v - t)^2/2, so t = v + s with s = sqrt(q + v^2/2), and s more to the origin. Below, by
    symmetry, with the signs changed.
    """
    side = 1.0 if q + v * abs(v) / 2.0 > 0.0 else -1.0
    s = math.sqrt(side * q + v * v / 2.0)
    first = side * v + s
    return Known(first + s, first + s, (first,), (-side, side))


def least_fuel(q: float, v: float, duration: float) -> Known | None:
    """To rest at the origin in a given time with |u| <= 1: a burn, a coast, and a burn the other way.

    A first burn of -1 for a time a leaves the velocity v - a = -b, which the last burn takes off in a time b. The
    way is q + v a - a^2/2 - b (T - a - b) - b^2/2 = 0, a quadratic equation for a. By symmetry for the other sign.
    ``None`` where no such control arrives, or not this kind of control is the best.
    """
    for side in (1.0, -1.0):
        x, w = side * q, side * v
        # with b = a - w:  a^2 - (T + w) a + x + w T + w^2/2 = 0
        half = (duration + w) / 2.0
        root = half * half - (x + w * duration + w * w / 2.0)
        if root <= 0.0:
            continue
        a = half - math.sqrt(root)
        b = a - w
        if a > 0.0 and b > 0.0 and a + b < duration:
            return Known(a + b, duration, (a, duration - b), (-side, 0.0, side))
    return None


def moving_arrivals(start: tuple[float, ...], end: tuple[Any, Any], low: float, high: float) -> list[float]:
    """Durations of all controls of one switch between two bounds that lead to a moving end, the shortest first.

    With u until the velocity is w, and u' from there, the way is (w^2 - v^2)/(2u) + (v'^2 - w^2)/(2u'): w follows up to
    its sign, and the times (w - v)/u and (v' - w)/u' must not be negative.
    """
    found = []
    (q, v), (goal, last) = start, end
    for first, then in ((low, high), (high, low)):
        squared = (goal - q + v * v / (2.0 * first) - last * last / (2.0 * then)) / (0.5 / first - 0.5 / then)
        for turning in (math.sqrt(squared), -math.sqrt(squared)) if squared >= 0.0 else ():
            times = (turning - v) / first, (last - turning) / then
            found += [sum(times)] if min(times) >= 0.0 else []
    return sorted(found)
