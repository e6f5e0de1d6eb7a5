"""Linear motions: the first arrival of all, the least cost, and evidence where nothing arrives; against other means."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import linprog
from sympy import Abs, Integer

from satsym import solvers as solve
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers.by_search import bang_bang
from satsym.solvers.certificate import certify
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.answers import answered
from satsym.solvers.switching.attempt import attempt
from satsym.solvers.switching.linear.linear_motion import exponential, linear_motion
from satsym.solvers.switching.linear.reach import Reach, nearest_point
from satsym.solvers.switching.linear.separation import separates
from satsym.solvers.switching.structure import LOWER, UPPER, Guess, Structure
from satsym.status import Status
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from tests.support.models import build
from tests.support.switching_closed_forms import FUEL, TIME, case, moving_arrivals
from tests.switching.test_switching_models import FREE, assert_certified, problem, v, w, x, y
from tests.switching.test_switching_models import case as built

START, GOAL = (2.8709045607534005, -1.07111663506606), {"q": -0.29012174824094394, "q_dot": -0.8997125657518318}
WEAK = {"lower": (-0.07966435744734197,), "upper": (0.19521843413322953,)}
"""Three extremals of least time, which take 2.912, 3.676 and 29.885."""


def moving(rng: np.random.Generator, name: str = TIME) -> Instance:
    """A body that is to end in motion, often in the direction in which it starts, with weak or strong controls."""
    goal = float(rng.choice([-1.0, 1.0]) * 10 ** rng.uniform(-1.0, 0.5))
    speed = goal * float(10 ** rng.uniform(-0.5, 0.5) * rng.choice([1.0, 1.0, -1.0]))
    place = float(rng.normal() * 3.0)
    low, high = (10 ** rng.uniform(-1.5, 0.5, 2)).tolist()
    final = {"q": place + float(rng.normal()) * 2.0, "q_dot": goal}
    return case(name, initial=(place, speed), final=final, lower=(-low,), upper=(high,))


def known(one: Instance) -> list[float]:
    """Durations of all its extremals of least time."""
    return moving_arrivals(one.initial, (one.final["q"], one.final["q_dot"]), one.lower[0], one.upper[0])


def least_fuel(one: Instance, states: Sequence[Sequence[float]], acting: Sequence[Sequence[float]]) -> float | None:
    """The least integral of |u| by a linear programme over controls constant in each of many steps, if any arrives."""
    count, n, m = 400, len(states), len(acting[0])
    assert one.tf is not None
    length = (one.tf - one.t0) / count
    both = expm(length * np.block([[np.array(states), np.array(acting)], [np.zeros((m, n + m))]]))
    power, columns = np.eye(n), []
    for _ in range(count):
        columns.append(power @ both[:n, n:])
        power = both[:n, :n] @ power
    effects = np.concatenate(columns[::-1], axis=1)
    bounds = [(0.0, max(b, 0.0)) for _ in range(count) for b in one.upper]
    bounds += [(0.0, max(-b, 0.0)) for _ in range(count) for b in one.lower]
    missing = np.array(list(one.final.values())) - power @ np.array(one.initial)
    both_signs = np.concatenate([effects, -effects], axis=1)
    found = linprog(np.full(2 * count * m, length), A_eq=both_signs, b_eq=missing, bounds=bounds, method="highs")
    return float(found.fun) if found.status == 0 else None


@pytest.fixture(scope="module")
def weak() -> Instance:
    return case(TIME, initial=START, final=GOAL, **WEAK)


def test_of_several_extremals_of_least_time_the_first_to_arrive_is_found(weak: Instance) -> None:
    assert known(weak) == pytest.approx([2.9121265916, 3.6759, 29.8852387], rel=1e-4)
    found = solve.solve(weak)
    assert found.objective == pytest.approx(known(weak)[0], rel=1e-12)
    assert_certified(found)


def test_ends_in_motion_are_reached_in_the_least_of_all_times() -> None:
    rng = np.random.default_rng(11)
    several = 0
    for _ in range(15):
        one = moving(rng)
        found = bang_bang(one)
        assert found.status is Status.CONVERGED, found.message
        assert found.objective == pytest.approx(known(one)[0], rel=1e-9)
        several += len(known(one)) > 1
    assert several > 0


def slowest(weak: Instance) -> Solution:
    """The extremal of the example that takes longest, exactly."""
    (q, speed), (goal, last) = weak.initial, weak.final.values()
    high, low = weak.upper[0], weak.lower[0]
    turning = (goal - q + speed**2 / (2.0 * high) - last**2 / (2.0 * low)) / (0.5 / high - 0.5 / low)
    first = (math.sqrt(turning) - speed) / high
    # The switching function is linear and vanishes at the switch; where the motion ends, H = 1 + l_q v + sigma u = 0.
    rest = known(weak)[-1] - first
    slope = -1.0 / (last - low * rest)
    start = Guess(Structure(((UPPER, LOWER),)), np.array([first]), np.array([slope, slope * first]), first + rest)
    exact = attempt(weak, start, Limits(100, float("inf")))
    assert exact is not None
    return answered(weak, exact, (), 0.0)


def test_an_extremal_that_arrives_later_than_another_is_not_certified(weak: Instance) -> None:
    late = replace(slowest(weak), wall_s=0.0)
    assert late.objective == pytest.approx(known(weak)[-1], rel=1e-9)
    verdict = certify(late)
    assert verdict is not None
    assert verdict.verdict == "extremal only", verdict.checks
    failed = {c.name for c in verdict.checks if not c.passed}
    assert "cheaper by: duration" in failed
    least = min(one.cheapest for one in verdict.competitors if one.solved)
    assert least == pytest.approx(known(weak)[0], rel=1e-9)
    assert verdict.not_checked == ()


@pytest.mark.parametrize("number", range(8))
def test_least_fuel_of_ends_in_motion_is_that_of_a_linear_programme(number: int) -> None:
    rng = np.random.default_rng(number)
    one = moving(rng, FUEL)
    one = replace(one, tf=float(rng.uniform(0.5, 1.6)) * float(rng.choice(known(one))))
    found, expected = bang_bang(one), least_fuel(one, [[0.0, 1.0], [0.0, 0.0]], [[0.0], [1.0]])
    if expected is None:
        assert found.status is Status.INFEASIBLE, found.message
    else:
        assert found.status is Status.CONVERGED, found.message
        assert found.objective == pytest.approx(expected, rel=1e-3, abs=1e-4)


def test_durations_that_lead_to_an_end_need_not_be_an_interval(weak: Instance) -> None:
    first, second, third = known(weak)
    for tf, reached in ((0.99 * first, False), (3.294, True), (1.2 * second, False), (1.05 * third, True)):
        one = case(FUEL, initial=START, final=GOAL, tf=tf, **WEAK)
        found, expected = bang_bang(one), least_fuel(one, [[0.0, 1.0], [0.0, 0.0]], [[0.0], [1.0]])
        assert (expected is not None) is reached
        assert found.status is (Status.CONVERGED if reached else Status.INFEASIBLE), found.message
        if expected is not None:
            assert found.objective == pytest.approx(expected, rel=1e-3)
        elif tf > first:
            assert "separate this final state from the reachable set" in found.message


def test_costates_separate_only_what_is_not_reached() -> None:
    one = case(FUEL, tf=1.9)
    motion = linear_motion(one)
    assert motion is not None
    distance, costate = Reach(one, motion, 1.9).separation()
    assert distance > 0.0
    assert separates(one, costate)
    assert not separates(one, -costate)
    assert not separates(replace(one, tf=2.1), costate)


@pytest.mark.parametrize(
    ("low", "high", "start", "tf", "cost"),
    [
        (-1.0, 1.0, (1.0, -1.0), 3.0, 1.0),  # however the speed is taken off
        (0.0, 1.0, (1.0, -1.0), 3.0, 1.0),
        (0.25, 1.0, (2.0, -1.5), 3.0, 1.5),
    ],
)
def test_where_any_brake_does_the_cost_is_given_and_no_strict_minimum_claimed(
    low: float, high: float, start: tuple[float, float], tf: float, cost: float
) -> None:
    found = solve.solve(case(FUEL, initial=start, tf=tf, lower=(low,), upper=(high,)))
    assert found.status is Status.CONVERGED, found.message
    assert found.objective == pytest.approx(cost, abs=1e-9)
    assert_not_strict(found)


def assert_not_strict(found: Solution) -> None:
    assert found.certificate is not None
    failed = [c.name for c in found.certificate.checks if not c.passed]
    assert failed == ["not strict: other controls have the same cost"], found.certificate.checks
    assert found.certificate.verdict == "extremal only"


@pytest.fixture(scope="module")
def axes(tmp_path_factory: pytest.TempPathFactory) -> Instance:
    """Two bodies on lines, from rest at 2 and at 1 to rest at zero in the least time."""
    names = ("a", "b", "c", "d")
    a, b, c, d = symbols_of(Variable(name, name) for name in names)
    controls = (Variable("f", "f"), Variable("g", "g"))
    f, g = symbols_of(controls)
    one = Problem(
        name="two_axes",
        title="Two bodies",
        model=FirstOrder(
            name="two_axes_motion",
            title="Two bodies",
            states=tuple(Variable(name, name) for name in names),
            controls=controls,
            parameters=(),
            rates={a: b, b: f, c: d, d: g},
        ),
        running_cost=Integer(1),
        control_set="box",
    )
    text = (
        "[initial]\na = 2.0\nb = 0.0\nc = 1.0\nd = 0.0\n[final]\na = 0.0\nb = 0.0\nc = 0.0\nd = 0.0\n"
        '[time]\ntf = "free"\n[control]\nf = [-1.0, 1.0]\ng = [-1.0, 1.0]\n'
    )
    return build(tmp_path_factory.mktemp("axes"), one, text)


def test_an_axis_that_needs_less_time_may_do_what_it_likes(axes: Instance) -> None:
    found = solve.solve(axes)
    assert found.status is Status.CONVERGED, found.message
    assert found.objective == pytest.approx(2.0 * math.sqrt(2.0), rel=1e-12)
    assert np.abs(found.x[:, -1]).max() < 1e-9
    assert_not_strict(found)


def test_two_axes_that_switch_together_are_certified(axes: Instance) -> None:
    found = solve.solve(replace(axes, initial=(2.0, 0.0, 2.0, 0.0)))
    assert found.objective == pytest.approx(2.0 * math.sqrt(2.0), rel=1e-12)
    assert_certified(found)


TRIPLE = problem("triple", {x: y, y: v, v: w}, Integer(1), ("w",))


def test_a_chain_of_three_is_led_back_by_the_arcs_that_led_it_away(tmp_path: Path) -> None:
    # Any control with at most two switches that arrives at the origin is the one of least time: all modes are real.
    rng = np.random.default_rng(2)
    base = built(tmp_path, TRIPLE, (1.0, 0.0, 0.0), (0.0, 0.0, 0.0), FREE)
    for number in range(4):
        low, high = -(10 ** rng.uniform(-0.5, 0.5)), 10 ** rng.uniform(-0.5, 0.5)
        lengths, sign = 10 ** rng.uniform(-0.7, 0.5, 3), rng.integers(2)
        state = np.zeros(3)
        for k in (2, 1, 0):
            u, t = (low, high)[(k + sign) % 2], -lengths[k]
            state = expm(t * np.eye(3, k=1)) @ state + u * np.array([t**3 / 6.0, t**2 / 2.0, t])
        found = bang_bang(replace(base, initial=tuple(state.tolist()), lower=(low,), upper=(high,)))
        assert found.status is Status.CONVERGED, found.message
        assert found.objective == pytest.approx(lengths.sum(), rel=1e-8)
        assert found.switching_times[0] == pytest.approx(np.cumsum(lengths)[:2], rel=1e-6)
        if number == 0:
            assert_certified(replace(found, certificate=certify(found)))


def test_one_signed_burns_too_short_for_few_steps_are_found(tmp_path: Path) -> None:
    fuel = problem("triple_fuel", {x: y, y: v, v: w}, Abs(w), ("w",))
    start, end = (-0.00385, -1.17868, 0.590564), (0.208124, 0.436708, -0.168314)
    found = solve.solve(replace(built(tmp_path, fuel, start, end, "12.84635"), lower=(-1.96388,), upper=(1.88495,)))
    assert found.status is Status.CONVERGED, found.message
    assert found.objective == pytest.approx(start[2] - end[2], rel=1e-9)
    assert_not_strict(found)


def test_a_later_start_and_a_control_without_room_change_nothing_but_times(axes: Instance) -> None:
    one = replace(axes, initial=(2.0, 0.0, 0.0, 0.0), lower=(-1.0, 0.0), upper=(1.0, 0.0), t0=5.0)
    found = solve.solve(one)
    assert found.status is Status.CONVERGED, found.message
    assert found.objective == pytest.approx(2.0 * math.sqrt(2.0), rel=1e-12)
    assert found.switching_times[0] == pytest.approx((5.0 + math.sqrt(2.0),), rel=1e-12)
    assert found.certificate is not None
    assert "not strict: other controls have the same cost" not in {
        c.name for c in found.certificate.checks if not c.passed
    }


@pytest.mark.slow
def test_time_is_weighed_against_fuel_where_every_control_brakes_as_well() -> None:
    # One burn from the start, then a coast: fuel of a one-signed control is the speed, and the rest is time.
    found = solve.solve(case(FUEL, initial=(2.0, 1.0), tf=None, parameters=(0.2,)))
    assert found.status is Status.CONVERGED, found.message
    assert_certified(found)
    for fraction in (0.9, 1.1):
        fixed = bang_bang(case(FUEL, initial=(2.0, 1.0), tf=fraction * float(found.times[-1])))
        assert fixed.objective + 0.2 * fixed.times[-1] > found.objective


def test_exponentials_of_matrices_are_those_of_the_library() -> None:
    rng = np.random.default_rng(0)
    for size in (1e-3, 1.0, 30.0):
        matrix = size * rng.normal(size=(4, 4))
        assert exponential(matrix) == pytest.approx(expm(matrix), rel=1e-9, abs=1e-12 * np.abs(expm(matrix)).max())


@pytest.mark.parametrize("centre", [(2.0, 0.0, 0.0), (2.0, 3.0, 0.5), (2.0, -2.0, 4.0), (0.5, 0.2, -0.3)])
def test_the_nearest_point_of_a_box_is_found(centre: tuple[float, float, float]) -> None:
    middle = np.array(centre)
    near = nearest_point(lambda d: middle - np.sign(d), middle + 1.0, 1e-12, 1e-9)
    expected = np.clip(0.0, middle - 1.0, middle + 1.0)
    assert near.fractions @ near.corners == pytest.approx(expected, abs=1e-8)
    assert max(near.distance, 0.0) == pytest.approx(np.linalg.norm(expected), abs=1e-6)
