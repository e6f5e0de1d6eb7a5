"""Ledgers by name or by path: a file, or a folder with ``ledger.toml`` and chapters. The shipped ones are folders."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from satsym import source_files
from satsym.status import BadInput
from satsym.wording import printable, refuse_unknown, suggestion

if TYPE_CHECKING:
    from satsym.auditing.ledger.contents import Ledger

HEAD, CHAPTERS = source_files.LEDGER, "ledger_*.toml"
"""The files of a folder: a head, with rows or without, and chapters of rows alone, by name."""
INDONESIAN = "says.id.toml"
"""What its rows are about, in Indonesian; a ledger need not have it."""


def shipped() -> list[Path]:
    """The ledgers that come with satsym, by name."""
    return source_files.documents()


def files_of(path: Path) -> list[Path]:
    """The files of a ledger, the head first."""
    return [path / HEAD, *sorted(path.glob(CHAPTERS))] if path.is_dir() else [path]


def beside(path: Path, name: str) -> Path:
    """A file that belongs to a ledger: in its folder, or for one file ``small.toml`` beside it, ``small.NAME``."""
    return path / name if path.is_dir() else path.with_suffix(f".{name}")


def read_from(path: Path) -> list[Path]:
    """All files that reading a ledger reads."""
    translated = beside(path, INDONESIAN)
    return [*files_of(path), *([translated] if translated.exists() else [])]


def named(path: Path) -> str:
    """How commands name a ledger: a shipped one by its document, any other by its path."""
    return path.name if path in shipped() else str(path)


def locate(name_or_path: str) -> Path:
    """The shipped ledger of a document, or the path that was given."""
    for path in shipped():
        if path.name == name_or_path:
            return path
    path = Path(name_or_path)
    try:
        if path.is_file() or (path / HEAD).is_file():
            return path
        if path.is_dir():
            raise BadInput(
                f"{printable(name_or_path, 200)}: this folder has no {HEAD}; put the main part of the ledger there"
            )
    except (OSError, ValueError):
        pass
    known = suggestion(name_or_path, [path.name for path in shipped()])
    raise BadInput(f"{printable(name_or_path, 200)}: there is no ledger of this name and no such file; {known}")


def refuse_unknown_items(ledgers: Sequence[Ledger], items: Sequence[str]) -> None:
    """Refuse items that no ledger has."""
    known = dict.fromkeys(name for x in ledgers for row in x.rows for name in (row.table.item, row.key))
    for item in items:
        refuse_unknown("there is no row", item, known)
