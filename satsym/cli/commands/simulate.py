"""``satsym simulate``: the motion of an instance under a given control law."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from satsym.choices import FEEDBACKS
from satsym.cli.help import command
from satsym.cli.options import json_option, plot_options, set_option, subject_argument, trajectory_option, with_values
from satsym.cli.output import answer, complain, in_colour
from satsym.cli.saving import folder_for, save, trajectory_files
from satsym.status import ExitCode

if TYPE_CHECKING:
    from satsym.report.look import Look

EXAMPLES = """\b
Examples:
  satsym simulate its-thesis            the uncontrolled motion
  satsym simulate its-thesis --plot     with pictures, in results/its-thesis/simulate
  satsym simulate geo-lqr --feedback lqr    the nonlinear motion under linear feedback
  satsym simulate lapan-classical       a pitch manoeuvre under its own control law
  satsym simulate lapan-minimum-time --feedback switching    the same in minimum time, by a switching curve
  satsym simulate lapan-minimum-time --feedback pulses       the same with a position sensor only"""


@command(epilog=EXAMPLES)
@subject_argument
@click.option(
    "--feedback",
    type=click.Choice(FEEDBACKS),
    default=None,
    metavar="LAW",
    help=f"Control law: {', '.join(FEEDBACKS)}. "
    "By default classical if the instance specifies such a law, otherwise none.",
)
@set_option
@json_option
@trajectory_option
@plot_options("simulate")
def simulate(
    subject: str, feedback: str | None, values: tuple[str, ...], as_json: bool, out: Path | None, look: Look | None
) -> ExitCode:
    """Simulate the motion under a control law.

    X is a shipped instance (`satsym instances` lists them) or the path of a TOML file. The motion is simulated from
    the initial state to the final time, and the drift of conserved quantities is measured.
    """
    from satsym import instance
    from satsym.analysis.regulator.feedback import simulate as simulated
    from satsym.report.results.objects import simulation_object, with_settings
    from satsym.report.terminal.solution import simulation_text, with_files

    case, given = with_values(instance.load(subject), values)
    folder = folder_for(case.name, "simulate", out, look)
    simulation = simulated(case, feedback)
    result = with_settings(simulation_object(simulation), given)
    saved = save(folder, result, trajectory_files(folder, simulation, look))
    answer(as_json, result, lambda: with_files(simulation_text(simulation, in_colour()), saved))
    if simulation.status.answered:
        return ExitCode.DONE
    if as_json:  # its object has no key for the reason
        complain(f"{simulation.status.value}: {simulation.message}")
    return ExitCode.NO_ANSWER
