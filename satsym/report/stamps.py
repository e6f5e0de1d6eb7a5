"""Stamps of earlier derivations: nothing is derived again as long as its stamp is valid.

A stamp holds only digests, of the files that were read and written. A missing, damaged or foreign one costs time and
nothing more, and `satsym derive --check` uses none.
"""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path

import msgspec

from satsym import source_files, user_cache

_ENGINE = ("satsym.report.artefacts",)
_LIBRARIES = ("mpmath", "numpy", "sympy")


class Made(msgspec.Struct, frozen=True):
    """The digests of one problem and its files."""

    identity: str
    """Digest of the declarations; empty if there are none."""

    files: dict[str, str]
    """Digests of the generated files, by name."""


class Stamp(msgspec.Struct, frozen=True):
    """The digests of one derivation file and its problems."""

    engine: str
    reached: dict[str, str]
    """Path -> digest of each file that was read; empty for a file that was searched but does not exist."""

    problems: dict[str, Made]


def engine() -> str:
    """Return a digest of all code that writes generated files."""
    libraries = " ".join(f"{name} {version(name)}" for name in _LIBRARIES)
    return _digest(f"{sys.version} {libraries} {source_files.digest(_ENGINE)}")


def read(path: Path, known: str) -> Stamp | None:
    """Return the stamp of a derivation file, if it belongs to this engine."""
    try:
        found = msgspec.json.decode(user_cache.read(_place(path)), type=Stamp)
    except (msgspec.MsgspecError, UnicodeDecodeError):
        return None
    return found if found.engine == known else None


def problems(stamp: Stamp | None) -> list[str]:
    """Return the names of the problems of a derivation file, in its order."""
    return list(stamp.problems) if stamp else []


def holds(stamp: Stamp, folder: Path) -> bool:
    """Tell whether the sources of a derivation file and its generated files are unchanged."""
    read_alike = all(source_files.digest_of(Path(path)) == digest for path, digest in stamp.reached.items())
    return read_alike and all(_in_place(made, folder) for made in stamp.problems.values())


def spares(stamp: Stamp | None, name: str, identity: str, folder: Path) -> bool:
    """Tell whether a problem and its generated files are unchanged, whatever else its file states."""
    made = stamp.problems.get(name) if stamp else None
    return made is not None and made.identity == identity != "" and _in_place(made, folder)


def keep(path: Path, before: Stamp | None, known: str, identities: Mapping[str, str], texts: Mapping[str, str]) -> None:
    """Save the stamp of a derivation file that has been loaded; problems that were not derived keep their old entry."""
    from satsym.symbolic import loader

    if engine() != known:  # edited while it was at work
        return
    problems = {}
    for name, identity in identities.items():
        files = {file: _digest(text) for file, text in texts.items() if file.partition(".")[0] == name}
        problems[name] = Made(identity, files) if files or before is None else before.problems[name]
    reached = {str(each): digest for each, digest in loader.reached(path).items()}
    user_cache.write(_place(path), msgspec.json.encode(Stamp(known, reached, problems)))


def _in_place(made: Made, folder: Path) -> bool:
    return all(source_files.digest_of(folder / name) == digest for name, digest in made.files.items())


def _digest(text: str) -> str:
    return hashlib.blake2b(text.encode(), digest_size=16).hexdigest()


def _place(path: Path) -> Path:
    return user_cache.folder("derive") / f"{path.stem[:40]}-{_digest(str(path.resolve()))}.json"
