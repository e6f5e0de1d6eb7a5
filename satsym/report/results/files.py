"""Single files, written whole or not at all; and checks of foreign files before they are read."""

from __future__ import annotations

import io
import json
import math
import os
import re
import stat
import struct
import warnings
import zipfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from satsym.status import BadInput
from satsym.wording import printable

Content: TypeAlias = Callable[[IO[bytes]], object]
"""A function that writes a file's content to a stream."""

BESIDE = re.compile(r"\.(\d+)\.tmp\Z")
"""Pattern of the suffix of an unfinished file, which contains the number of the process that writes it."""


def text(content: str) -> Content:
    """Encode a text as the content of a file, in UTF-8."""
    return lambda stream: stream.write(content.encode())


def binary(content: bytes) -> Content:
    """Return bytes as the content of a file."""
    return lambda stream: stream.write(content)


def to_json(value: Mapping[str, Any]) -> str:
    """Return the object as JSON text in plain ASCII.

    Raises ValueError for a number that is not finite.
    """
    return json.dumps(value, indent=2, allow_nan=False) + "\n"


def check_writable(folder: Path) -> None:
    """Check, without creating anything, that files can be written into a folder that need not exist yet.

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
    """Return the complaint about a place that the system refused to write to."""
    reason = getattr(error, "strerror", None) or "the path cannot be resolved"
    return BadInput(f"{printable(str(place))}: cannot be written ({reason}); choose another location")


@contextmanager
def opened(path: Path) -> Iterator[tuple[IO[bytes], int]]:
    """Open a regular file for reading, and return its size; a pipe or a device, which might never end, is refused.

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
    """Remove the remains of this file that processes which no longer run have left."""
    for path in target.parent.glob(f".{_literal(target.name)}.*.tmp"):
        end = BESIDE.search(path.name)
        if end and path.name[: end.start()] == f".{target.name}" and not _alive(int(end[1])):
            path.unlink(missing_ok=True)


def _literal(name: str) -> str:
    """Return a name as a pattern that matches only it."""
    return re.sub(r"([*?[])", r"[\1]", name)


def _alive(process: int) -> bool:
    """Tell whether a process of this number may exist; where that cannot be decided, it may."""
    if os.name != "posix":
        return True
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except OSError:
        return True
    return True


MOST_MEMBERS = 16
LONGEST_DIRECTORY = 2**16
"""Largest size in bytes of an archive's table of contents."""
MOST_AXES, LONGEST_AXIS = 2, 2**31

_END = struct.Struct("<4s4H2LH")
"""Record at the end of a zip archive: signature, disks, numbers of members, size and position of the table of contents,
comment."""
_LARGER = b"PK\x06\x07"
"""Signature of the table of contents of an archive of more than 4 GiB, which is refused."""


def unpacked(content: bytes) -> dict[str, NDArray[Any]]:
    """Return the arrays of a .npz file by name: numbers of double precision, and texts.

    Parameters
    ----------
    content
        Of the file, a zip archive of .npy files. An archive may name members that are larger than memory, compressed,
        encrypted, countless or inside one another, and an array may ask for any amount of memory or hold objects of
        Python; what NumPy itself writes of numbers and names has none of that, and nothing else is read. No more memory
        is used than a few times its size.

    Raises
    ------
    ValueError
        If it is anything else, with the reason.
    """
    _check_end(content)
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            members = archive.infolist()
            _check_members(members, len(content))
            return {member.filename.removesuffix(".npy"): _array(archive.read(member)) for member in members}
    except (zipfile.BadZipFile, EOFError, KeyError, NotImplementedError, RuntimeError, struct.error) as error:
        raise ValueError(f"not an archive of arrays: {error}") from None


def _check_end(content: bytes) -> None:
    """Check that the table of contents is short, before it is read."""
    place = len(content) - _END.size
    if place < 0 or content[place : place + 4] != b"PK\x05\x06":
        raise ValueError("not an archive of arrays: its end is missing")
    _, _, _, _, members, size, _, _ = _END.unpack_from(content, place)
    if members > MOST_MEMBERS or size > LONGEST_DIRECTORY or content[max(place - 20, 0) :].startswith(_LARGER):
        raise ValueError("not an archive of arrays: its table of contents is too long")


def _check_members(members: list[zipfile.ZipInfo], size: int) -> None:
    """Check that members are plain, and together not longer than the file."""
    names = [member.filename for member in members]
    if len(set(names)) != len(names) or not all(name.endswith(".npy") for name in names):
        raise ValueError("the archive contains something other than arrays")
    if any(member.compress_type != zipfile.ZIP_STORED or member.flag_bits & 0x1 for member in members):
        raise ValueError("the archive is compressed or encrypted")
    if sum(member.file_size for member in members) > size:
        raise ValueError("the archive contains less than it declares")


def _array(content: bytes) -> NDArray[Any]:
    """Return the array of a .npy file."""
    stream = io.BytesIO(content)
    if np.lib.format.read_magic(stream) != (1, 0):
        raise ValueError("an array of an unknown format")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about headers that older versions wrote, and what else the text may do
            shape, by_columns, kind = np.lib.format.read_array_header_1_0(stream)
    except (SyntaxError, TypeError, KeyError, RecursionError, MemoryError, OverflowError) as error:
        raise ValueError(f"an array whose header cannot be read ({type(error).__name__})") from None
    if kind.hasobject or not (kind.kind == "U" or (kind.kind == "f" and kind.itemsize == 8)) or not kind.itemsize:
        raise ValueError("an array of something other than numbers or texts")
    left = len(content) - stream.tell()
    if len(shape) > MOST_AXES or any(type(length) is not int or not 0 <= length < LONGEST_AXIS for length in shape):
        raise ValueError("an array whose shape does not match the number of its entries")
    if math.prod(shape) * kind.itemsize != left:
        raise ValueError("an array whose shape does not match the number of its entries")
    found: NDArray[Any] = np.frombuffer(content, kind, offset=stream.tell())
    found = found.reshape(shape, order="F" if by_columns else "C")
    if kind.kind == "U":
        found.tolist()  # raises for what is not text
        return found
    return found.astype(np.float64)
