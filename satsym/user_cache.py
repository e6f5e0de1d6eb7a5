"""A cache, in the user's folder for such data, of results that can be computed again."""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from contextlib import suppress
from pathlib import Path


def folder(purpose: str) -> Path:
    """Return the cache folder for one purpose, which need not exist."""
    if stated := os.environ.get("XDG_CACHE_HOME"):
        return Path(stated) / "satsym" / purpose
    if sys.platform == "win32" and (local := os.environ.get("LOCALAPPDATA")):
        return Path(local) / "satsym" / purpose
    home = Path.home()
    return home / ("Library/Caches" if sys.platform == "darwin" else ".cache") / "satsym" / purpose


def read(path: Path) -> bytes:
    """Return the content cached at a path; empty where there is none, or it cannot be read."""
    try:
        return path.read_bytes()
    except OSError:
        return b""


def write(path: Path, content: bytes) -> None:
    """Cache a content by writing a file and moving it, so that no reader sees half of it; errors are ignored."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=path.parent, suffix=".part")
        with os.fdopen(handle, "wb") as stream:
            stream.write(content)
        Path(name).replace(path)
    except OSError:
        return


def used(place: Path) -> None:
    """Record that a cache folder was used, for :func:`prune`."""
    with suppress(OSError):
        os.utime(place)


def prune(parent: Path, most: int, left: Path) -> None:
    """Remove the least recently used folders, until the others have no more than so many bytes.

    Parameters
    ----------
    left
        The one that stays in any case.
    """
    ages: list[tuple[float, int, Path]] = []
    with suppress(OSError):
        for one in parent.iterdir():
            if one.is_dir():
                ages.append((one.stat().st_mtime, sum(file.stat().st_size for file in one.iterdir()), one))
    total = 0
    for _, size, one in sorted(ages, key=lambda each: (each[2] != left, -each[0])):
        total += size
        if total > most and one != left:
            shutil.rmtree(one, ignore_errors=True)
