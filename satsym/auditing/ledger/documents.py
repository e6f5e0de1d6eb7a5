"""Ledgers by name or by path: the shipped ones lie beside the derivations."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from satsym.status import BadInput
from satsym.wording import printable, shown, suggestion

if TYPE_CHECKING:
    from satsym.auditing.ledger.contents import Ledger

SUFFIX = ".toml"


def shipped() -> list[Path]:
    """The ledgers that come with satsym, by name."""
    folder = Path(str(files("satsym.derivations"))) / "documents"
    return sorted(folder.glob(f"*{SUFFIX}"))


def comes_with_satsym(path: Path) -> bool:
    """Whether a path is that of a shipped ledger."""
    return path in shipped()


def named(path: Path) -> str:
    """How commands name a ledger: a shipped one by its document, any other by its path."""
    return path.stem if comes_with_satsym(path) else str(path)


def locate(name_or_path: str) -> Path:
    """The shipped ledger of a document, or the path that was given.

    Raises
    ------
    BadInput
        If there is none.
    """
    for path in shipped():
        if path.stem == name_or_path:
            return path
    path = Path(name_or_path)
    try:
        if path.is_file():
            return path
    except (OSError, ValueError):
        pass
    known = suggestion(name_or_path, [path.stem for path in shipped()])
    raise BadInput(f"{printable(name_or_path, 200)}: no ledger of this name, and no such file; {known}")


def refuse_unknown_items(ledgers: Sequence[Ledger], items: Sequence[str]) -> None:
    """Refuse items that no ledger has.

    Raises
    ------
    BadInput
        For the first of them.
    """
    known = dict.fromkeys(name for x in ledgers for row in x.rows for name in (row.table.item, row.key))
    for item in items:
        if item not in known:
            raise BadInput(f"no row {shown(item)}; {suggestion(item, known)}")
