"""What a means of solving again and again offers: collocation as it stands, or compiled shooting."""

from __future__ import annotations

from typing import Protocol

from satsym.instance import Instance
from satsym.solvers.collocation.extremal import Extremal
from satsym.solvers.iteration import Limits


class Means(Protocol):
    """Finds extremals of instances that differ in initial state and parameters; remembers the last good one."""

    name: str

    def near(self, case: Instance, limits: Limits) -> Extremal | None:
        """The extremal near the last good one; ``None`` if there is none of either."""

    def straight(self, case: Instance, limits: Limits) -> Extremal | None:
        """The one to which a straight line leads, if that leads to a minimum without bounds at once."""

    def cold(self, case: Instance, limits: Limits) -> Extremal:
        """What comes of a cold start."""

    def full(self, found: Extremal, limits: Limits) -> Extremal:
        """An extremal that was found, with everything an answer in full has."""
