"""Limits of the end: which of them are met is found by machine, and other choices are competitors."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm
from scipy.optimize import minimize
from sympy import Rational, sin

import satsym
from satsym.cli.saving import save, trajectory_files
from satsym.front.solution import Solution
from satsym.instance import Instance, load
from satsym.instance.end_time import never
from satsym.instance.ends import Side
from satsym.report.results import trajectory
from satsym.report.results.objects import solution_object
from satsym.solvers import end_limits
from satsym.solvers.by_search import collocation
from satsym.solvers.certificate import certify
from satsym.solvers.certificate.end_limits import pushes
from satsym.solvers.iteration import unsolved
from satsym.status import BadInput, Status, Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from satsym.symbolic.model import t

STATES, CONTROLS = (Variable("x", "x"), Variable("v", "v")), (Variable("u", "u"),)
PARAMETERS = tuple(Variable(name, name, default=0.0) for name in ("c", "k", "l"))
(x, v), (u,), (c, k, wall) = symbols_of(STATES), symbols_of(CONTROLS), symbols_of(PARAMETERS)
LINE = FirstOrder(
    name="line", title="x'' = u", states=STATES, controls=CONTROLS, parameters=PARAMETERS, rates={x: v, v: u}
)
PUSHED = Problem(name="pushed", title="pushed", model=LINE, running_cost=c + u**2 / 2)
HILL = Problem(name="hill", title="hill", model=LINE, running_cost=u**2 / 2, terminal_cost=-k * (x - 0.1) ** 2 / 2)
WALLED = Problem(name="walled", title="walled", model=LINE, running_cost=u**2 / 2, path_constraints={"wall": x - wall})
PARABOLA = Problem(
    name="parabola",
    title="beyond a parabola",
    model=LINE,
    running_cost=u**2 / 2,
    terminal_inequalities={"beyond": 1 - x - v**2 / 4, "slow": v - 2 - k},
)
BACK_BY = Problem(
    name="back_by",
    title="in time",
    model=LINE,
    running_cost=c + u**2 / 2,
    terminal_inequalities={"late": t - k},
    terminal_constraints=(x - 1,),
)
SQUARED = replace(BACK_BY, name="squared", terminal_inequalities={"late": t**2 - k**2})
WINDOW = replace(BACK_BY, name="window", terminal_inequalities={"late": Rational(1, 2) - 1 / (1 + (t - 4) ** 2)})
BRAKED = replace(BACK_BY, name="braked", path_constraints={"brake": -u - 1.2})
HIGH = Problem(
    name="high",
    title="as high as it goes",
    model=LINE,
    running_cost=-(u**2) / 2,
    terminal_cost=x,
    maximise=True,
    terminal_inequalities={"speed": v - k},
)
AT_REST = {"initial": {"x": 0.0, "v": 0.0}, "tf": 1.0}


def certified(of: Problem | str, **given: Any) -> Solution:
    found = satsym.solve(satsym.Instance.of(of, **given))
    said = found.to_dict()
    assert said["status"] == "converged", said["message"]
    assert said["certificate"]["verdict"] == "certified", said["certificate"]["checks"]
    return found


def ends(found: Solution) -> dict[str, str | None]:
    said: dict[str, str | None] = found.to_dict()["ends_met"]
    return said


def effort(there: np.ndarray) -> float:
    """Least 1/2 int u^2 of going from rest to a state in unit time."""
    return float(6 * there[0] ** 2 - 6 * there[0] * there[1] + 2 * there[1] ** 2)


@pytest.mark.parametrize(
    ("begun", "limits", "end", "met"),
    [
        (0.0, [1.0, 2.0], 1.0, "lower"),
        (3.0, [1.0, 2.0], 2.0, "upper"),
        (1.5, [1.0, 2.0], 1.5, None),
        (0.0, [1.0, "free"], 1.0, "lower"),
        (0.0, ["free", -1.0], -1.0, "upper"),
        (0.0, ["free", 1.0], 0.0, None),
    ],
)
def test_the_end_that_is_nearest_without_control_is_met(begun: float, limits: list[Any], end: float, met: str | None):
    """J = 3 (x - v0)^2 / 2 with a free final velocity."""
    found = certified(PUSHED, initial={"x": 0.0, "v": begun}, final={"x": limits}, tf=1.0)
    assert found.objective == pytest.approx(1.5 * (end - begun) ** 2, abs=1e-12)
    assert ends(found) == {"x": met}
    assert found.found.x[0, -1] == pytest.approx(end)


@pytest.mark.slow
@settings(max_examples=12, deadline=None)
@given(st.lists(st.integers(-20, 20), min_size=4, max_size=4))
def test_of_two_ranges_the_least_effort_of_all_ends_is_found(corners: list[int]):
    box = [sorted((0.1 * a + 0.03, 0.1 * b)) for a, b in (corners[:2], corners[2:])]
    wanted = minimize(effort, [np.mean(side) for side in box], bounds=box, tol=1e-14)
    found = certified(PUSHED, final={"x": box[0], "v": box[1]}, **AT_REST)
    assert found.objective == pytest.approx(wanted.fun, rel=1e-6, abs=1e-10)
    assert found.found.x[:, -1] == pytest.approx(wanted.x, abs=1e-4)


def test_the_multiplier_is_what_the_limit_costs():
    found = certified(PUSHED, final={"x": [1.0, 2.0], "v": [-1.0, -0.5]}, **AT_REST).found
    pressing, n = pushes(found), 2
    sizes = np.abs(found.lam).max(axis=1)
    for i, name in enumerate(("x", "v")):  # J = 6 x^2 - 6 x v + 2 v^2 at (1, -1/2)
        slope = (15.0, -8.0)[i] * (1.0 if name == "x" else -1.0)
        assert pressing[name] * max(sizes[i], 1e-300) == pytest.approx(slope, rel=1e-7)
    assert n == len(pressing)


@pytest.mark.parametrize("slow", [0.0, -1.5])
def test_of_inequalities_at_the_end_the_active_ones_are_found(slow: float):
    """Beyond 1 - v^2 / 4, a curve along which the effort is least, unless the velocity is bounded further."""
    limits = [
        {"type": "ineq", "fun": lambda z: z[0] + z[1] ** 2 / 4 - 1},
        {"type": "ineq", "fun": lambda z: 2 + slow - z[1]},
    ]
    wanted = minimize(effort, [1.0, 0.4], constraints=limits, tol=1e-14, method="SLSQP")
    found = certified(PARABOLA, parameters={"k": slow}, **AT_REST)
    assert found.objective == pytest.approx(wanted.fun, rel=1e-9)
    assert ends(found) == {"beyond": "upper", "slow": "upper" if slow else None}
    assert found.found.x[:, -1] == pytest.approx(wanted.x, abs=1e-6)


def test_an_end_that_comes_early_enough_by_itself_is_not_held_back():
    """c T + 3 / (2 T^3) with a free final velocity is least where T^4 = 9 / (2 c)."""
    lasting = (4.5 / 0.5) ** 0.25
    given = {"parameters": {"c": 0.5, "k": 3.0}, "initial": {"x": 0.0, "v": 0.0}, "tf": "free", "tf_guess": 1.0}
    found = certified(BACK_BY, **given)
    assert found.objective == pytest.approx(0.5 * lasting + 1.5 / lasting**3, rel=1e-9)
    assert ends(found) == {"late": None}


@pytest.mark.parametrize("of", [BACK_BY, SQUARED], ids=lambda of: of.name)
@pytest.mark.parametrize(("k", "c"), [(1.7, 0.5), (0.1, 0.5), (2.0, 0.0), (1.5, -1.0)])
def test_an_end_that_would_come_too_late_comes_at_the_latest_time(of: Problem, k: float, c: float):
    """c T + 6 / T^3 from rest to rest falls until T^4 = 18 / c, or for ever."""
    given = {"initial": {"x": 0.0, "v": 0.0}, "final": {"v": 0.0}, "tf": "free"}
    found = certified(of, parameters={"k": k, "c": c}, **given)
    assert found.objective == pytest.approx(c * k + 6.0 / k**3, rel=1e-10)
    assert found.found.times[-1] == pytest.approx(k, rel=1e-13)
    assert ends(found) == {"late": "upper"}
    # nu is by how much more the cost falls with the time, here relative to what the time has its unit from
    solution = found.found
    pace = np.abs(np.array([solution.x[1, -1], solution.u[0, -1]])) @ np.abs(solution.lam).max(axis=1)
    assert pushes(solution)["late"] * pace == pytest.approx(18.0 / k**4 - c, rel=1e-8)


@pytest.mark.slow
def test_a_latest_time_presses_by_the_cost_it_causes_where_a_constraint_holds_the_control_too():
    """Braking is bounded until the end, where H under its law is not H; the multiplier is the slope of the cost."""

    def within(latest: float) -> Solution:
        given = {"initial": {"x": 0.0, "v": 0.0}, "final": {"v": 0.0}, "tf": "free", "tf_guess": latest}
        return certified(BRAKED, parameters={"c": 0.5, "k": latest}, **given)

    found, step = within(2.1), 1e-4
    assert ends(found) == {"late": "upper"}
    assert [(one.kind, one.name) for one in found.events] == [("entry", "brake")]
    slope = (within(2.1 + step).objective - within(2.1 - step).objective) / (2 * step)
    solution = found.found
    pace = np.abs(np.array([solution.x[1, -1], solution.lam[1, -1]])) @ np.abs(solution.lam).max(axis=1)
    assert pushes(solution)["late"] * pace == pytest.approx(-slope, rel=1e-6)


def test_a_latest_time_that_is_none_is_said():
    given = {"initial": {"x": 0.0, "v": 0.0}, "final": {"v": 0.0}}
    before = satsym.solve(satsym.Instance.of(BACK_BY, parameters={"k": -1.0, "c": 0.5}, tf="free", **given))
    assert "late: no final time after the initial time satisfies it" in before.to_dict()["message"]
    past = satsym.solve(satsym.Instance.of(BACK_BY, parameters={"k": 1.0}, tf=2.0, **given))
    assert "late: the given final time 2 does not satisfy it" in past.to_dict()["message"]
    in_time = certified(BACK_BY, parameters={"k": 3.0}, tf=2.0, **given)
    assert ends(in_time) == {"late": None}


@pytest.mark.parametrize(("c", "latest"), [(0.5, 3.0), (0.01, 5.0)])
def test_a_window_of_final_times_far_from_the_guess_is_found(c: float, latest: float):
    """c T + 6 / T^3 is least at T = (18 / c)^(1/4), before the window from 3 to 5 or after it.

    Newton's method from the guess of one leaves the bump that states the window, on either side.
    """
    given = {"initial": {"x": 0.0, "v": 0.0}, "final": {"v": 0.0}, "tf": "free", "parameters": {"c": c, "k": 1.0}}
    found = certified(WINDOW, **given)
    assert found.objective == pytest.approx(c * latest + 6.0 / latest**3, rel=1e-10)
    assert ends(found) == {"late": "upper"}


def test_an_inequality_in_time_of_which_nothing_is_proved_is_not_called_infeasible():
    """(T - 2)^2 + 1 <= 0 holds never; that Newton's method finds no root shows nothing of it."""
    given = {"initial": {"x": 0.0, "v": 0.0}, "final": {"v": 0.0}, "tf": "free", "parameters": {"c": 0.5, "k": 1.0}}
    nowhere = replace(BACK_BY, name="nowhere", terminal_inequalities={"late": (t - 2) ** 2 + 1})
    instance = satsym.Instance.of(nowhere, **given).case
    assert never(instance) == ""
    assert never(satsym.Instance.of(WINDOW, **given).case) == ""
    given["parameters"] = {"c": 0.5, "k": -1.0}
    assert "no final time after the initial time" in never(satsym.Instance.of(BACK_BY, **given).case)


def test_a_method_that_finds_nothing_leaves_the_answer_to_the_search():
    """What the limits that seem to be met lead to is only tried; a singular problem there ends nothing."""
    instance, asked = satsym.Instance.of(PUSHED, final={"x": [1.0, 2.0]}, **AT_REST).case, []

    def hard(one: Instance, progress: Any) -> Any:
        asked.append(dict(one.met))
        return unsolved(one, "collocation", 0.0)

    found = end_limits.solve(instance, None, hard, lambda one, _: collocation(one))
    assert asked == [{"x": Side.LOWER}]
    assert found.status is Status.CONVERGED
    assert found.objective == pytest.approx(1.5, rel=1e-12)
    assert found.instance.work == np.inf


@pytest.mark.parametrize("speed", [0.1, 1.0])
def test_of_an_objective_to_maximise_limits_have_the_same_signs(speed: float):
    """x - 1/2 int u^2 is greatest with u = 1 - t, unless that ends too fast: v = 1/2 then."""
    found = certified(HIGH, parameters={"k": speed}, **AT_REST)
    wanted = minimize(lambda z: effort(z) - z[0], [0.1, 0.0], bounds=[(None, None), (None, speed)], tol=1e-14)
    assert found.objective == pytest.approx(-wanted.fun, rel=1e-7)
    assert ends(found) == {"speed": "upper" if speed < 0.5 else None}


def test_inequalities_at_the_end_are_typeset_in_both_languages():
    for lang, words in (("en", "terminal inequalities"), ("id", "pertidaksamaan akhir")):
        text = satsym.derive(PARABOLA).latex(lang=lang)
        assert words in text
        assert r"\le 0" in text
        assert r"\nu_k \ge 0" in text


def test_an_end_that_pulls_and_a_range_that_is_left_fail():
    found = certified(PUSHED, final={"x": [1.0, 2.0]}, **AT_REST).found
    turned = replace(found.instance, met={"x": Side.UPPER}, ranges={"x": (-5.0, 1.0)})
    moved = replace(found.instance, ranges={"x": (1.0, 2.0), "v": (2.0, 3.0)})
    for case, name in (
        (turned, "negative multiplier of a terminal limit"),
        (moved, "a terminal limit is violated"),
    ):
        certificate = certify(replace(found, instance=case))
        assert certificate is not None
        assert certificate.verdict is Verdict.FAILED
        assert [check.name for check in certificate.checks if not check.passed] == [name]


@pytest.mark.slow
def test_of_two_ends_that_are_local_optima_the_cheaper_is_found():
    """J = 3 x^2 / 2 - k (x - 1/10)^2 / 2 falls to both sides, more to the negative one."""
    found = certified(HILL, final={"x": [-1.0, 1.0]}, parameters={"k": 6.0}, **AT_REST)
    assert ends(found) == {"x": "lower"}
    assert found.objective == pytest.approx(1.5 - 3 * 1.1**2, rel=1e-10)
    others = found.to_dict()["certificate"]["competitors"][-1]
    assert others["kind"] == "seeded starts"
    assert others["solved"] > 1


def test_with_a_free_final_time_a_range_is_reached_when_that_is_cheapest():
    """c T + 6 x^2 / T^3 is least where T^4 = 18 x^2 / c."""
    found = certified(
        PUSHED,
        final={"x": [1.0, 2.0], "v": 0.0},
        parameters={"c": 2.0},
        initial={"x": 0.0, "v": 0.0},
        tf="free",
        tf_guess=1.0,
    )
    lasting = 9.0**0.25
    assert found.objective == pytest.approx(2.0 * lasting + 6.0 / lasting**3, rel=1e-9)
    assert ends(found) == {"x": "lower"}


@pytest.mark.slow
def test_before_a_wall_too():
    """From (0, 1) to v = -1 before a wall the end is as far back as the range allows (Bryson and Ho, 3.11)."""
    given = {"initial": {"x": 0.0, "v": 1.0}, "tf": 1.0, "parameters": {"l": 0.1}}
    exact = certified(WALLED, final={"x": 0.0, "v": -1.0}, **given)
    found = certified(WALLED, final={"x": [0.0, 0.05], "v": -1.0}, **given)
    assert ends(found) == {"x": "lower"}
    assert found.objective == pytest.approx(exact.objective, rel=1e-9)
    assert [one.kind for one in found.events] == ["entry", "exit"]


def test_before_a_wall_inequalities_at_the_end_are_found_too():
    problem = replace(WALLED, name="walled_back", terminal_inequalities={"back": v + 1})
    found = certified(problem, initial={"x": 0.0, "v": 1.0}, final={"x": 0.0}, tf=1.0, parameters={"l": 0.1})
    assert found.objective == pytest.approx(40 / 9, rel=1e-10)
    assert ends(found) == {"back": "upper"}


def test_where_controls_switch_too():
    bounded = {"control": {"u1": [-1.0, 1.0]}, "tf": "free"}
    found = certified(
        "double_integrator_time", initial={"q": 0.0, "q_dot": 0.0}, final={"q": [1.0, 2.0], "q_dot": 0.0}, **bounded
    )
    assert found.objective == pytest.approx(2.0, rel=1e-9)
    assert ends(found) == {"q": "lower"}


def test_an_orbit_within_limits_is_reached_with_less_effort():
    exact = satsym.solve("return-to-orbit")
    case = satsym.Instance.of(
        "polar_orbit",
        initial={"r": 1.1, "r_dot": 0.0, "theta": 0.0, "theta_dot": 0.9},
        final={"r": [0.99, 1.01], "r_dot": 0.0, "theta": "reference", "theta_dot": 1.0},
        tf=2 * np.pi,
    )
    found = satsym.solve(case)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED
    assert found.objective < exact.objective
    assert 0.99 - 1e-9 <= found.found.x[0, -1] <= 1.01 + 1e-9


def test_what_is_saved_comes_back_with_its_ends(tmp_path: Path):
    found = certified(PUSHED, final={"x": [1.0, 2.0]}, **AT_REST)
    save(tmp_path, solution_object(found.found), trajectory_files(tmp_path, found.found, look=None))
    again, _ = trajectory.read(found.found.instance.meeting({}), tmp_path)
    assert again.instance.met == {"x": Side.LOWER}
    assert again.instance.final == found.found.instance.final


@pytest.mark.parametrize(
    ("final", "more", "message"),
    [
        ({"x": [2.0, 1.0]}, {}, r"\[final\] x: the range is empty, because 2 exceeds 1; swap the two"),
        ({"x": ["free", "free"]}, {}, r"\[final\] x: both limits of the range are free; leave the state out"),
        ({"x": ["reference", 1.0]}, {}, r'\[final\] x: "reference" cannot be a limit of a range'),
        ({"x": [0.0, 1.0, 2.0]}, {}, r"\[final\] x: got"),
        ({"x": [0.0, 1.0]}, {"initial": {"x": "free", "v": 0.0}}, "cannot be combined with"),
        ({"x": [0.0, 1.0]}, {"solver": {"free_angles": ["x"]}}, "angle|turn"),
        ({"x": [0.0, 1.0]}, {"solver": {"method": "sweep"}}, "the sweep method does not support limits"),
    ],
)
def test_what_is_no_range_is_refused(final: dict[str, Any], more: dict[str, Any], message: str):
    with pytest.raises(BadInput, match=message):
        satsym.solve(satsym.Instance.of(PUSHED, **{**AT_REST, "final": final, **more}))


def test_a_start_behind_a_wall_is_refused_whatever_the_end():
    with pytest.raises(BadInput, match="initial: path constraint wall"):
        satsym.solve(satsym.Instance.of(WALLED, initial={"x": 1.0, "v": 0.0}, final={"x": [0.0, 0.1]}, tf=1.0))


@pytest.mark.slow
def test_a_range_behind_a_wall_has_no_answer():
    given = {"parameters": {"l": 0.1}, "final": {"x": [0.2, 0.3], "v": 0.0}}
    found = satsym.solve(satsym.Instance.of(WALLED, **AT_REST, **given))
    assert not found.status.answered
    assert "of active limits has a solution that satisfies the other limits" in found.message


def test_a_range_of_no_width_is_a_given_end():
    found = certified(PUSHED, final={"x": [1.0, 1.0]}, **AT_REST)
    assert "ends_met" not in found.to_dict()
    assert found.objective == pytest.approx(1.5, rel=1e-12)


def test_a_satellite_returns_to_the_end_of_its_window_that_the_linear_motion_says() -> None:
    """Least effort of Hill's equations by their Gramian; the deviation of 5 km is 1e-4 of the radius."""
    case = load("return-to-geo-window")
    radius, n = case.parameters[:2]
    a = np.array([[0, 1, 0, 0], [3 * n**2, 0, 0, 2 * n], [0, 0, 0, 1], [0, -2 * n, 0, 0]])
    b = np.array([[0, 0], [1, 0], [0, 0], [0, 1.0]])
    start = np.array([case.initial[0] - radius, 0.0, radius * case.initial[2], radius * (case.initial[3] - n)])
    flow = expm(np.block([[a, b @ b.T], [np.zeros((4, 4)), -a.T]]) * case.tf)
    gramian = flow[:4, 4:] @ flow[:4, :4].T
    missed = flow[:4, :4] @ start

    def effort(angle: float) -> float:
        gap = np.array([0.0, 0.0, radius * (angle - n * case.tf), 0.0]) - missed
        return float(gap @ np.linalg.solve(gramian, gap) / 2)

    lower, upper = case.ranges["theta"]
    assert effort(lower) < min(effort(lower + 1e-5), effort(upper))
    found = satsym.solve(satsym.load(case.name))
    assert found.certificate.verdict is Verdict.CERTIFIED
    assert found.x(case.tf)[2] == pytest.approx(lower, abs=1e-12)
    assert found.objective == pytest.approx(effort(lower), rel=1e-3)


def test_a_minimum_within_a_range_is_kept_where_a_cheaper_one_lies_outside() -> None:
    """A pendulum is swung up; where its end is free, it comes to rest below instead, outside of the range."""
    swung = FirstOrder(
        name="swung",
        title="x'' = u - sin x",
        states=STATES,
        controls=CONTROLS,
        parameters=(),
        rates={x: v, v: u - sin(x)},
    )
    up = Problem(name="swing_up", title="swing up", model=swung, running_cost=u**2 / 2)

    def solved(**final: Any) -> satsym.Solution:
        return satsym.solve(satsym.Instance.of(up, initial={"x": 0.0, "v": 0.4126}, final=final, tf=5.2301))

    found = solved(x=[2.5, 3.8], v=0.0)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED
    end = float(found.x["x"][-1])
    assert 2.5 < end < 3.8
    assert not found.found.instance.guess
    least, *others = (solved(x=end + moved, v=0.0).objective for moved in (0.0, -0.1, 0.1))
    assert found.objective == pytest.approx(least, rel=1e-9)
    assert min(others) > least
    assert solved(v=0.0).objective < 0.1 * least
