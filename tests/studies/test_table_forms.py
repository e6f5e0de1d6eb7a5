"""The table of a study as Parquet is that as CSV; where pyarrow is missing a line says so and nothing is written."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import satsym
from satsym.report.results import study_table
from satsym.report.results.study_table import columns, labels
from satsym.status import BadInput

VARY = {"initial.q": (0.2, 0.9, 20)}


def test_both_forms_hold_the_same(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pyarrow")
    monkeypatch.setattr(study_table, "GROUP", 7)  # more than one group of rows
    folders = {form: tmp_path / form for form in ("csv", "parquet")}
    for form, folder in folders.items():
        satsym.study("double-integrator-energy", folder, vary=VARY, table=form, workers=1)
        assert [one.name for one in folder.glob("table.*")] == [f"table.{form}"]
    texts, binary = (columns(folder / f"table.{form}") for form, folder in folders.items())
    assert list(texts) == list(binary)
    for name, column in texts.items():
        assert column.dtype.kind == binary[name].dtype.kind
        np.testing.assert_array_equal(column, binary[name])
    assert labels(folders["csv"] / "table.csv") == labels(folders["parquet"] / "table.parquet")
    again = satsym.study("double-integrator-energy", folders["parquet"], vary=VARY, table="parquet", workers=1)
    assert len(again["objective"]) == 20
    assert again.plot()[0].is_file()
    with pytest.raises(BadInput, match="table was parquet"):
        satsym.study("double-integrator-energy", folders["parquet"], vary=VARY, workers=1)


def test_without_pyarrow_it_is_refused_in_a_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(study_table, "find_spec", lambda _: None)
    for form, said in (("parquet", r"pip install 'satsym\[table\]'"), ("xls", "unknown; available: csv, parquet")):
        with pytest.raises(BadInput, match=said):
            satsym.study("double-integrator-energy", tmp_path / "none", vary=VARY, table=form)
    assert not (tmp_path / "none").exists()
