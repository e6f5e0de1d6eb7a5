"""Limits on the work and memory for one row of a ledger: counted, never timed, so that every machine agrees.

Work is counted in calls: the interpreter announces each call of a function, Python's or a library's, and each return.
That reaches everything which a text can set going, sympy's rewriting included, without a list of what may be slow.
What a single call may do beyond that (an array, a decomposition, a copy of a long text) is charged by hand, in the
numbers it touches. What is too large by its shape alone is refused before: :mod:`satsym.formula.weight`.

The limits are those below. The row of a shipped ledger that takes most is named beside each.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, replace
from types import FrameType
from typing import TypeVar

from satsym.status import BadInput

T = TypeVar("T")


@dataclass(frozen=True)
class Limit:
    """A limit of work and of memory."""

    calls: int
    """Largest number of calls and returns of functions; a million takes about half a second."""
    numbers: int = 20_000_000
    """Largest number of entries of arrays, characters of texts and the like, all together, kept or not."""


READING = Limit(50_000_000)
"""Limit for reading a whole ledger of at most a megabyte, with all measurements and units loaded; uny_thesis takes 4.9
million."""
FORMULA = Limit(25_000_000)
"""Limit for a row that is compared with a derived expression; lapan_pitch 24 takes 2.5 million."""
CLAIM = Limit(80_000_000)
"""Limit for a row that a proposition judges, with simulations and runs of printed programs; appendix B of its_thesis
takes 7.1 million."""
VERDICT = Limit(25_000_000)
"""Limit for the verdict on a row in view of the others; uny_thesis 2.64 takes 2.0 million."""
LEDGER = 600_000_000
"""Limit of calls for all rows of one ledger together; uny_thesis takes 58 million."""


_ADVICE = "shorten it, or split it into several rows"


class OverBudget(BadInput):
    """A row takes more work or memory than allowed; whether it is right stays open."""


class Spent(BaseException):
    """Raised where the last allowed call was made; not an Exception, so that no library's handler catches it."""


class Account:
    """The rest of a limit."""

    def __init__(self, limit: Limit) -> None:
        self.limit = limit
        self.calls, self.numbers = limit.calls, limit.numbers

    def charge(self, calls: int, numbers: int) -> None:
        """Subtract calls and numbers."""
        self.calls -= calls
        self.numbers -= numbers
        if self.overdrawn:
            raise Spent(self.overdrawn)

    @property
    def overdrawn(self) -> str:
        """Return what was exceeded, for people; empty where nothing was."""
        if self.calls < 0:
            return f"takes more than {self.limit.calls:,} operations; {_ADVICE}"
        return f"produces more than {self.limit.numbers:,} numbers; {_ADVICE}" if self.numbers < 0 else ""

    def profile(self, frame: FrameType, event: str, argument: object) -> None:
        """Count a call or a return, announced by the interpreter."""
        self.calls -= 1
        if self.calls < 0:
            raise Spent(self.overdrawn)


_ACTIVE: ContextVar[Account | None] = ContextVar("account", default=None)


def within(limit: Limit, work: Callable[[], T], spent: Callable[[int], None] = lambda _: None, calls: bool = True) -> T:
    """Do some work under a limit; nested work is under its own limit.

    Without ``calls`` only explicit charges count, which costs no time, for work that is known to be small.

    Raises
    ------
    OverBudget
        If it takes more.
    """
    if _ACTIVE.get() is not None:
        return work()
    account, before = Account(limit), sys.getprofile()
    token = _ACTIVE.set(account)
    # a function, not a context: the interpreter announces the end of a context, too, and would be refused there
    try:
        try:
            sys.setprofile(account.profile if calls else before)
            result = work()
        finally:
            sys.setprofile(before)
    except Spent as error:
        raise OverBudget(str(error)) from None
    finally:
        _ACTIVE.reset(token)
        spent(limit.calls - account.calls)
    if account.overdrawn:  # where a finaliser swallowed the end
        raise OverBudget(account.overdrawn)
    return result


@contextmanager
def exempt() -> Iterator[None]:
    """Suspend counting for work whose size no ledger decides, such as deriving a shipped model."""
    account = _ACTIVE.get()
    if account is None:
        yield
        return
    counting = sys.getprofile()
    sys.setprofile(None)
    try:
        yield
    finally:
        sys.setprofile(counting)


def charge(calls: int = 0, numbers: int = 0) -> None:
    """Count what a single call of a library does: repetitions and numbers made."""
    account = _ACTIVE.get()
    if account is not None:
        account.charge(int(calls), int(numbers))


@dataclass
class Allowance:
    """The work and memory that all rows of a ledger may take together."""

    counted: bool = True
    """Whether calls are counted, which halves the speed of the interpreter; shipped ledgers need no count."""
    left: int = LEDGER
    """Calls that are left."""

    def within(self, limit: Limit, work: Callable[[], T]) -> T:
        """Do some work as :func:`within` does, under the rest of the allowance."""
        if not self.counted:
            return work()
        if self.left <= 0:
            raise OverBudget(f"the preceding rows took {LEDGER:,} operations; check single rows with --item")
        return within(replace(limit, calls=min(limit.calls, self.left)), work, self._spent)

    def _spent(self, calls: int) -> None:
        self.left -= calls
