"""``satsym lqr``: the best linear feedback for quadratic costs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from satsym.cli import names
from satsym.cli.help import command
from satsym.cli.options import json_option, out_option, plot_options, set_option, with_values
from satsym.cli.output import answer
from satsym.cli.saving import folder_for, save
from satsym.status import BadInput, ExitCode, Status
from satsym.wording import printable

if TYPE_CHECKING:
    from satsym.report.look import Look
    from satsym.report.results.files import Content

EXAMPLES = """\b
Examples:
  satsym lqr uny-lqr                    the regulator of a thesis
  satsym lqr geo-lqr --plot             a geostationary satellite, weights from allowed deviations
  satsym lqr clohessy_wiltshire         a model with all inputs and all weights 1"""


@command(epilog=EXAMPLES)
@click.argument("subject", metavar="X", shell_complete=names.completed(names.instances, names.models))
@set_option
@json_option
@out_option
@plot_options("lqr")
def lqr(subject: str, values: tuple[str, ...], as_json: bool, out: Path | None, look: Look | None) -> ExitCode:
    """Find the linear quadratic regulator u = -K x.

    X is an instance with a table [lqr], or a model, for which all weights are 1; it is a shipped one, or the path of a
    file. The cost is the integral of x'Qx + 2x'Nu + u'Ru, without a factor 1/2, where x is the deviation from the
    reference.
    """
    from satsym.analysis.regulator.feedback import designed
    from satsym.analysis.subject import find
    from satsym.kernels import Kernels
    from satsym.report.results.linear import regulator_object
    from satsym.report.results.objects import head_about, with_settings
    from satsym.report.terminal.linear import regulator_text
    from satsym.report.terminal.solution import with_files

    given, numbers = find(subject), dict[str, float]()
    if values:
        if isinstance(given, Kernels):
            raise BadInput(
                f"--set {printable(values[0])}: applies to instances only, but {printable(subject)} is a model"
            )
        given, numbers = with_values(given, values)
    folder = folder_for(Path(subject).stem, "lqr", out, look)
    design = designed(given)
    result = with_settings(head_about("lqr", given, Status.CONVERGED) | regulator_object(design), numbers)
    pictures: dict[str, Content] = {}
    if folder and look:
        from satsym.report.plots.systems import of_design

        pictures = of_design(design, look)
    saved = save(folder, result, pictures)
    answer(as_json, result, lambda: with_files(regulator_text(design), saved))
    return ExitCode.DONE
