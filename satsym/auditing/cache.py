"""Verdicts kept between runs: nothing is judged twice as long as nothing that it depends on has changed.

The key is a digest of the ledger, of the derivations, kernels and instances, and of the modules of satsym that judging
imports: how verdicts are drawn and printed is none of them. What is found is only ever
compared and read as data; a file that is damaged or of another kind is ignored and written anew.
"""

from __future__ import annotations

import hashlib
import os
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from importlib.resources import files
from multiprocessing import get_context
from pathlib import Path
from queue import Empty
from typing import Any

import msgspec

from satsym import source_files, user_cache
from satsym.auditing.judged import Judged
from satsym.auditing.ledger import documents
from satsym.auditing.ledger.contents import Ledger
from satsym.auditing.run import audit as judge
from satsym.records import shelf

_JUDGING = ("satsym.auditing.run", "satsym.auditing.judged")
_READ = (("satsym.generated", "*.json"), ("satsym.generated", "*.py"), ("satsym", "instances/*.toml"))
"""What judging takes from beside the modules it imports, by package and pattern."""

_DERIVING = 30
"""How many rows are judged, about, while a derivation is derived."""
_LOOK = 0.1
"""Seconds after which it is looked whether a process has ended."""
_LIBRARIES = ("sympy", "numpy", "scipy", "pint", "mpmath")


def audit(
    ledger: Ledger, items: Sequence[str] = (), announce: Callable[[str], None] = lambda _: None, *, fresh: bool = False
) -> list[Judged]:
    """As :func:`satsym.auditing.run.audit`, from the cache unless it is to be fresh; single items are never kept."""
    if items:
        return judge(ledger, items, announce)
    place = _place(ledger)  # of the files as they are now: they may change while it is judged
    before = None if fresh else _read(place)
    if before is not None:
        return before
    found = judge(ledger, items, announce)
    user_cache.write(place, msgspec.json.encode(found))
    return found


def audit_all(
    ledgers: Sequence[Ledger],
    items: Sequence[str] = (),
    announce: Callable[[str], None] = lambda _: None,
    *,
    fresh: bool = False,
) -> dict[str, list[Judged]]:
    """As :func:`audit`, of several documents by key; those that are not kept in a process for each processor."""
    found = {} if fresh or items else {x.document.key: rows for x in ledgers if (rows := _read(_place(x))) is not None}
    left = sorted((x for x in ledgers if x.document.key not in found), key=_work, reverse=True)
    processes = min(os.cpu_count() or 1, len(left))
    if items or processes < 2:
        found |= {ledger.document.key: audit(ledger, items, announce, fresh=fresh) for ledger in left}
    else:
        context = get_context("spawn")
        queue = context.Queue()
        with ProcessPoolExecutor(processes, context, _telling, (queue,)) as pool:
            running = {ledger.document.key: pool.submit(_judged, ledger) for ledger in left}
            _follow(list(running.values()), queue, announce)
            found |= {key: future.result() for key, future in running.items()}
    return {ledger.document.key: found[ledger.document.key] for ledger in ledgers}


def _work(ledger: Ledger) -> int:
    """About how much there is to do, in rows: what takes longest is begun first."""
    return len(ledger.rows) + _DERIVING * len(ledger.models)


def _follow(running: Sequence[Future[list[Judged]]], queue: Any, announce: Callable[[str], None]) -> None:
    """Announce what the processes tell, until all have ended or one has failed."""
    last: dict[str, str] = {}
    while not all(future.done() for future in running):
        if any(future.done() and future.exception() for future in running):
            for future in running:
                future.cancel()
        try:
            document, _, row = queue.get(timeout=_LOOK).partition(": ")
        except Empty:
            continue
        last[document] = f"{document} {row.partition(',')[0].removeprefix('row ')}"
        announce("; ".join(last.values()))


_tell: list[Any] = []
"""Where a process puts what is announced."""


def _telling(queue: Any) -> None:
    queue.cancel_join_thread()  # what nobody reads any more does not keep the process from ending
    _tell.append(queue)


def _judged(ledger: Ledger) -> list[Judged]:
    """All rows of a ledger, in a process of its own."""
    return audit(ledger, (), _tell[0].put, fresh=True)


def _place(ledger: Ledger) -> Path:
    return user_cache.folder("audit") / f"{ledger.document.key[:40]}-{_digest(ledger)}.json"


def _read(path: Path) -> list[Judged] | None:
    try:
        return msgspec.json.decode(user_cache.read(path), type=list[Judged])
    except (ValueError, msgspec.MsgspecError):
        return None


def _digest(ledger: Ledger) -> str:
    digest = hashlib.blake2b(program().encode(), digest_size=16)
    for path in documents.read_from(ledger.path):
        digest.update(path.read_bytes())
    with shelf.opened(ledger.folder):
        for found in filter(None, map(shelf.path_of, ledger.models)):
            digest.update(found.read_bytes())
    return digest.hexdigest()


@cache
def program(modules: tuple[str, ...] = _JUDGING) -> str:
    """A digest of everything that verdicts, or what some modules find, depend on beside the ledger."""
    digest = hashlib.blake2b(digest_size=16)
    digest.update(sys.version.encode())
    for library in _LIBRARIES:
        try:
            digest.update(f"{library} {version(library)}".encode())
        except PackageNotFoundError:
            continue
    digest.update(source_files.digest(modules).encode())
    for package, pattern in _READ:
        for path in sorted(Path(str(files(package))).glob(pattern)):
            digest.update(path.name.encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()
