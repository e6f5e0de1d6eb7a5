"""``satsym bench``: what it measures is there, in a table and as JSON, and takes as long as it says."""

from __future__ import annotations

import json

import pytest

from satsym.cli.machine import bench
from satsym.kernels.batch import compiling
from satsym.status import Status
from satsym.studies.workers import usable_processors
from tests.cli.test_cli import Run, run

__all__ = ["run"]


@pytest.fixture(autouse=True)
def _short(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bench, "QUICK_SECONDS", 0.01)


def test_an_instance_is_measured_by_steps_and_by_its_solution(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compiling, "able", lambda: False)
    code, out, err = run("bench", "return-to-orbit", "--quick", "--json")
    assert (code, err) == (0, "")
    found = json.loads(out)
    assert found["command"] == "bench"
    assert found["machine"]["cores"] == usable_processors() >= 1
    assert [(one["backend"], one["cores"]) for one in found["steps"]] == [("numpy", 1)]
    assert 1e4 < found["steps"][0]["per_second"] < 1e10
    assert 0.0 < found["solve"]["solve_s"] < found["solve"]["certificate_s"] < 60.0
    code, out, _ = run("bench", "return-to-orbit", "--quick")
    assert code == 0
    assert "steps of one motion, NumPy" in out
    assert "pip install 'satsym[fast]'" in out


@pytest.mark.slow
def test_machine_code_is_measured_on_one_core_and_on_all(run: Run) -> None:
    pytest.importorskip("numba")
    code, out, _ = run("bench", "polar_orbit", "--quick", "--json")
    assert code == 0
    found = json.loads(out)
    assert found["solve"] is None, "a model has nothing to be solved"
    assert [one["cores"] for one in found["steps"]] == [1, *sorted({1, usable_processors()})]
    numpy, numba, *_ = (one["per_second"] for one in found["steps"])
    assert numba > 3.0 * numpy


def test_steps_that_take_longer_are_fewer_a_second(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [0.0]
    monkeypatch.setattr(bench.time, "perf_counter", lambda: now[0])

    def run(lasting: float) -> None:
        now[0] += lasting

    quick, slow = (bench._rate(lambda lasting=lasting: run(lasting), 1.0) for lasting in (0.01, 0.04))
    assert quick == pytest.approx(bench.COLUMNS * bench.STEPS / 0.01)
    assert slow == pytest.approx(quick / 4.0)


def test_without_an_answer_it_is_said(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compiling, "able", lambda: False)
    failed = Status.INFEASIBLE, {"method": "collocation", "solve_s": 0.1, "certificate_s": None}
    monkeypatch.setattr(bench, "measured_solution", lambda _: failed)
    code, out, _ = run("bench", "return-to-orbit", "--quick")
    assert code == 4
    assert "the instance has no solution: infeasible" in out
    code, out, err = run("bench", "nothing-of-that-name")
    assert (code, out) == (3, "")
    assert err.count("\n") == 1
