"""Rows that are solved together are those that are solved one by one, and no number of workers changes a byte."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
import pytest

from satsym import instance, solvers
from satsym.analysis.regulator import many
from satsym.instance import Instance
from satsym.report import study as reports
from satsym.solvers.batch import bounded as batch
from satsym.solvers.batch.many import Many
from satsym.solvers.switching.linear.by_reach import separating
from satsym.status import BadInput
from satsym.studies import chunks, solving
from satsym.studies.asked import Study, Task
from satsym.studies.asking import FEWEST_ROWS_COMPILED
from satsym.studies.asking import asked as asking
from satsym.studies.rows import Found, Row
from satsym.studies.together import rows_together, together
from satsym.studies.workers import Workers

NAME = "return-to-orbit"
SAMPLE = {"sample": 24, "uniform": {"initial.r": "0.9,1.1", "initial.theta_dot": "0.9,1.1"}, "seed": 1}


def asked(**said: Any) -> Study:
    written = instance.read(NAME)
    return asking(written, written.instance(), said, NAME)


def computed(study: Study) -> list[Row]:
    packed = chunks.pack(study)
    return [row for number in range(study.chunks) for row in chunks.computed(packed, study.chunk(number))]


@pytest.mark.slow
def test_rows_together_are_those_of_the_single_solver() -> None:
    study = asked(**SAMPLE)
    found = computed(study)
    assert {row.status for row in found} == {"converged"}
    assert {row.numbers["verdict"] for row in found} == {"local minimum"}
    assert sum(row.numbers["origin"] != "single solver" for row in found) >= 0.9 * len(found)
    case, values = instance.load(NAME), study.design.rows(0, 24)
    for k in range(0, 24, 8):
        r, theta_dot = values[k]
        single = solvers.solve(replace(case, initial=(r, 0.0, 0.0, theta_dot)), examined=False)
        assert found[k].numbers["objective"] == pytest.approx(single.objective, rel=1e-9)
        size = np.abs(single.lam[:, 0]).max()
        for i, state in enumerate(case.model.spec.state_names):
            assert abs(float(found[k].numbers[f"costate_initial.{state}"] or 0.0) - single.lam[i, 0]) <= 1e-9 * size


def test_what_is_not_solved_together_is_solved_alone() -> None:
    """Bounds that some rows meet, and a start that is far away."""
    tight = asked(vary={"initial.r": "1.0:1.4:8"}, certificate="local")
    task = tight.task
    assert together(task)
    found = computed(tight)
    assert {row.status for row in found} == {"converged"}
    kept = asked(vary={"initial.r": "1.0:1.1:2"}, trajectories=True)
    full = asked(vary={"initial.r": "1.0:1.1:2"}, certificate="full")
    timed = asked(vary={"time.tf": "6.0:6.3:2"})
    assert not any(together(one.task) for one in (kept, full, timed))


@pytest.mark.slow
def test_without_certificates_rows_are_minima_all_the_same() -> None:
    found = computed(asked(**SAMPLE | {"certificate": "none"}))
    assert {row.numbers["verdict"] for row in found} == {None}
    local = computed(asked(**SAMPLE))
    same = [a.numbers["objective"] == b.numbers["objective"] for a, b in zip(found, local, strict=True)]
    assert all(same)


def test_many_rows_are_compiled_where_that_is_possible() -> None:
    pytest.importorskip("numba")
    few, many = (
        asked(sample=count, uniform={"initial.r": "0.9,1.1"})
        for count in (FEWEST_ROWS_COMPILED - 1, FEWEST_ROWS_COMPILED)
    )
    assert not few.compiled
    assert many.compiled
    assert many.identity["backend"] == "numba"


def test_a_worker_without_a_compiler_answers_all_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    """As one of a cluster may be, though who asks has one."""
    study = replace(asked(sample=2, uniform={"initial.r": "0.9,1.1"}), compiled=True)

    def refused(task: Task) -> NoReturn:
        raise BadInput("compiled kernels need numba")

    monkeypatch.setattr(solving, "able", lambda: False)
    monkeypatch.setattr(solving, "_repeated", refused)  # kernels that were compiled before this test are kept
    found = computed(study)
    assert {row.status for row in found} == {"converged"}
    assert {row.numbers["origin"] for row in found} == {"single solver"}


def test_least_times_are_found_together() -> None:
    line, keys = "double-integrator-time", {"initial.q": "-2,2", "initial.q_dot": "-2,2", "final.q_dot": "-1,1"}
    written = instance.read(line)
    said = {"sample": 24, "uniform": keys, "seed": 3}
    study = asking(written, written.instance(), said, line)
    found = computed(study)
    assert {row.numbers["verdict"] for row in found} == {"local minimum"}
    assert {(row.numbers["method"], row.numbers["origin"]) for row in found} == {("bang-bang", "reachable set")}
    case, values = instance.load(line), study.design.rows(0, 24).tolist()
    for row, (q, q_dot, end) in list(zip(found, values, strict=True))[::8]:
        single = solvers.solve(replace(case, initial=(q, q_dot), final={"q": 0.0, "q_dot": end}), examined=False)
        assert row.numbers["objective"] == pytest.approx(single.objective, rel=1e-11)
        for i, state in enumerate(case.model.spec.state_names):
            assert row.numbers[f"costate_initial.{state}"] == pytest.approx(single.lam[i, 0], rel=1e-9)
        assert row.numbers["switching_times"] == len(single.switching_times[0])
    bare = computed(asking(written, written.instance(), said | {"certificate": "none"}, line))
    assert [row.numbers["objective"] for row in bare] == [row.numbers["objective"] for row in found]


def test_linear_problems_and_regulators_are_found_together(monkeypatch: pytest.MonkeyPatch) -> None:
    line = "double-integrator-energy"
    said = {"vary": {"initial.q": "0.2:0.4:3", "initial.q_dot": "-0.1:0:2"}}
    found = computed(asking(instance.read(line), instance.read(line).instance(), said, line))
    assert {(one.numbers["method"], one.numbers["verdict"]) for one in found} == {("linear", "local minimum")}
    geo = "geo-lqr"
    said = {"command": "lqr", "vary": {"initial.r": "42000 km:42300 km:4", "parameters.omega": "7e-5:7.5e-5:3"}}
    written = instance.read(geo)
    study = asking(written, written.instance(), said, geo)
    at_once = computed(study)
    monkeypatch.setattr(many, "regulators", lambda instances: None)
    for one, other in zip(at_once, computed(study), strict=True):
        assert list(one.numbers) == list(other.numbers)
        numbers = ([v for k, v in row.numbers.items() if k != "riccati_residual"] for row in (one, other))
        assert next(numbers) == pytest.approx(next(numbers), rel=1e-6, abs=1e-20)
        assert float(one.numbers["riccati_residual"] or 0.0) < 1e-12


def test_bounds_of_single_controls_vary_and_each_row_is_judged_by_its_own() -> None:
    """Without bounds the largest second thrust of these two returns is 0.0726 and 0.0116."""
    bounded = "return-to-orbit-005"
    written = instance.read(bounded)
    said = {"vary": {"initial.r": "1.02:1.06:2", "control.u2.upper": "0.04:0.12:2"}}
    study = asking(written, written.instance(), said, bounded)
    assert together(study.task)
    found = computed(study)
    assert {row.status for row in found} == {"converged"}
    case, values = instance.load(bounded), study.design.rows(0, 4).tolist()
    held = [row.numbers["origin"] == "answer without bounds" for row in found]
    assert held == [r < 1.04 and upper < 0.07 for r, upper in values]
    assert [row.numbers["switching_times"] > 0 for row in found] == held
    assert not any(row.numbers["origin"] == "single solver" for row in found)
    for row, (r, upper) in zip(found, values, strict=True):
        own = replace(case, initial=(r, *case.initial[1:]), upper=(case.upper[0], upper))
        assert row.numbers["objective"] == pytest.approx(solvers.solve(own, examined=False).objective, rel=1e-8)
    with pytest.raises(BadInput, match="exceeds the upper bound"):
        asking(written, written.instance(), {"vary": {"control.u2.lower": "0:9:2"}}, bounded)


@pytest.mark.slow
def test_workers_change_no_byte(tmp_path: Path) -> None:
    study = asked(**SAMPLE | {"certificate": "local"})
    for name, count in (("one", 1), ("two", 2)):
        reports.carry_out(study, tmp_path / name, lambda count=count: Workers(count), count)
    for name in ("table.csv", "result.json", "study.json"):
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes(), name


def test_ends_that_no_control_reaches_are_known_from_the_planes_of_others(monkeypatch: pytest.MonkeyPatch) -> None:
    """At rest from q to 0 with u from -1 to U takes at least the root of 2 q (1 + 1/U)."""
    case, rng = instance.load("double-integrator-energy"), np.random.default_rng(5)
    assert case.tf is not None
    cases, least = [], []
    for off in (-1e-2, -1e-4, 1e-4, 1e-2, 0.3):
        for upper in rng.uniform(0.5, 2.0, 4).tolist():
            least.append(case.tf * (1.0 + off))
            cases.append(replace(case, initial=(least[-1] ** 2 / (2.0 + 2.0 / upper), 0.0), upper=(upper,)))
    problems, looked = Many.of(case, cases, False), []
    monkeypatch.setattr(batch, "separating", lambda one: looked.append(one) or separating(one))
    found = batch.unreachable(problems, cases, np.arange(len(cases)))
    assert sorted(found) == [k for k, time in enumerate(least) if time > case.tf]
    assert len(looked) < len(cases)
    assert all("separate this final state from the reachable set" in message for message in found.values())


def test_rows_beyond_reach_are_not_solved_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    def alone(*_: object) -> NoReturn:
        raise AssertionError

    monkeypatch.setattr(solving, "alone", alone)
    written = instance.read("double-integrator-energy")
    study = asking(written, written.instance(), {"vary": {"initial.q": "2.5:6.0:4", "control.u1.upper": "0.5:2.0:4"}})
    found = computed(study)
    assert {row.status for row in found} == {"infeasible"}
    assert all(row.message.endswith("allow more time, or widen the bounds of the control") for row in found)


def test_what_wider_bounds_do_not_reach_narrower_ones_do_not() -> None:
    """Between the same ends only, and where no answer within narrower bounds shows the contrary."""
    tried: list[tuple[float, float]] = []

    def single(key: str, one: Instance) -> Row:
        tried.append((one.initial[0], one.upper[0]))
        reached = one.initial[0] < 1.2 or one.upper[0] > 0.35
        return Row(key, "converged", "") if reached else Row(key, "infeasible", "none arrives")

    def solve(_: Task, instances: list[Instance]) -> Found:
        minimum = np.array([one.initial[0] > 1.35 and one.upper[0] < 0.15 for one in instances])
        none, states = np.zeros(len(minimum)), np.zeros((4, len(minimum)))
        return Found(minimum, "shooting", [""] * len(minimum), none, none, states, states, none)

    task = asked(vary={"initial.r": "1.1:1.3:2"}, certificate="local").task
    bounds = (0.1, 0.3, 0.2, 0.4)
    cases = [
        (f"{r} {upper}", replace(task.instance, initial=(r, 0.0, 0.0, 1.0), lower=(-upper, -0.1), upper=(upper, 0.1)))
        for r in (1.1, 1.3, 1.4)
        for upper in bounds
    ]
    found = {row.key: row for row in rows_together(task, solve, single, cases)}
    assert list(found) == [key for key, _ in cases]
    assert [found[f"1.1 {upper}"].status for upper in bounds] == ["converged"] * 4
    assert [found[f"1.3 {upper}"].status for upper in bounds] == ["infeasible"] * 3 + ["converged"]
    assert found["1.3 0.3"].message == "none arrives"
    for upper in (0.1, 0.2):
        assert found[f"1.3 {upper}"].message.startswith(
            "the final state is not reached even with wider bounds: none arrives"
        )
    assert {upper for r, upper in tried if r == 1.3} == {0.3, 0.4}
    assert {upper for r, upper in tried if r == 1.4} == {0.2, 0.3, 0.4}
