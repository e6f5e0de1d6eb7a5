"""What solving for given ends comes to, by whatever method."""

from __future__ import annotations

from dataclasses import dataclass

from satsym.solvers.collocation.curve import Path
from satsym.solvers.collocation.problem import TwoPoint
from satsym.status import Status


@dataclass(frozen=True, eq=False)
class Extremal:
    """What solving came to: an extremal, or what was tried last and why it is none.

    Attributes
    ----------
    problem
        The two-point problem, with its bounds.
    path
        States, costates and extra unknowns, scaled.
    cost
        The cost J; infinite where there is no answer.
    status, message
        Outcome.
    iterations
        Linear systems that were solved.
    """

    problem: TwoPoint
    path: Path
    cost: float
    status: Status
    message: str
    iterations: int
