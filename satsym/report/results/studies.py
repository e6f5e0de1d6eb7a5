"""The files of a study, made from its chunks: table, trajectories, and summary."""

from __future__ import annotations

import io
import shlex
import zipfile
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import IO, Any

import numpy as np

from satsym.arrays import Array
from satsym.choices import Command
from satsym.instance import numbers as of_instances
from satsym.instance.shown import spec_of
from satsym.report.results import study_table
from satsym.report.results.files import Content, text, to_json
from satsym.report.results.objects import head, with_settings
from satsym.report.results.set_list import ASKED
from satsym.report.results.study_table import BEFORE, table
from satsym.report.said import counted, say
from satsym.status import BadInput, Status
from satsym.studies.asked import Study
from satsym.studies.branches import Branches
from satsym.studies.parts import Parts
from satsym.studies.rows import TEXTS, Column, Row

SHOWN = 5
"""Number of worst rows, and of rows without a solution, for which a command is given."""

DRAWN_FIRST, MOST_DRAWN = (Column.OBJECTIVE, Column.T_FINAL, Column.COST_FROM_INITIAL), 3
"""Columns that are plotted first, and largest number of plotted columns."""

MOST_READ, ROUNDING = 16, 1e-9
"""Number of columns that are examined, and relative difference that is attributed to rounding."""

LARGEST_FILE, FILES = 2**28, 100
"""Intended size in bytes of a file of trajectories, and approximate largest number of such files.

Files are larger only to limit their number.
"""


@dataclass(frozen=True, eq=False)
class Numbers:
    """The columns of a table that are drawn.

    Attributes
    ----------
    title
        One line.
    varied, quantities
        Labels with their units -> values, shape (rows,); NaN where there is none.
    status
        Of each row.
    shape
        Of the grid, in the order of `varied`; ``None`` for a sample.
    branch
        Of each row, NaN where it has none; nothing where neighbours were not compared.
    """

    title: str
    varied: Mapping[str, Array]
    quantities: Mapping[str, Array]
    status: Sequence[str]
    shape: tuple[int, ...] | None
    branch: Array | None = None


@dataclass(frozen=True, eq=False)
class Merged:
    """All rows of a study in order, read from its chunks on demand."""

    study: Study
    parts: Parts
    branches: Branches | None = None
    """The result of comparing neighbouring rows; ``None`` if they were not compared."""

    def rows(self) -> Iterator[tuple[int, list[float], Row]]:
        """Yield the number of each row from 0, its values, and its result."""
        for number in range(self.study.chunks):
            values = self.study.chunk(number).values.tolist()
            part = self.parts.read(number)
            for place, (own, row) in enumerate(zip(values, part.rows, strict=True)):
                yield part.start + place, own, self._now(part.start + place, row)

    def _now(self, number: int, row: Row) -> Row:
        """Return a row with its branch, and with its neighbour's answer where that costs less."""
        if self.branches is None:
            return row
        row = self.branches.changed.get(number, row)
        label = self.branches.labels.get(number)
        return row if label is None else replace(row, numbers={**row.numbers, Column.BRANCH: float(label)})

    def trajectories(self, number: int) -> dict[int, dict[str, Array]]:
        """Return the trajectories of a chunk, by the place of the row in it."""
        found, (start, count) = self.parts.trajectories(number), self.study.place(number)
        changed = {} if self.branches is None else self.branches.changed
        return found | {k: dict(changed[start + k].trajectory) for k in range(count) if start + k in changed}


TRAJECTORIES = "trajectories-{:03d}.npz"
"""Names of the files of trajectories."""


def files(merged: Merged) -> dict[str, Content]:
    """Return all files but result.json."""
    study = merged.study
    keys = [key.text for key in study.design.keys]
    asked = {ASKED: text(to_json(asked_object(study)))}
    written = table(study.instance.model.spec, keys, merged.rows, study.table)
    return asked | {study.table.file: written} | trajectories(merged)


def trajectories(merged: Merged) -> dict[str, Content]:
    """Return a few files of trajectories: arrays ``ROW.t``, ``ROW.x``, ``ROW.u``, ``ROW.lam``."""
    if not merged.study.trajectories:
        return {}
    sizes = [merged.parts.size(number) for number in range(merged.study.chunks)]
    most = max(LARGEST_FILE, sum(sizes) // FILES)
    groups, last = [[0]], sizes[0]
    for number, size in enumerate(sizes[1:], 1):
        last += size
        if last > most:
            groups.append([])
            last = size
        groups[-1].append(number)
    return {TRAJECTORIES.format(k): _trajectories(merged, group) for k, group in enumerate(groups)}


def _trajectories(merged: Merged, group: Sequence[int]) -> Content:
    def written(stream: IO[bytes]) -> None:
        with zipfile.ZipFile(stream, "w", zipfile.ZIP_STORED) as archive:
            for number in group:
                start = number * merged.study.size
                for place, arrays in merged.trajectories(number).items():
                    for name, array in arrays.items():
                        content = io.BytesIO()
                        np.lib.format.write_array(content, np.ascontiguousarray(array), allow_pickle=False)
                        # without a date, so that the same study has the same bytes
                        archive.writestr(zipfile.ZipInfo(f"{start + place}.{name}.npy"), content.getvalue())

    return written


def asked_object(study: Study) -> dict[str, Any]:
    """Return the object of study.json."""
    said = head("study", study.instance.model.spec, study.instance, Status.CONVERGED)
    del said["status"]
    varied = [key.text for key in study.design.keys]
    return with_settings(said | {"rows": study.design.count, "varied": varied, "asked": study.identity}, study.settings)


def study_object(merged: Merged) -> dict[str, Any]:
    """Return the object of ``satsym study --json`` and result.json."""
    study, spec = merged.study, merged.study.instance.model.spec
    statuses: Counter[str] = Counter()
    verdicts: Counter[str] = Counter()
    failures: list[dict[str, Any]] = []
    worst: list[tuple[float, int, list[float]]] = []
    sense = -1.0 if spec.maximise else 1.0
    for number, values, row in merged.rows():
        statuses[row.status] += 1
        if not row.answered:
            if len(failures) < SHOWN:
                said = {"status": row.status, "message": row.message}
                failures.append(_case(study, number, values) | said)
            continue
        if isinstance(verdict := row.numbers.get(Column.VERDICT), str):
            verdicts[verdict] += 1
        if isinstance(cost := row.numbers.get(Column.OBJECTIVE), float) and np.isfinite(cost):
            worst = sorted([*worst, (sense * cost, number, values)], reverse=True, key=lambda one: one[0])[:SHOWN]
    status = Status.CONVERGED if statuses[Status.CONVERGED.value] else Status.NOT_CONVERGED
    return with_settings(head("study", spec, study.instance, status), study.settings) | {
        "each": study.command.value,
        "rows": study.design.count,
        "varied": [key.text for key in study.design.keys],
        "grid": [axis.count for axis in study.design.axes] if hasattr(study.design, "axes") else None,
        "certificate": study.identity["certificate"],
        "statuses": dict(sorted(statuses.items())),
        "verdicts": dict(sorted(verdicts.items())),
        "worst": [_case(study, number, values) | {"objective": sense * cost} for cost, number, values in worst],
        "failures": failures,
        "branches": _branches(merged),
        "multiples": _multiples(study),
    }


def _multiples(study: Study) -> bool:
    """Tell whether the numbers of the first and of the last case are multiples, which are shown without units."""
    ends = (study.design.rows(k, k + 1)[0] for k in (0, study.design.count - 1))
    try:
        cases = [of_instances.at(study.instance, study.design.keys, tuple(map(float, values))) for values in ends]
    except BadInput:  # such a case has a row, but no solution
        cases = [study.instance]
    return all(spec_of(case) is not case.model.spec for case in cases)


def _branches(merged: Merged) -> dict[str, int] | None:
    """Count branches, neighbours of different ones, and rows with a neighbour's answer."""
    found = merged.branches
    if found is None:
        return None
    count = len(set(found.labels.values()))
    return {"count": count, "borders": found.borders, "changed": len(found.changed)}


_TITLES = {
    Command.SOLVE.value: "<name>: solutions of <rows>",
    Command.SIMULATE.value: "<name>: simulations of <rows>",
    Command.LQR.value: "<name>: regulators of <rows>",
}


def numbers(path: Path, said: Mapping[str, Any]) -> Numbers:
    """Return the columns of a table that are drawn: varied numbers, and the first quantities that differ by row.

    Parameters
    ----------
    said
        What result.json holds.
    """
    labels, varied = study_table.labels(path), said["varied"]
    if said.get("multiples"):
        labels = {name: name for name in labels}

    def chosen(names: list[str]) -> list[str]:
        drawn: list[str] = [name for name in DRAWN_FIRST if name in names]
        drawn += [name for name in names if name not in (*drawn, *BEFORE, *varied, *TEXTS, Column.BRANCH)]
        return [*varied, *drawn[:MOST_READ], Column.STATUS, *(name for name in names if name == Column.BRANCH)]

    found = study_table.columns(path, chosen)
    status, branch = found.pop(Column.STATUS), found.pop(Column.BRANCH, None)
    columns = {labels[name]: values for name, values in found.items()}
    rows = counted(said["rows"], "case")
    title = say(_TITLES[said["each"]], name=said["instance"], rows=rows)
    given = {labels[name]: columns.pop(labels[name]) for name in varied}
    return Numbers(
        title=title,
        varied=given,
        quantities=distinguishing(columns, given),
        status=status.tolist(),
        shape=tuple(said["grid"]) if said["grid"] else None,
        branch=branch,
    )


def distinguishing(quantities: Mapping[str, Array], varied: Mapping[str, Array]) -> dict[str, Array]:
    """Return the first quantities that differ by row, from each other and from what varies; else the first one."""

    def varies(name: str, values: Array) -> bool:
        known = values[np.isfinite(values)]
        if not known.size:
            return False
        # a final state that is given as zero is nothing but rounding
        size = float(np.abs(known).max()) + name.startswith("x_final")
        return bool(np.ptp(known) > ROUNDING * size)

    found = dict[str, Array]()
    for name, values in quantities.items():
        before = (*varied.values(), *found.values())
        if varies(name, values) and not any(_same(values, other) for other in before):
            found[name] = values
    names = list(found or quantities)[: MOST_DRAWN if found else 1]
    return {name: quantities[name] for name in names}


def _same(values: Array, others: Array) -> bool:
    """Tell whether two columns are equal up to rounding, such as duration and cost, where they have numbers."""
    known = np.isfinite(values)
    return bool(np.allclose(values[known], others[known], rtol=ROUNDING, atol=0.0))


def _case(study: Study, number: int, values: Sequence[float]) -> dict[str, Any]:
    """Return a row, and the command that computes it alone."""
    own = dict(zip((key.text for key in study.design.keys), values, strict=True))
    finite = {name: value if np.isfinite(value) else None for name, value in own.items()}
    return {"row": number, "values": finite, "reproduce": _reproduced(study, own)}


def _reproduced(study: Study, values: dict[str, float]) -> str:
    words = ["satsym", study.command.value, study.subject]
    if study.command is Command.SIMULATE and study.feedback:
        words += ["--feedback", study.feedback]
    words += [word for name, value in {**study.settings, **values}.items() for word in ("--set", f"{name}={value!r}")]
    return shlex.join(words)
