"""One of the sets whose product a control set is, as plain data, and how H is minimised over it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

PartKind = Literal["free", "box", "ball", "annulus", "angle"]
Branch = Literal["quadratic", "stationary", "direction", "throttled", "switched"]
"""How H is minimised over one set of controls: where H_u vanishes, on which it depends linearly or not; along a
direction, whatever it is; along one if that is worth more than the norm of the controls costs, and not at all
elsewhere; or, of a single control on which H depends linearly, at the bound to which it falls."""
DIRECTED = ("direction", "throttled", "switched")
SWITCHED = ("throttled", "switched")
"""Laws by which something switches between two levels: a norm, or the control itself."""


@dataclass(frozen=True)
class ControlPart:
    """One of the sets whose product is the control set.

    Attributes
    ----------
    name
        As instances name it.
    kind
        What the controls of it obey.
    controls
        Their names, in order.
    branch
        How H is minimised over it.
    ends
        Whether H may be least at an end without falling to it, so that there must be ends.
    turned_by
        Of a magnitude, which is never negative: the angle that turns what it multiplies.
    """

    name: str
    kind: PartKind
    controls: tuple[str, ...]
    branch: Branch
    ends: bool = False
    turned_by: str = ""

    @property
    def bounds(self) -> int:
        """How many numbers of the argument ``bounds`` belong to it."""
        return {"free": 0, "box": 2 * len(self.controls), "ball": 1, "annulus": 2, "angle": 1}[self.kind]

    @property
    def directed(self) -> bool:
        """Whether its controls are a direction."""
        return self.branch in DIRECTED

    @property
    def normed(self) -> bool:
        """Whether it limits a norm."""
        return self.kind in ("ball", "annulus")
