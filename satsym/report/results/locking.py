"""Folders that one process at a time writes into."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from satsym.status import BadInput
from satsym.wording import printable

PATIENCE, PAUSE = 30.0, 0.01
"""Seconds to wait for another process, and between two looks."""


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
                raise BadInput(f"{printable(str(folder))}: in use by another process; wait for it, or give another")
            time.sleep(PAUSE)
        yield
    finally:
        os.close(handle)


def _taken(lock: Callable[[], None]) -> bool:
    """Whether a lock was taken, or cannot be had on this file system."""
    try:
        lock()
    except BlockingIOError:
        return False
    except OSError:
        return True
    return True
