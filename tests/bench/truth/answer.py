"""What the independent side says of an instance."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from enum import Enum
from typing import Any


class Truth(str, Enum):
    """How much is known."""

    MINIMUM = "minimum"  # the least cost: in closed form, or with a lower bound that it meets
    REACHED = "reached"  # the cost of a control that was simulated and arrives
    INFEASIBLE = "infeasible"  # proved: no control arrives
    UNBOUNDED = "unbounded"  # proved: there is no least cost
    UNKNOWN = "unknown"  # nothing was found


@dataclass(frozen=True)
class Answer:
    """An independent answer.

    Attributes
    ----------
    truth
        How much is known.
    cost
        ``None`` where there is none.
    how
        By what means, with what makes it credible.
    duration
        t_f - t_0 of what it belongs to.
    """

    truth: Truth
    cost: float | None
    how: str
    duration: float | None = None

    def row(self) -> dict[str, Any]:
        """For a record."""
        return asdict(self) | {"truth": self.truth.value}

    @classmethod
    def of(cls, row: dict[str, Any]) -> Answer:
        """From a record."""
        return cls(Truth(row["truth"]), row["cost"], row["how"], row["duration"])
