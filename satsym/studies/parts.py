"""Saved chunks of a study, in two files that grow: rows as lines, trajectories as arrays.

A line holds a chunk, a digest of its study and a digest of itself, and is written after the arrays of its chunk; both
are flushed to the disk before the chunk counts. Whatever ends the process in between leaves an incomplete tail, which
does not count and is cut off before more is appended.
"""

from __future__ import annotations

import hashlib
import io
import json
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import numpy as np

from satsym.arrays import Array
from satsym.status import BadInput, Status
from satsym.studies.rows import PASSING, Row
from satsym.wording import printable

LINES, ARRAYS = "parts.jsonl", "parts.npz"
"""Names of the two files that contain finished parts while a study is being computed."""

DIGEST = 16
"""Number of characters of the digest at the beginning of a line."""


@dataclass(frozen=True)
class Place:
    """The place where the line of a chunk begins."""

    line: int
    size: int
    """Size of the arrays of the part in bytes."""


@dataclass(frozen=True, eq=False)
class Part:
    """A chunk that was read back."""

    number: int
    start: int
    rows: tuple[Row, ...]


class Parts:
    """The two files of a folder; see :func:`opened`.

    Parameters
    ----------
    lines, arrays
        The two open files.
    study
        Digest of the study to which the chunks belong.

    Attributes
    ----------
    done
        Places of the complete chunks by number.
    failures
        Number of rows without an answer in these chunks.
    rows
        Number of all rows in these chunks.
    """

    def __init__(self, lines: IO[bytes], arrays: IO[bytes], study: str) -> None:
        self._lines, self._arrays, self._study = lines, arrays, study
        self.done: dict[int, Place] = {}
        self.failures = self.rows = 0

    def recover(self) -> None:
        """Find the complete chunks, and cut off an incomplete tail.

        Chunks with rows that lost their workers or ran out of time do not count, since they may be answered in another
        run.

        Raises
        ------
        BadInput
            If there are chunks of another study.
        """
        self._lines.seek(0)
        end = arrays_end = 0
        for line in self._lines:
            found = _decoded(line)
            if found is None or found["arrays"][0] + found["arrays"][1] > _size(self._arrays):
                break
            if found.get("study") != self._study:
                raise BadInput(
                    f"{printable(self._lines.name)}: contains cases of another study; give another folder, or "
                    "remove them"
                )
            if all(status not in PASSING for _, status, *_ in found["rows"]):
                self.done[found["chunk"]] = Place(end, found["arrays"][1])
                self._count(found["rows"])
            end += len(line)
            arrays_end = max(arrays_end, found["arrays"][0] + found["arrays"][1])
        for stream, size in ((self._lines, end), (self._arrays, arrays_end)):
            stream.truncate(size)
            stream.seek(size)

    def append(self, number: int, start: int, rows: Sequence[Row]) -> None:
        """Save a chunk; it counts once this returns.

        Raises
        ------
        OSError
            If it cannot be written; then it does not count, and what was written of it is cut off by the next run.
        """
        kept = {place: row.trajectory for place, row in enumerate(rows) if row.trajectory}
        packed = _packed(kept)
        begin, size = self._arrays.tell(), self._lines.tell()
        entry: dict[str, Any] = {
            "study": self._study,
            "chunk": number,
            "start": start,
            "arrays": [begin, len(packed)],
            "rows": [[row.key, row.status, row.message, dict(row.numbers)] for row in rows],
        }
        if packed:
            _write(self._arrays, packed)
        _write(self._lines, _encoded(entry))
        self.done[number] = Place(size, len(packed))
        self._count(entry["rows"])

    def read(self, number: int) -> Part:
        """Read a saved chunk."""
        self._lines.seek(self.done[number].line)
        found = _decoded(self._lines.readline())
        if found is None:
            raise BadInput(
                f"{printable(self._lines.name)}: changed while it was being read; repeat the command with --resume"
            )
        rows = tuple(Row(key, status, message, numbers) for key, status, message, numbers in found["rows"])
        return Part(found["chunk"], found["start"], rows)

    def size(self, number: int) -> int:
        """Return the bytes of the trajectories of the chunk with this number."""
        return self.done[number].size

    def trajectories(self, number: int) -> dict[int, dict[str, Array]]:
        """Return the trajectories of a chunk by the place of their row in it, each as arrays by name."""
        self._lines.seek(self.done[number].line)
        found = _decoded(self._lines.readline())
        if found is None or not found["arrays"][1]:
            return {}
        self._arrays.seek(found["arrays"][0])
        with np.load(io.BytesIO(self._arrays.read(found["arrays"][1])), allow_pickle=False) as stored:
            kept: dict[int, dict[str, Array]] = {}
            for name in stored.files:
                place, _, what = name.partition(".")
                kept.setdefault(int(place), {})[what] = stored[name]
        return kept

    def _count(self, rows: Sequence[Sequence[Any]]) -> None:
        self.rows += len(rows)
        self.failures += sum(status != Status.CONVERGED.value for _, status, *_ in rows)


@contextmanager
def opened(folder: Path, study: str) -> Iterator[Parts]:
    """Open the saved chunks of a folder, none in a new one; no other process can open them meanwhile.

    Parameters
    ----------
    study
        Digest of the study to which the chunks belong.

    Raises
    ------
    BadInput
        If another process has them, or they are of another study.
    """
    with (folder / LINES).open("a+b") as lines, (folder / ARRAYS).open("a+b") as arrays:
        _lock(lines, folder)
        found = Parts(lines, arrays, study)
        found.recover()
        yield found


def remove(folder: Path) -> None:
    """Remove the files after all chunks are merged: the arrays first, since the lines state which there were."""
    for name in (ARRAYS, LINES):
        (folder / name).unlink(missing_ok=True)


def _lock(stream: IO[bytes], folder: Path) -> None:
    """Lock a file for as long as it is open; without effect where the system has no such locks."""
    try:
        import fcntl
    except ImportError:
        return
    try:
        fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise BadInput(
            f"{printable(str(folder))}: is in use by another process; wait until it is free, or give another folder"
        ) from None
    except OSError:
        return  # a file system without locks


def _encoded(entry: Mapping[str, Any]) -> bytes:
    text = json.dumps(entry, allow_nan=False, separators=(",", ":")).encode()
    return _digest(text) + b" " + text + b"\n"


def _decoded(line: bytes) -> dict[str, Any] | None:
    """Return the contents of a line; ``None`` for an incomplete one."""
    digest, _, text = line.rstrip(b"\n").partition(b" ")
    if not line.endswith(b"\n") or digest != _digest(text):
        return None
    found: dict[str, Any] = json.loads(text)
    return found


def _digest(text: bytes) -> bytes:
    return hashlib.blake2b(text, digest_size=DIGEST // 2).hexdigest().encode()


def _packed(kept: Mapping[int, Mapping[str, Array]]) -> bytes:
    if not kept:
        return b""
    stream = io.BytesIO()
    named: dict[str, Any] = {f"{place}.{name}": row for place, arrays in kept.items() for name, row in arrays.items()}
    np.savez(stream, **named)
    return stream.getvalue()


def _size(stream: IO[bytes]) -> int:
    return os.fstat(stream.fileno()).st_size


def _write(stream: IO[bytes], content: bytes) -> None:
    stream.write(content)
    stream.flush()
    os.fsync(stream.fileno())
