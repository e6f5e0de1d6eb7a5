"""``satsym plot``: pictures of a result that was saved before."""

from __future__ import annotations

from pathlib import Path

import click

from satsym.cli.options import json_option, subject_argument
from satsym.cli.output import emit, emit_json
from satsym.cli.saving import default_folder
from satsym.status import ExitCode

KINDS = ("png", "pdf")

EXAMPLES = """\b
Examples:
  satsym solve soft-return --out run    the results, without pictures
  satsym plot soft-return --from run --format pdf --format png    the pictures, for print and screen"""


@click.command(epilog=EXAMPLES)
@subject_argument
@click.option(
    "--from",
    "source",
    metavar="DIR",
    type=click.Path(path_type=Path),
    help="Where its trajectory.npz and result.json are; by default results/NAME.",
)
@click.option("--out", metavar="DIR", type=click.Path(path_type=Path), help="Where pictures go; by default there too.")
@click.option(
    "--format",
    "kinds",
    metavar="KIND",
    type=click.Choice(KINDS),
    multiple=True,
    default=("png",),
    help=f"One of: {', '.join(KINDS)}; may be given several times. By default png.",
)
@json_option
def plot(subject: str, source: Path | None, out: Path | None, kinds: tuple[str, ...], as_json: bool) -> ExitCode:
    """Draw a saved result, without solving again.

    X is the instance that was solved or simulated with --out or --plot.
    """
    from satsym import instance
    from satsym.report import plots, trajectory
    from satsym.report.text import with_files

    case = instance.load(subject)
    source = source or default_folder(case.name)
    found = trajectory.read(case, source)
    saved = plots.save(found, out or source, tuple(dict.fromkeys(kinds)))
    if as_json:
        emit_json({"model": case.model.spec.name, "instance": case.name, "pictures": [str(path) for path in saved]})
    else:
        emit(with_files(case.title or case.name, saved) if saved else "there is no trajectory to draw")
    return ExitCode.DONE
