"""The one writer: data to stdout; complaints and live progress to stderr, the latter on a terminal only."""

from __future__ import annotations

import os
import shutil
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from enum import Enum
from typing import Any, TextIO, cast

from satsym import activity
from satsym.report import said


class Voice(Enum):
    """How much is said."""

    QUIET = "quiet"
    NORMAL = "normal"
    VERBOSE = "verbose"


VOICE: ContextVar[Voice] = ContextVar("voice", default=Voice.NORMAL)
"""How much is printed in one run, as it was asked for."""
INTERVAL = 0.1
"""Seconds between two states of the live line."""
MOST_PROGRESS_LINES, SHORTEST_PROGRESS_INTERVAL, LONGEST_PROGRESS_INTERVAL = 10, 5.0, 60.0
"""Progress where lines stay: how many there are, and the least and the most seconds between two."""


def emit(text: str) -> None:
    """Write a text to stdout, with a line break at its end.

    Raises
    ------
    Unheard
        If stdout cannot take it, where :func:`hearable` watches it; closed pipes included.
    """
    _write(sys.stdout, text if text.endswith("\n") else text + "\n")


def tell(text: str) -> None:
    """Print a text for people, unless they want to hear nothing."""
    if VOICE.get() is not Voice.QUIET:
        emit(text)


def emit_json(value: Mapping[str, Any]) -> None:
    """Write an object to stdout as JSON."""
    from satsym.report.results.files import to_json

    emit(to_json(value))


def answer(as_json: bool, value: Mapping[str, Any], text: Callable[[], str]) -> None:
    """Write what a command found, for programs or for people, unless these want to hear nothing."""
    if as_json:
        emit_json(value)
    elif VOICE.get() is not Voice.QUIET:  # nor need it be made
        emit(text())


def complain(message: str) -> None:
    """One line on stderr, as far as it can be written to."""
    with unless_unwritable():
        _write(sys.stderr, f"satsym: {said.message(message.rstrip())}\n")


class Unheard(Exception):
    """Stdout cannot be written to; no OSError, of which libraries have notions of their own."""

    def __init__(self, cause: OSError) -> None:
        super().__init__(str(cause))
        self.cause = cause


@contextmanager
def hearable() -> Iterator[None]:
    """Raise :class:`Unheard` where stdout cannot be written to, whoever writes."""
    before = sys.stdout
    if before is not None:
        sys.stdout = cast(TextIO, _Watched(before))
    try:
        yield
    finally:
        sys.stdout = before


class _Watched:
    """A stream with another error for what it cannot write."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    def write(self, text: str) -> int:
        try:
            return self._stream.write(text)
        except OSError as error:
            raise Unheard(error) from None

    def flush(self) -> None:
        try:
            self._stream.flush()
        except OSError as error:
            raise Unheard(error) from None


@contextmanager
def unless_unwritable() -> Iterator[None]:
    """Write to stderr in here: that it cannot be written to is no reason for anything else to change."""
    try:
        yield
    except OSError:
        silence(sys.stderr)


def silence(stream: TextIO) -> None:
    """Forget what a stream has not written yet, so that nothing fails anew when the interpreter flushes it."""
    with suppress(OSError, ValueError, AttributeError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def in_colour() -> bool:
    """Whether stdout is a terminal whose user did not refuse colours (no-color.org)."""
    return _is_terminal(sys.stdout) and not os.environ.get("NO_COLOR")


_PLAIN = ("ascii", "us-ascii", "ansi_x3.4-1968")
"""Encodings of terminals that have no more than ASCII."""
_SPELT = str.maketrans({"\N{PLUS-MINUS SIGN}": "+-", "\N{HORIZONTAL ELLIPSIS}": "...", "\N{MINUS SIGN}": "-"})
"""What is written there for signs of ours; what is in names of others is escaped."""


class Live:
    """One line on stderr that is written over and over; where stderr is no terminal nothing, but of long studies.

    Who wants to hear everything has a line for each state, wherever stderr goes.
    """

    def __init__(self) -> None:
        self._kept = VOICE.get() is Voice.VERBOSE
        self._shown = not self._kept and VOICE.get() is Voice.NORMAL and _is_terminal(sys.stderr)
        self._due, self._told, self._tenth = 0.0, time.monotonic(), 0

    def show(self, text: str) -> None:
        """Replace the line, unless it was replaced a moment ago."""
        if time.monotonic() >= self._due:
            self.replace(text)

    def report(self, text: str, share: float) -> None:
        """Report a share of work that is done; where nobody sees a line change, print a line that stays now and then.

        Parameters
        ----------
        share
            From 0 to 1; each tenth has a line, unless the last one was written a moment ago.
        """
        if self._shown or self._kept or VOICE.get() is not Voice.NORMAL:
            self.show(text)
            return
        now = time.monotonic()
        waited, further = now - self._told, int(MOST_PROGRESS_LINES * share) > self._tenth
        if waited >= LONGEST_PROGRESS_INTERVAL or (further and waited >= SHORTEST_PROGRESS_INTERVAL):
            self._told, self._tenth = now, int(MOST_PROGRESS_LINES * share)
            with unless_unwritable():
                _write(sys.stderr, f"{text}\n")

    def replace(self, text: str) -> None:
        """Replace the line at once, for what is said now may stand for long."""
        if self._kept:
            self._due = time.monotonic() + INTERVAL
            with unless_unwritable():
                _write(sys.stderr, f"{text}\n")
        if self._shown:
            self._due = time.monotonic() + INTERVAL
            width = shutil.get_terminal_size().columns - 1
            with unless_unwritable():
                _write(sys.stderr, f"\r\x1b[K{text[:width]}")

    def erase(self) -> None:
        if self._shown and self._due:
            with unless_unwritable():
                _write(sys.stderr, "\r\x1b[K")


@contextmanager
def live() -> Iterator[Live]:
    """A live line, which also says what takes long, and is gone at the end, whatever the end is."""
    line = Live()
    try:
        with activity.heard(lambda what: line.replace(said.message(what))):
            yield line
    finally:
        line.erase()


def _is_terminal(stream: TextIO | None) -> bool:
    return stream is not None and stream.isatty() and os.environ.get("TERM") != "dumb"


def _write(stream: TextIO | None, text: str) -> None:
    if stream is None:  # the process was started without it
        return
    encoding = stream.encoding or "utf-8"
    if not text.isascii() and encoding.lower() in _PLAIN:
        text = text.translate(_SPELT)
    stream.write(text.encode(encoding, "backslashreplace").decode(encoding))
    stream.flush()
