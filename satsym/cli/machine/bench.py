"""``satsym bench``: how fast this machine is for a model."""

from __future__ import annotations

import click

from satsym.cli import names
from satsym.cli.help import command
from satsym.cli.options import json_option
from satsym.cli.output import answer, live
from satsym.status import ExitCode

QUICK_SECONDS, THOROUGH_SECONDS = 0.5, 5.0
"""Seconds for which each kind of step is measured."""

EXAMPLES = """\b
Examples:
  satsym bench return-to-orbit --quick  an instance: integration steps and solution
  satsym bench polar_orbit              a model: integration steps only, five seconds each

Exit codes: 0 measured, 4 measured, but the instance has no solution."""


@command(epilog=EXAMPLES)
@click.argument("subject", metavar="X", shell_complete=names.completed(names.instances, names.models))
@click.option("--quick", is_flag=True, help="Measure each kind of step for half a second instead of five.")
@json_option
def bench(subject: str, quick: bool, as_json: bool) -> ExitCode:
    """Measure how fast a model runs on this machine.

    X is an instance or a model, shipped or the path of one. Many motions at once are integrated by the classical
    Runge-Kutta method, with NumPy, and with numba (extra fast) on one core and on all. An instance with a cost is
    also solved and certified.
    """
    from satsym.analysis.speed import solved, speeds
    from satsym.analysis.subject import find
    from satsym.kernels import Kernels
    from satsym.report.said import say
    from satsym.report.terminal.speed import backend_name, speed_object, speed_text

    given, found = find(subject), []
    model = given if isinstance(given, Kernels) else given.model
    with live() as line:
        line.show(say("measuring <what> ...", what=backend_name("numpy")))
        for one in speeds(given, QUICK_SECONDS if quick else THOROUGH_SECONDS):
            found.append(one)
            line.show(say("measuring <what> ...", what=backend_name("numba")))
        solution = None
        if not isinstance(given, Kernels) and model.spec.has_cost:
            line.show(say("measuring <what> ...", what=say("one solution")))
            solution = solved(given)
    result = speed_object(given, found, solution)
    answer(as_json, result, lambda: speed_text(result))
    return ExitCode.DONE if solution is None or solution.status.answered else ExitCode.NO_ANSWER
