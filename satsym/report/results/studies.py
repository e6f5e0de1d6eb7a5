"""The table of a study, row by row from its chunks, its trajectories, and what is said of it as a whole."""

from __future__ import annotations

import csv
import io
import math
import shlex
import sys
import zipfile
from array import array
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import numpy as np

from satsym.arrays import Array
from satsym.instance.numbers import Table
from satsym.report.results.files import Content
from satsym.report.results.objects import head
from satsym.report.results.unit_names import units
from satsym.spec import ProblemSpec
from satsym.status import Status
from satsym.studies.asked import Command, Study
from satsym.studies.parts import Parts
from satsym.studies.rows import Row, Scalar
from satsym.wording import counted

TABLE, ASKED = "table.csv", "study.json"

TEXTS = ("key", "status", "message", "verdict", "method", "origin")
"""Columns that hold words."""

SHOWN = 5
"""Worst rows, and rows without an answer, for which a command is given."""

DRAWN, MOST_DRAWN = ("objective", "t_final", "cost_from_initial"), 3
"""Columns that are drawn first, and how many are."""

MOST_READ, ROUNDING = 16, 1e-9
"""How many of them are looked at, and what may differ by rounding alone."""

FEWEST_IN_FILE, MOST_FILES = 1000, 100
"""Rows of a file of trajectories where there are not too many for that, and files of them."""


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
    """

    title: str
    varied: Mapping[str, Array]
    quantities: Mapping[str, Array]
    status: Sequence[str]
    shape: tuple[int, ...] | None


@dataclass(frozen=True, eq=False)
class Merged:
    """All rows of a study, in order, read from its chunks whenever they are wanted."""

    study: Study
    parts: Parts

    def rows(self) -> Iterator[tuple[int, list[float], Row]]:
        """Number from 0, values of what varies, and what came of it."""
        for number in range(self.study.chunks):
            values = self.study.chunk(number).values.tolist()
            part = self.parts.read(number)
            for place, (own, row) in enumerate(zip(values, part.rows, strict=True)):
                yield part.start + place, own, row

    def columns(self) -> list[str]:
        """Names of the numbers that any row has, in the order of their first row."""
        found: dict[str, None] = {}
        for _, _, row in self.rows():
            found.update(dict.fromkeys(row.numbers))
        return list(found)


def table(merged: Merged) -> Content:
    """The table as CSV, in UTF-8; empty where there is no number."""
    keys = [key.text for key in merged.study.design.keys]
    spec = merged.study.instance.model.spec

    def written(stream: IO[bytes]) -> None:
        columns = merged.columns()
        text = io.TextIOWrapper(stream, encoding="utf-8", newline="", write_through=True)
        out = csv.writer(text, lineterminator="\n")
        out.writerow(header(spec, ["row", "key", *keys, "status", "message", *columns]))
        for number, values, row in merged.rows():
            numbers = (row.numbers.get(name) for name in columns)
            out.writerow([number, row.key, *map(_cell, values), row.status, row.message, *map(_cell, numbers)])
        text.flush()
        text.detach()

    return written


def header(spec: ProblemSpec, names: Sequence[str]) -> list[str]:
    """Names of columns with their units in brackets, but for plain numbers and words."""
    known = _units(spec)
    return [f"{name} [{unit}]" if (unit := known.get(name)) and unit != "1" else name for name in names]


def _units(spec: ProblemSpec) -> dict[str, str | None]:
    """The unit of each column that has one."""
    own = units(spec)
    found: dict[str, str | None] = dict.fromkeys(("t_final", "t_initial", "time.tf", "time.t0"), own["t"])
    found["objective"] = own.get("objective")
    for v in spec.states:
        found |= dict.fromkeys((f"{Table.INITIAL.value}.{v.symbol}", f"{Table.FINAL.value}.{v.symbol}"), v.unit)
        found |= {f"x_final.{v.symbol}": v.unit, f"found.{v.symbol}": v.unit}
        found[f"costate_initial.{v.symbol}"] = own.get(f"lambda_{v.symbol}")
    for v in spec.parameters:
        found |= {f"{Table.PARAMETERS.value}.{v.symbol}": v.unit, f"found.{v.symbol}": v.unit}
    found |= {f"drift.{v.symbol}": v.unit for v in spec.invariants}
    if spec.controls:
        found[f"{Table.CONTROL.value}.max_norm"] = spec.controls[0].unit
    return found


def trajectories(merged: Merged) -> dict[str, Content]:
    """Files of trajectories, few whatever the number of rows: arrays ``ROW.t``, ``ROW.x``, ``ROW.u``, ``ROW.lam``."""
    study = merged.study
    if not study.trajectories:
        return {}
    each = max(1, -(-max(FEWEST_IN_FILE, -(-study.design.count // MOST_FILES)) // study.size))
    groups = [range(first, min(first + each, study.chunks)) for first in range(0, study.chunks, each)]
    return {f"trajectories-{k:03d}.npz": _trajectories(merged, group) for k, group in enumerate(groups)}


def _trajectories(merged: Merged, group: range) -> Content:
    def written(stream: IO[bytes]) -> None:
        with zipfile.ZipFile(stream, "w", zipfile.ZIP_STORED) as archive:
            for number in group:
                start = number * merged.study.size
                for place, arrays in merged.parts.trajectories(number).items():
                    for name, array in arrays.items():
                        content = io.BytesIO()
                        np.lib.format.write_array(content, np.ascontiguousarray(array), allow_pickle=False)
                        # without a date, so that the same study has the same bytes
                        archive.writestr(zipfile.ZipInfo(f"{start + place}.{name}.npy"), content.getvalue())

    return written


def asked_object(study: Study) -> dict[str, Any]:
    """What study.json holds."""
    said = head("study", study.instance.model.spec, study.instance.name, Status.CONVERGED)
    del said["status"]
    varied = [key.text for key in study.design.keys]
    return said | {"rows": study.design.count, "varied": varied, "asked": study.identity}


def study_object(merged: Merged) -> dict[str, Any]:
    """What ``satsym study --json`` prints and result.json holds."""
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
        if isinstance(verdict := row.numbers.get("verdict"), str):
            verdicts[verdict] += 1
        if isinstance(cost := row.numbers.get("objective"), float):
            worst = sorted([*worst, (sense * cost, number, values)], reverse=True, key=lambda one: one[0])[:SHOWN]
    status = Status.CONVERGED if statuses[Status.CONVERGED.value] else Status.NOT_CONVERGED
    return head("study", spec, study.instance.name, status) | {
        "each": study.command.value,
        "rows": study.design.count,
        "varied": [key.text for key in study.design.keys],
        "grid": [axis.count for axis in study.design.axes] if hasattr(study.design, "axes") else None,
        "certificate": study.identity["certificate"],
        "statuses": dict(sorted(statuses.items())),
        "verdicts": dict(sorted(verdicts.items())),
        "worst": [_case(study, number, values) | {"objective": sense * cost} for cost, number, values in worst],
        "failures": failures,
    }


def numbers(path: Path, said: Mapping[str, Any]) -> Numbers:
    """The columns of a table that are drawn: what varies, and the first that tell of the whole.

    Parameters
    ----------
    said
        What result.json holds.
    """
    with path.open(encoding="utf-8", newline="") as stream:
        rows = csv.reader(stream)
        labels = next(rows)
        names = [label.partition(" [")[0] for label in labels]
        varied = [names.index(name) for name in said["varied"]]
        drawn = [names.index(name) for name in DRAWN if name in names]
        first = len(varied) + 4  # the number, the key, the status and its message stand before
        drawn += [k for k in range(first, len(names)) if k not in drawn and names[k] not in TEXTS]
        chosen, place = [*varied, *drawn[:MOST_READ]], names.index("status")
        status: list[str] = []
        values = array("d")
        for row in rows:
            status.append(sys.intern(row[place]))
            values.extend(float(row[k]) if row[k] else math.nan for k in chosen)
    table = np.array(values).reshape(-1, len(chosen))
    columns = {labels[k]: table[:, place] for place, k in enumerate(chosen)}
    title = f"{said['instance']}: {said['each']} for {counted(said['rows'], 'row')}"
    return Numbers(
        title=title,
        varied={labels[k]: columns[labels[k]] for k in varied},
        quantities=telling({labels[k]: columns[labels[k]] for k in chosen[len(varied) :]}),
        status=status,
        shape=tuple(said["grid"]) if said["grid"] else None,
    )


def telling(quantities: Mapping[str, Array]) -> dict[str, Array]:
    """The first of them that differ from row to row by more than rounding does; where none does, the first alone."""

    def varies(name: str, values: Array) -> bool:
        known = values[np.isfinite(values)]
        if not known.size:
            return False
        # a final state that is given as zero is nothing but rounding
        size = float(np.abs(known).max()) + name.startswith("x_final")
        return bool(np.ptp(known) > ROUNDING * size)

    found = [name for name, values in quantities.items() if varies(name, values)]
    return {name: quantities[name] for name in (found or list(quantities))[: MOST_DRAWN if found else 1]}


def _case(study: Study, number: int, values: Sequence[float]) -> dict[str, Any]:
    """A row, and the command that computes it alone."""
    own = dict(zip((key.text for key in study.design.keys), values, strict=True))
    finite = {name: value if np.isfinite(value) else None for name, value in own.items()}
    return {"row": number, "values": finite, "reproduce": _reproduced(study, own)}


def _reproduced(study: Study, values: dict[str, float]) -> str:
    words = ["satsym", study.command.value, _subject(study)]
    if study.command is Command.SIMULATE and study.feedback:
        words += ["--feedback", study.feedback]
    words += [word for name, value in values.items() for word in ("--set", f"{name}={value!r}")]
    return shlex.join(words)


def _subject(study: Study) -> str:
    from satsym.instance import shipped

    instance = study.instance
    return instance.name if instance.name in shipped() else str(instance.path)


def _cell(value: Scalar) -> str:
    if value is None:
        return ""
    return value if isinstance(value, str) else repr(float(value))
