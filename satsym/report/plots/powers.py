"""Ticks with their own power of ten, instead of one at the end of the axis. Loads matplotlib."""

from __future__ import annotations

import math
from collections.abc import Iterable

from matplotlib.ticker import ScalarFormatter

from satsym.report.display import number, times_ten_to
from satsym.report.said import decimal

PLAIN = 1e-3, 1e6
"""Range of the largest tick within which ticks are printed without a power of ten."""


class WithPowers(ScalarFormatter):
    """A formatter for numbers such as 2 × 10⁻¹²; short numbers are plain."""

    def __init__(self) -> None:
        super().__init__(useOffset=False)
        self.set_scientific(False)
        self._power = 0

    def set_locs(self, locs: Iterable[float]) -> None:
        """Take all ticks, which matplotlib passes before it requests the text of each."""
        places = list(locs)
        super().set_locs(places)
        largest = max((abs(place) for place in places), default=0.0)
        plain = largest == 0.0 or PLAIN[0] <= largest < PLAIN[1]
        self._power = 0 if plain else math.floor(math.log10(largest))

    def __call__(self, x: float, pos: int | None = None) -> str:
        """Return the text of a tick."""
        if not self._power:
            return decimal(str(super().__call__(x, pos)))
        return decimal(number(x / 10.0**self._power, 4)) + times_ten_to(self._power) if x else "0"
