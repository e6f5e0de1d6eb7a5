"""The only writer of output: data to stdout; complaints and live progress to stderr, progress only on a terminal."""

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
    """How much output the user wants."""

    QUIET = "quiet"
    NORMAL = "normal"
    VERBOSE = "verbose"


VOICE: ContextVar[Voice] = ContextVar("voice", default=Voice.NORMAL)
"""How much is printed in the current run."""
INTERVAL = 0.1
"""Seconds between two updates of the live line."""
MOST_PROGRESS_LINES, SHORTEST_PROGRESS_INTERVAL, LONGEST_PROGRESS_INTERVAL = 10, 5.0, 60.0
"""Largest number of permanent progress lines, and the least and the largest number of seconds between two."""


def emit(text: str) -> None:
    """Write a text to stdout, with a line break at its end.

    Raises
    ------
    Unheard
        If stdout cannot take it, where :func:`hearable` watches it; closed pipes included.
    """
    _write(sys.stdout, text if text.endswith("\n") else text + "\n")


def tell(text: str) -> None:
    """Print a text for people, unless output is to be quiet."""
    if VOICE.get() is not Voice.QUIET:
        emit(text)


def emit_json(value: Mapping[str, Any]) -> None:
    """Write an object to stdout as JSON."""
    from satsym.report.results.files import to_json

    emit(to_json(value))


def answer(as_json: bool, value: Mapping[str, Any], text: Callable[[], str]) -> None:
    """Write the result of a command, as JSON or as text for people, unless output is to be quiet."""
    if as_json:
        emit_json(value)
    elif VOICE.get() is not Voice.QUIET:  # nor need it be made
        emit(text())


def complain(message: str) -> None:
    """Write one line to stderr, as far as that is possible."""
    with unless_unwritable():
        _write(sys.stderr, f"satsym: {said.message(message.rstrip())}\n")


class Unheard(Exception):
    """Stdout cannot be written to; not an OSError, since libraries handle those in their own ways."""

    def __init__(self, cause: OSError) -> None:
        super().__init__(str(cause))
        self.cause = cause


@contextmanager
def hearable() -> Iterator[None]:
    """Raise :class:`Unheard` in this context where stdout cannot be written to, whoever writes."""
    before = sys.stdout
    if before is not None:
        sys.stdout = cast(TextIO, _Watched(before))
    try:
        yield
    finally:
        sys.stdout = before


class _Watched:
    """A stream that raises another error where it cannot be written to."""

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
    """Ignore errors of writing to stderr in this context."""
    try:
        yield
    except OSError:
        silence(sys.stderr)


def silence(stream: TextIO) -> None:
    """Discard what a stream has buffered, so that the interpreter's final flush does not fail."""
    with suppress(OSError, ValueError, AttributeError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def in_colour() -> bool:
    """Tell whether stdout is a terminal whose user did not refuse colours (no-color.org)."""
    return _is_terminal(sys.stdout) and not os.environ.get("NO_COLOR")


_PLAIN = ("ascii", "us-ascii", "ansi_x3.4-1968")
"""Encodings of terminals that have only ASCII characters."""
_SPELT = str.maketrans({"\N{PLUS-MINUS SIGN}": "+-", "\N{HORIZONTAL ELLIPSIS}": "...", "\N{MINUS SIGN}": "-"})
"""ASCII replacements of satsym's own signs; those in other names are escaped."""


class Live:
    """A line on stderr that is overwritten; without a terminal only long studies report.

    With verbose output each state has a line of its own, on a terminal or not.
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
        """Report a fraction of work done; without a terminal, print a permanent line now and then.

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
        """Replace the line at once, for a state that may last."""
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
    """Show a live line in this context, which reports slow operations and is removed at the end."""
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
