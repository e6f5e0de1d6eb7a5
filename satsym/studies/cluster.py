"""The workers of a Dask cluster that is there already, in the shape of ``concurrent.futures``."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from importlib import import_module
from socket import create_connection
from typing import Any
from urllib.parse import urlsplit

from satsym.status import BadInput
from satsym.wording import printable

PATIENCE = 10.0
"""Seconds in which a scheduler has to answer."""

AHEAD = 2
"""Chunks for each thread of a worker, so that none waits for the next."""


@contextmanager
def cluster(address: str) -> Iterator[tuple[Executor, int]]:
    """An executor, and how many chunks to give it at a time.

    Workers need satsym and share no disk: what is solved is sent to them, and rows come back.

    Parameters
    ----------
    address
        Of the scheduler, such as ``tcp://192.168.0.1:8786``.

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
            raise BadInput(f"{printable(address)}: that scheduler has no workers; start some")
        yield client.get_executor(pure=False), AHEAD * threads


def _listens(address: str) -> bool:
    """Whether anything listens there; of other protocols than TCP it is not known."""
    try:
        parts = urlsplit(address if "://" in address else f"tcp://{address}")
        if parts.scheme in ("tcp", "tls"):
            create_connection((parts.hostname or "", parts.port or 0), PATIENCE).close()
    except (OSError, ValueError, OverflowError):
        return False
    return True
