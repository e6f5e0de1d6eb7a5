"""``satsym study``: one instance for many values of some of its numbers."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click

from satsym.cli.options import json_option, place_option, plot_options, subject_argument
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
  satsym study my_case.toml --out DIR --resume    go on with a study that was interrupted

KEY is initial.STATE, final.STATE, parameters.NAME, time.tf, time.t0, or control.max_norm. The table [study] of an
instance says the same: command, sample, method, seed, and [study.vary] "initial.r" = "0.9:1.1:50".

Exit codes: 0 done (rows that fail say so in the table), 3 the study cannot be carried out, 4 no row has an answer."""


@click.command(epilog=EXAMPLES)
@subject_argument
@click.option("--vary", multiple=True, metavar="KEY=LOW:HIGH:N", help="A grid of N values; log: of equal ratio.")
@click.option("--sample", type=int, metavar="N", help="Draw N rows, instead of a grid.")
@click.option("--normal", multiple=True, metavar="KEY=MEAN,SD", help="A normal distribution to draw from.")
@click.option("--uniform", multiple=True, metavar="KEY=LOW,HIGH", help="A uniform distribution to draw from.")
@click.option("--method", metavar="METHOD", help="Of drawing: sobol (the default), lhs or random.")
@click.option("--seed", type=int, metavar="S", help="Of drawing; 0 by default.")
@click.option("--command", metavar="COMMAND", help="What is done with each row: solve (the default), simulate or lqr.")
@click.option(
    "--certificate",
    metavar="KIND",
    help="Of solve: none, local (the default: all but competitors), or full (as `satsym solve`).",
)
@click.option("--feedback", metavar="LAW", help="Of simulate, as `satsym simulate` has it.")
@click.option("--trajectories", is_flag=True, help="Keep them, too, in few npz files.")
@place_option("--out", metavar="DIR", help="Where it goes; by default results/NAME/study.")
@click.option("--resume", is_flag=True, help="Go on with the study that is there, or begin it.")
@click.option("--workers", type=click.IntRange(1, 1000), metavar="N", help="Processes; by default one a processor.")
@click.option("--scheduler", metavar="ADDRESS", help="Of a Dask cluster that computes instead: tcp://HOST:PORT.")
@plot_options("study")
@json_option
def study(
    subject: str,
    vary: tuple[str, ...],
    sample: int | None,
    normal: tuple[str, ...],
    uniform: tuple[str, ...],
    method: str | None,
    seed: int | None,
    command: str | None,
    certificate: str | None,
    feedback: str | None,
    trajectories: bool,
    out: Path | None,
    resume: bool,
    workers: int | None,
    scheduler: str | None,
    look: Look | None,
    as_json: bool,
) -> ExitCode:
    """Solve, simulate or regulate an instance for many values.

    X is a shipped instance (`satsym instances` lists them) or the path of a TOML file. The table has a row for each
    combination of values, with its numbers or with the reason why there are none. Whatever interrupts a study, --resume
    goes on with it, and what has been computed is not computed again.
    """
    from satsym import instance
    from satsym.report.results.studies import TABLE
    from satsym.report.study import carry_out, draw
    from satsym.report.terminal.solution import with_files
    from satsym.report.terminal.study import progress_line, study_text
    from satsym.studies import reading
    from satsym.studies.asking import Options, asked

    written = instance.read(subject)
    case = written.instance()
    design = reading.Written(
        vary=reading.read_pairs(vary, "vary"),
        normal=reading.read_pairs(normal, "normal"),
        uniform=reading.read_pairs(uniform, "uniform"),
        sample=sample,
        method=method,
        seed=seed,
    )
    options = Options(command=command, certificate=certificate, feedback=feedback, trajectories=trajectories)
    found = asked(case, written.tree.get("study", {}), design, options)
    folder = out or Path(RESULTS, case.name, "study")
    with _computing(scheduler, min(workers or os.cpu_count() or 1, found.chunks)) as (made, count), live() as line:
        result = carry_out(
            found,
            folder,
            made,
            count,
            resume=resume,
            watch=lambda advance: line.show(progress_line(advance)),
        )
    drawn = draw(folder, look)[1] if look else []
    answer(as_json, result, lambda: with_files(study_text(result), [folder / TABLE, *drawn]))
    return ExitCode.DONE if result["status"] == "converged" else ExitCode.NO_ANSWER


@contextmanager
def _computing(scheduler: str | None, count: int) -> Iterator[tuple[Callable[[], Executor], int]]:
    """What computes chunks, and how many at a time: processes of this machine, or a cluster."""
    if scheduler is None:
        from satsym.studies.workers import Workers

        yield lambda: Workers(count), count
        return
    from satsym.studies.cluster import cluster

    with cluster(scheduler) as (executor, most):
        yield lambda: executor, most
