"""Searches for competitors end where they come near the answer, and only there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from sympy import exp

from satsym import instance
from satsym.arrays import Array
from satsym.instance import Guess, Instance
from satsym.solution import Solution
from satsym.solvers import solve
from satsym.solvers.certificate.comparison import Competitor
from satsym.solvers.certificate.seeded.answer import Answer, Near
from satsym.solvers.certificate.seeded.searches import at_its_duration, from_path
from satsym.solvers.cold_start.from_path import from_path as minimised
from satsym.solvers.collocation.curve import Curve
from satsym.solvers.iteration import Limits
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from tests.support.models import build

AXES, RATES = (Variable("x1", "x_1"), Variable("x2", "x_2")), (Variable("u1", "u_1"), Variable("u2", "u_2"))
x1, x2 = symbols_of(AXES)
u1, u2 = symbols_of(RATES)
hill = Problem(
    name="hill",
    title="A hill in the way",
    model=FirstOrder(name="rates", title="R", states=AXES, controls=RATES, parameters=(), rates={x1: u1, x2: u2}),
    running_cost=(u1**2 + u2**2) / 2 + 3 * exp(-8 * (x1**2 + x2**2)),
    control_set="box",
)
ENDS = "[initial]\nx1 = -1.0\nx2 = 0.0\n[final]\nx1 = 1.0\nx2 = 0.0\n[time]\ntf = 2.0\n"


@pytest.fixture
def beside(tmp_path: Path) -> Solution:
    """The hill is passed on one side."""
    guess = Guess(state={"x1": (-1.0, 0.0, 1.0), "x2": (0.0, 0.6, 0.0)})
    found = solve(replace(build(tmp_path, hill, ENDS), guess=guess), examined=False)
    assert found.x[1, found.x.shape[1] // 2] > 0.1
    return found


def surroundings(solution: Solution) -> Near:
    near = Answer(solution).near
    assert near is not None
    return near


def mirrored(near: Near) -> Curve:
    """The other side of the hill."""
    signs = np.array([1.0, -1.0, 1.0, -1.0])
    return replace(near.curve, nodes=near.curve.nodes * signs[:, None], stages=near.curve.stages * signs[:, None, None])


def shaken(curve: Curve, by: float) -> Curve:
    """The same with waves of so much of its size."""

    def waves(values: Array) -> Array:
        return values + by * np.abs(values).max() * np.cos(np.arange(values.size)).reshape(values.shape)

    return replace(curve, nodes=waves(curve.nodes), stages=waves(curve.stages))


def led(solution: Solution, path: Callable[[Array], Array], answer: Answer | None) -> Competitor:
    found = from_path(at_its_duration(solution), path, 1.0, solution.objective, answer=answer)(Limits(200, np.inf))
    assert found is not None
    return found


def around(height: float) -> Callable[[Array], Array]:
    return lambda tau: np.array([2.0 * tau - 1.0, height * np.sin(np.pi * tau)])


def test_what_lies_about_the_answer_leads_to_it_and_other_extremals_do_not(beside: Solution) -> None:
    near = surroundings(beside)
    residual = near.system.residual(mirrored(near))
    assert np.abs(residual.stages).max() < 1e-6  # an extremal as well
    assert near.leads(shaken(near.curve, 0.02))
    assert not near.leads(mirrored(near))
    assert not near.leads(shaken(mirrored(near), 0.02))
    straight = replace(near.curve, nodes=near.curve.nodes * np.array([1.0, 0.0, 1.0, 0.0])[:, None])
    assert not near.leads(straight)


def test_searches_on_either_side_find_their_own_side(beside: Solution) -> None:
    same, other = (led(beside, around(height), Answer(beside)) for height in (0.6, -0.6))
    assert same.curve is not None
    assert other.curve is not None
    assert same.curve.nodes[1].sum() > 0.0 > other.curve.nodes[1].sum()
    assert same.cost == pytest.approx(beside.objective, rel=1e-11)
    assert other.cost == pytest.approx(beside.objective, rel=1e-9)


def test_a_search_that_is_led_nowhere_is_what_it_is_without_an_answer(beside: Solution) -> None:
    problem = at_its_duration(beside)
    plain, asked = (minimised(problem, around(-0.6), Limits(200, np.inf), 15, one) for one in (None, lambda _: False))
    assert (plain.curve.nodes == asked.curve.nodes).all()
    assert plain.iterations == asked.iterations


def test_being_led_to_the_answer_costs_what_finding_it_again_does() -> None:
    solution = solve(instance.load("return-to-orbit"), examined=False)
    line = np.array([[1.1, 1.0], [0.0, 0.0], [0.0, 2.0 * np.pi], [0.9, 1.0]])
    scale = at_its_duration(solution).scale.state[:, None]

    def path(tau: Array) -> Array:
        bent = line[:, :1] + (line[:, 1:] - line[:, :1]) * tau + 0.1 * np.sin(np.pi * tau)
        return np.asarray(bent / scale)

    short, long = (led(solution, path, answer) for answer in (Answer(solution), None))
    assert short.cost == pytest.approx(solution.objective, rel=1e-11)
    assert long.cost == pytest.approx(solution.objective, rel=1e-10)
    costlier = replace(solution, objective=1.001 * solution.objective)
    assert led(costlier, path, Answer(costlier)).cost == pytest.approx(solution.objective, rel=1e-11)
    assert short.curve is not None
    begun = np.concatenate([solution.x[:, 0], solution.lam[:, 0]]) / at_its_duration(solution).scale.both[:, 0]
    assert short.curve.nodes[:, 0] == pytest.approx(begun, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("share", [0.8, 0.9999])
def test_an_answer_that_meets_its_bounds_leads_nowhere(beside: Solution, share: float) -> None:
    """Also where it hardly differs from an extremal without bounds."""
    most = share * float(np.abs(beside.u[1]).max())
    case: Instance = replace(beside.instance, lower=(-np.inf, -most), upper=(np.inf, most))
    within = solve(case, examined=False)
    assert within.status.answered
    assert Answer(beside).near is not None
    assert Answer(within).near is None
