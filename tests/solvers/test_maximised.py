"""An objective that is maximised is stated in its author's sense and unit wherever it is reported.

For x' = u with J = x(1) + int x - u^2/2 from x(0) = 0 the control is 2 - t and the largest J is 7/6.
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest
from sympy import Integer

import satsym
from satsym.front.solution import Solution
from satsym.report.latex.document import render
from satsym.symbolic import FirstOrder, Problem, Variable, derive, symbols_of
from satsym.symbolic.derivation import DerivationError

STATES = (Variable("x", "x", "m"),)
CONTROLS = (Variable("u", "u", "m/s"),)
PARAMETERS = (Variable("k", "k", "s", default=1.0), Variable("c", "c", "m/s", default=1.0, positive=True))
(x,), (u,), (k, c) = (symbols_of(group) for group in (STATES, CONTROLS, PARAMETERS))

GAIN = Problem(
    name="largest_gain",
    title="The largest gain",
    model=FirstOrder(
        name="integrator", title="x' = u", states=STATES, controls=CONTROLS, parameters=PARAMETERS, rates={x: u}
    ),
    running_cost=x / k - u**2 / (2 * c),
    terminal_cost=x,
    maximise=True,
    unit="m",
)
LARGEST = 7.0 / 6.0


@pytest.fixture(scope="module")
def found() -> Solution:
    return satsym.solve(satsym.Instance.of(GAIN, initial={"x": 0.0}, tf=1.0))


def test_the_largest_objective_is_reported_and_the_costates_are_those_of_its_negative(found: Solution) -> None:
    said = found.to_dict()
    assert said["objective"] == pytest.approx(LARGEST, rel=1e-10)
    assert said["costate_initial"]["x"] == pytest.approx(-2.0, rel=1e-9)
    assert said["certificate"]["verdict"] == "certified"
    assert (said["units"]["objective"], said["units"]["lambda_x"]) == ("m", "1")
    assert found.objective == said["objective"]
    text = repr(found)
    assert re.search(r"objective J, maximised +1\.166666667 m \(costs and costates are those of -J\)", text)
    assert "cost J" not in text


def test_competitors_are_reported_in_the_same_sense(found: Solution) -> None:
    for one in found.to_dict()["certificate"]["competitors"]:
        assert one["cheapest"] is None or one["cheapest"] <= LARGEST * (1 + 1e-8)
    assert "cheapest costs" not in repr(found)


def test_what_is_saved_and_read_again_is_the_same(found: Solution, tmp_path: Path) -> None:
    found.save(tmp_path)
    again = Solution.load(tmp_path)
    file = again.to_dict()["instance_file"]
    assert file["name"] == "largest_gain.toml"
    assert again.to_dict() == found.to_dict() | {"instance_file": file}
    assert again.found.objective == found.found.objective
    assert again.found.history == found.found.history


@pytest.mark.parametrize("convention", ["minimum", "maximum"])
@pytest.mark.parametrize("language", ["en", "id"])
def test_the_typeset_problem_asks_for_the_largest_objective(convention: str, language: str) -> None:
    text = render(derive(replace(GAIN, convention=convention)), language=language)  # type: ignore[arg-type]
    assert ("maximises the objective" if language == "en" else "memaksimumkan") in text
    assert r"-S\bigl(\mathbf{x}(t_f), t_f\bigr) - \int_{t_0}^{t_f} L \,dt" in text
    assert ("derivatives of the maximum of $J$" in text) == (convention == "maximum" and language == "en")


def test_the_same_problem_as_a_cost_has_the_opposite_objective(found: Solution) -> None:
    cost = replace(GAIN, maximise=False, running_cost=-GAIN.running_cost, terminal_cost=-x, unit="")
    smallest = satsym.solve(satsym.Instance.of(cost, initial={"x": 0.0}, tf=1.0))
    assert smallest.objective == -found.objective
    assert "cost J" in repr(smallest)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"maximise": "yes"}, r'^largest_gain: maximise: got "yes"; write True or False$'),
        ({"unit": "km/s"}, r"^largest_gain: unit: the objective has the dimension .*length.*, not .*time"),
        ({"unit": "furlongs!"}, r'^largest_gain: unit: the unit "furlongs!" cannot be read'),
        (
            {"running_cost": Integer(0), "terminal_cost": Integer(0)},
            r"^largest_gain: no objective; give a running_cost \(1 for minimum time\) or a terminal_cost$",
        ),
    ],
)
def test_what_makes_no_sense_is_refused(changes: dict[str, object], message: str) -> None:
    with pytest.raises(DerivationError, match=message):
        derive(replace(GAIN, **changes))  # type: ignore[arg-type]


def test_pictures_show_the_objective_and_its_unit(found: Solution) -> None:
    from satsym.report.plots.pages import _facts
    from satsym.report.plots.scene import Scene

    facts = _facts(Scene.of(found.found))
    assert any(re.fullmatch(r"\$J\$ = 1\.166667 .*m.*", fact) for fact in facts), facts
