"""Sets of result files, replaced as a whole and read only as a whole.

A set is what its ``result.json`` lists, with sizes and digests. Several files cannot take their places in one step, so
a set is replaced in steps after each of which a process may be killed, and :func:`read` still finds all of the old set
or all of the new one:

1. The new files and their list are written into a hidden folder, which no reader looks into.
2. That folder gets the name ``.satsym-next``. From here on the new set is the one that counts.
3. Files of the old set that the new one does not have are removed; the new files take their places, the list last.

Whoever writes next completes step 3 and removes what step 1 left. Readers change nothing: they look for each file in
``.satsym-next`` first, and know it by its digest.
"""

from __future__ import annotations

import os
import shutil
import time
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec

from satsym.report.results.files import Content, store, text, to_json, unwritable
from satsym.report.results.set_list import LIST, STUDY, Listed, content, decoded, is_listed, listed_as, unusable
from satsym.status import BadInput
from satsym.wording import printable

NEXT = ".satsym-next"
STAGING = ".satsym-new-"

KEPT_APART = (STUDY, "plot")
"""Commands whose result folders replace only results of the same command."""


@dataclass(frozen=True)
class Found:
    """A set of files that was read."""

    folder: Path
    """Folder of the result."""
    command: str
    """Command that wrote the result."""
    result: bytes
    """Text of the file result.json."""
    listed: Mapping[str, Listed]
    """Names of the other files of the result."""
    contents: Mapping[str, bytes]
    """Contents of the requested files."""


def write(folder: Path, result: Mapping[str, Any], files: Mapping[str, Content]) -> list[Path]:
    """Replace the set of a folder, which is created if necessary; other files in it are left alone.

    Parameters
    ----------
    result
        What result.json holds, without the list ``files``, which is added.
    files
        Name -> content of all other files.

    Returns
    -------
    list of Path
        Of the files in their order, result.json last.

    Raises
    ------
    BadInput
        If the folder cannot be written to.
    """
    return _write(folder, result, files, None)


def extend(found: Found, files: Mapping[str, Content]) -> list[Path]:
    """Add files to a set that was read, or replace them in it; return their paths.

    Its result.json keeps its time, because the result is as old as before.

    Raises
    ------
    BadInput
        If the folder cannot be written to, or the set has been replaced since it was read.
    """
    result = msgspec.json.decode(found.result)
    del result["files"]
    return _write(found.folder, result, files, found)[:-1]


def read(folder: Path, wanted: Collection[str] = ()) -> Found:
    """Return the set of a folder, with every file checked against the list.

    Parameters
    ----------
    wanted
        Files whose content is wanted, as far as the set has them.

    Raises
    ------
    BadInput
        If there is none, or a file is missing or is not what the list says.
    """
    if not folder.is_dir():
        return _verified(folder, folder / LIST, wanted)
    try:
        with locked(folder, shared=True):
            return _counting(folder, wanted)
    except OSError as error:
        raise unusable(folder / LIST, f"cannot be opened ({error.strerror or 'not a file'})") from None


def written_at(folder: Path) -> int | None:
    """Return when the set of a folder was written, in nanoseconds; ``None`` where there is none."""
    for place in (folder / NEXT / LIST, folder / LIST):
        with suppress(OSError):
            return place.stat().st_mtime_ns
    return None


def command_of(folder: Path) -> str | None:
    """Return the command that wrote the set of a folder, ``None`` where there is none.

    Raises
    ------
    BadInput
        If its result.json cannot be read.
    """
    place = next((p for p in (folder / NEXT / LIST, folder / LIST) if p.exists()), None)
    return None if place is None else printable(decoded(place)[1])


def keep_apart(folder: Path, command: str) -> None:
    """Refuse a folder whose set must not be replaced by one of another command.

    A study is neither replaced by another command, because it may have taken days, nor replaces another result; the
    same holds for pictures without their result.

    Raises
    ------
    BadInput
        If the folder holds such a set.
    """
    try:
        other = command_of(folder)
    except BadInput:
        if command == "plot":
            raise
        return  # which is not whole, and is to be written anew
    if other not in (None, command) and (other == STUDY or command in KEPT_APART):
        raise BadInput(f"{printable(str(folder))}: contains the result of {other}; give another folder")


def _counting(folder: Path, wanted: Collection[str]) -> Found:
    """Return the valid set: the next one if it is complete, else the one in place."""
    with suppress(BadInput):
        return _verified(folder, folder / NEXT / LIST, wanted)
    return _verified(folder, folder / LIST, wanted)


def _verified(folder: Path, path: Path, wanted: Collection[str]) -> Found:
    raw, command, listed = decoded(path)
    contents = {}
    for name, each in listed.items():
        place = next((p for p in (path.parent / name, folder / name) if is_listed(p, each)), None)
        if place is None:
            raise unusable(folder / name, f"is listed in {LIST}, but is missing or has changed", command)
        if name in wanted:
            contents[name] = content(place, each)
    return Found(folder, command, raw, listed, contents)


def _write(folder: Path, result: Mapping[str, Any], files: Mapping[str, Content], found: Found | None) -> list[Path]:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with locked(folder):
            _recover(folder)
            if found is not None and decoded(folder / LIST)[0] != found.result:
                raise BadInput(f"{printable(str(folder))}: was rewritten in the meantime; try again")
            for name in (*files, LIST):
                if (folder / name).is_dir():
                    raise BadInput(f"{printable(str(folder / name))}: is a folder; remove it, or give another folder")
            _stage(folder, result, files, found)
            _install(folder)
    except OSError as error:
        raise unwritable(folder, error) from None
    return [folder / name for name in (*files, LIST)]


def _stage(folder: Path, result: Mapping[str, Any], files: Mapping[str, Content], found: Found | None) -> None:
    """Do steps 1 and 2; an interruption, except for a kill, leaves nothing behind."""
    staging = folder / f"{STAGING}{os.getpid()}"
    staging.mkdir()
    try:
        for name, written in files.items():
            store(staging / name, written)
        listed = dict(found.listed) if found else {}
        listed |= {name: listed_as(staging / name) for name in files}
        plain = {name: msgspec.structs.asdict(each) for name, each in listed.items()}
        store(staging / LIST, text(to_json({**result, "files": plain})))
        if found and (then := written_at(folder)) is not None:
            os.utime(staging / LIST, ns=(then, then))
        _flush(staging)
        staging.rename(folder / NEXT)
    except BaseException:
        shutil.rmtree(staging, ignore_errors=True)
        raise
    _flush(folder)


def _install(folder: Path) -> None:
    """Do step 3, from wherever it was interrupted."""
    source = folder / NEXT
    _, _, listed = decoded(source / LIST)
    for name, each in _listed_before(folder).items():
        if name not in listed and is_listed(folder / name, each):
            (folder / name).unlink()
    for name in (*listed, LIST):
        if (source / name).exists():
            (source / name).replace(folder / name)
    shutil.rmtree(source)
    _flush(folder)


def _recover(folder: Path) -> None:
    """Complete or undo what a killed process has begun."""
    if (folder / NEXT).exists():
        try:
            _verified(folder, folder / NEXT / LIST, ())
        except BadInput:
            shutil.rmtree(folder / NEXT)
        else:
            _install(folder)
    for leftover in folder.glob(f"{STAGING}*"):
        shutil.rmtree(leftover)


def _flush(folder: Path) -> None:
    """Make the system write the names in a folder to the disk, where that is possible."""
    if os.name == "posix":
        handle = os.open(folder, os.O_RDONLY)
        try:
            with suppress(OSError):  # not every file system can
                os.fsync(handle)
        finally:
            os.close(handle)


def _listed_before(folder: Path) -> dict[str, Listed]:
    try:
        return decoded(folder / LIST)[2]
    except BadInput:
        return {}


def listed(folder: Path) -> set[str]:
    """Return the names of the files of the set in a folder, with its list; empty where there is no such list."""
    for place in (folder / NEXT / LIST, folder / LIST):
        with suppress(BadInput):
            return {*decoded(place)[2], LIST}
    return set()


PATIENCE, PAUSE = 30.0, 0.01
"""Seconds of waiting for another process, and seconds between two attempts."""


@contextmanager
def locked(folder: Path, *, shared: bool = False) -> Iterator[None]:
    """Keep other processes from writing into a folder; without effect where the system has no such locks.

    The lock is on the folder itself, so that it leaves no file, and goes with the process. A shared one lets others
    read.
    """
    try:
        import fcntl
    except ImportError:
        yield
        return
    kind = (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | fcntl.LOCK_NB
    handle, until = os.open(folder, os.O_RDONLY), time.monotonic() + PATIENCE
    try:
        while not _taken(lambda: fcntl.flock(handle, kind)):
            if time.monotonic() > until:
                raise BadInput(
                    f"{printable(str(folder))}: is in use by another process; wait until it is free, or give "
                    "another folder"
                )
            time.sleep(PAUSE)
        yield
    finally:
        os.close(handle)


def _taken(lock: Callable[[], None]) -> bool:
    """Tell whether a lock was taken, or cannot be taken on this file system."""
    try:
        lock()
    except BlockingIOError:
        return False
    except OSError:
        return True
    return True
