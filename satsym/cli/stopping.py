"""Being stopped: SIGTERM ends a command as SIGINT does, so that it cleans up and says so."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

from satsym.cli.output import complain

INTERRUPTED = 130
TERMINATED = 143
"""As the shell reports programs that SIGINT or SIGTERM ended."""


class Terminated(KeyboardInterrupt):
    """SIGTERM has come; whatever lets an interruption pass lets it pass, too."""


@contextmanager
def terminable() -> Iterator[None]:
    """Let SIGTERM raise :class:`Terminated`, unless whoever started the process had it ignored."""
    if threading.current_thread() is not threading.main_thread() or signal.getsignal(signal.SIGTERM) is signal.SIG_IGN:
        yield
        return
    before = signal.signal(signal.SIGTERM, _raise)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def stopped(error: BaseException) -> int:
    """Say on stderr, as far as it can be written to, that the command was stopped; its exit code."""
    terminated = isinstance(error, Terminated)
    complain("terminated" if terminated else "interrupted")
    return TERMINATED if terminated else INTERRUPTED


def _raise(_signal: int, _frame: FrameType | None) -> None:
    raise Terminated
