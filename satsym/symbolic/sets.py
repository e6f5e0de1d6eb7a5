"""Sets of admissible controls as a derivation file states them; an instance gives their numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from satsym.control_part import PartKind


@dataclass(frozen=True, init=False)
class AdmissibleSet:
    """A set of admissible values of named controls; the control set is the product of such sets.

    Parameters
    ----------
    controls
        Names of its controls.
    """

    controls: tuple[str, ...]

    kind: ClassVar[PartKind]

    def __init__(self, *controls: str) -> None:
        object.__setattr__(self, "controls", controls)


class Free(AdmissibleSet):
    """Controls without bounds."""

    kind = "free"


class Box(AdmissibleSet):
    """Controls, each between its bounds (a box): ``u = [lower, upper]`` in the ``[control]`` of an instance."""

    kind = "box"


class Ball(AdmissibleSet):
    """Controls whose norm is bounded: ``max_norm`` in the ``[control.NAME]`` of an instance."""

    kind = "ball"


class Annulus(AdmissibleSet):
    """Controls whose norm lies between ``min_norm`` and ``max_norm`` in the ``[control.NAME]`` of an instance."""

    kind = "annulus"


class Angle(AdmissibleSet):
    """One control that is an angle in a plane, without bounds."""

    kind = "angle"
