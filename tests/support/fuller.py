"""Fuller's problem in closed form, the force between any two bounds: x'' = u in [-a, b], the least integral of x^2.

The problem is the same in all sizes: with x' smaller by q and x by q^2 it takes q of the time and costs q^5. So the
force switches where x is a multiple of x'^2, and speeds at switches become smaller by two ratios in turn. With
c = a |x|/x'^2 where -a begins, r the ratio of the speed where it ends, and c', r' the same of b, the costates say

    c = (1 + r) (1 - sqrt(r/3))/2,   and from the position   (1 - r^2)/2 - c = a/b c' r^2,

once for each bound: lambda2 vanishes at both ends of an arc, and with it H = x^2 + lambda1 x' there.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

import numpy as np
from numpy.polynomial import Polynomial
from scipy.optimize import brentq


def spent(position: float, velocity: float, force: float, duration: float) -> float:
    """The integral of the squared position under a constant force."""
    return float((Polynomial([position, velocity, force / 2.0]) ** 2).integ()(duration))


def coefficient(ratio: float) -> float:
    """By which square of the speed, over the force that begins, a position is one of a switch."""
    return (1.0 + ratio) * (1.0 - sqrt(ratio / 3.0)) / 2.0


def ratios(a: float, b: float) -> tuple[float, float]:
    """By how much the speed is smaller after an arc at -a, and after one at b."""

    def off(ratio: float, other: float, share: float) -> float:
        return (1.0 - ratio**2) / 2.0 - coefficient(ratio) - share * coefficient(other) * ratio**2

    def before(other: float) -> float:
        return float(brentq(off, 1e-12, 1.0 / 3.0, args=(other, a / b), xtol=1e-16, rtol=1e-14))

    then = float(brentq(lambda r: off(r, before(r), b / a), 1e-12, 1.0 / 3.0, xtol=1e-16, rtol=1e-14))
    return before(then), then


@dataclass(frozen=True)
class Least:
    """The optimum: its cost, its first switching times, and when the body is at rest."""

    cost: float
    times: list[float]
    over: float


def least(position: float, velocity: float, a: float = 1.0, b: float = 1.0) -> Least:
    """From where the force is to be -a at first."""
    r, then = ratios(a, b)
    switch = coefficient(then) / b
    speed = sqrt((velocity**2 / (2.0 * a) + position) / (0.5 / a + switch))
    first, lengths, cycle = (velocity + speed) / a, ((1.0 + then) / b, then * (1.0 + r) / a), r * then
    cost = spent(switch, -1.0, b, lengths[0])
    cost += spent(-coefficient(r) / a * then**2, then, -a, lengths[1])
    times = np.cumsum([first, *(speed * cycle**k * length for k in range(4) for length in lengths)])
    whole = spent(position, velocity, -a, first) + cost * speed**5 / (1.0 - cycle**5)
    return Least(whole, times.tolist(), first + speed * sum(lengths) / (1.0 - cycle))
