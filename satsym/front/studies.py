"""Studies as users meet them: one instance for many values of some of its numbers."""

from __future__ import annotations

import csv
import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from satsym.front.instance import Instance, as_case
from satsym.report.look import Look
from satsym.report.results.files import to_json
from satsym.report.results.studies import TABLE
from satsym.report.study import carry_out, draw
from satsym.report.terminal.study import study_text
from satsym.studies import reading
from satsym.studies.asking import Options, asked
from satsym.studies.running import Watch
from satsym.studies.workers import Workers

if TYPE_CHECKING:
    from numpy.typing import NDArray

Said = Mapping[str, str | Sequence[float]]
"""Keys such as ``"initial.r"``, and a text as on the command line or its numbers: ``(0.9, 1.1, 50)``."""


@dataclass(frozen=True, eq=False, repr=False)
class Study:
    """A study that was carried out.

    Parameters
    ----------
    folder
        Where its table is.
    summary
        What ``satsym study --json`` prints.
    """

    folder: Path
    summary: dict[str, Any]

    @cached_property
    def columns(self) -> dict[str, NDArray[Any]]:
        """The table by the names of its columns, units left out: numbers (NaN where there is none), or texts."""
        with (self.folder / TABLE).open(encoding="utf-8", newline="") as stream:
            names, *rows = csv.reader(stream)
        return {
            name.partition(" [")[0]: _column(column)
            for name, column in zip(names, zip(*rows, strict=True), strict=True)
        }

    def __getitem__(self, name: str) -> NDArray[Any]:
        return self.columns[name]

    def plot(self, formats: Sequence[str] = ("png",), titled: bool = True) -> list[Path]:
        """Draw it into its folder; the pictures."""
        return draw(self.folder, Look(tuple(formats), titled))[1]

    def to_json(self) -> str:
        """The summary as text."""
        return to_json(self.summary)

    def __repr__(self) -> str:
        return study_text(self.summary)


def study(
    instance: Instance | str | Path,
    folder: str | Path,
    *,
    vary: Said | None = None,
    normal: Said | None = None,
    uniform: Said | None = None,
    sample: int | None = None,
    method: str | None = None,
    seed: int | None = None,
    command: str | None = None,
    certificate: str | None = None,
    feedback: str | None = None,
    trajectories: bool = False,
    resume: bool = True,
    workers: int | None = None,
    executor: Callable[[], Executor] | None = None,
    progress: Watch = lambda _: None,
) -> Study:
    """Solve, simulate or regulate an instance for many values of some of its numbers.

    Parameters
    ----------
    instance
        Made by ``load`` or ``Instance.of``; or a name or path, which is loaded.
    folder
        Where the table goes; a study that is there must be this one, and only what is missing is computed.
    vary
        A grid: by key a low and a high value and their number, ``(0.9, 1.1, 50)``, or ``"log:1:100:20"``.
    normal, uniform
        Distributions to draw `sample` rows from: by key mean and standard deviation, or both ends.
    sample, method, seed
        Rows to draw, by ``"sobol"``, ``"lhs"`` or ``"random"`` points.
    command
        ``"solve"``, ``"simulate"`` or ``"lqr"``.
    certificate
        Of solve: ``"none"``, ``"local"`` for all but competitors, or ``"full"``.
    feedback
        Of simulate.
    trajectories
        Whether they are kept, too.
    resume
        Whether a study may be there.
    workers
        Processes; by default one a processor.
    executor
        Makes something of the shape of ``concurrent.futures.Executor`` that computes instead of these processes;
        `workers` calls are given to it at a time.
    progress
        Told after each chunk how far the study is.

    Raises
    ------
    BadInput
        If it cannot be carried out, with one line that says what, where and what to do.

    Examples
    --------
    ::

        found = satsym.study("return-to-orbit", "map", vary={"initial.r": (0.9, 1.1, 50)})
        found["objective"].max()
    """
    case = as_case(instance)
    design = reading.Written(
        vary=_said(vary, ":"),
        normal=_said(normal, ","),
        uniform=_said(uniform, ","),
        sample=sample,
        method=method,
        seed=seed,
    )
    options = Options(command=command, certificate=certificate, feedback=feedback, trajectories=trajectories)
    found = asked(case.case, case.written.tree.get("study", {}), design, options)
    count = min(workers or os.cpu_count() or 1, found.chunks)
    made = executor or (lambda: Workers(count))
    return Study(Path(folder), carry_out(found, Path(folder), made, count, resume=resume, watch=progress))


def _said(given: Said | None, between: str) -> list[tuple[str, str]]:
    """As the command line has it."""
    pairs = (given or {}).items()
    return [(str(k), v if isinstance(v, str) else between.join(_text(one) for one in v)) for k, v in pairs]


def _text(value: float) -> str:
    return repr(int(value)) if isinstance(value, int | np.integer) else repr(float(value))


def _column(values: Sequence[str]) -> NDArray[Any]:
    """Numbers, if all that is there is one."""
    try:
        return np.array([float(value) if value else np.nan for value in values])
    except ValueError:
        return np.array(values)
