"""Studies in Python: one instance for many values of some of its numbers."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from satsym.front import saved
from satsym.front.calls import in_one_line, single_threaded
from satsym.front.instance import Instance, as_case
from satsym.front.tables import name_of, plain
from satsym.report.look import Look
from satsym.report.results.files import to_json
from satsym.report.results.study_table import columns, path_of
from satsym.report.study import carry_out, draw, written_as
from satsym.report.terminal.study import study_text
from satsym.status import BadInput
from satsym.studies.asking import asked, named
from satsym.studies.running import Watch
from satsym.studies.workers import Workers, processes
from satsym.wording import shown

if TYPE_CHECKING:
    from numpy.typing import NDArray

Said = Mapping[str, str | Sequence[float]]
"""Keys such as ``"initial.r"`` with a text as on the command line or with numbers: ``(0.9, 1.1, 50)``."""


@dataclass(frozen=True, eq=False, repr=False)
class Study:
    """A completed study with its table of results.

    Parameters
    ----------
    folder
        Folder that contains the table.
    summary
        The data that ``satsym study --json`` prints.
    """

    folder: Path
    summary: dict[str, Any]

    @cached_property
    def columns(self) -> dict[str, NDArray[Any]]:
        """Return the columns of the table by name, without units: numbers (NaN for missing values), or texts."""
        return columns(path_of(self.folder))

    def __getitem__(self, name: str) -> NDArray[Any]:
        return self.columns[name]

    def plot(self, formats: str | Sequence[str] = "png", titled: bool = True) -> list[Path]:
        """Draw the pictures into the study's folder, and return their paths."""
        return draw(self.folder, Look.of(formats, titled))[1]

    def to_json(self) -> str:
        """Return the summary as JSON text."""
        return to_json(self.summary)

    def __repr__(self) -> str:
        return study_text(self.summary)


@single_threaded()
@in_one_line
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
    table: str | None = None,
    resume: bool = True,
    workers: int | None = None,
    executor: Callable[[], Executor] | None = None,
    progress: Watch = lambda _: None,
) -> Study:
    """Solve or simulate an instance, or design regulators for it, over ranges of its inputs (a parameter study).

    Parameters
    ----------
    instance
        An instance, or the name or path of one, which is then loaded.
    folder
        Output folder. If it contains a study, this must be the same study, and only missing cases are computed.
    vary
        A grid: for each key, the lowest value, the highest value and the number of values, ``(0.9, 1.1, 50)``,
        or a text such as ``"log:1:100:20"``.
    normal
        Normal distributions of a random sample: for each key, the mean and the standard deviation.
    uniform
        Uniform distributions of a random sample: for each key, the lower and the upper end of the interval.
    sample
        Number of cases that are drawn at random, in place of a grid. This and the next five override the table
        ``[study]`` of the instance.
    method
        Sampling method: ``"sobol"``, the default, ``"lhs"`` (Latin hypercubes) or ``"random"``.
    seed
        Seed of the sampling; zero by default.
    command
        What is computed for each case: ``"solve"``, the default, ``"simulate"`` or ``"lqr"``.
    certificate
        How solutions are certified: ``"local"``, the default, computes no competing solutions; ``"full"`` does;
        ``"sample"`` does so for one case in a hundred; ``"none"`` certifies nothing.
    feedback
        Control law of simulations, as for ``satsym simulate --feedback``.
    trajectories
        Whether to save the trajectories as well.
    table
        Format of the table: ``"csv"``, the default, or ``"parquet"``, which needs pyarrow (extra ``table``).
    resume
        Whether to continue a study in the output folder.
    workers
        Number of processes; by default one for each processor that this process may use.
    executor
        Function that returns an object like ``concurrent.futures.Executor``, which computes in place of these
        processes; at most `workers` calls are submitted to it at a time.
    progress
        Function that is called with the progress of the study after each chunk.

    Raises
    ------
    BadInput
        If the study cannot be carried out, with a one-line message that says what is wrong, where, and what to do.

    Examples
    --------
    ::

        found = satsym.study("return-to-orbit", "map", vary={"initial.r": (0.9, 1.1, 50)})
        found["objective"].max()
    """
    if not isinstance(folder, str | Path):
        raise BadInput(f"folder: {shown(folder)} is not a path; give the path of a folder")
    case, place = as_case(instance), Path(folder)
    said = {"vary": _said(vary, ":"), "normal": _said(normal, ","), "uniform": _said(uniform, ",")}
    said |= {"sample": sample, "method": method, "seed": seed}
    said |= {"command": command, "certificate": certificate, "feedback": feedback, "trajectories": trajectories}
    subject = named(case.written)
    found = asked(case.written, case.case, plain(said), subject or str(place / f"{case.name}.toml"))
    found = written_as(found, table)
    count = processes(workers, found.chunks)
    made, more = executor or (lambda: Workers(count)), {} if subject else saved.origin(case)
    return Study(place, carry_out(found, place, made, count, resume=resume, watch=progress, more=more))


def _said(given: Any, between: str) -> Any:
    """Convert a value to the form of the command line; an unsuitable value is kept, so that it is refused later."""
    if isinstance(given, Mapping):
        return {name_of(key): _said(value, between) for key, value in given.items()}
    if isinstance(found := plain(given), list):
        return between.join(one if isinstance(one, str) else repr(one) for one in found)
    return found
