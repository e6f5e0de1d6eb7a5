"""Arrays in files of unknown origin: everything about them is checked before anything is read.

A .npz file is a zip archive of .npy files. An archive may name members that are larger than memory, compressed,
encrypted, countless or inside one another, and an array may ask for any amount of memory or hold Python objects. What
NumPy itself writes of numbers and names has none of that, and nothing else is read.
"""

from __future__ import annotations

import io
import math
import struct
import warnings
import zipfile
from typing import Any

import numpy as np
from numpy.typing import NDArray

MOST_MEMBERS = 16
LONGEST_DIRECTORY = 2**16
"""Bytes of an archive's table of contents."""
MOST_AXES, LONGEST_AXIS = 2, 2**31

_END = struct.Struct("<4s4H2LH")
"""The end of an archive: signature, disks, numbers of members, size and place of the directory, a comment."""
_LARGER = b"PK\x06\x07"
"""Refers to a directory of the kind for more than 4 GiB, which could say anything."""


def unpacked(content: bytes) -> dict[str, NDArray[Any]]:
    """The arrays of a .npz file, by name: numbers of double precision, and texts.

    Parameters
    ----------
    content
        Of the file. No more memory is used than a few times its size.

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
        raise ValueError(f"no archive of arrays: {error}") from None


def _check_end(content: bytes) -> None:
    """See that the table of contents is short, before it is read."""
    place = len(content) - _END.size
    if place < 0 or content[place : place + 4] != b"PK\x05\x06":
        raise ValueError("no archive of arrays: it has no end")
    _, _, _, _, members, size, _, _ = _END.unpack_from(content, place)
    if members > MOST_MEMBERS or size > LONGEST_DIRECTORY or content[max(place - 20, 0) :].startswith(_LARGER):
        raise ValueError("no archive of arrays: its table of contents is too long")


def _check_members(members: list[zipfile.ZipInfo], size: int) -> None:
    """See that members are plain, and no longer together than the file."""
    names = [member.filename for member in members]
    if len(set(names)) != len(names) or not all(name.endswith(".npy") for name in names):
        raise ValueError("the archive holds something else than arrays")
    if any(member.compress_type != zipfile.ZIP_STORED or member.flag_bits & 0x1 for member in members):
        raise ValueError("the archive is compressed or encrypted")
    if sum(member.file_size for member in members) > size:
        raise ValueError("the archive promises more than it holds")


def _array(content: bytes) -> NDArray[Any]:
    """The array of a .npy file."""
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
        raise ValueError("an array of something else than numbers or texts")
    left = len(content) - stream.tell()
    if len(shape) > MOST_AXES or any(type(length) is not int or not 0 <= length < LONGEST_AXIS for length in shape):
        raise ValueError("an array of another shape than it has numbers")
    if math.prod(shape) * kind.itemsize != left:
        raise ValueError("an array of another shape than it has numbers")
    found: NDArray[Any] = np.frombuffer(content, kind, offset=stream.tell())
    found = found.reshape(shape, order="F" if by_columns else "C")
    if kind.kind == "U":
        found.tolist()  # raises for what is not text
        return found
    return found.astype(np.float64)
