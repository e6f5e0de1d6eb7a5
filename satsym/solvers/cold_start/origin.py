"""Origins of extremals: the initial guess from which an extremal was found."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from satsym.solvers.collocation.attempt import Attempt


class Origin(str, Enum):
    """The initial guess from which an extremal was found, in the words of messages."""

    GUESS = "guess"
    STRAIGHT_LINE = "straight line"
    NO_MINIMUM = "straight line, because no minimum was found"
    LAST_ANSWER = "last solution"
    COLD_START = "cold start"


@dataclass(frozen=True, eq=False)
class Start:
    """An extremal of low order from which a method starts."""

    found: Attempt
    """The minimum of lowest cost, or otherwise the last attempt with the reason why it failed."""
    origin: Origin
    """The initial guess from which the extremal was found."""
    steps: int
    """Number of steps of all attempts."""
    bounded: bool = False
    """Whether bounds were imposed from the beginning."""
    saddle: Attempt | None = None
    """An extremal that is not a minimum, if no minimum was found."""

    @property
    def named(self) -> str:
        """The origin in the words of messages."""
        return self.origin.value
