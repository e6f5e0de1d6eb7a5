"""How much work and memory one row of a ledger may take: counted, never timed, so that the answer is the same anywhere.

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
    """What something may take."""

    calls: int
    """Calls and returns of functions; a million takes about half a second."""
    numbers: int = 20_000_000
    """Entries of arrays, characters of texts and the like, all of them together, kept or not."""


READING = Limit(50_000_000)
"""A whole ledger of a megabyte at most, with all measurements and units loaded; uny_thesis takes 4.9 million."""
FORMULA = Limit(25_000_000)
"""A row that is compared with what is derived; lapan_pitch 24 takes 2.5 million."""
CLAIM = Limit(80_000_000)
"""A row that a proposition judges: it simulates, and walks through printed programs; appendix B of its_thesis takes 7.1
million."""
VERDICT = Limit(25_000_000)
"""A row in the light of the others; uny_thesis 2.64 takes 2.0 million."""
LEDGER = 600_000_000
"""Calls for all rows of one ledger together; uny_thesis takes 58 million."""


_ADVICE = "write it shorter, or split it into rows"


class OverBudget(BadInput):
    """More work or memory than one row may take; nothing is said of whether it is right."""


class Spent(BaseException):
    """Raised where the last call was made; no handler of a library's for mere exceptions swallows it."""


class Account:
    """What is left of a limit."""

    def __init__(self, limit: Limit) -> None:
        self.limit = limit
        self.calls, self.numbers = limit.calls, limit.numbers

    def charge(self, calls: int, numbers: int) -> None:
        """Take something off."""
        self.calls -= calls
        self.numbers -= numbers
        if self.overdrawn:
            raise Spent(self.overdrawn)

    @property
    def overdrawn(self) -> str:
        """What was exceeded, for people; empty where nothing was."""
        if self.calls < 0:
            return f"takes more than {self.limit.calls:,} operations; {_ADVICE}"
        return f"makes more than {self.limit.numbers:,} numbers; {_ADVICE}" if self.numbers < 0 else ""

    def profile(self, frame: FrameType, event: str, argument: object) -> None:
        """Called by the interpreter for each call and each return."""
        self.calls -= 1
        if self.calls < 0:
            raise Spent(self.overdrawn)


_ACTIVE: ContextVar[Account | None] = ContextVar("account", default=None)


def within(limit: Limit, work: Callable[[], T], spent: Callable[[int], None] = lambda _: None, calls: bool = True) -> T:
    """Do some work, and give up once it takes more than a limit; inside other such work that one's limit holds.

    Without ``calls`` only what is charged counts, which costs no time, for work that is known to be small.

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
    """Work that no ledger decides the size of, such as deriving a shipped model, is not counted."""
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
    """Count what a single call of a library does: how often it does something, how many numbers it makes."""
    account = _ACTIVE.get()
    if account is not None:
        account.charge(int(calls), int(numbers))


@dataclass
class Allowance:
    """What all rows of a ledger may take together."""

    counted: bool = True
    """Whether it is counted at all. Counting makes the interpreter half as fast; of a ledger that comes with satsym it
    is known what it takes."""
    left: int = LEDGER
    """Calls that are left."""

    def within(self, limit: Limit, work: Callable[[], T]) -> T:
        """As :func:`within`, of what is left."""
        if not self.counted:
            return work()
        if self.left <= 0:
            raise OverBudget(f"the rows before it took {LEDGER:,} operations; judge single rows with --item")
        return within(replace(limit, calls=min(limit.calls, self.left)), work, self._spent)

    def _spent(self, calls: int) -> None:
        self.left -= calls
