"""Records of derivations by name: first those in the folder of a user's own model, then the shipped ones."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path

from satsym import source_files
from satsym.records import record
from satsym.records.record import Record
from satsym.spec import is_name
from satsym.status import BadInput
from satsym.wording import printable, shown, suggestion

_FOLDER: ContextVar[Path | None] = ContextVar("folder", default=None)


def place_of(model: str, beside: Path) -> tuple[Path | None, str]:
    """Return folder and name of a model: ``"NAME"`` is shipped, ``"DIR/NAME"`` is relative to a file.

    Raises
    ------
    BadInput
        If the name is none.
    """
    folder, slash, name = model.removesuffix(record.SUFFIX).rpartition("/")
    if not is_name(name):
        raise BadInput(
            f'{shown(model)} is not a model; give the name of a model, or "DIR/NAME" after satsym derive --out DIR'
        )
    try:
        return (beside / folder if slash else None), name
    except (OSError, ValueError):
        raise BadInput(f"{shown(model)} is not a path") from None


@contextmanager
def opened(folder: Path | None) -> Iterator[None]:
    """Make the records of a folder take precedence over the shipped ones in this context."""
    token = _FOLDER.set(folder)
    try:
        yield
    finally:
        _FOLDER.reset(token)


def path_of(name: str) -> Path | None:
    """Return the path of a model's record; ``None`` where there is none."""
    folder = _FOLDER.get()
    places = [folder] if folder is not None else []
    for place in (*places, *source_files.generated()):
        path = place / f"{name}{record.SUFFIX}"
        try:
            if is_name(name) and path.is_file():
                return path
        except (OSError, ValueError):
            continue
    return None


def is_shipped(name: str) -> bool:
    """Tell whether a name is that of a shipped model, and of none in the current folder of records."""
    path = path_of(name)
    return path is None or path.parent in source_files.generated()


def find(name: str) -> Record:
    """Return the record of a model.

    Raises
    ------
    BadInput
        If there is none, or it is older than its derivation.
    """
    path = path_of(name)
    if path is not None:
        return record.load(path)
    folder = _FOLDER.get()
    if folder is not None and (folder / f"{name}.py").is_file():
        where = printable(str(folder), 200)
        raise BadInput(f"{where}: {name}.py exists, but {name}{record.SUFFIX} is missing; run satsym derive again")
    raise BadInput(f"there is no derivation {shown(name)}; {suggestion(name, source_files.models())}")
