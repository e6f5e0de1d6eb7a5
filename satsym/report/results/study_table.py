"""The table of a study: names and units of its columns, and reading of numbers and texts by these names."""

from __future__ import annotations

import csv
import io
import math
import sys
from array import array
from collections.abc import Callable, Iterable, Iterator, Sequence
from importlib import import_module
from importlib.util import find_spec
from itertools import islice
from pathlib import Path
from typing import IO, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from satsym.choices import TableFormat
from satsym.instance.numbers import SIDES, Table
from satsym.report.results.files import Content
from satsym.report.results.objects import COST, per, units, with_units
from satsym.spec import ProblemSpec
from satsym.status import BadInput
from satsym.studies.rows import TEXTS, Column, Row, Scalar

BEFORE, AFTER = (Column.ROW, Column.KEY), (Column.STATUS, Column.MESSAGE)
"""Columns before the values of the varied numbers, and columns after them."""


Rows: TypeAlias = Callable[[], Iterable[tuple[int, list[float], Row]]]
"""Function that yields, for each row, its index from zero, its values and its result."""


def table(spec: ProblemSpec, varied: Sequence[str], rows: Rows, form: TableFormat = TableFormat.CSV) -> Content:
    """Return the table of a study; empty where there are no numbers.

    Parameters
    ----------
    varied
        Names of what varies.
    rows
        Gone through twice.
    """
    return _as_parquet(spec, varied, rows) if form is TableFormat.PARQUET else _as_csv(spec, varied, rows)


def _found(rows: Rows) -> list[str]:
    """Return the names of all numbers in the rows."""
    found: dict[str, None] = {}
    for _, _, row in rows():
        found.update(dict.fromkeys(row.numbers))
    return [str(getattr(name, "value", name)) for name in found]


def _as_parquet(spec: ProblemSpec, varied: Sequence[str], rows: Rows) -> Content:
    def written(stream: IO[bytes]) -> None:
        found = _found(rows)
        names = [str(getattr(name, "value", name)) for name in (*BEFORE, *varied, *AFTER, *found)]
        kinds: list[type] = [int, str, *[float] * len(varied), str, str]
        kinds += [str if name in TEXTS else float for name in found]
        lines = (
            [number, row.key, *values, row.status, row.message, *(row.numbers.get(name) for name in found)]
            for number, values, row in rows()
        )
        write(stream, header(spec, names), kinds, lines)

    return written


def _as_csv(spec: ProblemSpec, varied: Sequence[str], rows: Rows) -> Content:
    """Return the table as CSV in UTF-8."""

    def written(stream: IO[bytes]) -> None:
        found = _found(rows)
        text = io.TextIOWrapper(stream, encoding="utf-8", newline="", write_through=True)
        out = csv.writer(text, lineterminator="\n")
        names = [*BEFORE, *varied, *AFTER, *found]
        out.writerow(header(spec, [str(getattr(name, "value", name)) for name in names]))
        for number, values, row in rows():
            numbers = (row.numbers.get(name) for name in found)
            out.writerow([number, row.key, *map(_cell, values), row.status, row.message, *map(_cell, numbers)])
        text.flush()
        text.detach()

    return written


def header(spec: ProblemSpec, names: Sequence[str]) -> list[str]:
    """Return the names of columns with their units."""
    return with_units(names, dict(_units(spec)))


def _units(spec: ProblemSpec) -> Iterator[tuple[str, str | None]]:
    """Return the unit of each column that has one.

    Numbers of steps, estimated errors and other measures of control laws have none.
    """
    own = units(spec)
    time, costs = own["t"], (Column.COST_FROM_INITIAL.value, "metrics.lqr_cost", "metrics.lqr_cost_linear")
    for name in (Column.T_FINAL.value, Column.T_INITIAL.value, f"{Table.TIME.value}.tf", f"{Table.TIME.value}.t0"):
        yield name, time
    for name in (Column.OBJECTIVE.value, Column.COST_LOWER.value, Column.COST_UPPER.value):
        yield name, own.get("objective")
    yield from dict.fromkeys(costs, COST).items()
    yield "metrics.transition_time", time
    for k in range(1, len(spec.states) + 1):
        yield from dict.fromkeys((f"eigenvalue_{k}.re", f"eigenvalue_{k}.im"), per("1", time)).items()
    for v in spec.states:
        for place in (Table.INITIAL.value, Table.FINAL.value, "x_final", "found"):
            yield f"{place}.{v.symbol}", v.unit
        for kind in ("min", "max", "error"):
            yield f"metrics.{v.symbol}_{kind}", v.unit
        yield f"costate_initial.{v.symbol}", own.get(f"lambda_{v.symbol}")
        for control in spec.controls:
            yield f"K.{control.symbol}.{v.symbol}", per(control.unit, v.unit)
    for v in spec.parameters:
        yield f"{Table.PARAMETERS.value}.{v.symbol}", v.unit
        yield f"found.{v.symbol}", v.unit
    for v in spec.invariants:
        yield f"drift.{v.symbol}", v.unit
    if spec.controls:
        yield f"{Table.CONTROL.value}.max_norm", spec.controls[0].unit
    for v in spec.controls:
        yield from ((f"{Table.CONTROL.value}.{v.symbol}.{side}", v.unit) for side in SIDES)


def columns(path: Path, chosen: Callable[[list[str]], Iterable[str]] = lambda names: names) -> dict[str, NDArray[Any]]:
    """Return columns of a table by name: numbers, NaN where there is none, or texts.

    Parameters
    ----------
    chosen
        Of all names those that are wanted.
    """
    if path.name == TableFormat.PARQUET.file:
        known = {label.partition(" [")[0]: label for label in names_of(path)}
        taken = list(chosen(list(known)))
        return dict(zip(taken, read(path, [known[name] for name in taken]), strict=True))
    with path.open(encoding="utf-8", newline="") as stream:
        rows = csv.reader(stream)
        names = list(labels_of(next(rows)))
        wanted = [(names.index(name), name in TEXTS) for name in chosen(names)]
        found: list[Any] = [[] if words else array("d") for _, words in wanted]
        for row in rows:
            for column, (place, words) in zip(found, wanted, strict=True):
                cell = row[place]
                column.append(sys.intern(cell) if words else float(cell) if cell else math.nan)
    return {names[place]: np.array(column) for column, (place, _) in zip(found, wanted, strict=True)}


def labels(path: Path) -> dict[str, str]:
    """Map names of columns to names with units."""
    if path.name == TableFormat.PARQUET.file:
        return labels_of(names_of(path))
    with path.open(encoding="utf-8", newline="") as stream:
        return labels_of(next(csv.reader(stream)))


def labels_of(header: Sequence[str]) -> dict[str, str]:
    """Return the labels of the columns that the first line of a table names."""
    return {label.partition(" [")[0]: label for label in header}


def path_of(folder: Path) -> Path:
    """Return the table of a finished study, whatever its format."""
    return next((found for one in TableFormat if (found := folder / one.file).is_file()), folder / TableFormat.CSV.file)


def _cell(value: Scalar) -> str:
    if value is None:
        return ""
    return value if isinstance(value, str) else repr(float(value))


GROUP = 16384
"""Number of rows that are written, and held in memory, at a time."""


def require() -> None:
    """Refuse, before anything is computed, if pyarrow is missing.

    Raises
    ------
    BadInput
        With what to do.
    """
    if find_spec("pyarrow") is None:
        raise BadInput(
            "table: parquet needs pyarrow, which is not installed; run pip install 'satsym[table]', or use csv"
        )


def write(stream: IO[bytes], names: Sequence[str], kinds: Sequence[type], rows: Iterable[Sequence[Any]]) -> None:
    """Write a table.

    Parameters
    ----------
    names, kinds
        Of the columns: ``int``, ``float`` or ``str``.
    rows
        Values, ``None`` where there is none.
    """
    arrow, parquet = _arrow(), import_module("pyarrow.parquet")
    known = {int: arrow.int64(), float: arrow.float64(), str: arrow.string()}
    schema = arrow.schema([(name, known[kind]) for name, kind in zip(names, kinds, strict=True)])
    left = iter(rows)
    with parquet.ParquetWriter(stream, schema) as writer:
        while group := list(islice(left, GROUP)):
            turned = zip(*group, strict=True)
            columns = [arrow.array(column, known[kind]) for column, kind in zip(turned, kinds, strict=True)]
            writer.write_table(arrow.table(columns, schema=schema))


def names_of(path: Path) -> list[str]:
    """Return the names of the columns, with their units."""
    require()
    names: list[str] = import_module("pyarrow.parquet").read_schema(path).names
    return names


def read(path: Path, names: Sequence[str]) -> list[NDArray[Any]]:
    """Return columns: numbers, NaN where there is none, or texts, empty where there is none."""
    require()
    table = import_module("pyarrow.parquet").read_table(path, columns=list(names))
    arrow, found = _arrow(), []
    for name in names:
        column = table.column(name)
        if arrow.types.is_string(column.type):
            found.append(np.array([text or "" for text in column.to_pylist()]))
        else:
            found.append(np.asarray(column.cast(arrow.float64()).to_numpy()))
    return found


def _arrow() -> Any:
    return import_module("pyarrow")
