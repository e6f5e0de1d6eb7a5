"""The list of files in the ``result.json`` of a set, and checks of files against it; see :mod:`.sets`."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import IO

import msgspec

from satsym.report.results.files import opened
from satsym.status import BadInput
from satsym.wording import printable, shown

LIST = "result.json"

MOST_FILES = 200
LONGEST_LIST = 2**24
"""Largest size of a result.json that is read, in bytes."""
LARGEST_READ = 2**28
"""Largest size in bytes of a file that is read, twice the size that an instance can lead to."""
BLOCK = 2**20


class Listed(msgspec.Struct, frozen=True):
    """A file in the list of its set."""

    bytes: int
    sha256: str


class _List(msgspec.Struct):
    """The part of result.json that lists its files; those of older versions list none."""

    files: dict[str, Listed] | None = None
    command: str = ""


STUDY, ASKED = "study", "study.json"
"""The command whose results take long to compute, and the first file that it writes."""


def unusable(path: Path, why: str, command: str = "", more: str = "") -> BadInput:
    """Return the complaint about a file of a set, with the command that writes such a set.

    Parameters
    ----------
    command, more
        The command that wrote it, where that is known, and options that it had.
    """
    if not command.isalpha():
        command = STUDY if (path.parent / ASKED).is_file() else "solve"
    more += " --resume" if command == STUDY else ""
    place = printable(str(path.parent), 120)
    return BadInput(f"{printable(str(path), 120)}: {why}; `satsym {command} X{more} --out {place}` writes it again")


def decoded(path: Path) -> tuple[bytes, str, dict[str, Listed]]:
    """Return text, command and files of a result.json.

    Raises
    ------
    BadInput
        If it cannot be read, or lists none or what no set has.
    """
    try:
        with opened(path) as (stream, size):
            if size > LONGEST_LIST:
                raise unusable(path, "cannot be read (it is too long)")
            raw = stream.read(size)
        found = msgspec.json.decode(raw, type=_List)
    except OSError as error:
        raise unusable(path, f"cannot be opened ({error.strerror or 'not a file'})") from None
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise unusable(path, f"cannot be read ({printable(str(error))})") from None
    if found.files is None:
        raise unusable(path, "does not list its files, so it was written by another version of satsym", found.command)
    wrong = next((name for name, each in found.files.items() if not (may_hold(name) and each.bytes >= 0)), None)
    if wrong is not None or len(found.files) > MOST_FILES:
        which = shown(wrong) if wrong is not None else f"more than {MOST_FILES}"
        raise unusable(path, f"lists files that are not part of a result: {which}", found.command)
    return raw, found.command, found.files


def may_hold(name: str) -> bool:
    """Tell whether a set may have a file of this name: a plain name in its own folder."""
    plain = name.isprintable() and 0 < len(name) <= 100 and name[0] not in ". " and not set("/\\:") & set(name)
    return plain and name != LIST


def is_listed(path: Path, listed: Listed) -> bool:
    """Tell whether a file is the listed one, by its size first and then its digest."""
    try:
        with opened(path) as (stream, size):
            return size == listed.bytes and _digest(stream) == listed.sha256
    except OSError:
        return False


def content(path: Path, listed: Listed) -> bytes:
    """Return the content of a listed file after a check against the list.

    Raises
    ------
    BadInput
        If it is too large, or not the right one after all.
    """
    if listed.bytes > LARGEST_READ:
        raise unusable(path, f"is larger than {LARGEST_READ} bytes")
    try:
        with opened(path) as (stream, _):
            found = stream.read(listed.bytes + 1)
    except OSError as error:
        raise unusable(path, f"cannot be opened ({error.strerror or 'not a file'})") from None
    if hashlib.sha256(found).hexdigest() != listed.sha256:
        raise unusable(path, "changed while it was being read")
    return found


def listed_as(path: Path) -> Listed:
    """Return the entry of a file in a list."""
    with opened(path) as (stream, size):
        return Listed(size, _digest(stream))


def _digest(stream: IO[bytes]) -> str:
    found = hashlib.sha256()
    while block := stream.read(BLOCK):
        found.update(block)
    return found.hexdigest()
