"""What sentences leave open, stated once: how near is "returns", how late is "in the end", how often is "swings"."""

from __future__ import annotations

import math

from satsym.auditing.constants import PUBLISHED
from satsym.auditing.measurements import value
from satsym.auditing.quantities import Quantity, in_base_units


@value
def near() -> float:
    """A state is back, or stays, where it is no farther from its aim than this (relative where the aim exceeds 1)."""
    return 0.05


@value
def often() -> int:
    """A curve goes up and down where it turns at least so often."""
    return 2


@value
def years() -> list[Quantity]:
    """What is called a year: of the calendar, Julian, sidereal."""
    return [in_base_units(text) for text in ("365 d", "365.25 d", PUBLISHED["sidereal_year"].quantity)]


@value
def pi() -> float:
    """Half a turn."""
    return math.pi
