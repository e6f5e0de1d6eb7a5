"""What terminals show fits them, loses nothing on the way, and never breaks a path."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from satsym import instance, kernels
from satsym.analysis.subject import survey
from satsym.report.terminal import listing
from satsym.report.terminal.orbit import orbit_text
from satsym.report.terminal.solution import simulation_text, solution_text, with_files
from satsym.report.terminal.table import table, wrapped
from satsym.solvers import simulate
from tests.support.solved import solve

WORDS = st.text("abcdefghij", min_size=1, max_size=7)


@pytest.fixture(scope="module")
def texts() -> dict[str, object]:
    models = [kernels.load(name).spec for name in ("polar_orbit", "clohessy_wiltshire", "pitch_wheel")]
    cases = [instance.load(name) for name in ("soft-return", "lapan-minimum-time", "its-thesis")]
    return {
        "solution": solve(instance.load("soft-return-geo")),
        "simulation": simulate(instance.load("its-thesis")),
        "orbit": survey(instance.load("itb-earth")),
        "models": models,
        "cases": cases,
    }


@pytest.mark.parametrize("columns", [60, 80])
def test_summaries_and_lists_fit(texts: dict, columns: int, monkeypatch: pytest.MonkeyPatch) -> None:
    def shown() -> list[str]:
        return [
            solution_text(texts["solution"]),
            simulation_text(texts["simulation"]),
            orbit_text(texts["orbit"]),
            listing.models_text(texts["models"]),
            listing.instances_text(texts["cases"]),
            listing.model_text(texts["models"][0]),
        ]

    monkeypatch.delenv("COLUMNS", raising=False)
    whole = shown()
    monkeypatch.setenv("COLUMNS", str(columns))
    for text, narrow in zip(whole, shown(), strict=True):
        assert max(map(len, narrow.splitlines())) <= columns
        assert set(text.split()) == set(narrow.split())


@given(st.lists(st.tuples(WORDS, WORDS, WORDS, WORDS), min_size=1, max_size=4), st.integers(20, 60))
def test_a_table_of_any_width_has_all_its_cells_in_the_rows_of_their_names(rows: list, columns: int) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("COLUMNS", str(columns))
        lines = table([("name", "one", "two", "three"), *rows])
    assert max(map(len, lines)) <= columns
    below = [line.split() for line in lines]
    for name, *cells in rows:
        assert all(any(row[:1] == [name] and cell in row[1:] for row in below) for cell in cells)


def test_paths_and_long_words_are_never_broken(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "60")
    folder = Path("/a-rather-long/path-with-hyphens/" + "x" * 50)
    told = with_files("summary", [folder / "a.png", folder / "b.png"])
    assert f"  written to {folder}:\n  a.png, b.png" in told
    assert wrapped("y" * 90)[-1].strip() == "y" * 90


def test_a_long_name_is_broken_where_all_columns_then_fit_beside_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    long = "second variation positive with respect to arc lengths and directions"
    lines = table([("condition", "measured", "limit"), (long, "1e-12", "1e-09"), ("short", "0", "1e-08")], right=(1,))
    assert len([line for line in lines if "condition" in line]) == 1
    assert max(map(len, lines)) <= 80
    assert " ".join(" ".join(lines).split()).startswith("condition measured limit second variation positive")
