"""Location of ledgers by name or path. A ledger is one file, or a folder with ``ledger.toml`` and chapters.

The shipped ledgers are folders.
"""

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
"""Files of a ledger's folder: the main file, and the chapters, which contain only rows and are read in order of
name."""
INDONESIAN = "says.id.toml"
"""File with the Indonesian subjects of the rows; it is optional."""


def shipped() -> list[Path]:
    """Return the paths of the ledgers that are shipped with satsym, ordered by name."""
    return source_files.documents()


def files_of(path: Path) -> list[Path]:
    """Return the files of a ledger, the main file first."""
    return [path / HEAD, *sorted(path.glob(CHAPTERS))] if path.is_dir() else [path]


def beside(path: Path, name: str) -> Path:
    """Return the path of a file that belongs to a ledger, in its folder or, for ``small.toml``, at ``small.NAME``."""
    return path / name if path.is_dir() else path.with_suffix(f".{name}")


def read_from(path: Path) -> list[Path]:
    """Return all files that are read for a ledger."""
    translated = beside(path, INDONESIAN)
    return [*files_of(path), *([translated] if translated.exists() else [])]


def named(path: Path) -> str:
    """Return how commands refer to a ledger: a shipped one by the name of its document, others by their path."""
    return path.name if path in shipped() else str(path)


def locate(name_or_path: str) -> Path:
    """Return the path of the shipped ledger of a document, or the given path of a ledger.

    Raises
    ------
    BadInput
        If there is neither a shipped ledger nor a ledger at this path.
    """
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
    raise BadInput(f"{printable(name_or_path, 200)}: there is neither a ledger nor a file of this name; {known}")


def refuse_unknown_items(ledgers: Sequence[Ledger], items: Sequence[str]) -> None:
    """Raise BadInput for items that no ledger contains."""
    known = dict.fromkeys(name for x in ledgers for row in x.rows for name in (row.table.item, row.key))
    for item in items:
        refuse_unknown("there is no row", item, known)
