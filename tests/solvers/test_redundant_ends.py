"""Final states that follow from others, because a function of them is conserved whatever the controls do."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest
from sympy import Expr, Symbol

from satsym import instance
from satsym.solution import Solution
from satsym.solvers import solve
from satsym.solvers.redundant_ends import _dependent, redundant
from satsym.status import Status, Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from tests.support.models import build

STATES, CONTROLS = tuple(Variable(name, name) for name in ("x", "y")), (Variable("w", "w"),)
x, y = symbols_of(STATES)
(w,) = symbols_of(CONTROLS)


def solved(folder: Path, rates: dict[Symbol, Expr], start: tuple[float, float], end: tuple[float, float]) -> Solution:
    moving = FirstOrder(name="moving", title="M", states=STATES, controls=CONTROLS, parameters=(), rates=rates)
    problem = Problem(name="tied", title="T", model=moving, running_cost=w**2)
    text = f"[initial]\nx = {start[0]}\ny = {start[1]}\n[final]\nx = {end[0]}\ny = {end[1]}\n[time]\ntf = 2.0\n"
    return solve(build(folder, problem, text))


@pytest.mark.parametrize("end", [(0.0, 1.0), (0.0, -1.0), (math.sqrt(0.75), -0.5)])
def test_a_turn_ends_on_its_circle_whichever_way_it_is_asked(tmp_path: Path, end: tuple[float, float]) -> None:
    """The turn by an angle a in two units of time costs a^2 / 2."""
    found = solved(tmp_path, {x: -w * y, y: w * x}, (1.0, 0.0), end)
    assert found.status is Status.CONVERGED, found.message
    assert found.x[:, -1] == pytest.approx(end, abs=1e-9)
    assert found.objective == pytest.approx(math.atan2(end[1], end[0]) ** 2 / 2.0, rel=1e-9)
    assert "follows from the other final states" in found.message
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED


def test_an_end_that_the_conserved_quantity_does_not_allow_is_told(tmp_path: Path) -> None:
    found = solved(tmp_path, {x: w, y: -w}, (1.0, 0.0), (0.2, 0.7))
    assert found.status is Status.NOT_CONVERGED
    assert "ties the final" in found.message
    assert "0.3 instead of 0.2" in found.message
    assert not math.isfinite(found.objective)


def test_what_is_known_of_an_end_on_the_reference_is_known_for_other_starts() -> None:
    case = instance.load("return-to-orbit")
    assert redundant(case) is None
    known = _dependent.cache_info()
    assert redundant(replace(case, initial=(1.05, 0.0, 0.02, 0.95))) is None
    assert _dependent.cache_info().misses == known.misses
    assert redundant(replace(case, final={**case.final, "r_dot": 0.1})) is None  # another end is looked at
    assert _dependent.cache_info().misses == known.misses + 1


def test_a_reorientation_with_all_four_components_leaves_one_out() -> None:
    body = instance.load("reorientation")
    assert redundant(body) is None
    for sign in (1.0, -1.0):
        less = redundant(replace(body, final={**body.final, "q3": sign}))
        assert less is not None
        assert less.state == "q3"
        assert less.instance.final == body.final


@pytest.mark.parametrize("name", ["brachistochrone", "cart-pole", "transfer-fuel", "return-to-orbit", "linear-tangent"])
def test_nothing_is_left_out_where_controls_move_every_end(name: str) -> None:
    """Of the bead the energy is conserved, but its final speed is free."""
    assert redundant(instance.load(name)) is None
