"""``satsym solve``: the optimum of an instance."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from satsym import methods
from satsym.cli.help import command
from satsym.cli.options import json_option, plot_options, set_option, subject_argument, trajectory_option, with_values
from satsym.cli.output import answer, in_colour, live
from satsym.cli.saving import folder_for, save, trajectory_files
from satsym.status import ExitCode, Verdict

if TYPE_CHECKING:
    from satsym.instance import Instance
    from satsym.report.look import Look

METHODS = "\n".join(f"  {method.name:<15}{method.title}" for method in methods.METHODS.values())

EXAMPLES = f"""\b
Methods (auto chooses the one that suits the problem):
{METHODS}

\b
Examples:
  satsym solve soft-return --plot       results and pictures into results/soft-return/solve
  satsym solve my_case.toml --json      the result as JSON, for another program
  satsym solve soft-return --continue c1=1:1e-2   continuation from an easier problem

Exit codes: 0 converged, 3 invalid instance, 4 no solution (the status says why),
5 a solution whose certificate fails."""


def _positive(_context: click.Context, _option: click.Parameter, value: float | None) -> float | None:
    if value is not None and not 0.0 < value < math.inf:
        raise click.BadParameter(f"{value} is not a positive number.")
    return value


@command(epilog=EXAMPLES)
@subject_argument
@json_option
@trajectory_option
@plot_options("solve")
@click.option(
    "--method",
    type=click.Choice(methods.names()),
    metavar="METHOD",
    help=f"Solver, overriding the instance: {', '.join(methods.names())}.",
)
@set_option
@click.option("--steps", type=click.IntRange(2, 10**7), metavar="N", help="Number of steps of the time grid.")
@click.option(
    "--continue",
    "varied",
    multiple=True,
    metavar="KEY=FROM:TO",
    help="Continuation: start from another value of KEY and follow the solutions. KEY is a parameter, tf, t0, "
    "initial.STATE or final.STATE.",
)
@click.option(
    "--tolerance", type=float, callback=_positive, metavar="EPS", help="Largest residual that a solution may have."
)
def solve(
    subject: str,
    as_json: bool,
    out: Path | None,
    look: Look | None,
    values: tuple[str, ...],
    method: str | None,
    steps: int | None,
    varied: tuple[str, ...],
    tolerance: float | None,
) -> ExitCode:
    """Find the control that minimises the cost, and certify it.

    X is a shipped instance (`satsym instances` lists them) or the path of a TOML file. A summary is printed; with
    --out or --plot, states, controls and costates over time are written into files. METHOD, N and EPS override
    [solver] in the instance.
    """
    from satsym import instance, solvers
    from satsym.report.results.objects import solution_object, with_settings
    from satsym.report.terminal.solution import progress_line, solution_text, with_files

    written = instance.read(subject)
    written = replace(written, tree=_continued(written.tree, varied))
    case, given = with_values(written.instance(), values)
    case = _changed(case, method=method, steps=steps, tolerance=tolerance)
    folder = folder_for(case.name, "solve", out, look)
    with live() as line:
        solution = solvers.solve(case, progress=lambda iteration: line.show(progress_line(iteration, case)))
    if case.limits:
        from satsym.analysis.comparison import limits_noted

        solution = limits_noted(solution)
    on_the_way = {text.partition("=")[0] for text in varied}
    given |= {one.key.text: one.end for one in case.continuation if one.key.short in on_the_way}
    result = with_settings(solution_object(solution), given)
    saved = save(folder, result, trajectory_files(folder, solution, look))
    answer(as_json, result, lambda: with_files(solution_text(solution, in_colour()), saved))
    if not solution.status.answered:
        return ExitCode.NO_ANSWER
    failed = solution.certificate is not None and solution.certificate.verdict is Verdict.FAILED
    return ExitCode.CERTIFICATE_FAILED if failed else ExitCode.DONE


def _continued(tree: Mapping[str, Any], varied: Sequence[str]) -> Mapping[str, Any]:
    """Return the tables of an instance with the continuation from the command line."""
    found: dict[str, list[float | str]] = {}
    for text in varied:
        key, equals, values = text.partition("=")
        ends = values.split(":")
        if not (equals and key and len(ends) == 2 and all(ends)):
            raise click.BadParameter(f"{text} is not KEY=FROM:TO, such as c1=1:1e-6.", param_hint="--continue")
        found[key] = [_number(end) for end in ends]
    before = tree.get("continuation", {})
    return {**tree, "continuation": {**before, **found}} if found and isinstance(before, Mapping) else tree


def _number(text: str) -> float | str:
    """Return a number, or a quantity with its unit."""
    try:
        return float(text)
    except ValueError:
        return text


def _changed(case: Instance, **options: Any) -> Instance:
    """Return the instance with the solver options from the command line."""
    given = {name: value for name, value in options.items() if value is not None}
    if not given:
        return case
    import msgspec

    from satsym.instance.options import solver

    return replace(case, solver=solver(msgspec.structs.replace(case.solver, **given), case.model.spec))
