"""Exact switching times of a body on a line, by the solver that knows nothing of it, against closed forms."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sympy import Abs, Integer

from satsym import solvers as solve
from satsym.instance import Instance
from satsym.report.results import sets, trajectory
from satsym.report.results.objects import solution_object
from satsym.solution import Iteration, Solution
from satsym.solvers.by_search import bang_bang
from satsym.status import BadInput, Status
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from tests.support.models import build
from tests.support.switching_closed_forms import FUEL, TIME, Known, case, least_fuel, minimum_time, starts

SAMPLED = 24
"""Of the 1,000 random starts that the bench solves."""


def with_solver(one: Instance, **options: Any) -> Instance:
    """The same with other solver options."""
    return replace(one, solver=msgspec.structs.replace(one.solver, **options))


def assert_known(found: Solution, known: Known) -> None:
    """Cost and duration to 1e-9, switching times to 1e-10, the control what it should be in between."""
    assert found.status is Status.CONVERGED, found.message
    assert found.objective == pytest.approx(known.cost, abs=1e-9)
    assert found.times[-1] == pytest.approx(known.duration, abs=1e-9)
    assert found.switching_times[0] == pytest.approx(known.switches, abs=1e-10)
    edges = [0.0, *known.switches, known.duration]
    for level, start, end in zip(known.levels, edges, edges[1:], strict=False):
        inside = (found.times > start + 1e-9) & (found.times < end - 1e-9)
        assert (found.u[0, inside] == level).all()


def test_least_times_from_random_starts_are_those_of_the_closed_form() -> None:
    for start in starts(SAMPLED):
        assert_known(bang_bang(case(TIME, initial=start)), minimum_time(*start))


def test_costates_of_the_least_time_are_those_of_the_closed_form() -> None:
    start = (2.0, 1.0)
    known, found = minimum_time(*start), bang_bang(case(TIME, initial=start))
    # The switching function is linear, vanishes at the switch and is -1 where the motion rests: H = 1 + sigma u = 0.
    slope = -1.0 / (known.duration - known.switches[0])
    assert found.lam[0] == pytest.approx(np.full(len(found.times), -slope), abs=1e-9)
    assert found.lam[1] == pytest.approx(slope * (found.times - known.switches[0]), abs=1e-9)


@settings(max_examples=12)
@given(speed=st.floats(0.05, 4.0), side=st.sampled_from([-1.0, 1.0]), off=st.sampled_from([0.0, 1e-12, 1e-7, -1e-5]))
def test_on_the_switching_curve_and_next_to_it_the_least_time_is_found(speed: float, side: float, off: float) -> None:
    start = (side * speed * speed / 2.0 * (1.0 + off), -side * speed)
    known, found = minimum_time(*start), bang_bang(case(TIME, initial=start))
    assert found.status is Status.CONVERGED, found.message
    assert found.objective == pytest.approx(known.cost, rel=1e-5 if abs(off) < 1e-7 else 1e-9)
    assert np.abs(found.x[:, -1]).max() < 1e-9


@pytest.mark.parametrize("number", range(12))
def test_least_fuel_is_that_of_the_closed_form(number: int) -> None:
    rng = np.random.default_rng(number)
    while True:
        q, v = rng.uniform(-3.0, 3.0, 2).tolist()
        duration = minimum_time(q, v).duration * float(rng.uniform(1.02, 2.5))
        known = least_fuel(q, v, duration)
        if known is not None:
            break
    assert_known(bang_bang(case(FUEL, initial=(q, v), tf=duration)), known)


@pytest.mark.parametrize("number", range(4))
def test_least_energy_without_bounds_is_that_of_the_closed_form(number: int) -> None:
    # The control is linear in time; its coefficients follow from the two ends.
    rng = np.random.default_rng(number)
    q, v = rng.uniform(-5.0, 5.0, 2).tolist()
    duration = float(rng.uniform(1.0, 8.0))
    free = case("double-integrator-energy", initial=(q, v), tf=duration, lower=(-np.inf,), upper=(np.inf,))
    found = solve.solve(free)
    known = 6.0 * q * q / duration**3 + 6.0 * q * v / duration**2 + 2.0 * v * v / duration
    assert found.objective == pytest.approx(known, rel=1e-10)
    assert found.u[0, 0] == pytest.approx(-6.0 * q / duration**2 - 4.0 * v / duration, abs=1e-9)


def test_hardly_more_than_the_least_time_leaves_a_short_coast() -> None:
    known = least_fuel(1.0, 0.0, 2.0 + 1e-6)
    assert known is not None
    found = bang_bang(case(FUEL, tf=2.0 + 1e-6))
    assert found.status is Status.CONVERGED, found.message
    assert found.switching_times[0] == pytest.approx(known.switches, abs=1e-9)


@pytest.mark.study
def test_a_control_that_only_pushes_away_is_infeasible_and_the_nearest_end_is_told() -> None:
    # With u >= 1/2 for 3 s from q = 1 nothing ends below q = 1 + 9/4, or slower than 3/2.
    found = bang_bang(case(FUEL, initial=(1.0, 0.0), tf=3.0, lower=(0.5,)))
    assert found.status is Status.INFEASIBLE
    assert "misses q by 3.25, q_dot by 1.5" in found.message
    assert not np.isfinite(found.x).any()


@pytest.mark.parametrize("fraction", [0.5, 0.99])
def test_a_given_time_below_the_least_is_infeasible_and_the_least_is_told(fraction: float) -> None:
    least = minimum_time(3.0, -1.0).duration
    found = solve.solve(case(FUEL, initial=(3.0, -1.0), tf=fraction * least))
    assert found.status is Status.INFEASIBLE
    assert f"the minimum time to the given final state is {least:.9g}"[:-1] in found.message
    assert found.certificate is None
    assert solution_object(found)["objective"] is None


def test_a_motion_that_arrives_by_itself_needs_no_fuel() -> None:
    found = bang_bang(case(FUEL, initial=(0.0, 0.0)))
    assert (found.status, found.objective) == (Status.CONVERGED, 0.0)
    assert not found.u.any()


def test_where_any_brake_costs_the_same_the_cost_is_found_and_no_strict_minimum_claimed() -> None:
    # At 1 m/s towards the origin and with time to spare: taking off the speed costs 1, however it is spread.
    found = solve.solve(case(FUEL, initial=(1.0, -1.0), tf=3.0))
    assert found.objective == pytest.approx(1.0, abs=1e-9)
    assert found.certificate is not None
    assert found.certificate.verdict == "extremal only"
    failed = [c.name for c in found.certificate.checks if not c.passed]
    assert "not strict: other controls have the same cost" in failed


@pytest.mark.study
def test_fuel_without_a_weight_on_time_has_no_minimiser() -> None:
    assert bang_bang(case(FUEL, tf=None)).status is Status.NO_MINIMISER


@pytest.mark.parametrize(
    ("one", "complaint"),
    [
        (case(TIME, lower=(-np.inf,)), r"\[control\] u1: .* needs both bounds"),
        (case(TIME, lower=(1.0,)), r"\[control\]: the lower and upper bounds of every control are equal"),
        (case(TIME, initial=(0.0, 0.0)), r"the initial state satisfies the final conditions"),
        (case(TIME, tf=3.0), r'write tf = "free"'),
        (with_solver(case(TIME), method="collocation"), r'use "bang-bang"'),
        (with_solver(case(FUEL), method="sweep"), r'use "bang-bang"'),
        (with_solver(case("double-integrator-energy"), method="bang-bang"), r'use "collocation"'),
    ],
)
def test_what_cannot_be_solved_so_is_refused_in_one_line(one: Instance, complaint: str) -> None:
    with pytest.raises(BadInput, match=complaint) as refused:
        solve.solve(one)
    assert "\n" not in str(refused.value)


def test_time_that_is_up_is_said() -> None:
    found = bang_bang(with_solver(case(FUEL), max_seconds=1e-3))
    assert found.status is Status.TIME_LIMIT
    assert not found.status.answered


def test_progress_is_reported() -> None:
    seen: list[Iteration] = []
    found = bang_bang(case(FUEL), seen.append)
    assert len(seen) > 2
    assert tuple(seen) == found.history


def test_the_trajectory_jumps_at_the_exact_switching_times() -> None:
    found = bang_bang(case(FUEL))
    for switch, before, after in zip(found.switching_times[0], (-1.0, 0.0), (0.0, 1.0), strict=True):
        (left, right) = np.flatnonzero(found.times == switch)
        assert right == left + 1
        assert (found.u[0, left], found.u[0, right]) == (before, after)
        assert (found.x[:, left] == found.x[:, right]).all()


def test_the_table_of_the_trajectory_holds_both_sides_of_a_switch(tmp_path: Path) -> None:
    found = bang_bang(case(TIME))
    sets.write(tmp_path, {}, trajectory.contents(found))
    with (tmp_path / "trajectory.csv").open() as stream:
        rows = [row for row in csv.DictReader(stream) if float(row["t [s]"]) == found.switching_times[0][0]]
    assert [float(row["u1 [m/s**2]"]) for row in rows] == [-1.0, 1.0]


def test_the_machinery_does_not_know_the_problem_by_its_name_or_its_states(tmp_path: Path) -> None:
    # The same motion in other coordinates, a = 2 q + v and b = v - 3 q, driven the other way and ten times as hard.
    a, b, force = symbols_of(Variable(name, name) for name in ("alpha", "beta", "force"))
    v = (3 * a + 2 * b) / 5
    turned = Problem(
        name="turned",
        title="Two mixed states",
        model=FirstOrder(
            name="turned_motion",
            title="Two mixed states",
            states=(Variable("alpha", "a"), Variable("beta", "b")),
            controls=(Variable("force", "f"),),
            parameters=(),
            rates={a: 2 * v - force / 10, b: -force / 10 - 3 * v},
        ),
        running_cost=Integer(1),
        control_set="box",
    )
    start = (1.5, -0.7)
    text = (
        f"[initial]\nalpha = {2 * start[0] + start[1]}\nbeta = {start[1] - 3 * start[0]}\n"
        '[final]\nalpha = 0.0\nbeta = 0.0\n[time]\ntf = "free"\n[control]\nforce = [-10.0, 10.0]\n'
    )
    found, known = bang_bang(build(tmp_path, turned, text)), minimum_time(*start)
    assert found.objective == pytest.approx(known.cost, abs=1e-9)
    assert found.switching_times[0] == pytest.approx(known.switches, abs=1e-10)


def test_fuel_on_both_sides_of_one_control_is_found_for_a_control_that_only_pushes(tmp_path: Path) -> None:
    # A rocket without a brake: u in [0, 1] against a constant pull; coast, then burn.
    height, speed, thrust = symbols_of(Variable(name, name) for name in ("height", "speed", "thrust"))
    landing = Problem(
        name="landing",
        title="Landing with least fuel",
        model=FirstOrder(
            name="landing_motion",
            title="Fall",
            states=(Variable("height", "h"), Variable("speed", "v")),
            controls=(Variable("thrust", "u"),),
            parameters=(),
            rates={height: speed, speed: thrust - 1},
        ),
        running_cost=Abs(thrust),
        control_set="box",
    )
    text = (
        "[initial]\nheight = 1.0\nspeed = 0.0\n[final]\nheight = 0.0\nspeed = 0.0\n"
        '[time]\ntf = "free"\n[control]\nthrust = [0.0, 3.0]\n'
    )
    found = solve.solve(build(tmp_path, landing, text))
    # Fall for t1, then brake with 2: t1^2/2 + t1^2/4 = 1.
    first = (4.0 / 3.0) ** 0.5
    assert found.status is Status.CONVERGED, found.message
    assert found.switching_times[0] == pytest.approx((first,), abs=1e-10)
    assert found.objective == pytest.approx(1.5 * first, abs=1e-9)
    assert found.certificate is not None
    assert found.certificate.verdict == "certified", found.certificate.checks
