"""Tables as Parquet, by pyarrow (extra ``table``), which is loaded by nothing else."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from importlib import import_module
from importlib.util import find_spec
from itertools import islice
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from satsym.status import BadInput

GROUP = 16384
"""Rows that are written at a time, and are in memory."""


def require() -> None:
    """Refuse where pyarrow is missing, before anything is computed.

    Raises
    ------
    BadInput
        With what to do.
    """
    if find_spec("pyarrow") is None:
        raise BadInput("table: parquet needs pyarrow, which is not installed; pip install 'satsym[table]', or take csv")


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
    """Columns: numbers, NaN where there is none, or texts, empty where there is none."""
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
