"""``satsym study``: one instance for many values of some of its numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from satsym.choices import Checked, Choice, Command, Sampling, TableFormat
from satsym.cli.help import command
from satsym.cli.options import json_option, place_option, plot_options, set_option, subject_argument
from satsym.cli.output import answer, live
from satsym.cli.saving import RESULTS
from satsym.status import ExitCode

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from satsym.report.look import Look

EXAMPLES = """\b
Examples:
  satsym study return-to-orbit --vary initial.r=0.9:1.1:20 --vary parameters.c1=log:1:100:10
  satsym study return-to-orbit --sample 1000 --normal initial.r=1.1,0.01 --uniform initial.theta_dot=0.9,1.1
  satsym study its-thesis --command simulate --vary initial.r=1.05:1.2:50 --trajectories
  satsym study my_case.toml --out DIR --resume    continue an interrupted study

KEY is initial.STATE, final.STATE, parameters.NAME, time.tf, time.t0, time.tf_guess, control.max_norm,
control.NAME.lower or control.NAME.upper. A study can also be specified in the table [study] of an instance, with the
keys command, sample, method, seed, and [study.vary] "initial.r" = "0.9:1.1:50".

Exit codes: 0 done (failed cases are marked in the table), 3 the study cannot be carried out,
4 no case has a solution."""


def _listed(choices: type[Choice]) -> str:
    *others, last = choices.names()
    return f"{', '.join(others)} or {last}"


@command(epilog=EXAMPLES)
@subject_argument
@click.option(
    "--vary",
    multiple=True,
    metavar="KEY=LOW:HIGH:N",
    help="A grid of N evenly spaced values; with KEY=log:LOW:HIGH:N, logarithmically spaced.",
)
@click.option("--sample", type=int, metavar="N", help="Draw a random sample of N cases instead of a grid.")
@click.option("--normal", multiple=True, metavar="KEY=MEAN,SD", help="Draw from a normal distribution.")
@click.option("--uniform", multiple=True, metavar="KEY=LOW,HIGH", help="Draw from a uniform distribution.")
@click.option("--method", metavar="METHOD", help=f"Sampling method: {_listed(Sampling)}; by default sobol.")
@click.option("--seed", type=int, metavar="S", help="Seed of the sampling; 0 by default.")
@click.option(
    "--command", metavar="COMMAND", help=f"Command to run for each case: {_listed(Command)}; by default solve."
)
@click.option(
    "--certificate",
    metavar="KIND",
    help=f"How solutions are certified: {_listed(Checked)}. By default local, which computes no competing solutions; "
    "full is the certificate of `satsym solve`; sample is full for one case in a hundred and local for the others.",
)
@set_option
@click.option("--feedback", metavar="LAW", help="Control law for simulate; see `satsym simulate`.")
@click.option("--trajectories", is_flag=True, help="Also save the trajectories, in a few npz files.")
@click.option("--table", metavar="FORM", help=f"File format of the table: {_listed(TableFormat)}; by default csv.")
@place_option("--out", metavar="DIR", help="Output folder; by default results/NAME/study.")
@click.option("--resume", is_flag=True, help="Continue the study in the output folder; without one, start it.")
@click.option(
    "--workers",
    type=click.IntRange(1, 1000),
    metavar="N",
    help="Number of processes; by default one per processor.",
)
@click.option("--scheduler", metavar="ADDRESS", help="Compute on the Dask cluster with this address: tcp://HOST:PORT.")
@plot_options("study")
@json_option
def study(
    subject: str,
    vary: tuple[str, ...],
    normal: tuple[str, ...],
    uniform: tuple[str, ...],
    out: Path | None,
    resume: bool,
    workers: int | None,
    scheduler: str | None,
    look: Look | None,
    as_json: bool,
    table: str | None,
    values: tuple[str, ...],
    **options: Any,
) -> ExitCode:
    """Solve, simulate or regulate many variants of an instance.

    X is a shipped instance (`satsym instances` lists them) or the path of a TOML file. The table has one row for each
    case, that is, for each combination of values; it contains the results or the reason why there are none. An
    interrupted study is continued with --resume; nothing is computed twice.
    """
    from satsym import instance
    from satsym.report.study import carry_out, draw, written_as
    from satsym.report.terminal.solution import with_files
    from satsym.report.terminal.study import progress_line, study_text
    from satsym.status import Status
    from satsym.studies.asking import asked, named
    from satsym.studies.reading import read_pairs, settings
    from satsym.studies.workers import processes

    written = instance.read(subject)
    case = written.instance()
    said = {name: read_pairs(pairs, name) for name, pairs in (("vary", vary), ("normal", normal), ("uniform", uniform))}
    found = asked(written, case, said | options, named(written) or subject, settings(case, values))
    found = written_as(found, table)
    folder = out or Path(RESULTS, case.name, "study")
    with _computing(scheduler, processes(workers, found.chunks)) as (made, count), live() as line:
        try:
            result = carry_out(
                found,
                folder,
                made,
                count,
                resume=resume,
                watch=lambda advance: line.report(progress_line(advance), advance.done / max(1, advance.total)),
            )
        except KeyboardInterrupt as stop:
            stop.add_note("repeat the command with --resume to continue")
            raise
    drawn = draw(folder, look)[1] if look else []
    pictures = {"pictures": [str(path) for path in drawn]} if look else {}
    answer(as_json, result | pictures, lambda: with_files(study_text(result), [*_written(folder), *drawn]))
    return ExitCode.DONE if result["status"] == Status.CONVERGED.value else ExitCode.NO_ANSWER


def _written(folder: Path) -> list[Path]:
    """Return the files of a study, those with the trajectories and the request included, without its pictures."""
    from satsym.report.results.set_list import ASKED, LIST
    from satsym.report.results.sets import listed
    from satsym.report.results.study_table import path_of

    table, names = path_of(folder), listed(folder)
    trajectories = sorted(name for name in names if name.endswith(".npz"))
    return [table, *(folder / name for name in (*trajectories, ASKED, LIST))]


@contextmanager
def _computing(scheduler: str | None, count: int) -> Iterator[tuple[Callable[[], Executor], int]]:
    """Return the executor of chunks, and how many it takes at a time: local processes, or a cluster."""
    if scheduler is None:
        from satsym.studies.workers import Workers

        yield lambda: Workers(count), count
        return
    from satsym.studies.workers import cluster

    with cluster(scheduler) as (executor, most):
        yield lambda: executor, most
