"""What comes of an attempt at an extremal, by whatever means: a curve, why it ended there, and what that took."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from satsym.solvers.collocation.curve import Curve
from satsym.solvers.collocation.linearised import Linearised


class Reason(Enum):
    """Why an attempt ended, with the words for it."""

    MINIMUM = "minimum"
    SADDLE = "saddle"
    EXTREMAL = "extremal"
    """Nobody asked whether it is a minimum."""
    OUTGROWN = "the solution needs more mesh intervals than are allowed"
    SINGULAR = "the equations are singular"
    NOT_FINITE = "not finite"
    TIME_UP = "time limit reached"
    NO_DESCENT = "no descent"
    NO_CONVERGENCE = "no convergence in {} steps"
    OUT_OF_DOMAIN = "the minimum lies outside the domain of the model"
    BLOCKED = "the relaxed bounds could be tightened only by {:.0%}"
    UNSETTLED = (
        "the times at which bounds become active do not converge: try wider bounds, another tf, or --continue "
        "from an easier problem"
    )
    INACCURATE = "the estimated error stays at {:.0e} on {} intervals"


@dataclass(frozen=True, eq=False)
class Attempt:
    """Where an attempt ended."""

    curve: Curve
    """The last one."""
    reason: Reason
    """Whether that is an extremal, or why not."""
    iterations: int
    """Linear systems that were solved."""
    cost: float = float("nan")
    """Scaled cost there; NaN where it was not asked for."""
    hard: bool = True
    """Whether the way was not straight: a Gauss-Newton step after the first, or a step cut short. Other minima may then
    be cheaper."""
    linearised: Linearised | None = None
    """The equations there, where they are at hand."""
    error: float = float("inf")
    """Estimated error, at the nodes and between them, relative as in :meth:`Step.size`; infinite where nobody asked."""
    facts: tuple[float | str, ...] = ()
    """What the words of the reason leave open."""

    @property
    def minimum(self) -> bool:
        """Whether it is a strict local minimum of the discretised problem."""
        return self.reason is Reason.MINIMUM

    @property
    def solved(self) -> bool:
        """Whether it is a minimum, or an extremal of which nobody asked more."""
        return self.reason in (Reason.MINIMUM, Reason.EXTREMAL)

    @property
    def message(self) -> str:
        """The reason in words."""
        return self.reason.value.format(*self.facts)
