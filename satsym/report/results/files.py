"""Single files, written whole or not at all; and what files of unknown origin may hold before they are read."""

from __future__ import annotations

import json
import os
import re
import stat
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any, TypeAlias

from satsym.status import BadInput
from satsym.wording import printable

Content: TypeAlias = Callable[[IO[bytes]], object]
"""Writes a file's content to a stream."""

BESIDE = re.compile(r"\.(\d+)\.tmp\Z")
"""How the name of a file ends that is not finished, with the process that writes it."""


def text(content: str) -> Content:
    """A text as the content of a file, in UTF-8."""
    return lambda stream: stream.write(content.encode())


def binary(content: bytes) -> Content:
    """Bytes as the content of a file."""
    return lambda stream: stream.write(content)


def to_json(value: Mapping[str, Any]) -> str:
    """The object as JSON text, plain ASCII. Raises ValueError for a number that is not finite."""
    return json.dumps(value, indent=2, allow_nan=False) + "\n"


def check_writable(folder: Path) -> None:
    """See, without making anything, whether files can be written into a folder that need not exist yet.

    Raises
    ------
    BadInput
        If not.
    """
    try:
        existing = next(place for place in (folder, *folder.absolute().parents) if place.exists())
        fine = existing.is_dir() and os.access(existing, os.W_OK | os.X_OK)
    except OSError as error:
        raise unwritable(folder, error) from None
    if not fine:
        reason = "no permission to write there" if existing.is_dir() else f"{printable(str(existing))} is not a folder"
        raise BadInput(f"{printable(str(folder))}: {reason}; give another folder")


def store(path: Path, content: Content) -> None:
    """Write a new file and flush it to the disk."""
    with path.open("wb") as stream:
        content(stream)
        stream.flush()
        os.fsync(stream.fileno())


def write_text(path: Path, content: str) -> None:
    """Write a text file whole or not at all; through links, and straight into what is a device or a pipe.

    It is written beside its place and flushed to the disk before it takes it. What a killed process has left beside it
    is removed.

    Raises
    ------
    BadInput
        If it cannot be written.
    """
    try:
        target = path.resolve()
        if target.is_dir():
            raise BadInput(f"{printable(str(path))}: is a folder; give the name of a file")
        if target.exists() and not target.is_file():
            target.write_text(content, encoding="utf-8")
            return
        target.parent.mkdir(parents=True, exist_ok=True)
        _sweep(target)
        beside = target.with_name(f".{target.name}.{os.getpid()}.tmp")
        try:
            store(beside, text(content))
            beside.replace(target)
        finally:
            beside.unlink(missing_ok=True)
    except (OSError, RuntimeError) as error:  # RuntimeError: a loop of links
        raise unwritable(path, error) from None


def unwritable(place: Path, error: Exception) -> BadInput:
    """The complaint about a place that the system would not write to."""
    reason = getattr(error, "strerror", None) or "the path leads nowhere"
    return BadInput(f"{printable(str(place))}: cannot be written ({reason}); give another place")


@contextmanager
def opened(path: Path) -> Iterator[tuple[IO[bytes], int]]:
    """A regular file to be read, and its size; a pipe or a device, which might never end, is no such file.

    Raises
    ------
    OSError
        If it cannot be opened, or is something else.
    """
    # not blocking: a pipe would wait for a writer before it could be seen to be one
    handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    with os.fdopen(handle, "rb") as stream:
        status = os.fstat(stream.fileno())
        if not stat.S_ISREG(status.st_mode):
            raise OSError(None, "not a regular file")
        yield stream, status.st_size


def _sweep(target: Path) -> None:
    """Remove what processes that are gone have left of this file."""
    for path in target.parent.glob(f".{_literal(target.name)}.*.tmp"):
        end = BESIDE.search(path.name)
        if end and path.name[: end.start()] == f".{target.name}" and not _alive(int(end[1])):
            path.unlink(missing_ok=True)


def _literal(name: str) -> str:
    """The name as a pattern that only it matches."""
    return re.sub(r"([*?[])", r"[\1]", name)


def _alive(process: int) -> bool:
    """Whether there may be a process of this number; where that cannot be asked, there may."""
    if os.name != "posix":
        return True
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except OSError:
        return True
    return True
