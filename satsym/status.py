"""What can come of a request: solver statuses with advice, verdicts, exit codes, and the error for bad input."""

from __future__ import annotations

from enum import Enum, IntEnum


class Status(str, Enum):
    """How a solver run ended; each value carries a sentence of advice."""

    CONVERGED = "converged"
    NOT_CONVERGED = "not converged"
    INFEASIBLE = "infeasible"
    NO_MINIMISER = "no minimiser"
    LEFT_DOMAIN = "left domain"
    NON_FINITE = "non-finite"
    TIME_LIMIT = "time limit"

    @property
    def advice(self) -> str:
        """What the user can do about it; empty for a converged run."""
        return _ADVICE[self]

    def explain(self, message: str) -> str:
        """A message with the advice behind it, unless it has some itself."""
        return "; ".join(filter(None, [message, self.advice_beside(message)]))

    def advice_beside(self, message: str) -> str:
        """What is left to be advised beside a message: nothing where it says that itself, or what helps instead."""
        return "" if self.advice in message or any(one in message for one in _INSTEAD) else self.advice

    @property
    def answered(self) -> bool:
        """Whether the run gave an answer (as opposed to a reason for having none)."""
        return self is Status.CONVERGED


_ADVICE = {
    Status.CONVERGED: "",
    Status.NOT_CONVERGED: "try more steps, another method, or a guess closer to the answer",
    Status.INFEASIBLE: "allow more time, or widen the bounds of the control",
    Status.NO_MINIMISER: "",
    Status.LEFT_DOMAIN: "check the initial state, shorten the horizon, or widen the bounds of the control",
    Status.NON_FINITE: "check the initial state and the parameters for values that cause a division by zero "
    "or an overflow",
    Status.TIME_LIMIT: "raise [solver] max_seconds, or use fewer steps",
}


LEAVE_FREE = "leave one of these states free"
"""What helps where no control changes something, whatever time it has."""
_INSTEAD = (LEAVE_FREE,)
"""Advice that takes the place of a status's own."""


class Verdict(str, Enum):
    """What a certificate says: a strict local minimum without a cheaper competitor, an extremal, or not even that.

    Where no competitor was looked for, a strict local minimum is all that is said.
    """

    CERTIFIED = "certified"
    LOCAL_MINIMUM = "local minimum"
    EXTREMAL_ONLY = "extremal only"
    FAILED = "failed"

    @classmethod
    def of(cls, necessary: bool, sufficient: bool, compared: bool = True) -> Verdict:
        """The verdict where necessary conditions hold or not, and sufficient ones, and competitors were compared."""
        if not necessary:
            return cls.FAILED
        if not sufficient:
            return cls.EXTREMAL_ONLY
        return cls.CERTIFIED if compared else cls.LOCAL_MINIMUM


class Scope(str, Enum):
    """Among which motions the claim of a certificate holds: those near by, or all that are admissible."""

    LOCAL = "local"
    GLOBAL = "global"


class ExitCode(IntEnum):
    """Exit codes of the command line."""

    DONE = 0
    UNFORESEEN = 1
    USAGE = 2
    BAD_INPUT = 3
    NO_ANSWER = 4
    CERTIFICATE_FAILED = 5
    STALE = 6


class BadInput(Exception):
    """A file or value from the user is not usable; the message is one line: what, where, what to do."""
