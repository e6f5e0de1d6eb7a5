"""Where the results of ``solve`` and ``simulate`` go."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from satsym.cli.output import to_json

if TYPE_CHECKING:
    from satsym.solution import Flight, Solution


def default_folder(name: str) -> Path:
    """Where the results of an instance go if nobody says where."""
    return Path("results", name)


def folder_for(name: str, out: Path | None, plot: bool) -> Path | None:
    """Where the results of an instance go, ``None`` where nothing is to be written.

    Raises
    ------
    BadInput
        If that is no place to write to; better now than after a long run.
    """
    folder = out or (default_folder(name) if plot else None)
    if folder:
        from satsym.report.files import check_writable

        check_writable(folder)
    return folder


def save(folder: Path | None, found: Solution | Flight, result: Mapping[str, Any], plot: bool) -> list[Path]:
    """Write the trajectory, the result and, where asked for, the pictures.

    Returns
    -------
    list of Path
        What was written.
    """
    if folder is None:
        return []
    from satsym.report import files, trajectory

    saved = files.write(folder, trajectory.contents(found) | {"result.json": files.text(to_json(result))})
    if plot:
        from satsym.report import plots

        try:
            saved += plots.save(found, folder)
        except OSError as error:
            raise files.unwritable(folder, error) from None
    return saved
