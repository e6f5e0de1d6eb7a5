"""``satsym bench``: how fast this machine is for a model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import click

from satsym.cli import names
from satsym.cli.help import command
from satsym.cli.options import json_option
from satsym.cli.output import answer, live
from satsym.report.said import say
from satsym.status import ExitCode, Status

if TYPE_CHECKING:
    from satsym.analysis.speed import Solved, Speed
    from satsym.instance import Instance
    from satsym.kernels import Kernels

QUICK_SECONDS, THOROUGH_SECONDS = 0.5, 5.0
"""Seconds for which each kind of step is measured."""

BACKENDS = {"numpy": "NumPy", "numba": "numba"}
"""Names of the backends for people."""

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

    X is a shipped instance or model, or the path of one. Many motions are integrated at once by the classical
    Runge-Kutta method: with NumPy, and with numba (the extra `fast`) on one core and on all cores. An instance with a
    cost is also solved and certified.
    """
    from satsym.analysis.speed import solved, speeds
    from satsym.analysis.subject import find
    from satsym.kernels import Kernels

    given, found = find(subject), []
    model = given if isinstance(given, Kernels) else given.model
    with live() as line:
        line.show(say("measuring <what> ...", what=BACKENDS["numpy"]))
        for one in speeds(given, QUICK_SECONDS if quick else THOROUGH_SECONDS):
            found.append(one)
            line.show(say("measuring <what> ...", what=BACKENDS["numba"]))
        solution = None
        if not isinstance(given, Kernels) and model.spec.has_cost:
            line.show(say("measuring <what> ...", what=say("one solution")))
            solution = solved(given)
    result = _object(given, found, solution)
    answer(as_json, result, lambda: _text(result))
    return ExitCode.DONE if solution is None or solution.status.answered else ExitCode.NO_ANSWER


def _text(found: Mapping[str, Any]) -> str:
    """Return the summary of what ``satsym bench`` measured, from its object."""
    from satsym.report.terminal.table import figure, table, wrapped

    machine, steps, solve = found["machine"], found["steps"], found["solve"]
    first = steps[0]["per_second"]
    rows = [(say("what"), say("cores"), say("per second"), say("relative to the first"))]
    for one in steps:
        name = say("steps of one motion, <backend>", backend=BACKENDS[one["backend"]])
        rows.append((name, str(one["cores"]), figure(one["per_second"], 3), f"{one['per_second'] / first:.3g}"))
    if solve is not None:
        name = say("solutions, <method>", method=solve["method"])
        rows.append((name, "1", figure(1.0 / solve["solve_s"], 3), ""))
        if solve["certificate_s"] is not None:
            rows.append((say("certificates"), "1", figure(1.0 / solve["certificate_s"], 3), ""))
    lines = [
        f"{found['instance'] or found['model']}, {machine['system']} {machine['processor']}, "
        f"Python {machine['python']}, numpy {machine['numpy']}",
        "",
        *table(rows, right=(1, 2, 3)),
    ]
    if solve is not None and solve["certificate_s"] is None:
        lines += ["", *wrapped(say("the instance has no solution: <said_status>", said_status=found["status"]))]
    if all(one["backend"] == "numpy" for one in steps):
        lines += ["", *wrapped(say("numba is not installed; run pip install 'satsym[fast]'"))]
    return "\n".join(lines)


def _object(given: Instance | Kernels, speeds: Sequence[Speed], solved: Solved | None) -> dict[str, Any]:
    """Return the object of the results: the machine, steps a second by backend, and times of one solution."""
    import platform

    import numpy as np

    from satsym.analysis.speed import cores
    from satsym.report.results.objects import head_about

    solution = None
    if solved is not None:
        solution = {
            "method": solved.method,
            "solve_s": solved.seconds,
            "certificate_s": solved.certificate_seconds,
        }
    return head_about("bench", given, Status.CONVERGED if solved is None else solved.status) | {
        "machine": {
            "system": platform.system(),
            "processor": platform.machine(),
            "cores": cores(),
            "python": platform.python_version(),
            "numpy": np.__version__,
        },
        "steps": [{"backend": one.backend, "cores": one.cores, "per_second": one.steps} for one in speeds],
        "solve": solution,
    }
