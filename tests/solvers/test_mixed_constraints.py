"""Constraints that hold a control: structures are found from a cold start, optima are those of closed forms."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import satsym
from satsym.front.solution import Solution
from satsym.solvers.certificate import certify
from satsym.status import Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from satsym.symbolic.model import t

STATES, CONTROLS = (Variable("x", "x"), Variable("v", "v")), (Variable("u", "u"),)
PARAMETERS = (Variable("a", "a", default=1.0), Variable("c", "c", default=0.0))
(x, v), (u,), (a, c) = symbols_of(STATES), symbols_of(CONTROLS), symbols_of(PARAMETERS)


def kept(name: str, second: bool = False, cost: Any = u**2 / 2, **constraints: Any) -> Problem:
    """A body whose velocity, or whose acceleration, is the control."""
    rates = {x: v, v: u} if second else {x: u}
    model = FirstOrder(
        name=f"moved_by_{name}",
        title="a body",
        states=STATES if second else STATES[:1],
        controls=CONTROLS,
        parameters=PARAMETERS,
        rates=rates,
    )
    return Problem(name=name, title=name, model=model, running_cost=cost, path_constraints=constraints)


def certified(of: Problem, **given: Any) -> Solution:
    found = satsym.solve(satsym.Instance.of(of, **given))
    said = found.to_dict()
    assert said["status"] == "converged", said["message"]
    assert said["certificate"]["verdict"] == "certified", said["certificate"]["checks"]
    return found


def kinds(found: Solution) -> list[tuple[str, str]]:
    return [(one.kind, one.name) for one in found.events]


@pytest.mark.parametrize("begun", [0.0, 3.0])
def test_a_velocity_that_may_not_fall_below_a_bound_is_on_it_first(begun: float):
    """With x itself in the cost, u = -(T - t) until the end, or -a where that is less."""

    def velocity(time: float) -> float:
        return -min(0.5, 1.0 - time)

    optimum = quad(lambda s: velocity(s) ** 2 / 2 + (1.0 - s) * velocity(s), 0.0, 1.0, points=[0.5])[0]
    problem = kept("falling", cost=u**2 / 2 + x, floor=-a - u)
    found = certified(problem, parameters={"a": 0.5}, initial={"x": 0.0}, t0=begun, tf=begun + 1.0)
    assert found.objective == pytest.approx(optimum, rel=1e-10)
    assert [(one.kind, one.t) for one in found.events] == [
        ("entry", begun),
        ("exit", pytest.approx(begun + 0.5, abs=1e-9)),
    ]


@pytest.mark.parametrize(("floor", "optimum"), [(1 + x - u, (math.e**2 - 1) / 4), (1 - u, 0.5)])
def test_a_constraint_may_be_active_all_along(floor: Any, optimum: float):
    """Where there is no time at which it is left, that it is met at the start says it."""
    found = certified(kept("growing", floor=floor), initial={"x": 0.0}, tf=1.0)
    assert found.objective == pytest.approx(optimum, rel=1e-10)
    assert kinds(found) == [("entry", "floor")]


def test_a_bound_that_grows_with_time_is_left_where_it_exceeds_the_mean():
    """u = min(2 t, k), with which 0.9 is reached."""
    k = brentq(lambda k: k * k / 4 + k * (1 - k / 2) - 0.9, 0.0, 2.0)
    found = certified(kept("growing_bound", cap=u - 2 * t), initial={"x": 0.0}, final={"x": 0.9}, tf=1.0)
    assert found.objective == pytest.approx(k**3 / 12 + k * k / 2 * (1 - k / 2), rel=1e-10)
    assert found.events[-1].t == pytest.approx(k / 2, abs=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("bound", [1.51, 1.6])
def test_a_power_that_is_bounded_makes_the_body_slower_the_farther_it_is(bound: float):
    """x x' <= a, from 1 to 2 in unit time: x' = k until x = a / k, then x^2 grows by 2 a."""

    def late(k: float) -> float:
        return (bound / k - 1) / k + (4 - (bound / k) ** 2) / (2 * bound) - 1

    k = brentq(late, bound / 2, bound)
    optimum = k / 2 * (bound / k - 1) + bound / 2 * math.log(2 * k / bound)
    given = {"initial": {"x": 1.0}, "final": {"x": 2.0}, "tf": 1.0}
    found = certified(kept("driven", power=x * u - a), parameters={"a": bound}, **given)
    assert found.objective == pytest.approx(optimum, rel=1e-9)
    assert kinds(found) == [("entry", "power")]


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_accelerations_between_two_bounds_are_on_both(size: float):
    """u = a, then falls in a line to -a: a s^2 + a s (1 - 2 s) + 2 a (1/2 - s)^2 / 3 is the way."""
    bound, s = 4.2, brentq(lambda s: 4.2 * (s * s + s * (1 - 2 * s) + 2 * (0.5 - s) ** 2 / 3) - 1, 0.0, 0.5)
    found = certified(
        kept("pulled", second=True, up=u - a, low=-a - u),
        parameters={"a": bound * size},
        initial={"x": 0.0, "v": 0.0},
        final={"x": size, "v": 0.0},
        tf=1.0,
    )
    assert found.objective == pytest.approx(size**2 * bound**2 * (s + (0.5 - s) / 3), rel=1e-9)
    assert kinds(found) == [("entry", "up"), ("exit", "up"), ("entry", "low")]
    assert [one.t for one in found.events] == pytest.approx([0.0, s, 1 - s], abs=1e-8)


@pytest.mark.parametrize("bound", [4.0, 6.0])
def test_beside_a_bound_on_the_speed_each_has_its_arc(bound: float):
    """u = a, falls in a line to 0 at the greatest speed w = 1.2, is 0, and falls again until the body rests."""
    w = 1.2

    def parts(slope: float) -> tuple[float, float, float]:
        first, ramp, last = w / bound - bound / (2 * slope), bound / slope, math.sqrt(2 * w / slope)
        return first, ramp, last

    def short(slope: float) -> float:
        first, ramp, last = parts(slope)
        way = bound * (first**2 / 2 + first * ramp + ramp**2 / 3) + w * (1 - first - ramp - last)
        return way + w * last - slope * last**3 / 6 - 1

    slope = brentq(short, bound**2 / (2 * w) * (1 + 1e-9), 1e4)
    first, ramp, last = parts(slope)
    found = certified(
        kept("driven_fast", second=True, speed=v - w, up=u - a),
        parameters={"a": bound},
        initial={"x": 0.0, "v": 0.0},
        final={"x": 1.0, "v": 0.0},
        tf=1.0,
    )
    optimum = bound**2 * (first / 2 + ramp / 6) + slope**2 * last**3 / 6
    assert found.objective == pytest.approx(optimum, rel=1e-9)
    assert kinds(found) == [("entry", "up"), ("exit", "up"), ("entry", "speed"), ("exit", "speed")]


@pytest.mark.parametrize("bound", [5.0, 7.0])
def test_beside_a_box_its_bounds_have_arcs_like_constraints(bound: float):
    """Before a wall, from (0, 1) to (0, -1): u = -B for a time s, then rises in a line to 0 where the body rests."""
    wall = 1 / 9

    def ramp(s: float) -> float:
        return 2 * (1 - bound * s) / bound

    def short(s: float) -> float:
        return s - bound * s * s / 2 + (1 - bound * s) * ramp(s) - bound * ramp(s) ** 2 / 3 - wall

    free = bound * wall >= 2 / 3  # the largest deceleration is 2 / (3 l)
    s = 0.0 if free else brentq(short, 0.0, 1 / bound)
    optimum = 4 / (9 * wall) if free else bound**2 * (s + ramp(s) / 3)
    problem = replace(kept("walled_in", second=True, wall=x - a), control_set="box")
    found = certified(
        problem,
        parameters={"a": wall},
        initial={"x": 0.0, "v": 1.0},
        final={"x": 0.0, "v": -1.0},
        tf=1.0,
        control={"u": [-bound, bound]},
    )
    assert found.objective == pytest.approx(optimum, rel=1e-9)
    bounds = [one.t for one in found.events if one.name == "u_min"]
    assert bounds == ([] if free else pytest.approx([0.0, s, 1 - s], abs=1e-8))
    assert found.to_dict()["switching_times"] == ([] if free else pytest.approx([s, 1 - s], abs=1e-8))


@pytest.mark.slow
def test_a_free_duration_ends_where_h_vanishes_under_the_active_constraint():
    """At u = 2 time would be worth it; with u <= 1 the way of 1 takes a time of 1, and costs 2 + 1/2."""
    problem, ends = kept("timed", cost=u**2 / 2 + 2, cap=u - a), {"initial": {"x": 0.0}, "final": {"x": 1.0}}
    found = satsym.solve(satsym.Instance.of(problem, tf="free", tf_guess=1.2, **ends))
    assert found.objective == pytest.approx(2.5, rel=1e-10)
    assert found.to_dict()["t_final"] == pytest.approx(1.0, rel=1e-9)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.EXTREMAL_ONLY  # the second variation with a free time is not seen to


@pytest.mark.slow
def test_what_can_hardly_be_kept_is_not_said_to_be_infeasible():
    """Only u = 1 reaches the end within the bound, and nothing is between it and the boundary."""
    problem, ends = kept("hurried", cap=u - a), {"initial": {"x": 0.0}, "final": {"x": 1.0}, "tf": 1.0}
    found = satsym.solve(satsym.Instance.of(problem, parameters={"a": 1.0}, **ends)).to_dict()
    assert found["status"] in {"converged", "not converged"}
    found = satsym.solve(satsym.Instance.of(problem, parameters={"a": 0.9}, **ends)).to_dict()
    assert found["status"] == "infeasible"
    assert "cap" in found["message"]


@pytest.mark.slow
def test_from_the_top_of_a_hill_it_goes_to_one_side_and_not_on_for_ever():
    """Without the bounds the cost is unbounded below; u = 0 is stationary, and no minimum."""
    problem = replace(kept("hill", up=u - 1, low=-1 - u), terminal_cost=-2 * x**2)
    found = certified(problem, initial={"x": 0.0}, tf=1.0)
    assert found.objective == pytest.approx(-1.5, rel=1e-9)
    assert np.ptp(found.found.u) == 0.0


@pytest.mark.slow
@pytest.mark.parametrize("damage", ["later", "without", "longer"])
def test_the_certificate_sees_arcs_that_are_none(damage: str):
    problem = kept("damaged", second=True, up=u - a, low=-a - u)
    given = {"initial": {"x": 0.0, "v": 0.0}, "final": {"x": 1.0, "v": 0.0}, "tf": 1.0}
    good = certified(problem, parameters={"a": 4.2}, **given).found
    if damage == "without":
        bad = replace(good, events=good.events[1:])
    elif damage == "longer":
        bad = replace(good, instance=replace(good.instance, parameters=(4.1, 0.0)))
    else:
        moved = tuple(replace(one, t=one.t + 1e-4 * (one.t > 0.0)) for one in good.events)
        times = good.times.copy()
        for one, other in zip(good.events, moved, strict=True):
            times[np.abs(times - one.t) < 1e-12] = other.t
        bad = replace(good, events=moved, times=times)
    found = certify(bad)
    assert found is not None
    assert found.verdict is Verdict.FAILED
