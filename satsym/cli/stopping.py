"""Handling of stop signals: SIGTERM ends a command as SIGINT does, with clean-up and a message."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from queue import SimpleQueue
from types import FrameType, TracebackType
from typing import TYPE_CHECKING

from satsym.cli.output import complain

if TYPE_CHECKING:
    from sys import UnraisableHookArgs

INTERRUPTED = 130
TERMINATED = 143
"""Exit codes with which the shell reports programs that SIGINT or SIGTERM ended."""

STOP_INTERVAL = 0.05
"""Seconds after which an unanswered stop is repeated."""

_NO_MORE = 0
"""A number that no signal has."""

_asked: list[int] = []
"""Signals that have arrived to stop the command."""


class Terminated(KeyboardInterrupt):
    """SIGTERM has arrived; handled like a keyboard interrupt."""


@contextmanager
def terminable() -> Iterator[None]:
    """Let SIGTERM raise :class:`Terminated` in this context, unless it is ignored; no stop is lost."""
    _asked.clear()
    if threading.current_thread() is not threading.main_thread() or signal.getsignal(signal.SIGTERM) is signal.SIG_IGN:
        yield
        return
    interrupt, hooks = signal.getsignal(signal.SIGINT), (sys.unraisablehook, sys.excepthook)
    heard: SimpleQueue[int] = SimpleQueue()
    over = threading.Event()

    def stop(sign: int, _frame: FrameType | None) -> None:
        if over.is_set():
            return
        _asked.append(sign)
        heard.put(sign)
        raise Terminated if sign == signal.SIGTERM else KeyboardInterrupt

    def unraisable(report: UnraisableHookArgs) -> None:
        """Report a stop in a finaliser or a weak reference's callback, where Python ignores exceptions."""
        if not (_asked and issubclass(report.exc_type, KeyboardInterrupt)):
            hooks[0](report)

    def printed(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
        """Report a stop that C code printed while it loaded a module, and then went on."""
        if not (_asked and issubclass(kind, KeyboardInterrupt)):
            hooks[1](kind, error, trace)

    terminate = signal.signal(signal.SIGTERM, stop)
    if interrupt is signal.default_int_handler:
        signal.signal(signal.SIGINT, stop)
    sys.unraisablehook, sys.excepthook = unraisable, printed
    insisting = threading.Thread(target=_insist, args=(threading.main_thread().ident, heard, over), daemon=True)
    insisting.start()
    try:
        yield
    finally:
        over.set()
        heard.put(_NO_MORE)
        insisting.join()
        sys.unraisablehook, sys.excepthook = hooks
        signal.signal(signal.SIGTERM, terminate)
        signal.signal(signal.SIGINT, interrupt)


def _insist(thread: int | None, heard: SimpleQueue[int], over: threading.Event) -> None:
    """Repeat a stop that was lost, because Python or C code ignored the exception."""
    sign = heard.get()
    while not over.wait(STOP_INTERVAL):
        if not _answers(thread):
            os.kill(os.getpid(), sign)


def _answers(thread: int | None) -> bool:
    """Tell whether a thread is handling a stop or its consequences: cleaning up may take time."""
    found: object = sys._current_exceptions().get(thread or 0)
    error = found[1] if isinstance(found, tuple) else found  # Python 3.11 has the type and the traceback as well
    while isinstance(error, BaseException):
        if isinstance(error, KeyboardInterrupt):
            return True
        error = error.__context__
    return False


def comes_of_a_stop(error: BaseException) -> bool:
    """Tell whether an error is a stop, or follows from one: interrupted libraries may raise anything."""
    return bool(_asked) or isinstance(error, KeyboardInterrupt)


def stopped(error: BaseException) -> int:
    """Report on stderr that the command was stopped, with its notes; return the exit code."""
    terminated = isinstance(error, Terminated) or signal.SIGTERM in _asked
    complain("; ".join(["terminated" if terminated else "interrupted", *getattr(error, "__notes__", ())]))
    return TERMINATED if terminated else INTERRUPTED
