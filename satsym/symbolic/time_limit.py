"""Limits on algebra, which may go on for hours or for ever without any message.

A derivation has a time limit. The other limit is on sympy's search for the sign of a sum: wherever zero times something
is written, sympy asks whether that is finite, thus whether a divisor may vanish. For a polynomial in one symbol of
known sign it then finds all roots of the derivative, by way of the prime factors of the coefficients. Coefficients that
were decimals have hundreds of digits.
"""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

import sympy as sp
from sympy.core import exprtools

from satsym.symbolic.derivation import DerivationError

SIGNAL_INTERVAL = 0.5
"""Seconds between repetitions of the signal, in case that code has suppressed it."""

_at: list[tuple[str, str]] = []
"""The subject that is being derived, and its current step."""

_deadlines: list[float] = []

LARGEST_COEFFICIENT = 2**64
"""Largest integer coefficient of a polynomial whose roots SymPy may compute in order to find its sign."""

_sign = exprtools._monotonic_sign


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


def keep_short() -> None:
    """Make sympy answer that it does not know the signs of polynomials with long coefficients.

    Sympy gives this answer for most sums, and nothing may rely on more.
    """
    exprtools._monotonic_sign = _sign_or_none


def _sign_or_none(expression: sp.Expr) -> sp.Expr | None:
    return None if _has_long_coefficients(expression) else _sign(expression)


def _has_long_coefficients(expression: sp.Expr) -> bool:
    """Tell whether an expression is a polynomial in one symbol, of degree at least three, with long coefficients."""
    free = expression.free_symbols
    if not expression.is_Add or len(free) != 1 or not expression.is_polynomial(*free):
        return False
    polynomial = sp.Poly(expression, *free)
    if polynomial.degree() < 3 or expression.has(sp.Float):
        return polynomial.degree() >= 3
    exact = polynomial.domain.is_ZZ or polynomial.domain.is_QQ
    return exact and polynomial.clear_denoms(convert=True)[1].max_norm() > LARGEST_COEFFICIENT
