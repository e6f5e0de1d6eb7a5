"""From where extremals are found, and one that was, with that."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from satsym.solvers.collocation.attempt import Attempt


class Origin(str, Enum):
    """From where an extremal was found, in the words of messages."""

    GUESS = "guess"
    STRAIGHT_LINE = "straight line"
    LAST_ANSWER = "last answer"
    COLD_START = "cold start"


@dataclass(frozen=True, eq=False)
class Start:
    """An extremal of low order from which a method starts."""

    found: Attempt
    """A minimum, or the only extremal."""
    origin: Origin
    """From where it was found."""
    steps: int
    """Steps of all attempts."""
    bounded: bool = False
    """Whether it was looked for within the bounds at once."""

    @property
    def named(self) -> str:
        """The origin in words."""
        return self.origin.value
