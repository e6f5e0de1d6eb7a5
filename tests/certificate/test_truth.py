"""What satsym says of random instances is true, by stored independent answers; and the bench behind them can tell."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.bench.truth import classes, closed, duality, judge, multistart, ours, programs, record, sample, table
from tests.bench.truth.answer import Answer, Truth
from tests.bench.truth.case import OWN, Case
from tests.bench.truth.judge import Outcome, Wrong

PARTS = 45
LEAST = Answer(Truth.MINIMUM, 1.0, "by hand")
ANSWER = {"status": "converged", "cost": 1.0, "verdict": "certified", "kinds": ["seeded starts 4/4"]}
ANSWER |= {"missed": 0.0, "off cost": 0.0, "out": 0.0}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where instances lie beside the bench's own models, as far as these are derived."""
    home = tmp_path_factory.mktemp("truth")
    (home / "models").mkdir()
    return home


def derived(folder: Path, name: str) -> None:
    """Derive one of the bench's own models, if it is one."""
    from satsym.codegen import module
    from satsym.symbolic.loader import load
    from tests.support import derived as shared

    target = folder / "models" / f"{name}.py"
    if not name.startswith(OWN) or target.exists():
        return
    found = next(p for path in (record.HERE / "models").glob("*.py") for p in load(path) if p.name == name)
    target.write_text(module.render(shared.derived(found), "a test"), encoding="utf-8")


def answered(case: Case, folder: Path) -> dict[str, Any]:
    """satsym's answer to a case."""
    derived(folder, case.model)
    return ours.answer(case, ours.written(case, folder))


@pytest.mark.slow
@pytest.mark.parametrize("part", range(PARTS))
def test_no_word_about_the_stored_instances_is_wrong_and_each_has_an_answer(folder: Path, part: int):
    for case, truth in sample.read()[part::PARTS]:
        found = judge.judged(truth, answered(case, folder))
        assert found.wrong is None, case.key
        assert found.outcome in (Outcome.AGREED, Outcome.OURS), case.key


def test_the_sample_is_of_many_classes_and_says_how_each_answer_was_obtained():
    rows = sample.read()
    assert len(rows) == len({case.key for case, _ in rows}) == sample.SIZE
    assert len({case.family for case, _ in rows}) >= 30
    assert all(truth.how and truth.truth is not Truth.UNKNOWN for _, truth in rows)


@pytest.mark.parametrize(
    ("truth", "changes", "wrong"),
    [
        (LEAST, {"cost": 1.0 + 2e-5}, Wrong.CERTIFIED),
        (replace(LEAST, truth=Truth.REACHED), {"cost": 2.0}, Wrong.CERTIFIED),
        (replace(LEAST, truth=Truth.UNBOUNDED, cost=None), {}, Wrong.CERTIFIED),
        (LEAST, {"cost": 2.0, "kinds": ["neighbours 4/4"]}, Wrong.UNCOMPARED),
        (LEAST, {"cost": 1.0 - 2e-5}, Wrong.BELOW),
        (LEAST, {"missed": 0.01}, Wrong.VIOLATED),
        (LEAST, {"out": 0.01}, Wrong.VIOLATED),
        (LEAST, {"off cost": 0.1}, Wrong.VIOLATED),
        (LEAST, {"missed": math.nan}, Wrong.VIOLATED),
        (replace(LEAST, truth=Truth.INFEASIBLE, cost=None), {}, Wrong.ARRIVED),
        (LEAST, {"status": "infeasible"}, Wrong.INFEASIBLE),
        (replace(LEAST, truth=Truth.UNBOUNDED, cost=None), {"status": "infeasible"}, Wrong.INFEASIBLE),
        (LEAST, {"status": "no minimiser"}, Wrong.NO_MINIMISER),
        (replace(LEAST, truth=Truth.INFEASIBLE, cost=None), {"status": "no minimiser"}, Wrong.NO_MINIMISER),
    ],
)
def test_every_kind_of_wrong_word_is_seen(truth: Answer, changes: dict[str, Any], wrong: Wrong):
    assert judge.judged(truth, ANSWER | changes).wrong is wrong


@pytest.mark.parametrize(
    ("truth", "changes", "outcome"),
    [
        (LEAST, {"cost": 1.0 + 5e-6}, Outcome.AGREED),
        (LEAST, {"cost": 2.0, "verdict": "extremal only"}, Outcome.THEIRS),
        (replace(LEAST, truth=Truth.REACHED), {"cost": 0.5}, Outcome.OURS),
        (replace(LEAST, cost=0.0), {"cost": 1e-15}, Outcome.AGREED),
        (replace(LEAST, truth=Truth.INFEASIBLE), {"status": "infeasible"}, Outcome.AGREED),
        (replace(LEAST, truth=Truth.UNBOUNDED), {"status": "no minimiser"}, Outcome.AGREED),
        (replace(LEAST, truth=Truth.UNKNOWN), {"status": "infeasible"}, Outcome.UNJUDGED),
        (LEAST, {"status": "not converged"}, Outcome.NONE),
    ],
)
def test_true_words_are_none_of_the_wrong_ones(truth: Answer, changes: dict[str, Any], outcome: Outcome):
    found = judge.judged(truth, ANSWER | changes)
    assert (found.wrong, found.outcome) == (None, outcome)


def test_every_class_draws_the_same_instance_again_and_another_for_another_number():
    for family in classes.CLASSES:
        first, again, other = (classes.drawn(family, number).text(True) for number in (3, 3, 4))
        assert first == again != other, family


def test_classes_take_turns_in_proportion_to_their_sizes():
    families = list(classes.CLASSES)
    order = list(classes.in_turn(families))
    assert len(order) == len(set(order)) == sum(one.size for one in classes.CLASSES.values()) >= 1000
    half = order[: len(order) // 2]
    for family, one in classes.CLASSES.items():
        assert abs(sum(name == family for name, _ in half) - one.size / 2) <= 1.5


def test_least_times_by_algebra_and_by_linear_programs_agree():
    case = classes.drawn("line, time", 1)
    assert programs.minimum_time(case).cost == pytest.approx(closed.line_time(case).cost, rel=3e-6)


def test_least_fuel_by_algebra_and_by_linear_programs_agree():
    for number in range(4):
        case = classes.drawn("line, fuel, free time", number)
        algebra = closed.line_fuel_free(case)
        program = programs.least_fuel(replace(case, tf=algebra.duration))
        assert algebra.cost is not None
        assert algebra.duration is not None
        time = case.parameters["weight_time"] * algebra.duration
        assert program.cost == pytest.approx(algebra.cost - time, rel=3e-6)


def test_least_energy_by_the_dual_problem_agrees_with_arcs_at_the_bound():
    # From rest at 1 to rest at 0 in 2.25 with |u| <= 1: u = -1 + ..., a straight line cut at both bounds.
    case = Case("", 0, "double_integrator_energy", {"q": 1.0, "q_dot": 0.0}, {"q": 0.0, "q_dot": 0.0}, 2.25)
    bounded = replace(case, bounds={"u1": (-1.0, 1.0)})
    assert duality.least_energy(case).cost == pytest.approx(6.0 / 2.25**3, rel=1e-6)
    # Full thrust for a at either end, straight between: half the way is T^2/8 - (T/2 - a)^2/6 = 1/2.
    half = 2.25 / 2.0
    middle = math.sqrt(3.0 * (half**2 - 1.0))
    assert duality.least_energy(bounded).cost == pytest.approx(half - middle + middle / 3.0, rel=1e-6)


@pytest.mark.parametrize(("fraction", "truth"), [(0.995, Truth.INFEASIBLE), (1.005, Truth.MINIMUM)])
def test_bounds_that_forbid_to_arrive_by_a_hair_are_told_from_those_that_allow_it(fraction: float, truth: Truth):
    # The least time is 2, so that in that time a thrust of 1 is just enough.
    case = Case("", 0, "double_integrator_energy", {"q": 1.0, "q_dot": 0.0}, {"q": 0.0, "q_dot": 0.0}, 2.0)
    case = replace(case, bounds={"u1": (-fraction, fraction)})
    assert duality.least_energy(case).truth is truth
    fuel = programs.least_fuel(replace(case, model="double_integrator_fuel"))
    assert (fuel.truth is Truth.INFEASIBLE) == (truth is Truth.INFEASIBLE)


def test_one_way_thrust_that_cannot_brake_is_infeasible_by_algebra():
    case = Case("", 0, "double_integrator_time", {"q": 1.0, "q_dot": 1.0}, {"q": 0.0, "q_dot": 0.0})
    assert closed.line_time(replace(case, bounds={"u1": (0.0, 1.0)})).truth is Truth.INFEASIBLE
    assert closed.line_time(replace(case, bounds={"u1": (-1.0, 1.0)})).cost == pytest.approx(1 + math.sqrt(6.0))


def test_a_minimum_ends_at_the_conjugate_time():
    case = Case("", 0, "conjugate_1", {"x1": 0.0}, {"x1": 1.0}, 3.1)
    assert closed.conjugate(case).cost == pytest.approx(0.5 / math.tan(3.1))
    assert closed.conjugate(replace(case, tf=3.2)).truth is Truth.UNBOUNDED
    assert closed.conjugate(replace(case, final={}, tf=1.6)).truth is Truth.UNBOUNDED


def test_negative_weights_leave_a_minimum_while_the_gramian_outweighs_them():
    # With the end weighed by k < 0 there is one for 1 + k T^3/3 > 0, the rate being free and unweighed.
    case = Case("", 0, "end_weighed", {"x1": 1.0, "x2": 0.0}, {}, 1.0, parameters={"k1": -2.9})
    assert closed.weighed(case).cost == pytest.approx(-2.9 / 2.0 / (1.0 - 2.9 / 3.0))
    assert closed.weighed(replace(case, parameters={"k1": -3.1})).truth is Truth.UNBOUNDED


def test_answers_outlive_changes_of_the_other_side_and_broken_lines(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(record, "FOLDER", tmp_path)
    kept = record.Record("truth")
    kept.add("a:0", "text", "one", LEAST.row())
    with kept.path.open("a") as file:
        file.write(json.dumps({"key": "a:1", "case": "", "revision": "one"})[:-9])
    again = record.Record("truth")
    assert list(again.rows) == ["a:0"]
    assert again.get("a:0", "another text", "one") is None
    assert again.get("a:0", "text", "another") is None
    row = again.get("a:0", "text", "one")
    assert row is not None
    assert Answer.of(row) == LEAST


def test_satsyms_revision_is_no_part_of_the_independent_one(monkeypatch: pytest.MonkeyPatch):
    before = record.of_truth(multistart.best)
    monkeypatch.setattr(record, "SATSYM", ())
    record._of_modules.cache_clear()
    assert record.of_truth(multistart.best) == before != record.of_truth(closed.ellipse)


def test_the_table_counts_and_cuts_names_to_the_columns(monkeypatch: pytest.MonkeyPatch):
    good, bad = (judge.judged(LEAST, ANSWER | {"cost": cost}) for cost in (1.0, 1.1))
    entries = [table.Entry("a class with a long name", k, LEAST, ANSWER, j) for k, j in enumerate((good, bad))]
    monkeypatch.setenv("COLUMNS", "112")
    lines_of_it = table.text(entries).splitlines()
    assert max(map(len, lines_of_it[:3])) <= 112
    assert lines_of_it[1].split()[-10:-3] == ["2", "1", "0", "1", "0", "0", "1"]
    assert "wrong: 1 (goal: none)" in table.text(entries)
    assert table.wrong(entries).startswith("a class with a long name 1: certified, though there is a cheaper control")


def test_a_control_that_does_not_arrive_is_seen_by_the_coarse_simulation():
    class Solution:
        times, objective = np.linspace(0.0, 2.0, 201), 2.0
        u = np.where(times < 1.0, -1.0, 1.0)[None, :]
        x = np.zeros((2, 201))

    case = Case("", 0, "double_integrator_time", {"q": 1.0, "q_dot": 0.0}, {"q": 0.0, "q_dot": 0.0})
    case = replace(case, bounds={"u1": (-1.0, 1.0)})
    found = ours.violations(case, Solution)
    assert found["missed"] < 0.02
    assert found["off cost"] < 1e-9
    assert ours.violations(replace(case, final={"q": 0.2, "q_dot": 0.0}), Solution)["missed"] == pytest.approx(
        0.2, abs=0.02
    )
    assert ours.violations(replace(case, bounds={"u1": (-0.5, 1.0)}), Solution)["out"] == pytest.approx(0.5)
