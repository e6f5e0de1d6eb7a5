"""Folders of results: ``results/NAME/COMMAND``, or the folder that the user states."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from satsym.report.said import say
from satsym.status import BadInput
from satsym.wording import printable

if TYPE_CHECKING:
    from satsym.report.look import Look
    from satsym.report.results.files import Content
    from satsym.solution import Simulation, Solution

RESULTS = "results"
READ = ("solve", "simulate")
"""Commands whose saved trajectories can be drawn again, repeated here because ``--help`` loads no reader of them."""
DRAWN = (*READ, "analyse", "lqr", "compare")
"""Commands whose results can be drawn again; those of some are computed again."""


def folder_for(name: str, command: str, out: Path | None, look: Look | None) -> Path | None:
    """Return the folder for the results of a command, ``None`` where nothing is written.

    Raises
    ------
    BadInput
        If that is no place to write to; better now than after a long run.
    """
    folder = out or (Path(RESULTS, name, command) if look else None)
    if folder:
        from satsym.report.results.files import check_writable
        from satsym.report.results.sets import keep_apart

        check_writable(folder)
        keep_apart(folder, command)
    return folder


def save(folder: Path | None, result: Mapping[str, Any], files: Mapping[str, Content]) -> list[Path]:
    """Replace earlier results in a folder, if one is to be written; return the files that were written."""
    if folder is None:
        return []
    from satsym.report.results import sets

    return sets.write(folder, result, files)


def trajectory_files(folder: Path | None, found: Solution | Simulation, look: Look | None) -> dict[str, Content]:
    """Return trajectory, problem and requested pictures by file name; none where nothing is written."""
    if folder is None:
        return {}
    from satsym.cli.output import live
    from satsym.report import plots
    from satsym.report.results import problem, trajectory

    with live() as line:
        line.show(say("drawing ..." if look else "writing ..."))
        stated = problem.contents(found.instance)
        return trajectory.contents(found) | stated | (plots.pictures(found, look) if look else {})


def split(subject: str) -> tuple[str, str | None]:
    """Split ``NAME`` or ``NAME/COMMAND`` into an instance and the command whose results are meant."""
    name, _, command = subject.rpartition("/")
    return (name, command) if name and command in DRAWN else (subject, None)


def study_folder(subject: str, source: Path | None) -> Path | None:
    """Return the folder of the study that is meant, if one is: the folder itself, or ``NAME/study``."""
    from satsym.report.study import is_study

    places = [source] if source else [Path(subject), Path(RESULTS, subject)]
    return next((place for place in places if is_study(place)), None)


def newest(name: str, command: str | None) -> Path | None:
    """Return the folder of the newest results of an instance or model, of one command or of any."""
    from satsym.report.results.sets import written_at

    home = Path(RESULTS, name)
    there = {home / each: written_at(home / each) for each in ([command] if command else DRAWN)}
    known = {folder: time for folder, time in there.items() if time is not None}
    return max(known, key=lambda folder: known[folder], default=None)


def saved_folder(name: str, command: str | None) -> Path:
    """Return the folder of :func:`newest`, or refuse with what to run where there are no results.

    Parameters
    ----------
    name
        Name of an instance or a model.
    command
        The command that wrote the results; ``None`` for the command that wrote last.

    Raises
    ------
    BadInput
        If there are none.
    """
    found = newest(name, command)
    if found is None:
        home, which = Path(RESULTS, name), f"of `satsym {command}` " if command else ""
        raise BadInput(
            f"{printable(name)}: there are no results {which}in {printable(str(home))}; write them with `satsym "
            f"{command or 'solve'} {printable(name)} --plot`, or give their folder with --from"
        )
    return found
