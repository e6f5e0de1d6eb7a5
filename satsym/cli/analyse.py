"""``satsym analyse``: stability, controllability and observability of a model or an instance."""

from __future__ import annotations

from pathlib import Path

import click

from satsym.cli.options import json_option, out_option, plot_option
from satsym.cli.output import emit, emit_json, in_colour, to_json
from satsym.cli.saving import folder_for
from satsym.status import ExitCode

EXAMPLES = """\b
Examples:
  satsym analyse clohessy_wiltshire     a satellite near a circular orbit
  satsym analyse soft-return-geo        a nonlinear model, near its reference, in kilometres and seconds
  satsym analyse uny-lqr --plot         with pictures, into results/uny-lqr"""


@click.command(epilog=EXAMPLES)
@click.argument("subject", metavar="X")
@json_option
@out_option
@plot_option
def analyse(subject: str, as_json: bool, out: Path | None, plot: bool) -> ExitCode:
    """Tell what a model does near its reference or an equilibrium.

    X is a shipped model or instance, or the path of one. Eigenvalues with their Jordan blocks, stability with its
    reason, the Routh array, and how much of the state the inputs move and the outputs show: by numbers, and exactly
    where the model is linear.
    """
    from satsym.analysis.structure import analyse as analysed
    from satsym.cli.exact import exact
    from satsym.cli.subject import find
    from satsym.report.linear import analysis_object
    from satsym.report.linear_text import analysis_text
    from satsym.report.text import with_files

    given = find(subject)
    folder = folder_for(Path(subject).stem, out, plot)
    found = analysed(given)
    saved: list[Path] = []
    if as_json or folder is not None:
        result = analysis_object(found, exact(found.about.model))
    if folder is not None:
        from satsym.report import files

        saved = files.write(folder, {"result.json": files.text(to_json(result))})
        if plot:
            from satsym.report.plots.systems import save_analysis

            saved += save_analysis(found, folder)
    if as_json:
        emit_json(result)
    else:
        emit(with_files(analysis_text(found, in_colour()), saved))
    return ExitCode.DONE
