"""What solving for given ends comes to, by whatever method."""

from __future__ import annotations

from dataclasses import dataclass

from satsym.solvers.collocation.curve import Path
from satsym.solvers.collocation.problem import TwoPoint
from satsym.status import Status


@dataclass(frozen=True, eq=False)
class Extremal:
    """What solving came to: an extremal, or what was tried last and why it is none."""

    problem: TwoPoint
    """The two-point problem, with its bounds."""
    path: Path
    """States, costates and extra unknowns, scaled."""
    cost: float
    """The cost J; infinite where there is no answer."""
    status: Status
    message: str
    """Outcome."""
    iterations: int
    """Linear systems that were solved."""
    obeys: bool = False
    """Without an answer: whether the path still obeys the problem itself, and not only an easier one on the way."""
