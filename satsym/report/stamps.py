"""What was derived before, and from what: nothing is derived twice as long as its stamp fits.

A stamp holds digests only, of what was read and of what was written. A missing, damaged or foreign one costs time and
no more, and `satsym derive --check` relies on none.
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
    """What one problem led to."""

    identity: str
    """Digest of what was declared; empty where it has none."""

    files: dict[str, str]
    """File name -> digest of its content."""


class Stamp(msgspec.Struct, frozen=True):
    """What one derivation file led to."""

    engine: str
    reached: dict[str, str]
    """The files it consists of -> digests of their content; empty for one that was looked for and is not there."""

    problems: dict[str, Made]


def engine() -> str:
    """A digest of all code that files are written by."""
    libraries = " ".join(f"{name} {version(name)}" for name in _LIBRARIES)
    return _digest(f"{sys.version} {libraries} {source_files.digest(_ENGINE)}")


def read(path: Path, known: str) -> Stamp | None:
    """The stamp of a derivation file, if it is one of that engine."""
    try:
        found = msgspec.json.decode(user_cache.read(_place(path)), type=Stamp)
    except (msgspec.MsgspecError, UnicodeDecodeError):
        return None
    return found if found.engine == known else None


def problems(stamp: Stamp | None) -> list[str]:
    """Names of the problems of a derivation file, in its order."""
    return list(stamp.problems) if stamp else []


def holds(stamp: Stamp, folder: Path) -> bool:
    """Whether all that a derivation file consisted of is what it was, and so is all in the folder that came of it."""
    read_alike = all(source_files.digest_of(Path(path)) == digest for path, digest in stamp.reached.items())
    return read_alike and all(_in_place(made, folder) for made in stamp.problems.values())


def spares(stamp: Stamp | None, name: str, identity: str, folder: Path) -> bool:
    """Whether a problem states what it did, and what came of it is in the folder, whatever else its file states."""
    made = stamp.problems.get(name) if stamp else None
    return made is not None and made.identity == identity != "" and _in_place(made, folder)


def keep(path: Path, before: Stamp | None, known: str, identities: Mapping[str, str], texts: Mapping[str, str]) -> None:
    """Keep the stamp of a derivation file that has been loaded; what was not derived is as in the one before."""
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
