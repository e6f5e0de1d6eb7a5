"""Result of solving for given end conditions, by any method."""

from __future__ import annotations

from dataclasses import dataclass

from satsym.solvers.collocation.curve import Path
from satsym.solvers.collocation.problem import TwoPoint
from satsym.status import Status


@dataclass(frozen=True, eq=False)
class Extremal:
    """An extremal or, if none was found, the last path and the reason."""

    problem: TwoPoint
    """The two-point problem, with its bounds."""
    path: Path
    """States, costates and extra unknowns, scaled."""
    cost: float
    """The cost J; infinite if there is no answer."""
    status: Status
    message: str
    """Outcome as a status and a message."""
    iterations: int
    """Number of linear systems that were solved."""
    obeys: bool = False
    """Whether the path of a failed solution satisfies the equations of the problem itself, and not only of an easier
    one."""
