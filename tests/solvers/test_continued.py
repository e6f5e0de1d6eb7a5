"""Continuation: every answer is the guess of the next, past folds, and where it ends is said."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_bvp
from sympy import Expr

import satsym
from satsym.cli import main
from satsym.front.solution import Solution
from satsym.status import BadInput
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

X, U = Variable("x", "x"), Variable("u", "u")
A, C = Variable("a", "a", default=1.0), Variable("c", "c", default=1.0, positive=True)
(x,), (u,), (a, c) = symbols_of((X,)), symbols_of((U,)), symbols_of((A, C))


def problem(name: str, rate: Expr, cost: Expr, end: Expr) -> Problem:
    model = FirstOrder(
        name=f"{name}_motion", title=name, states=(X,), controls=(U,), parameters=(A, C), rates={x: rate}
    )
    return Problem(name=name, title=name, model=model, running_cost=cost, terminal_cost=end)


SOFT = problem("soft", u, (x**2 + c * u**2) / 2, a * 0)
WELLS = problem("two_wells", u, u**2 / 2 + x**4 / 2 - x**2, -a * x)


def solved(of: Problem, way: dict[str, Any], **given: Any) -> Solution:
    return satsym.solve(satsym.Instance.of(of, **given, continuation=way))


@pytest.mark.slow
def test_a_long_way_is_gone_by_shares_of_its_logarithm() -> None:
    found = solved(SOFT, {"c": [1.0, 1e-6]}, initial={"x": 1.0}, tf=1.0)
    said = found.to_dict()
    values = [one["c"] for one in said["continuation"]]
    assert values[0] == 1.0
    assert sum(value < 1e-3 for value in values) > 2
    assert values == sorted(values, reverse=True)
    for one in said["continuation"]:  # x' = u, int x^2 + c u^2 from 1: sqrt(c) tanh(T / sqrt(c)) / 2
        assert one["objective"] == pytest.approx(one["c"] ** 0.5 * math.tanh(one["c"] ** -0.5) / 2, rel=1e-9)
    assert said["certificate"]["verdict"] == "certified"
    assert said["objective"] == pytest.approx(5e-4, rel=1e-9)


@pytest.mark.slow
def test_folds_are_passed() -> None:
    given = {"initial": {"x": -0.1}, "tf": 3.0, "solver": {"steps": 100}}
    found = solved(WELLS, {"a": [-1.0, 1.0]}, **given)
    assert "past 2 folds" in found.message
    assert found.certificate is not None
    assert found.certificate.verdict == "certified"
    assert found.x[0, -1] > 0.5 > -0.5 > found.found.intermediate[0].x[0, -1]
    times = np.linspace(0.0, 3.0, 40)
    other = solve_bvp(
        lambda t, z: np.array([-z[1], -(2 * z[0] ** 3 - 2 * z[0])]),
        lambda start, end: np.array([start[0] + 0.1, end[1] + 1.0]),
        times,
        np.array([1.3 * times / 3.0, -np.ones_like(times)]),
        tol=1e-10,
        max_nodes=20000,
    )
    assert other.success
    assert found.x[0, -1] == pytest.approx(other.y[0, -1], rel=1e-8)


def test_times_and_ends_change_as_well() -> None:
    given = {"initial": {"x": 1.0}, "final": {"x": 0.0}, "tf": 9.0}
    found = solved(SOFT, {"tf": [1.0, 4.0], "final.x": [0.0, 2.0], "initial.x": [1.0, -1.0]}, **given)
    assert found.status.value == "converged"
    assert [found.times[-1], found.x[0, 0], found.x[0, -1]] == pytest.approx([4.0, -1.0, 2.0], rel=1e-9)
    assert found.to_dict()["continuation"][0]["final.x"] == 0.0
    assert (found.instance.case.tf, found.instance.case.initial, found.instance.case.final) == (
        4.0,
        (-1.0,),
        {"x": 2.0},
    )


@pytest.mark.slow
def test_where_the_way_ends_is_said_with_the_reason() -> None:
    case = satsym.load("double-integrator-energy").with_(continuation={"tf": [3.0, 1.5]})
    found = satsym.solve(case)
    assert found.status.value == "infeasible"
    assert "continuation stops at tf = 2.0" in found.message
    assert math.isnan(found.objective)
    assert len(found.found.intermediate) > 1


def test_every_answer_is_kept(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["solve", "soft-return", "--continue", "c1=1:1e-2", "--out", str(tmp_path), "--json"]
    assert main(arguments) == 0
    count = len(json.loads(capsys.readouterr().out)["continuation"])
    assert count > 1
    assert sorted(path.name for path in tmp_path.glob("step-*.csv")) == [f"step-{k:03d}.csv" for k in range(count)]
    first = (tmp_path / "step-000.csv").read_text().splitlines()
    assert first[0].startswith("t [s],r [km],r_dot [km/s]")
    assert len(first) > 100


@pytest.mark.parametrize(
    ("way", "message"),
    [
        ({"b": [1, 2]}, r"\[continuation\] b: .*has no numerical quantity of this name"),
        ({"a": [1, 2], "parameters.a": [1, 3]}, r"\[continuation\] parameters.a: is given twice, as a and as param"),
        ({"a": [1, 1]}, r"\[continuation\] a: both values are 1"),
        ({"a": 1}, r"\[continuation\] a: got 1; give the first and the last value"),
        ({"tf": [1, -1]}, r"\[continuation\]: tf = -1 is not after t0 = 0"),
        ({"final.x": [1, 2]}, r"\[continuation\] final.x: the instance gives no numerical value for this key"),
    ],
)
def test_a_way_that_makes_no_sense_is_refused(way: dict[str, Any], message: str) -> None:
    with pytest.raises(BadInput, match=message):
        satsym.Instance.of(SOFT, initial={"x": 1.0}, tf=1.0, continuation=way)


@pytest.mark.parametrize("name", ["a", "parameters.a"])
def test_a_parameter_is_named_with_its_table_or_without(name: str) -> None:
    (way,) = satsym.Instance.of(SOFT, initial={"x": 1.0}, tf=1.0, continuation={name: [1, 2]}).case.continuation
    assert way.key.text == "parameters.a"


@pytest.mark.parametrize("way", ["c1", "c1=1", "c1=1:2:3", "=1:2"])
def test_the_command_line_says_how_a_way_is_written(way: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["solve", "soft-return", "--continue", way]) == 2
    assert "KEY=FROM:TO" in capsys.readouterr().err
