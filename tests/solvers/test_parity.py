"""`make parity` tells what is better from what is worse, and its record has a line for every shipped instance."""

from __future__ import annotations

import json
import math
import time
import tomllib
from dataclasses import replace
from typing import Any

import pytest

from satsym import instance
from satsym.solvers import solve
from tests.bench import children, parity
from tests.bench.differences import Differences, differences
from tests.bench.unique import unique

OLD: dict[str, Any] = {
    "status": "converged",
    "verdict": "extremal only",
    "cost": 2.0,
    "duration": 4.0,
    "unique": True,
    "costates": {"x": 1.0, "v": 0.0},
    "sizes": [1.0, 0.5],
    "events": [["entry", "wall", 1.0], ["exit", "wall", 2.0]],
    "switches": {"u": [0.5]},
    "competitors": {"seeded starts": "3/4"},
    "not checked": [],
    "seconds": 1.0,
}
NOTHING = {"status": "not converged", "said": "too few steps", "seconds": 1.0}


def against(changes: dict[str, Any]) -> Differences:
    return differences(OLD, OLD | changes)


@pytest.mark.parametrize(
    "changes",
    [
        {"cost": 2.0 * (1.0 + 9e-10)},
        {"cost": 2.0 * (1.0 - 9e-10)},
        {"costates": {"x": 1.0 + 9e-8, "v": 4e-8}},
        {"costates": {"x": -1.0, "v": 3.0}, "unique": False},
        {"events": [["entry", "wall", 1.0 + 3e-7], ["exit", "wall", 2.0]]},
        {"switches": {"u": [0.5 - 3e-7]}},
        {"seconds": 100.0},
    ],
)
def test_digits_that_do_not_count_and_seconds_are_no_difference(changes: dict[str, Any]):
    found = against(changes)
    assert (found.better, found.worse) == ((), ())


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"cost": 2.0 * (1.0 + 2e-9)}, "cost"),
        ({"cost": 2.0 * (1.0 - 9e-7)}, "cost"),
        ({"cost": math.nan}, "cost"),
        ({"costates": {"x": 1.0, "v": 6e-8}}, "costate of v"),
        ({"costates": {"x": 1.0, "v": math.nan}}, "costate of v"),
        ({"events": [["entry", "wall", 1.0], ["exit", "wall", 2.0 + 5e-7]]}, "exit of wall"),
        ({"events": [["touch", "wall", 1.5]]}, "events"),
        ({"events": []}, "events"),
        ({"switches": {"u": [0.5 + 5e-7]}}, "switch of u"),
        ({"switches": {}}, "switches of u"),
        ({"switches": {"u": [0.5, 0.6]}}, "switches of u"),
        ({"verdict": "failed"}, "verdict"),
        ({"verdict": "none"}, "verdict"),
    ],
)
def test_every_difference_of_answers_is_named_and_for_the_worse(changes: dict[str, Any], word: str):
    found = against(changes)
    assert [line.startswith(word) for line in found.worse] == [True]
    assert not found.better


@pytest.mark.parametrize(
    ("changes", "worse"),
    [
        ({"verdict": "certified"}, 0),
        ({"verdict": "local minimum"}, 0),
        # Of a cheaper answer costates, events and switches are others.
        ({"cost": 2.0 * (1.0 - 2e-6), "costates": {"x": 3.0, "v": 1.0}, "events": [], "switches": {}}, 0),
        ({"cost": 1.0, "verdict": "failed"}, 1),
        ({"cost": 2.1, "verdict": "certified"}, 1),
    ],
)
def test_what_is_better_stands_apart_from_what_is_worse(changes: dict[str, Any], worse: int):
    found = against(changes)
    assert (len(found.better), len(found.worse)) == (1, worse)


def test_a_cost_of_zero_is_compared_in_the_size_of_its_terms():
    zero = OLD | {"cost": 1e-13, "terms": 5.0}
    assert not differences(zero, zero | {"cost": -4e-9}).worse
    assert differences(zero, zero | {"cost": 6e-9}).worse


def test_what_a_solution_was_compared_with_is_told_only():
    found = against({"competitors": {"seeded starts": "4/4"}, "not checked": ["neighbours"]})
    assert (found.better, found.worse, len(found.told)) == ((), (), 2)


@pytest.mark.parametrize(
    ("old", "new", "better", "worse"),
    [
        (NOTHING, OLD, 1, 0),
        (OLD, NOTHING, 0, 1),
        (NOTHING, NOTHING | {"said": "otherwise"}, 0, 0),
        (NOTHING, NOTHING | {"status": "infeasible"}, 0, 1),
        (NOTHING, NOTHING | {"status": "too long"}, 0, 1),
        (NOTHING | {"status": "too long"}, NOTHING, 1, 0),
        (NOTHING | {"status": "not derived"}, NOTHING, 1, 0),
        (NOTHING | {"status": "error"}, OLD, 1, 0),
    ],
)
def test_an_answer_where_there_was_none_is_better(old: dict[str, Any], new: dict[str, Any], better: int, worse: int):
    found = differences(old, new)
    assert (len(found.better), len(found.worse)) == (better, worse)


def test_the_record_names_every_case_and_each_known_optimum():
    known = parity.recorded()
    assert {case.name for case in parity.cases()} <= known.keys()
    assert list(known) == sorted(known)
    optima = tomllib.loads((parity.PATH.parent / "optima.toml").read_text(encoding="utf-8"))
    assert {name: known[name]["verdict"] for name in optima} == {n: entry["verdict"] for n, entry in optima.items()}


def test_a_record_is_read_as_it_was_written_a_line_each(tmp_path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(parity, "PATH", tmp_path / "parity.json")
    parity.write({"b": OLD, "a": NOTHING}, "a revision")
    assert parity.recorded() == {"a": NOTHING, "b": OLD}
    assert len(parity.PATH.read_text(encoding="utf-8").splitlines()) == 4


def test_lines_of_the_record_stay_where_nothing_differs_and_cases_that_are_gone_leave_it():
    old = {"same": OLD, "other": OLD, "gone": OLD, "not run": OLD, "cases/a/b": OLD}
    new = {"same": OLD | {"cost": 2.0 + 1e-12, "seconds": 1.1}, "other": OLD | {"seconds": 2.0}, "new": NOTHING}
    found = parity.renewed(old, new, frozenset({"same", "other", "not run", "new"}))
    assert found == {"same": OLD, "other": new["other"], "not run": OLD, "cases/a/b": OLD, "new": NOTHING}


def test_an_answer_comes_from_a_process_of_its_own_and_is_that_on_record(capsys: pytest.CaptureFixture[str]):
    case = next(case for case in parity.cases() if case.name == "double-integrator-time")
    old, new = parity.recorded(), dict(parity.answers([case]))
    assert not parity.report(old, new)
    assert "1 case: 1 certified\n0 worse, 0 better" in capsys.readouterr().out


@pytest.mark.parametrize(("start", "only_ones"), [((1.0, 0.0), True), ((0.5, -1.0), False)])
def test_costates_of_a_least_time_are_unique_if_there_is_a_switch(start: tuple[float, float], only_ones: bool):
    # From (1/2, -1) one arc, without a switch, leads to rest at 0: only the scale of the costates is fixed there.
    given = replace(instance.load("double-integrator-time"), initial=start)
    assert unique(solve(given)) is only_ones


@pytest.mark.parametrize("name", ["soft-return", "ends-4-rendezvous", "bryson-denham"])
def test_costates_of_regular_problems_are_unique(name: str):
    assert unique(solve(instance.load(name)))


def test_a_question_that_takes_too_long_is_given_up():
    began = time.process_time()
    with pytest.raises(children.TooLong):
        busy(began + 10.0)
    assert time.process_time() - began < 5.0


def busy(until: float) -> None:
    with children.limited(0.05):
        while time.process_time() < until:
            json.dumps([])
