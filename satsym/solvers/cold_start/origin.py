"""From where extremals are found, and one that was, with that."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from satsym.solvers.collocation.attempt import Attempt


class Origin(str, Enum):
    """From where an extremal was found, in the words of messages."""

    GUESS = "guess"
    STRAIGHT_LINE = "straight line"
    NO_MINIMUM = "straight line, because no minimum was found"
    LAST_ANSWER = "last answer"
    COLD_START = "cold start"


@dataclass(frozen=True, eq=False)
class Start:
    """An extremal of low order from which a method starts."""

    found: Attempt
    """The cheapest minimum, or the last attempt, and why that is none."""
    origin: Origin
    """From where it was found."""
    steps: int
    """Steps of all attempts."""
    bounded: bool = False
    """Whether it was looked for within the bounds at once."""
    saddle: Attempt | None = None
    """An extremal that is no minimum, where no minimum was found."""

    @property
    def named(self) -> str:
        """The origin in words."""
        return self.origin.value
