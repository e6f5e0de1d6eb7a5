"""Where results go: ``results/NAME/COMMAND``, or where the user says."""

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
"""Commands whose trajectories can be drawn again; here once more, because ``--help`` loads no reader of them."""
DRAWN = (*READ, "analyse", "lqr", "compare")
"""Commands whose results can be drawn again; of the others what they show is found again."""


def folder_for(name: str, command: str, out: Path | None, look: Look | None) -> Path | None:
    """Where the results of a command go, ``None`` where nothing is to be written.

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
    """Replace what a folder holds of earlier results, if there is one to write to; the files that were written."""
    if folder is None:
        return []
    from satsym.report.results import sets

    return sets.write(folder, result, files)


def trajectory_files(folder: Path | None, found: Solution | Simulation, look: Look | None) -> dict[str, Content]:
    """Trajectory, problem and, where asked for, pictures: name -> content; none where nothing is to be written."""
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
    """An instance, and the command whose results are meant: from ``NAME`` or ``NAME/COMMAND``."""
    name, _, command = subject.rpartition("/")
    return (name, command) if name and command in DRAWN else (subject, None)


def study_folder(subject: str, source: Path | None) -> Path | None:
    """Where the study is that is meant, if one is: its folder itself, or ``NAME/study``."""
    from satsym.report.study import is_study

    places = [source] if source else [Path(subject), Path(RESULTS, subject)]
    return next((place for place in places if is_study(place)), None)


def newest(name: str, command: str | None) -> Path | None:
    """Where the results of an instance or a model are: of a command, or of the one that wrote last, if any are."""
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
        Of an instance or a model.
    command
        Whose results are meant; ``None``: those of the command that wrote last.

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
