"""Being stopped: SIGTERM ends a command as SIGINT does, so that it cleans up and says so."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import TYPE_CHECKING

from satsym.cli.output import complain

if TYPE_CHECKING:
    from sys import UnraisableHookArgs

INTERRUPTED = 130
TERMINATED = 143
"""As the shell reports programs that SIGINT or SIGTERM ended."""

AGAIN = 0.02
"""Seconds after which a stop that Python ignored is repeated."""

_asked: list[int] = []
"""Signals that have come to stop the command."""


class Terminated(KeyboardInterrupt):
    """SIGTERM has come; whatever lets an interruption pass lets it pass, too."""


@contextmanager
def terminable() -> Iterator[None]:
    """Let SIGTERM raise :class:`Terminated`, unless whoever started the process had it ignored; lose no stop."""
    _asked.clear()
    if threading.current_thread() is not threading.main_thread() or signal.getsignal(signal.SIGTERM) is signal.SIG_IGN:
        yield
        return
    interrupt, hook = signal.getsignal(signal.SIGINT), sys.unraisablehook
    terminate = signal.signal(signal.SIGTERM, _raise)
    if interrupt is signal.default_int_handler:
        signal.signal(signal.SIGINT, _raise)
    repeats: list[threading.Timer] = []

    def ignored(report: UnraisableHookArgs) -> None:
        """Python ignores what is raised in a finaliser or a weak reference's callback: stop once that is over."""
        if not _asked:
            hook(report)
        elif issubclass(report.exc_type, KeyboardInterrupt):
            repeats.append(threading.Timer(AGAIN, os.kill, (os.getpid(), _asked[-1])))
            repeats[-1].daemon = True
            repeats[-1].start()

    sys.unraisablehook = ignored
    try:
        yield
    finally:
        for repeat in repeats:
            repeat.cancel()
        sys.unraisablehook = hook
        signal.signal(signal.SIGTERM, terminate)
        signal.signal(signal.SIGINT, interrupt)


def comes_of_a_stop(error: BaseException) -> bool:
    """Whether an error is a stop, or comes after one: libraries that are broken off may raise anything."""
    return bool(_asked) or isinstance(error, KeyboardInterrupt)


def stopped(error: BaseException) -> int:
    """Say on stderr, as far as it can be written to, that the command was stopped, and its notes; its exit code."""
    terminated = isinstance(error, Terminated) or signal.SIGTERM in _asked
    complain("; ".join(["terminated" if terminated else "interrupted", *getattr(error, "__notes__", ())]))
    return TERMINATED if terminated else INTERRUPTED


def _raise(sign: int, _frame: FrameType | None) -> None:
    _asked.append(sign)
    raise Terminated if sign == signal.SIGTERM else KeyboardInterrupt
