"""Verdicts kept between runs: nothing is judged twice as long as nothing that it depends on has changed.

The key is a digest of the ledger, of the derivations, kernels and instances, and of the modules of satsym that judging
imports: how verdicts are drawn and printed is none of them. What is found is only ever
compared and read as data; a file that is damaged or of another kind is ignored and written anew.
"""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Callable, Sequence
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from importlib.resources import files
from pathlib import Path

import msgspec

from satsym import kept, sources
from satsym.auditing.judged import Judged
from satsym.auditing.ledger import documents
from satsym.auditing.ledger.contents import Ledger
from satsym.auditing.run import audit as judge

_JUDGING = ("satsym.auditing.run", "satsym.auditing.judged")
_READ = (("satsym.derivations", "*.py"), ("satsym.generated", "*.py"), ("satsym", "instances/*.toml"))
"""What judging takes from beside the modules it imports, by package and pattern."""

_LIBRARIES = ("sympy", "numpy", "scipy", "pint", "mpmath")


def audit(
    ledger: Ledger, items: Sequence[str] = (), announce: Callable[[str], None] = lambda _: None, *, fresh: bool = False
) -> list[Judged]:
    """As :func:`satsym.auditing.run.audit`, from the cache if it can be; judging some items alone is never cached.

    Parameters
    ----------
    ledger, items, announce
        As there.
    fresh
        Judge anew, and keep what is found.
    """
    if items:
        return judge(ledger, items, announce)
    path = kept.folder("audit") / f"{ledger.document.key[:40]}-{_digest(ledger)}.json"
    before = None if fresh else _read(path)
    if before is not None:
        return before
    found = judge(ledger, items, announce)
    kept.write(path, msgspec.json.encode(found))
    return found


def _read(path: Path) -> list[Judged] | None:
    try:
        return msgspec.json.decode(kept.read(path), type=list[Judged])
    except (ValueError, msgspec.MsgspecError):
        return None


def _digest(ledger: Ledger) -> str:
    digest = hashlib.blake2b(_program().encode(), digest_size=16)
    for path in documents.files_of(ledger.path):
        digest.update(path.read_bytes())
    return digest.hexdigest()


@cache
def _program() -> str:
    """A digest of everything that verdicts depend on beside the ledger."""
    digest = hashlib.blake2b(digest_size=16)
    digest.update(sys.version.encode())
    for library in _LIBRARIES:
        try:
            digest.update(f"{library} {version(library)}".encode())
        except PackageNotFoundError:
            continue
    digest.update(sources.digest(_JUDGING).encode())
    for package, pattern in _READ:
        for path in sorted(Path(str(files(package))).glob(pattern)):
            digest.update(path.name.encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()
