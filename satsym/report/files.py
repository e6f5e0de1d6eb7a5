"""Result files, written whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import IO, TypeAlias

from satsym.status import BadInput
from satsym.wording import printable

Content: TypeAlias = Callable[[IO[bytes]], object]
"""Writes a file's content to a stream."""


def text(content: str) -> Content:
    """A text as the content of a file, in UTF-8."""
    return lambda stream: stream.write(content.encode())


def binary(content: bytes) -> Content:
    """Bytes as the content of a file."""
    return lambda stream: stream.write(content)


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


def write(folder: Path, files: Mapping[str, Content]) -> list[Path]:
    """Write files into a folder, which is made if need be.

    All are written beside their places and flushed to the disk before the first takes its place, so that
    whatever goes wrong meanwhile leaves what was there before.

    Returns
    -------
    list of Path
        In the order of `files`.

    Raises
    ------
    BadInput
        If the folder cannot be written to.
    """
    waiting: dict[Path, Path] = {}
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, content in files.items():
            beside = folder / f".{name}.{os.getpid()}.tmp"
            waiting[beside] = folder / name
            with beside.open("wb") as stream:
                content(stream)
                stream.flush()
                os.fsync(stream.fileno())
        for beside, place in waiting.items():
            beside.replace(place)
    except OSError as error:
        raise unwritable(folder, error) from None
    finally:
        for beside in waiting:
            beside.unlink(missing_ok=True)
    return list(waiting.values())


def write_text(path: Path, content: str) -> None:
    """Write a text file whole or not at all; through links, and straight into what is a device or a pipe.

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
    except (OSError, RuntimeError) as error:  # RuntimeError: a loop of links
        raise unwritable(path, error) from None
    write(target.parent, {target.name: text(content)})


def unwritable(place: Path, error: Exception) -> BadInput:
    """The complaint about a place that the system would not write to."""
    reason = getattr(error, "strerror", None) or "the path leads nowhere"
    return BadInput(f"{printable(str(place))}: cannot be written ({reason}); give another place")
