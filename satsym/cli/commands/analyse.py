"""``satsym analyse``: stability, controllability and observability of a model or an instance."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from satsym.cli import names
from satsym.cli.help import command
from satsym.cli.options import json_option, out_option, plot_options
from satsym.cli.output import emit_json, in_colour, tell
from satsym.cli.saving import folder_for, save
from satsym.status import ExitCode

if TYPE_CHECKING:
    from satsym.analysis.subject import Analysis, Survey
    from satsym.report.look import Look
    from satsym.report.results.files import Content
    from satsym.symbolic.equilibria.momenta import Attitudes

EXAMPLES = """\b
Examples:
  satsym analyse itb-earth --plot       an orbit: its type, its monodromy matrix, and the meaning of its stability
  satsym analyse clohessy_wiltshire     a satellite near a circular orbit
  satsym analyse soft-return-geo        a nonlinear model about its reference, in kilometres and seconds
  satsym analyse gyrostat-equilibria    all equilibrium attitudes of a satellite with a wheel
  satsym analyse uny-lqr --plot         with pictures, in results/uny-lqr/analyse"""


@command(epilog=EXAMPLES)
@click.argument("subject", metavar="X", shell_complete=names.completed(names.instances, names.models))
@json_option
@out_option
@plot_options("analyse")
def analyse(subject: str, as_json: bool, out: Path | None, look: Look | None) -> ExitCode:
    """Analyse a model, an orbit, or attitudes in orbit.

    X is a shipped model or instance, or the path of one. For a model: eigenvalues with their Jordan blocks, stability
    and its reason, the Routh array, and the controllable and observable subspaces, numerically and, for linear
    models, exactly. For an instance that starts on an orbit: its elements and type, the eigenvalues at the initial
    point and why they do not decide stability, the monodromy matrix and the Floquet multipliers. For the attitude of
    a satellite in orbit: all equilibria, counted exactly, and how their number and stability change with the momentum
    of the wheel.
    """
    from satsym.analysis.subject import examined, find
    from satsym.report.results.linear import attitudes
    from satsym.report.results.orbit import examination_object
    from satsym.report.terminal.solution import with_files

    given = find(subject)
    folder = folder_for(Path(subject).stem, "analyse", out, look)
    found, orbit = examined(given)
    resting = attitudes(given)
    saved: list[Path] = []
    if as_json or folder is not None:
        result = examination_object(given, found, orbit, attitudes=resting)
        pictures: dict[str, Content] = {}
        if folder and look:
            from satsym.report.plots.systems import of_subject

            pictures = of_subject(given, found, orbit, resting, look)
        saved = save(folder, result, pictures)
    if as_json:
        emit_json(result)
    else:
        tell(with_files(_text(found, orbit, resting), saved))
    return ExitCode.DONE


def _text(found: Analysis | None, orbit: Survey | None, resting: Attitudes | None) -> str:
    from satsym.report.terminal.linear import analysis_text, attitudes_text
    from satsym.report.terminal.orbit import orbit_text

    parts = [analysis_text(found, in_colour())] if found else []
    parts += [orbit_text(orbit, in_colour())] if orbit else []
    return "\n\n".join(parts + ([attitudes_text(resting)] if resting else []))
