"""Outcomes of requests: solver statuses with advice, verdicts, exit codes, and the error for bad input."""

from __future__ import annotations

from enum import Enum, IntEnum


class Status(str, Enum):
    """The outcome of a solver run; each value carries a sentence of advice."""

    CONVERGED = "converged"
    NOT_CONVERGED = "not converged"
    INFEASIBLE = "infeasible"
    NO_MINIMISER = "no minimiser"
    LEFT_DOMAIN = "left domain"
    NON_FINITE = "non-finite"
    TIME_LIMIT = "time limit"

    @property
    def advice(self) -> str:
        """Return what the user can do about the outcome; empty for a converged run."""
        return _ADVICE[self]

    def explain(self, message: str) -> str:
        """Return a message followed by the advice, unless it has some itself."""
        return "; ".join(filter(None, [message, self.advice_beside(message)]))

    def advice_beside(self, message: str) -> str:
        """Return the advice that a message lacks; empty where the message says it, or what helps instead."""
        return "" if self.advice in message or any(one in message for one in _INSTEAD) else self.advice

    @property
    def answered(self) -> bool:
        """Tell whether the run gave an answer, as opposed to a reason for having none."""
        return self is Status.CONVERGED


_ADVICE = {
    Status.CONVERGED: "",
    Status.NOT_CONVERGED: "try more steps, another method, or a guess closer to the solution",
    Status.INFEASIBLE: "allow more time, or widen the bounds of the control",
    Status.NO_MINIMISER: "",
    Status.LEFT_DOMAIN: "check the initial state, shorten the horizon, or widen the bounds of the control",
    Status.NON_FINITE: "check the initial state and the parameters for values that cause a division by zero "
    "or an overflow",
    Status.TIME_LIMIT: "raise [solver] max_seconds, or use fewer steps",
}


LEAVE_FREE = "leave one of these states free"
"""Advice where no control changes a state that is required at the end."""
_INSTEAD = (LEAVE_FREE,)
"""Advice that replaces that of a status."""


class Verdict(str, Enum):
    """The verdict of a certificate: a strict local minimum without a cheaper competitor, an extremal, or neither.

    Where no competitor was searched, the verdict claims only a strict local minimum.
    """

    CERTIFIED = "certified"
    LOCAL_MINIMUM = "local minimum"
    EXTREMAL_ONLY = "extremal only"
    FAILED = "failed"

    @classmethod
    def of(cls, necessary: bool, sufficient: bool, compared: bool = True) -> Verdict:
        """Return the verdict from necessary and sufficient conditions, and whether competitors were compared."""
        if not necessary:
            return cls.FAILED
        if not sufficient:
            return cls.EXTREMAL_ONLY
        return cls.CERTIFIED if compared else cls.LOCAL_MINIMUM


class Scope(str, Enum):
    """The set of motions for which a certificate's claim holds: nearby ones, or all admissible ones."""

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
