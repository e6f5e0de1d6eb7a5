"""``satsym bench``: how fast this machine is for a model, in integration steps a second and solutions."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import click

from satsym.cli import names
from satsym.cli.help import command
from satsym.cli.options import json_option
from satsym.cli.output import answer, live
from satsym.report.said import say
from satsym.status import ExitCode, Status

if TYPE_CHECKING:
    from satsym.arrays import Array
    from satsym.instance import Instance
    from satsym.kernels import Kernels

QUICK_SECONDS, THOROUGH_SECONDS = 0.5, 5.0
"""Seconds for which each kind of step is measured."""
RUNS = 3
"""Number of runs, of which the fastest counts, since other processes slow the others down."""

COLUMNS, STEPS = 4096, 10
"""Number of motions at once, and of steps between two readings of the clock."""
REPEATED = 20
"""Factor of the steps of machine code between two readings of the clock, since starting a thread takes time."""
STEP_LENGTH, START_DISTANCE = 1e-4, 1e-3
"""Length of a step, in the unit of time, and distance between neighbouring starts."""

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
    from satsym.analysis.subject import find
    from satsym.kernels import Kernels
    from satsym.report.results.objects import head_about

    given, steps = find(subject), []
    model = given if isinstance(given, Kernels) else given.model
    with live() as line:
        line.show(say("measuring <what> ...", what=BACKENDS["numpy"]))
        for one in measured_steps(given, QUICK_SECONDS if quick else THOROUGH_SECONDS):
            steps.append(one)
            line.show(say("measuring <what> ...", what=BACKENDS["numba"]))
        status = Status.CONVERGED
        solution: dict[str, Any] | None = None
        if not isinstance(given, Kernels) and model.spec.has_cost:
            line.show(say("measuring <what> ...", what=say("one solution")))
            status, solution = measured_solution(given)
    result = head_about("bench", given, status) | {"machine": _machine(), "steps": steps, "solve": solution}
    answer(as_json, result, lambda: _text(result))
    return ExitCode.DONE if status.answered else ExitCode.NO_ANSWER


def measured_steps(subject: Instance | Kernels, seconds: float) -> Iterator[dict[str, Any]]:
    """Measure the steps a second of many motions at once, by NumPy and by machine code, on one core and on all.

    Parameters
    ----------
    subject
        A model, or an instance of one, about whose initial state the motions begin.
    seconds
        Time for which each is measured; making machine code comes before that.

    Returns
    -------
    iterator of dict
        The backend, ``"numpy"`` or ``"numba"``, the number of cores that took part, and the steps of the classical
        Runge-Kutta method a second, each step of one motion.
    """
    from concurrent.futures import ThreadPoolExecutor

    import numpy as np

    from satsym.kernels import Kernels
    from satsym.kernels.batch import compiling
    from satsym.kernels.blocks import block_step
    from satsym.solvers.simulation.batch import simulate
    from satsym.studies.workers import usable_processors

    model = subject if isinstance(subject, Kernels) else subject.model
    x, p = _columns(subject)
    until = [0.0, STEP_LENGTH * STEPS]
    rate = _rate(lambda: simulate(model, until, x, list(p), STEPS), seconds)
    yield {"backend": "numpy", "cores": 1, "per_second": rate}
    if not compiling.able():
        return
    advance, controls = block_step(model.compiled()), np.zeros((len(model.spec.controls), COLUMNS))
    for count in sorted({1, usable_processors()}):
        ends = np.linspace(0, COLUMNS, count + 1).astype(int)
        parts = [
            tuple(np.ascontiguousarray(rows[:, low:high]) for rows in (x, controls, p)) for low, high in pairwise(ends)
        ]
        with ThreadPoolExecutor(count) as pool:

            def run(pool: ThreadPoolExecutor = pool, parts: list[tuple[Array, ...]] = parts) -> None:
                list(
                    pool.map(lambda part: advance(0.0, STEP_LENGTH, STEPS * REPEATED, part[0].copy(), *part[1:]), parts)
                )

            yield {"backend": "numba", "cores": count, "per_second": REPEATED * _rate(run, seconds)}


def _columns(subject: Instance | Kernels) -> tuple[Array, Array]:
    """Return states about a start, and parameters, in a column for each motion."""
    import numpy as np

    from satsym.kernels import Kernels

    if isinstance(subject, Kernels):
        start = [1.0] * len(subject.spec.states)
        parameters = [1.0 if one.default is None else float(one.default) for one in subject.spec.parameters]
    else:
        start, parameters = list(subject.initial), list(subject.parameters)
    rng, x = np.random.default_rng(0), np.array(start)[:, None]
    apart = START_DISTANCE * np.maximum(np.abs(x), 1.0) * rng.uniform(-1.0, 1.0, (len(x), COLUMNS))
    return x + apart, np.repeat(np.array(parameters).reshape(-1, 1), COLUMNS, axis=1)


def _rate(run: Callable[[], object], seconds: float) -> float:
    """Return the steps a second of the fastest of several runs."""
    import numpy as np

    with np.errstate(all="ignore"):
        run()  # what is made when it is first called is made now
        best = 0.0
        for _ in range(RUNS):
            count, began = 0, time.perf_counter()
            while (took := time.perf_counter() - began) < seconds / RUNS or not count:
                run()
                count += 1
            best = max(best, count * COLUMNS * STEPS / took)
    return best


def measured_solution(instance: Instance) -> tuple[Status, dict[str, Any]]:
    """Measure the time of one solution, and of its certificate with all competitors if there is a solution."""
    from satsym import solvers
    from satsym.solvers.certificate import certify

    solvers.solve(instance, examined=False)  # so that what is loaded is there
    began = time.perf_counter()
    found = solvers.solve(instance, examined=False)
    took = time.perf_counter() - began
    certificate: float | None = None
    if found.status.answered:
        began = time.perf_counter()
        certify(replace(found, wall_s=took))
        certificate = time.perf_counter() - began
    return found.status, {"method": found.method, "solve_s": took, "certificate_s": certificate}


def _machine() -> dict[str, Any]:
    """Return the object that describes this machine."""
    import platform

    import numpy as np

    from satsym.studies.workers import usable_processors

    return {
        "system": platform.system(),
        "processor": platform.machine(),
        "cores": usable_processors(),
        "python": platform.python_version(),
        "numpy": np.__version__,
    }


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
