"""Conventions for vague expressions in claims: the tolerance of "returns", the lateness of "in the end", etc."""

from __future__ import annotations

import math

from satsym.auditing.constants import PUBLISHED
from satsym.auditing.quantities import Quantity, in_base_units


def near() -> float:
    """Return the distance below which a state has reached its target; relative to the target if that exceeds 1."""
    return 0.05


def often() -> int:
    """Return the number of turning points from which a curve is said to oscillate."""
    return 2


def years() -> list[Quantity]:
    """Return the lengths of a year: calendar year, Julian year, sidereal year."""
    return [in_base_units(text) for text in ("365 d", "365.25 d", PUBLISHED["sidereal_year"])]


def infinity() -> float:
    """Return infinity."""
    return math.inf


def pi() -> float:
    """Return the number pi."""
    return math.pi


def epsilons() -> list[float]:
    """Return distances from an equilibrium within which motions have to stay for stability."""
    return [1e-2, 1.0, 1e2]


def deltas() -> list[float]:
    """Return initial distances from an equilibrium, both far below and far above those of :func:`epsilons`."""
    return [1e-6, 1e-3, 1.0, 1e3, 1e6]


def halved() -> list[float]:
    """Return a sequence of steps that tends to zero, each half of the one before, for limits."""
    return [2.0**-k for k in range(6, 12)]
