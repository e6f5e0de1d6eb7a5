"""``satsym export``: a motion as other programs read it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from satsym.cli.help import command
from satsym.cli.options import place_option, set_option, subject_argument, with_values
from satsym.cli.output import complain, emit, live, tell
from satsym.report.said import message
from satsym.status import ExitCode

if TYPE_CHECKING:
    from satsym.instance import Instance
    from satsym.solution import Simulation, Solution

KINDS = ("oem", "czml", "stk", "csv")
"""The formats, repeated here because ``--help`` loads no writer of them."""

EXAMPLES = """\b
Examples:
  satsym export return-to-geo --format oem > geo.oem    a CCSDS Orbit Ephemeris Message, including manoeuvres
  satsym export return-to-geo --format czml --out geo.czml    for viewing in Cesium
  satsym export molniya --format stk --out molniya.e    an uncontrolled motion, for STK
  satsym export return-to-geo --format csv --from results/return-to-geo/solve    a saved result, as CSV"""


@command(epilog=EXAMPLES)
@subject_argument
@click.option(
    "--format", "kind", type=click.Choice(KINDS), required=True, metavar="KIND", help=f"One of: {', '.join(KINDS)}."
)
@place_option("--out", metavar="FILE", help="Write to this file instead of stdout; an existing file is replaced.")
@place_option("--from", "source", metavar="DIR", help="A saved result of X, which is exported without solving again.")
@set_option
def export(subject: str, kind: str, out: Path | None, source: Path | None, values: tuple[str, ...]) -> ExitCode:
    """Write a motion about a central body for other programs.

    X is an instance, specified as for `satsym solve`, with a table [orbit] that gives the date of the motion and the
    orientation of its plane in space. The instance is solved; if its model has no cost, the uncontrolled motion is
    simulated. Formats are oem (CCSDS Orbit Ephemeris Message), czml (Cesium), stk (STK ephemeris) and csv.
    """
    from satsym import instance
    from satsym.report.exchange import exported
    from satsym.report.exchange.ephemeris import placed
    from satsym.report.results import trajectory
    from satsym.report.results.files import write_text
    from satsym.report.terminal.solution import with_files

    case, _ = with_values(instance.load(subject), values)
    placed(case)  # now, rather than after a long run
    found = trajectory.read(case, source)[0] if source else _found(case)
    if not found.status.answered:
        complain(f"{case.name}: {message(found.status.value)}: {message(found.message)}")
        return ExitCode.NO_ANSWER
    text = exported(found, kind)
    if out is None:
        emit(text)
    else:
        write_text(out, text)
        tell(with_files(f"{case.name}: {message(found.status.value)}", [out]))
    return ExitCode.DONE


def _found(case: Instance) -> Solution | Simulation:
    """Return the optimum, or the motion without control where no cost is to be minimised."""
    from satsym import solvers
    from satsym.analysis.regulator.feedback import simulate
    from satsym.report.terminal.solution import progress_line

    if not case.model.spec.has_cost:
        return simulate(case, None)
    with live() as line:
        return solvers.solve(case, progress=lambda iteration: line.show(progress_line(iteration, case)))
