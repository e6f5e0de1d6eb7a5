"""Verdicts kept between runs: a document is judged anew only if something that its verdicts depend on has changed.

The key of an entry is a digest of the ledger (the file that lists the claims of the document), of the derivations,
kernels and instances, and of the modules of satsym that are imported for judging. Modules that only print or draw
verdicts are not part of the key. An entry is only ever compared and read as data; a file that is damaged or of another
kind is ignored and replaced.
"""

from __future__ import annotations

import hashlib
import os
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from importlib.resources import files
from multiprocessing import get_context
from pathlib import Path

import msgspec

from satsym import source_files, user_cache
from satsym.auditing.judged import Judged
from satsym.auditing.ledger import documents
from satsym.auditing.ledger.contents import Ledger
from satsym.auditing.run import audit as judge
from satsym.records import shelf

_JUDGING = ("satsym.auditing.run", "satsym.auditing.judged")
_READ = (("satsym.generated", "*.json"), ("satsym.generated", "*.py"), ("satsym", "instances/*.toml"))
"""Files that verdicts depend on besides the imported modules, as pairs (package, file pattern)."""

_DERIVING = 30
"""Approximate number of rows that are judged in the time that one derivation takes."""
_LIBRARIES = ("sympy", "numpy", "scipy", "pint", "mpmath")


def audit(
    ledger: Ledger, items: Sequence[str] = (), announce: Callable[[str], None] = lambda _: None, *, fresh: bool = False
) -> list[Judged]:
    """Return the verdicts of a ledger, from the cache unless `fresh` is true; audits of single items are never cached.

    See :func:`satsym.auditing.run.audit` for the arguments.
    """
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
    """Return the verdicts of several ledgers by the key of the document.

    Documents without an entry in the cache are judged in parallel processes, one for each processor. `announce`
    receives the keys of the documents that are not ready yet.
    """
    found = {} if fresh or items else {x.document.key: rows for x in ledgers if (rows := _read(_place(x))) is not None}
    left = sorted((x for x in ledgers if x.document.key not in found), key=_work, reverse=True)
    processes = min(os.cpu_count() or 1, len(left))
    if items or processes < 2:
        found |= {ledger.document.key: audit(ledger, items, announce, fresh=fresh) for ledger in left}
    else:
        with ProcessPoolExecutor(processes, get_context("spawn")) as pool:
            running = {pool.submit(audit, ledger, fresh=True): ledger.document.key for ledger in left}
            announce(", ".join(running.values()))
            try:
                for done in as_completed(running):
                    found[running[done]] = done.result()
                    announce(", ".join(key for key in running.values() if key not in found))
            except BaseException:
                pool.shutdown(cancel_futures=True)
                raise
    return {ledger.document.key: found[ledger.document.key] for ledger in ledgers}


def _work(ledger: Ledger) -> int:
    """Estimate the work of judging a ledger, in rows; the ledger with the most work is begun first."""
    return len(ledger.rows) + _DERIVING * len(ledger.models)


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
    """Return a digest of everything except the ledger that results of some modules (default: verdicts) depend on."""
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
