"""The one writer: data to stdout; complaints and live progress to stderr, the latter on a terminal only."""

from __future__ import annotations

import json
import os
import shutil
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any, TextIO

INTERVAL = 0.1
"""Seconds between two states of the live line."""


def emit(text: str) -> None:
    """Write a text to stdout, with a line break at its end.

    Raises
    ------
    OSError
        If stdout cannot take it; closed pipes included.
    """
    _write(sys.stdout, text if text.endswith("\n") else text + "\n")


def emit_json(value: Mapping[str, Any]) -> None:
    """Write an object to stdout as JSON."""
    emit(to_json(value))


def to_json(value: Mapping[str, Any]) -> str:
    """The object as JSON text, plain ASCII. Raises ValueError for a number that is not finite."""
    return json.dumps(value, indent=2, allow_nan=False) + "\n"


def complain(message: str) -> None:
    """One line on stderr."""
    _write(sys.stderr, f"satsym: {message.rstrip()}\n")


def silence() -> None:
    """Forget what stdout has not written yet, so that nothing fails anew when the interpreter flushes it."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def in_colour() -> bool:
    """Whether stdout is a terminal whose user did not refuse colours (no-color.org)."""
    return _is_terminal(sys.stdout) and not os.environ.get("NO_COLOR")


class Live:
    """One line on stderr that is written over and over; nothing at all where stderr is no terminal."""

    def __init__(self) -> None:
        self._shown = _is_terminal(sys.stderr)
        self._due = 0.0

    def show(self, text: str) -> None:
        """Replace the line, unless it was replaced a moment ago."""
        now = time.monotonic()
        if self._shown and now >= self._due:
            self._due = now + INTERVAL
            width = shutil.get_terminal_size().columns - 1
            _write(sys.stderr, f"\r\x1b[K{text[:width]}")

    def erase(self) -> None:
        if self._shown and self._due:
            _write(sys.stderr, "\r\x1b[K")


@contextmanager
def live() -> Iterator[Live]:
    """A live line that is gone at the end, whatever the end is."""
    line = Live()
    try:
        yield line
    finally:
        line.erase()


def _is_terminal(stream: TextIO | None) -> bool:
    return stream is not None and stream.isatty() and os.environ.get("TERM") != "dumb"


def _write(stream: TextIO | None, text: str) -> None:
    if stream is None:  # the process was started without it
        return
    encoding = stream.encoding or "utf-8"
    stream.write(text.encode(encoding, "backslashreplace").decode(encoding))
    stream.flush()
