"""One set of a product of control sets, as plain data, and how H is minimised over it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

PartKind = Literal["free", "box", "ball", "annulus", "angle"]
Branch = Literal["quadratic", "stationary", "direction", "throttled", "switched"]
"""The way in which H is minimised over one set of controls: at a zero of H_u, where H is quadratic or not; along a
direction; along a direction if that gains more than the norm of the controls costs, and else at zero; or, for a single
control in which H is linear, at the bound towards which H falls."""
DIRECTED = ("direction", "throttled", "switched")
SWITCHED = ("throttled", "switched")
"""Branches in which a norm, or the control itself, switches between two levels."""


@dataclass(frozen=True)
class ControlPart:
    """One set of a product of control sets.

    Attributes
    ----------
    name
        Name of the set in instances.
    kind
        Kind of the set.
    controls
        Names of the controls, in order.
    branch
        The way in which H is minimised over the set.
    ends
        Whether H may be least at an end without falling to it, so that there must be ends.
    turned_by
        Name of the angle that turns what the control multiplies, if the control is a magnitude; else empty.
    """

    name: str
    kind: PartKind
    controls: tuple[str, ...]
    branch: Branch
    ends: bool = False
    turned_by: str = ""

    @property
    def bounds(self) -> int:
        """Return how many numbers of the argument ``bounds`` belong to this set."""
        return {"free": 0, "box": 2 * len(self.controls), "ball": 1, "annulus": 2, "angle": 1}[self.kind]

    @property
    def directed(self) -> bool:
        """Tell whether the controls of the set are a direction."""
        return self.branch in DIRECTED

    @property
    def normed(self) -> bool:
        """Tell whether the set limits a norm."""
        return self.kind in ("ball", "annulus")
