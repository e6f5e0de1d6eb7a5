"""``satsym plot``: pictures of a result that was saved before."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from satsym.cli.help import command
from satsym.cli.options import json_option, look_options, place_option, subject_argument
from satsym.cli.output import answer, emit_json, tell
from satsym.cli.saving import DRAWN, READ, newest, saved_folder, split, study_folder
from satsym.report.said import say
from satsym.status import BadInput, ExitCode
from satsym.wording import printable

if TYPE_CHECKING:
    from satsym.report.look import Look
    from satsym.report.results.files import Content
    from satsym.report.results.sets import Found

EXAMPLES = """\b
Examples:
  satsym solve soft-return --plot       results and pictures
  satsym plot soft-return --format pdf --format png    the pictures again, for print and for the screen
  satsym plot soft-return/simulate      the results of a particular command
  satsym plot run                       results written by `satsym solve soft-return --out run`"""


@command(epilog=EXAMPLES)
@subject_argument
@place_option(
    "--from",
    "source",
    metavar="DIR",
    help="Folder with the result; by default the newest one in results/X.",
)
@place_option("--out", metavar="DIR", help="Folder for the pictures; by default that of the result.")
@look_options
@json_option
def plot(subject: str, source: Path | None, out: Path | None, look: Look, as_json: bool) -> ExitCode:
    """Draw a saved result again, without solving.

    X is an instance or model whose results were saved with --out or --plot; or X/COMMAND, the results of one
    command; or a folder that contains results, including those of a study. Incomplete results are rejected. For the
    commands analyse, lqr and compare, the numbers are computed again.
    """
    from satsym import instance
    from satsym.cli.redrawing import named_in
    from satsym.report import plots
    from satsym.report.results import trajectory
    from satsym.report.results.files import check_writable
    from satsym.report.results.objects import head
    from satsym.report.results.sets import command_of
    from satsym.report.study import draw
    from satsym.report.terminal.solution import with_files

    if (study := study_folder(subject, source)) is not None:
        said, drawn = draw(study, look, out)
        shown = said | {"command": "plot", "pictures": [str(path) for path in drawn]}
        about = say("<name>: study of <number> cases", name=said["instance"], number=said["rows"])
        answer(as_json, shown, lambda: with_files(about, drawn))
        return ExitCode.DONE
    if source is None and (named := named_in(Path(subject))):
        subject, source = named, Path(subject)
    name, command = split(subject)
    home = source or newest(Path(name).stem, command)
    if home and (wrote := command_of(home)) in DRAWN and wrote not in READ:
        return _redrawn(name, command, home, out, look, as_json)
    case = instance.load(name)
    source = source or saved_folder(case.name, command)
    check_writable(out or source)
    result, found = trajectory.read(case, source)
    _require(command, found)
    pictures = plots.pictures(result, look)
    begins = head("plot", case.model.spec, case, result.status)
    saved = _save(out or source, found, begins, pictures) if pictures else []
    if as_json:
        emit_json(begins | {"pictures": [str(path) for path in saved]})
    else:
        tell(with_files(say(case.title) or case.name, saved) if saved else say("there is no trajectory to draw"))
    return ExitCode.DONE


def _redrawn(name: str, command: str | None, home: Path, out: Path | None, look: Look, as_json: bool) -> ExitCode:
    """Draw the pictures of an analysis, a regulator or a comparison again."""
    from satsym.cli.redrawing import redrawn
    from satsym.report.results import sets
    from satsym.report.results.files import check_writable
    from satsym.report.terminal.solution import with_files

    check_writable(out or home)
    found = sets.read(home)
    _require(command, found)
    begins, title, pictures = redrawn(name, found, look)
    saved = _save(out or home, found, begins, pictures)
    answer(as_json, begins | {"pictures": [str(path) for path in saved]}, lambda: with_files(say(title) or name, saved))
    return ExitCode.DONE


def _require(command: str | None, found: Found) -> None:
    if command not in (None, found.command):
        raise BadInput(f"{printable(str(found.folder))}: contains the result of {found.command}, not of {command}")


def _save(folder: Path, found: Found, begins: Mapping[str, Any], pictures: Mapping[str, Content]) -> list[Path]:
    """Add pictures to the set they belong to, or save them as a set of their own."""
    from satsym.report.results import sets

    if folder.resolve() == found.folder.resolve():
        return sets.extend(found, pictures)
    sets.keep_apart(folder, "plot")
    return sets.write(folder, begins, pictures)[:-1]
