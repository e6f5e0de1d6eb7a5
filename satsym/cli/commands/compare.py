"""``satsym compare``: several instances of one system, side by side."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from satsym.cli import names
from satsym.cli.help import command
from satsym.cli.options import json_option, out_option, plot_options
from satsym.cli.output import answer, complain, live
from satsym.cli.saving import folder_for, save
from satsym.status import ExitCode

if TYPE_CHECKING:
    from satsym.analysis.comparison import Range
    from satsym.instance import Instance
    from satsym.report.look import Look
    from satsym.report.results.files import Content

EXAMPLES = """\b
Examples:
  satsym compare lapan-classical lapan-minimum-time lapan-minimum-energy
  satsym compare lapan-classical lapan-minimum-time lapan-minimum-time-100s --plot
  satsym compare lapan-classical lapan-minimum-time --range    for other dampings and commands"""

FACTORS = (0.25, 0.5, 1.0, 2.0, 4.0)
"""Factors of the instance's damping and command, for a range of these."""


@command(epilog=EXAMPLES)
@click.argument("subjects", metavar="X...", nargs=-1, required=True, shell_complete=names.completed(names.instances))
@json_option
@click.option(
    "--range", "ranged", is_flag=True, help="Vary the damping and the command of the first instance's control law."
)
@out_option
@plot_options("compare")
def compare(subjects: tuple[str, ...], as_json: bool, ranged: bool, out: Path | None, look: Look | None) -> ExitCode:
    """Compare several instances of one system side by side.

    An instance that specifies a control law ([classical]) is simulated under that law; any other instance is solved.
    The metrics are durations, integrals, and peak and final values, each explained below the table. Results go into
    the folder of the first X.
    """
    from satsym import instance
    from satsym.analysis import comparison
    from satsym.report.terminal.comparison import comparison_object, comparison_text
    from satsym.report.terminal.solution import with_files

    loaded = [instance.load(subject) for subject in subjects]
    folder = folder_for(loaded[0].name, "compare", out, look)
    over = _range(loaded[0]) if ranged else None
    with live() as line:
        cases = comparison.compare(loaded, line.show)
    result = comparison_object(cases, over)
    pages: dict[str, Content] = {}
    if folder and look:
        from satsym.report.plots import comparison as plots

        pages = plots.pictures(cases, look)
    saved = save(folder, result, pages)
    answer(as_json, result, lambda: with_files(comparison_text(cases, over), saved))
    for case in cases:
        if not case.answered:
            complain(f"{case.instance.name}: {case.message}")
    if not all(case.answered for case in cases):
        return ExitCode.NO_ANSWER
    failed = any(case.verdict == "failed" for case in cases)
    return ExitCode.CERTIFICATE_FAILED if failed else ExitCode.DONE


def _range(case: Instance) -> Range:
    from satsym.analysis.comparison import ranged

    options = case.classical
    damping, command = (options.damping or 0.0, options.command) if options else (0.0, 0.0)
    return ranged(case, [factor * damping for factor in FACTORS], [factor * command for factor in FACTORS])
