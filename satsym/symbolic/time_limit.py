"""A time limit for derivations, since algebra may go on for ever without any message."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

from satsym.symbolic.derivation import DerivationError

SIGNAL_INTERVAL = 0.5
"""Seconds between repetitions of the signal, in case that code has suppressed it."""

_at: list[tuple[str, str]] = []
"""The subject that is being derived, and its current step."""

_deadlines: list[float] = []


class _TimeUp(BaseException):
    """Raised when time is over; not an Exception, so that no handler of algebraic errors catches it."""


def entering(subject: str, step: str) -> None:
    """Record the step that begins; where no signal can come, check the time."""
    _at[:] = [(subject, step)]
    if _deadlines and time.monotonic() > _deadlines[-1]:
        raise _TimeUp


@contextmanager
def within(seconds: float | None, subject: str) -> Iterator[None]:
    """Limit the time of every derivation inside this context.

    Parameters
    ----------
    seconds
        The limit; ``None`` for none. In a thread, and where the system has no timers, it ends the step it falls into.
    subject
        What messages call it until a step has begun.

    Raises
    ------
    DerivationError
        Where the time is over, with the model and the step.
    """
    if seconds is None or _deadlines:  # the outer one holds
        yield
        return
    _at[:] = [(subject, "reading the file")]
    _deadlines.append(time.monotonic() + seconds)
    try:
        with _timer(seconds):
            yield
    except _TimeUp:
        model, step = _at[0]
        advice = "simplify it, name parts of it as definitions, or allow more time with --max-seconds"
        raise DerivationError(f"{model}: the derivation exceeded {seconds:g} s in the step {step}; {advice}") from None
    finally:
        _deadlines.clear()


@contextmanager
def _timer(seconds: float) -> Iterator[None]:
    """Send a signal when the time is over, and repeat it until it is handled."""
    alone = threading.current_thread() is threading.main_thread() and hasattr(signal, "setitimer")
    if not alone or signal.getsignal(signal.SIGALRM) is not signal.SIG_DFL:
        yield
        return
    signal.signal(signal.SIGALRM, _over)
    signal.setitimer(signal.ITIMER_REAL, seconds, SIGNAL_INTERVAL)
    try:
        yield
    finally:
        _disarm()


def _over(_sign: int, _frame: FrameType | None) -> None:
    if _deadlines:
        raise _TimeUp
    _disarm()  # this signal, or the one before it, came while the timer was being stopped


def _disarm() -> None:
    signal.setitimer(signal.ITIMER_REAL, 0.0)
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
