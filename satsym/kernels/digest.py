"""The digests in a generated module: its own, and those of the derivation files that it was made from.

Its own digest shows whether a module was edited by hand, the others whether it is older than its derivation. They guard
against accidents, not against malice: a module with forged digests still has to pass :mod:`satsym.kernels.consistency`.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path

from satsym.source_files import digest_of

_LINE = re.compile(r"^Digest: ([0-9a-f]{64})\n", re.MULTILINE)
_SOURCE = re.compile(r"^Source: ([^\n\0]{1,400}\.py) ([0-9a-f]{32})\n", re.MULTILINE)
_PLACE = "    satsym derive "
_MOST_BYTES = 10_000_000
"""Largest size of a derivation file, in bytes."""


def sealed(text: str, folder: Path | None = None, stating: Mapping[Path, str] | None = None) -> str:
    """Return the text of a module with its digests in the docstring; any earlier digests are replaced.

    Parameters
    ----------
    folder
        Folder for which the module is written.
    stating
        Derivation files from which the module was made, with their digests; the file that states the problem is first.
    """
    bare = _SOURCE.sub("", _without(text))
    end = bare.index("\n", bare.index(_PLACE)) + 1
    lines = "".join(_source_line(*each, folder) for each in (stating or {}).items()) if folder else ""
    bare = f"{bare[:end]}{lines}{bare[end:]}"
    end += len(lines)
    return f"{bare[:end]}Digest: {_of(bare)}\n{bare[end:]}"


def intact(text: str) -> bool:
    """Tell whether the digest of a module fits its text; without a digest it does not. Line ends do not count."""
    text = text.replace("\r\n", "\n")
    found = _LINE.search(text)
    return found is not None and found[1] == _of(_without(text))


def changed(text: str, folder: Path) -> tuple[Path, Path] | None:
    """Return a derivation file that has changed since a module was made from it, and the file of the module's problem.

    ``None`` where all are the same; what is not there is not known to have changed.

    Parameters
    ----------
    folder
        Folder of the module.
    """
    head, _, _ = text.replace("\r\n", "\n").partition("MODEL = {")
    found = [(folder / place, digest) for place, digest in _SOURCE.findall(head)]
    odd = (path for path, digest in found if _now(path) not in ("", digest))
    return next(((path, found[0][0]) for path in odd), None)


def _source_line(path: Path, digest: str, folder: Path) -> str:
    """Return a derivation file's path relative to the module, with its digest; empty without such a path."""
    try:
        place = Path(os.path.relpath(path.resolve(), folder.resolve())).as_posix()
    except ValueError:  # another drive
        return ""
    line = f"Source: {place} {digest}\n"
    return line if _SOURCE.fullmatch(line) else ""


def _now(path: Path) -> str:
    """Return the digest of a derivation file; empty where there is no readable file."""
    try:
        small = path.is_file() and path.stat().st_size <= _MOST_BYTES
    except (OSError, ValueError):
        return ""
    return digest_of(path) if small else ""


def _without(text: str) -> str:
    return _LINE.sub("", text, count=1)


def _of(bare: str) -> str:
    return sha256(bare.encode()).hexdigest()
