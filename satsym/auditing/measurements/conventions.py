"""What sentences leave open, stated once: how near is "returns", how late is "in the end", how often is "swings"."""

from __future__ import annotations

import math

from satsym.auditing.constants import PUBLISHED
from satsym.auditing.quantities import Quantity, in_base_units


def near() -> float:
    """A state is back, or stays, where it is no farther from its aim than this (relative where the aim exceeds 1)."""
    return 0.05


def often() -> int:
    """A curve goes up and down where it turns at least so often."""
    return 2


def years() -> list[Quantity]:
    """What is called a year: of the calendar, Julian, sidereal."""
    return [in_base_units(text) for text in ("365 d", "365.25 d", PUBLISHED["sidereal_year"])]


def infinity() -> float:
    """Beyond all numbers."""
    return math.inf


def pi() -> float:
    """Half a turn."""
    return math.pi


def epsilons() -> list[float]:
    """Distances from an equilibrium within which motions are to stay."""
    return [1e-2, 1.0, 1e2]


def deltas() -> list[float]:
    """Distances from an equilibrium at which motions start: far smaller and far larger ones than :func:`epsilons`."""
    return [1e-6, 1e-3, 1.0, 1e3, 1e6]


def halved() -> list[float]:
    """Steps that go to zero, each half of the one before, for limits."""
    return [2.0**-k for k in range(6, 12)]
