"""Competitors drawn as extremals: pushes and swings beside which other starts find nothing that costs less."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from sympy import Expr, Integer, Rational, sin

from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers import solve
from satsym.solvers.certificate.seeded.drawn_extremals import far_from_linear, may_swing
from satsym.solvers.collocation.scaling import two_point
from satsym.solvers.drawn_beside import Known, beside
from satsym.solvers.spare_time import longest
from satsym.status import Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from tests.support.models import build

STATES, CONTROLS = (Variable("a", "a"), Variable("b", "b")), (Variable("w", "w"),)
(a, b), (w,) = symbols_of(STATES), symbols_of(CONTROLS)


@cache
def _moved(name: str, force: Expr, time: Expr = Integer(0)) -> Problem:
    model = FirstOrder(
        name=f"{name}_motion",
        title="A mass",
        states=STATES,
        controls=CONTROLS,
        parameters=(),
        rates={a: b, b: force + w},
    )
    return Problem(name=name, title="Least effort", model=model, running_cost=w**2 / 2 + time, control_set="box")


WELLS = _moved("two_wells", a - a**3 - b / 20)
LINEAR = _moved("one_spring", -a)
PENDULUM = _moved("one_pendulum", -sin(a))
STIFF = _moved("stiff_spring", -a - Rational("1.44") * a**3 - Rational("0.0951") * b, Rational("0.0127"))


def _case(
    folder: Path, problem: Problem, start: str, end: str, duration: float | None, bound: float = 100.0
) -> Instance:
    (x, v), (y, u) = start.split(), end.split()
    lasting = '"free"' if duration is None else duration
    ends = f"[initial]\na = {x}\nb = {v}\n[final]\na = {y}\nb = {u}\n[time]\ntf = {lasting}\n"
    return build(folder, problem, f"{ends}[control]\nw = [-{bound}, {bound}]\n")


def _certified(case: Instance) -> Solution:
    found = solve(case)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED
    return found


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "end", "duration", "bound", "cost"),
    # Gauss collocation with CasADi and Ipopt from the answer, 400 intervals; the first extremals that are found, strict
    # minima to which all starts lead, cost 0.19140 and 0.03844
    [("-1 0", "1 0", 16.0, 0.2, 0.1476230919), ("-0.862 -0.836", "-1.19 -0.205", 9.63, 100.0, 0.0362634299)],
)
def test_what_all_starts_lead_to_is_not_certified_beside_a_cheaper_swing(
    tmp_path: Path, start: str, end: str, duration: float, bound: float, cost: float
) -> None:
    found = _certified(_case(tmp_path, WELLS, start, end, duration, bound))
    assert found.objective == pytest.approx(cost, rel=2e-7)


@pytest.mark.slow
def test_a_push_at_once_is_not_certified_where_swinging_once_costs_less(tmp_path: Path) -> None:
    """The push takes 0.14 and costs 0.6775; Ipopt from 30 drawn starts: 0.09204528304, in 3.5497."""
    found = _certified(_case(tmp_path, STIFF, "-1.49 -0.514", "-1.49 0.268", None))
    assert found.objective == pytest.approx(0.09204528304, rel=1e-9)
    assert float(found.times[-1]) == pytest.approx(3.5496715912, rel=1e-6)


@pytest.mark.slow
def test_motions_drawn_beside_a_push_last_longer_and_would_cost_less(tmp_path: Path) -> None:
    push = solve(_case(tmp_path, STIFF, "-1.49 -0.514", "-1.49 0.268", 0.14), examined=False)
    problem = two_point(push.instance, 0.14)
    n, z = 2, np.concatenate([push.x, push.lam]) / problem.scale.both
    known = Known(z[:n], z[n:], push.objective / problem.scale.cost, longest=10.0, free=True)
    drawn = beside(problem, known, np.random.default_rng(0))
    assert drawn
    assert all(one.duration > 1.0 for one in drawn)
    for one in drawn:
        assert one.states[:, 0] == pytest.approx(problem.initial)
        assert one.states[:, -1] * problem.scale.state == pytest.approx([-1.49, 0.268], abs=1e-9)
    assert not beside(problem, replace(known, cost=known.cost * 1e-4), np.random.default_rng(0))


def test_a_motion_is_far_from_linear_where_its_rates_change_along_the_way(tmp_path: Path) -> None:
    spring = solve(_case(tmp_path, LINEAR, "0 0", "1 0", 5.0), examined=False)
    assert not far_from_linear(spring)
    nearly = solve(_case(tmp_path, PENDULUM, "0.1 0", "0 0", 5.0), examined=False)
    assert not far_from_linear(nearly)
    lifted = solve(_case(tmp_path, PENDULUM, "0 0", "3.14 0", 5.0), examined=False)
    assert far_from_linear(lifted)
    assert longest(lifted) == pytest.approx(5.0)
    assert not may_swing(lifted)  # its duration is given


def test_time_that_can_be_paid_for_leaves_room_for_swings(tmp_path: Path) -> None:
    push = solve(_case(tmp_path, STIFF, "-1.49 -0.514", "-1.49 0.268", 0.14), examined=False)
    paid = push.objective / 0.0127
    free = replace(push, instance=replace(push.instance, tf=None))
    assert 3.55 < longest(free) <= paid
    assert may_swing(free)
    dear = replace(free, objective=0.0127 * 0.3)
    assert longest(dear) == pytest.approx(0.3)
    assert not may_swing(dear)
