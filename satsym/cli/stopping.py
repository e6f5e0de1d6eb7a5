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


class Terminated(KeyboardInterrupt):
    """SIGTERM has come; whatever lets an interruption pass lets it pass, too."""


@contextmanager
def terminable() -> Iterator[None]:
    """Let SIGTERM raise :class:`Terminated`, unless whoever started the process had it ignored."""
    if threading.current_thread() is not threading.main_thread() or signal.getsignal(signal.SIGTERM) is signal.SIG_IGN:
        yield
        return
    before, hook = signal.signal(signal.SIGTERM, _raise), sys.unraisablehook
    repeats: list[threading.Timer] = []

    def ignored(report: UnraisableHookArgs) -> None:
        """Python ignores what is raised in a finaliser or a weak reference's callback: stop once that is over."""
        if not issubclass(report.exc_type, KeyboardInterrupt):
            hook(report)
            return
        sign = signal.SIGTERM if issubclass(report.exc_type, Terminated) else signal.SIGINT
        repeats.append(threading.Timer(AGAIN, os.kill, (os.getpid(), sign)))
        repeats[-1].daemon = True
        repeats[-1].start()

    sys.unraisablehook = ignored
    try:
        yield
    finally:
        for repeat in repeats:
            repeat.cancel()
        sys.unraisablehook = hook
        signal.signal(signal.SIGTERM, before)


def stopped(error: BaseException) -> int:
    """Say on stderr, as far as it can be written to, that the command was stopped; its exit code."""
    terminated = isinstance(error, Terminated)
    complain("terminated" if terminated else "interrupted")
    return TERMINATED if terminated else INTERRUPTED


def _raise(_signal: int, _frame: FrameType | None) -> None:
    raise Terminated
