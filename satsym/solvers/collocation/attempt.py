"""Result of an attempt to find an extremal by any method: a curve, the reason for its end, and the work."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from satsym.solvers.collocation.curve import Curve
from satsym.solvers.collocation.linearised import Linearised


class Reason(Enum):
    """Reasons why an attempt ended, with the messages for them."""

    MINIMUM = "minimum"
    SADDLE = "saddle"
    EXTREMAL = "extremal"
    """An extremal for which it was not tested whether it is a minimum."""
    OUTGROWN = "the solution needs more mesh intervals than are allowed"
    SINGULAR = "the equations are singular"
    NOT_FINITE = "not finite"
    TIME_UP = "time limit reached"
    NO_DESCENT = "no descent direction was found"
    NO_CONVERGENCE = "no convergence in {} steps"
    OUT_OF_DOMAIN = "the minimum lies outside the domain of the model"
    BLOCKED = "the relaxed bounds could be tightened by only {:.0%}"
    UNSETTLED = (
        "the times at which bounds become active do not converge: try wider bounds, another tf, or --continue "
        "from an easier problem"
    )
    INACCURATE = "the estimated error stays at {:.0e} on {} intervals"


@dataclass(frozen=True, eq=False)
class Attempt:
    """Result of an attempt to find an extremal."""

    curve: Curve
    """Curve at which the attempt ended."""
    reason: Reason
    """Reason why the attempt ended: the curve is an extremal, or why it is not."""
    iterations: int
    """Number of linear systems that were solved."""
    cost: float = float("nan")
    """Scaled cost of the curve; NaN if it was not computed."""
    hard: bool = True
    """Whether the iteration was irregular: it had a Gauss-Newton step after the first, or a shortened step. Other
    minima may then be cheaper."""
    linearised: Linearised | None = None
    """Linearised equations at the curve, ``None`` if they are not known."""
    error: float = float("inf")
    """Estimated error, at the nodes and between them, relative as in :meth:`Step.size`; infinite if it was not
    estimated."""
    facts: tuple[float | str, ...] = ()
    """Values that are inserted into the message of the reason."""

    @property
    def minimum(self) -> bool:
        """Return whether the curve is a strict local minimum of the discretised problem."""
        return self.reason is Reason.MINIMUM

    @property
    def solved(self) -> bool:
        """Return whether the curve is a minimum, or an extremal that was not tested further."""
        return self.reason in (Reason.MINIMUM, Reason.EXTREMAL)

    @property
    def message(self) -> str:
        """Return the message of the reason."""
        return self.reason.value.format(*self.facts)
