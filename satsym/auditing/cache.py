"""Verdicts kept between runs: nothing is judged twice as long as nothing that it depends on has changed.

The key is a digest of the ledger, of the derivations and instances, and of satsym itself. What is found is only ever
compared and read as data; a file that is damaged or of another kind is ignored and written anew.
"""

from __future__ import annotations

import hashlib
import os
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from importlib.resources import files
from pathlib import Path

import msgspec

from satsym.auditing.judged import Judged
from satsym.auditing.ledger import documents
from satsym.auditing.ledger.contents import Ledger
from satsym.auditing.run import audit as judge

_PARTS = ("satsym", "satsym.derivations", "satsym.generated")
_KEPT = (".py", ".toml")
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
    path = _folder() / f"{ledger.document.key[:40]}-{_digest(ledger)}.json"
    kept = None if fresh else _read(path)
    if kept is not None:
        return kept
    found = judge(ledger, items, announce)
    _write(path, found)
    return found


def _read(path: Path) -> list[Judged] | None:
    try:
        return msgspec.json.decode(path.read_bytes(), type=list[Judged])
    except (OSError, ValueError, msgspec.MsgspecError):
        return None


def _write(path: Path, found: list[Judged]) -> None:
    """Written beside and moved, so that no reader meets half a file; a folder that cannot be written is no error."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=path.parent, suffix=".part")
        with os.fdopen(handle, "wb") as stream:
            stream.write(msgspec.json.encode(found))
        Path(name).replace(path)
    except OSError:
        return


def _folder() -> Path:
    """The folder of the user's for what can be computed again."""
    if stated := os.environ.get("XDG_CACHE_HOME"):
        return Path(stated) / "satsym" / "audit"
    if sys.platform == "win32" and (local := os.environ.get("LOCALAPPDATA")):
        return Path(local) / "satsym" / "audit"
    home = Path.home()
    return home / ("Library/Caches" if sys.platform == "darwin" else ".cache") / "satsym" / "audit"


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
    for part in _PARTS:
        for path in sorted(_files(Path(str(files(part))))):
            digest.update(path.name.encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()


def _files(folder: Path) -> Iterator[Path]:
    return (path for path in folder.rglob("*") if path.suffix in _KEPT and path.is_file())
