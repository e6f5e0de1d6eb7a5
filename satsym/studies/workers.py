"""Worker processes in the form of ``concurrent.futures``, of which one that dies does not affect the others.

The workers of an existing Dask cluster have the same form.
"""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import import_module
from multiprocessing import get_context
from multiprocessing.connection import Connection, wait
from multiprocessing.resource_tracker import ensure_running
from queue import SimpleQueue
from socket import create_connection
from threading import Lock, Thread
from types import ModuleType
from typing import Any
from urllib.parse import urlsplit

from satsym.status import BadInput
from satsym.wording import printable, shown

LIBRARIES = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
ONE_THREAD = dict.fromkeys(LIBRARIES, "1")
"""Variables of the environment that limit libraries to one thread when they are loaded."""

QUIETLY = {"PYTHONWARNINGS": "ignore:resource_tracker"}
"""Environment of the resource tracker, which would otherwise warn of semaphores left by a killed process."""


@dataclass(frozen=True, eq=False)
class _Process:
    """A pool of one process, and a pipe whose closing ends that process."""

    pool: ProcessPoolExecutor
    lifeline: Connection

    def end(self) -> None:
        self.lifeline.close()
        self.pool.shutdown(wait=True, cancel_futures=True)


class Workers(Executor):
    """Several pools of one process each, so that it is known what a process that dies was at.

    A library's pool is broken as a whole by the death of one of its processes; here the next call has another process.
    All end with this process, whatever ends it.

    Parameters
    ----------
    count
        Number of processes, and of calls at a time; submitting another call waits until one of them is over.
    """

    def __init__(self, count: int) -> None:
        self._all = [_begun() for _ in range(count)]
        self._over, self._renewing = False, Lock()
        self._idle: SimpleQueue[int] = SimpleQueue()
        for k in range(count):
            self._idle.put(k)

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Compute a call in an idle process, as ``Executor.submit`` does."""
        k = self._idle.get()
        with _inherited(ONE_THREAD), _main_hidden():
            try:
                future = self._all[k].pool.submit(fn, *args, **kwargs)
            except BrokenExecutor:  # a process that died with nothing to do
                self._renew(k)
                future = self._all[k].pool.submit(fn, *args, **kwargs)

        def over(done: Future[Any]) -> None:
            if not done.cancelled() and isinstance(done.exception(), BrokenExecutor):
                self._renew(k)
            self._idle.put(k)

        future.add_done_callback(over)
        return future

    def _renew(self, k: int) -> None:
        with self._renewing:  # while all end, which another thread may have them do
            if not self._over:
                self._all[k].lifeline.close()
                self._all[k] = _begun()

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End all processes, whatever they are at."""
        with self._renewing:
            self._over = True
        for process in self._all:
            process.end()


def processes(wanted: int | None, chunks: int) -> int:
    """Return the number of processes for so many chunks: by default one for each usable processor.

    Raises
    ------
    BadInput
        If less than one is wanted.
    """
    if wanted is not None and (not isinstance(wanted, int) or wanted < 1):
        raise BadInput(
            f"workers: the number of workers must be positive, not {shown(wanted)}; give a whole number of at "
            "least 1, or leave it out"
        )
    return min(wanted or usable_processors(), chunks)


def usable_processors() -> int:
    """Return the number of processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _begun() -> _Process:
    """Return a pool whose process begins with its first call."""
    with _inherited(QUIETLY):
        ensure_running()
    context = get_context("spawn")
    theirs, ours = context.Pipe(duplex=False)
    return _Process(ProcessPoolExecutor(1, context, _tied, (theirs,)), ours)


def _tied(lifeline: Connection) -> None:
    """End this process when the other end of a pipe is closed; only the parent reacts to interrupts."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)

    def watch() -> None:
        wait([lifeline])
        os._exit(1)

    Thread(target=watch, daemon=True).start()


@contextmanager
def _inherited(variables: Mapping[str, str]) -> Iterator[None]:
    """Give processes that are started in this context some environment variables."""
    before = {name: os.environ.get(name) for name in variables}
    os.environ.update(variables)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


@contextmanager
def _main_hidden() -> Iterator[None]:
    """Keep processes that are started in this context from running the user's script again."""
    main = sys.modules["__main__"]
    sys.modules["__main__"] = ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = main


PATIENCE = 10.0
"""Seconds within which a scheduler has to respond."""

AHEAD = 2
"""Number of chunks assigned to each thread of a worker at a time, so that no thread waits for its next chunk."""


@contextmanager
def cluster(address: str) -> Iterator[tuple[Executor, int]]:
    """Return an executor on a cluster, and how many chunks to give it at a time.

    Workers need satsym but share no disk: the study is sent to them, and rows come back.

    Parameters
    ----------
    address
        Address of the scheduler, such as ``tcp://192.168.0.1:8786``.

    Raises
    ------
    BadInput
        If Dask is not installed, or no scheduler with workers answers there.
    """
    try:
        distributed: Any = import_module("distributed")
    except ImportError:
        raise BadInput("Dask is not installed; install the extra: pip install 'satsym[cluster]'") from None
    silent = BadInput(f"{printable(address)}: no Dask scheduler answers there; write tcp://HOST:PORT")
    if not _listens(address):  # a client that waits in vain complains once more when it is removed
        raise silent
    try:
        client = distributed.Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError, TimeoutError):
        raise silent from None
    with client:
        threads = sum(client.nthreads().values())
        if not threads:
            raise BadInput(f"{printable(address)}: the scheduler has no workers; start at least one worker")
        yield client.get_executor(pure=False), AHEAD * threads


def _listens(address: str) -> bool:
    """Tell whether a program listens at an address; unknown for protocols other than TCP."""
    try:
        parts = urlsplit(address if "://" in address else f"tcp://{address}")
        if parts.scheme in ("tcp", "tls"):
            create_connection((parts.hostname or "", parts.port or 0), PATIENCE).close()
    except (OSError, ValueError, OverflowError):
        return False
    return True
