"""What is derived of points on the way: jumps of costates and of H; and what is refused."""

from __future__ import annotations

from typing import Any

import pytest
import sympy as sp

from satsym.report.latex.document import render
from satsym.symbolic import Angle, Ball, FirstOrder, Problem, Variable, derive, symbols_of
from satsym.symbolic.derivation import DerivationError
from satsym.symbolic.model import t
from tests.support.derived import derived

STATES, CONTROLS = (Variable("x", "x"), Variable("v", "v")), (Variable("u", "u"),)
(x, v), (u,) = symbols_of(STATES), symbols_of(CONTROLS)
LINE = FirstOrder(name="line", title="a body", states=STATES, controls=CONTROLS, parameters=(), rates={x: v, v: u})


def through(*conditions: Any, **more: Any) -> Problem:
    stated = {"name": "passing", "title": "", "model": LINE, "running_cost": u**2 / 2}
    return Problem(**{"interior": {"mark": conditions}, **stated, **more})


@pytest.mark.parametrize(("convention", "sign"), [("minimum", 1), ("maximum", -1)])
def test_costates_and_h_jump_by_the_derivatives_of_the_conditions(convention: Any, sign: int):
    found = derived(through(x - sp.sin(t), v * x, convention=convention))
    jumps = {one.name: one.rhs for one in found.step("interior_conditions").equations}
    first, second = sp.symbols("pi_mark_1 pi_mark_2", real=True)
    assert sp.expand(jumps["mark_lambda_x"] - sign * (first + v * second)) == 0
    assert sp.expand(jumps["mark_lambda_v"] - sign * x * second) == 0
    assert sp.expand(jumps["mark_H"] - sign * first * sp.cos(t)) == 0


def test_bounds_beside_points_are_constraints_with_multipliers():
    found = derived(through(x - 1, control_set="box"))
    assert {"u_min_eta", "u_max_eta"} <= {one.name for one in found.step("mixed_constraints").equations}


@pytest.mark.parametrize("language", ["en", "id"])
def test_points_are_typeset(language: str):
    text = render(derived(through(x - 1, v - 2)), language)
    assert r"\lambda_{x}(t_1^-) - \lambda_{x}(t_1^+) &= \pi_{11}" in text
    assert "N_{12}" in text


@pytest.mark.parametrize(
    ("problem", "message"),
    [
        (through(x - 1, path_constraints={"wall": x - 2}), "together with path_constraints"),
        (through(x - 1, control_set="ball"), 'together with control_set "ball"'),
        (through(x - 1, control_sets={"all": Ball("u")}), "together with control_sets"),
        (through(x - 1, control_sets={"all": Angle("u")}), "together with control_sets"),
        (through(x - 1, running_cost=sp.Abs(u), control_set="box"), "where H is quadratic"),
        (through(x - 1, sp.Integer(2)), "mark requires 2 = 0, but this condition does not depend on the motion"),
        (through(x - u), "the interior point mark cannot depend on u"),
        (through(x - 1, v, x + v), "more conditions than there are states"),
        (through(), "give each point a name"),
        (through(x - 1, interior={"Mark": (x,)}), "the name of a point must be"),
        (through(x - 1, interior={"mark": x}), "give each point a name"),
    ],
)
def test_what_is_not_solved_or_not_sound_is_refused(problem: Problem, message: str):
    with pytest.raises(DerivationError, match=message):
        derive(problem)
