"""Constraints on the state along the way: structures are found from a cold start, optima are those of closed forms."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar, root
from sympy import Rational, pi, sin

import satsym
from satsym.front.solution import Solution
from satsym.instance import Instance
from satsym.solvers.certificate import certify
from satsym.solvers.certificate.constrained.replay import replay
from satsym.solvers.certificate.constrained.second_variation import curvature
from satsym.solvers.constrained.refusals import refuse
from satsym.solvers.iteration import watched
from satsym.solvers.search.failing import contradiction
from satsym.status import BadInput, Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from satsym.symbolic.model import t

STATES = (Variable("x", "x"), Variable("v", "v"))
CONTROLS, PARAMETERS = (Variable("u", "u"),), (Variable("l", "l", default=0.1), Variable("c", "c", default=0.0))
(x, v), (u,), (wall_at, c) = symbols_of(STATES), symbols_of(CONTROLS), symbols_of(PARAMETERS)
LINE = FirstOrder(
    name="body", title="x'' = u", states=STATES, controls=CONTROLS, parameters=PARAMETERS, rates={x: v, v: u}
)


def kept(name: str, **constraints: Any) -> Problem:
    return Problem(name=name, title=name, model=LINE, running_cost=c + u**2 / 2, path_constraints=constraints)


WALL = kept("wall", wall=x - wall_at)
SPEED = kept("speed", limit=v - wall_at)
MOVING = kept("moving", wall=x - wall_at - c * (t - 0.5))
GATE = kept("gate", ceiling=x - wall_at, floor=wall_at + 0.1 - 4 * (t - 0.5) ** 2 - x)
FLOOR = kept("floor", floor=wall_at + 0.1 - 4 * (t - 0.5) ** 2 - x)
LANE = kept("lane", lane=v - sin(pi * t) - Rational(1, 10))
THERE_AND_BACK = {"initial": {"x": 0.0, "v": 1.0}, "final": {"x": 0.0, "v": -1.0}, "tf": 1.0}
AT_REST = {"initial": {"x": 0.0, "v": 0.0}, "final": {"x": 0.0, "v": 0.0}, "tf": 1.0}
ACROSS = {"initial": {"x": 0.0, "v": 0.0}, "final": {"x": 1.0, "v": 0.0}, "tf": 1.0}


def solved(of: Problem | str, **given: Any) -> Solution:
    return satsym.solve(satsym.Instance.of(of, **given))


def certified(found: Solution) -> Solution:
    said = found.to_dict()
    assert said["status"] == "converged", said["message"]
    assert said["certificate"]["verdict"] == "certified", said["certificate"]["checks"]
    return found


def least_effort(wall: float) -> float:
    """Of going from (0, 1) to (0, -1) in unit time before a wall (Bryson and Ho, 3.11)."""
    if wall <= 1 / 6:
        return 4 / (9 * wall)
    return 2 + 6 * max(0.0, 1 - 4 * wall) ** 2


@pytest.mark.parametrize(
    ("wall", "events"),
    [
        *((wall, ["entry", "exit"]) for wall in (0.02, 1 / 9, 0.1666)),
        *((wall, ["touch"]) for wall in (0.1667, 0.24)),
        *((1 / 6, None), (0.25, None), (0.3, [])),
    ],
)
def test_before_a_wall_the_body_rests_touches_or_turns_by_itself(wall: float, events: list[str] | None):
    found = certified(solved("bryson_denham", parameters={"l": wall}, **THERE_AND_BACK))
    assert found.objective == pytest.approx(least_effort(wall), rel=1e-9)
    kinds = [one.kind for one in found.events]
    assert events is None or kinds == events
    if kinds == ["entry", "exit"]:
        assert [one.t for one in found.events] == pytest.approx([3 * wall, 1 - 3 * wall], abs=1e-8)
    assert ("no path constraint is ever active" in found.message) == (not kinds)
    assert found.found.x[0].max() <= wall * (1 + 1e-9)


@pytest.mark.parametrize("speed", [1.02, 1.2, 1.49])
def test_a_bound_on_the_speed_has_an_order_of_one_and_no_jumps(speed: float):
    """v rises as a (t - t^2 / (2 tau)) to the bound, tau = 3 (w - 1) / (2 w): J = 8 w^3 / (9 (w - 1))."""
    found = certified(solved(SPEED, parameters={"l": speed}, **ACROSS))
    ramp = 3 * (speed - 1) / (2 * speed)
    assert found.objective == pytest.approx(8 * speed**3 / (9 * (speed - 1)), rel=1e-9)
    assert [(one.kind, one.t) for one in found.events] == [
        ("entry", pytest.approx(ramp, abs=1e-8)),
        ("exit", pytest.approx(1 - ramp, abs=1e-8)),
    ]
    twice = np.flatnonzero(np.diff(found.found.times) == 0.0)
    assert np.abs(found.found.lam[:, twice + 1] - found.found.lam[:, twice]).max() < 1e-8


def test_before_a_moving_wall_it_is_as_before_one_at_rest_and_the_hamiltonian_jumps():
    pace, wall = 0.3, 1 / 9
    ends = {"initial": {"x": -pace / 2, "v": 1 + pace}, "final": {"x": pace / 2, "v": -1 + pace}, "tf": 1.0}
    found = solved(MOVING, parameters={"l": wall, "c": pace}, **ends)
    assert certified(found).objective == pytest.approx(least_effort(wall) + pace, rel=1e-9)
    case, n = found.found.instance, 2
    z = np.concatenate([found.found.x, found.found.lam])
    h = case.model.hamiltonian_batch(found.found.times, z[:n], found.found.u, z[n:], case.parameters)
    first = int(np.flatnonzero(np.diff(found.found.times) == 0.0)[0])
    jump = found.found.lam[0, first] - found.found.lam[0, first + 1]
    assert jump == pytest.approx(2 / (9 * wall**2), rel=1e-8)
    assert h[first] - h[first + 1] == pytest.approx(pace * jump, rel=1e-7)  # -zeta g_t, with g_t = -pace


@pytest.mark.slow
def test_a_free_duration_ends_where_the_wall_is_touched():
    """With time weighed, J(T) = c T + (2 + 6 (1 - 4 l / T)^2) / T while the wall is touched, from T = 4 l to 6 l."""
    wall, weight = 0.1, 8.0
    best = minimize_scalar(
        lambda lasting: weight * lasting + least_effort(wall / lasting) / lasting,
        bounds=(4 * wall, 6 * wall),
        method="bounded",
        options={"xatol": 1e-12},
    )
    found = solved(WALL, parameters={"l": wall, "c": weight}, **{**THERE_AND_BACK, "tf": "free", "tf_guess": 0.5})
    assert found.status.answered, found.message
    assert found.objective == pytest.approx(best.fun, rel=1e-10)
    assert found.to_dict()["t_final"] == pytest.approx(best.x, rel=1e-6)
    assert [one.kind for one in found.events] == ["touch"]
    certified(found)


def of_touching(wall: float) -> tuple[Any, Any, Any]:
    """T -> effort, and its derivatives, of going from (0, 1) to (0, -1) in so long before a wall that is touched."""

    def effort(lasting: float) -> float:
        return 2 / lasting + 6 * (1 - 4 * wall / lasting) ** 2 / lasting

    return (
        effort,
        lambda s: -8 / s**2 + 96 * wall / s**3 - 288 * wall**2 / s**4,
        lambda s: 16 / s**3 - 288 * wall / s**4 + 1152 * wall**2 / s**5,
    )


def of_speed(limit: float) -> tuple[Any, Any, Any]:
    """The same of going from rest to rest one further at a bounded speed."""
    return (
        lambda s: 8 * limit**3 / (9 * (limit * s - 1)),
        lambda s: -8 * limit**4 / (9 * (limit * s - 1) ** 2),
        lambda s: 16 * limit**5 / (9 * (limit * s - 1) ** 3),
    )


@pytest.mark.slow
@pytest.mark.parametrize("name", ["wall", "limit"])
@pytest.mark.parametrize(("share", "least"), [(0.0, True), (0.98, True), (1.02, False), (1.5, False)])
def test_a_free_duration_is_a_minimum_where_the_cost_is_convex_in_it(name: str, share: float, least: bool):
    """With c T - k T^2 / 2 besides, c such that a duration is stationary; it is a minimum where k is less than J''."""
    limit, lasting = (0.1, 0.5) if name == "wall" else (1.2, 1.0)
    effort, slope, curve = (of_touching if name == "wall" else of_speed)(limit)
    k = share * curve(lasting)
    weight = k * lasting - slope(lasting)
    stated = {"wall": x - wall_at} if name == "wall" else {"limit": v - wall_at}
    problem = replace(kept(f"timed_{name}", **stated), terminal_cost=-Rational(k) * t**2 / 2)
    there = THERE_AND_BACK if name == "wall" else ACROSS
    fixed = solved(problem, **{**there, "tf": lasting, "parameters": {"l": limit, "c": weight}})
    case = replace(fixed.found.instance, tf=None, tf_guess=lasting)
    at = replace(fixed.found, instance=case)
    again = replay(at)
    assert again is not None
    assert fixed.objective == pytest.approx(effort(lasting) + weight * lasting - k * lasting**2 / 2, rel=1e-9)
    assert (curvature(at, again) > 0.0) == least
    certificate = certify(at, compared=False)
    assert certificate is not None
    assert certificate.verdict is (Verdict.LOCAL_MINIMUM if least else Verdict.EXTREMAL_ONLY)


@pytest.mark.slow
def test_a_motion_that_ends_on_a_boundary_at_a_free_time_is_extremal_only():
    found = solved(
        SPEED, initial={"x": 0.0, "v": 0.0}, final={"x": 1.0}, tf="free", tf_guess=1.5, parameters={"l": 1.0, "c": 1.0}
    )
    assert [one.kind for one in found.events] == ["entry"]
    said = found.to_dict()["certificate"]
    assert said["verdict"] == "extremal only"
    failed = {c["name"] for c in said["checks"] if not c["passed"]}
    assert "second variation not resolved: the motion ends on a boundary at a free time" in failed


def test_a_beam_under_a_ceiling_has_twice_the_effort():
    assert certified(satsym.solve("beam")).objective == pytest.approx(80 / 9, rel=1e-10)


@pytest.mark.parametrize(
    ("of", "given", "message"),
    [
        (WALL, {"initial": {"x": 0.2, "v": 1.0}}, "initial: path constraint wall has the value 0.1 at that point"),
        (WALL, {"final": {"x": 0.2, "v": -1.0}}, "final: path constraint wall has the value 0.1 at that point"),
        (WALL, {"initial": {"x": 0.1, "v": 1.0}}, "violated just after the start"),
        (WALL, {"final": {"x": 0.1, "v": -1.0}}, "violated just before the end"),
        (WALL, {"parameters": {"l": "free"}}, "cannot be combined with path constraints"),
    ],
)
def test_what_cannot_be_kept_at_the_ends_is_refused(of: Problem, given: dict[str, Any], message: str):
    with pytest.raises(BadInput, match=message):
        solved(of, **{**THERE_AND_BACK, **given})


def round_discs(**given: Any) -> satsym.Instance:
    """Among two discs in a plane, the first of radius 0.2 about (0.3, -0.05)."""
    at_rest = {"x": 0.0, "y": -0.05, "vx": 0.0, "vy": 0.0}
    return satsym.Instance.of("obstacle", **{"initial": at_rest, "tf": 1.0, **given})


def test_a_state_that_is_left_free_may_keep_a_constraint_whose_slope_by_it_vanishes_where_it_begins():
    refuse(round_discs(final={"x": 0.3}).case)
    with pytest.raises(BadInput, match="final: path constraint"):
        refuse(round_discs(final={"x": 0.3, "y": -0.05}).case)


def test_a_constraint_at_the_end_is_tested_at_the_final_time_or_where_it_never_changes():
    def at_the_end(of: Problem, tf: float | str) -> Instance:
        stated = {"initial": {"x": 0.0, "v": 0.0}, "final": {"x": 0.3}, "parameters": {"c": 0.2}}
        return satsym.Instance.of(of, tf=tf, **stated).case

    refuse(at_the_end(MOVING, 2.0))  # the wall is at 0.4 then
    refuse(at_the_end(MOVING, "free"))
    for of, tf in ((MOVING, 1.0), (WALL, 1.0), (WALL, "free")):
        with pytest.raises(BadInput, match="final: path constraint wall has the value 0"):
            refuse(at_the_end(of, tf))


@pytest.mark.parametrize("angle", [0.3, 1.1, 2.0, 2.5])
def test_a_start_along_a_boundary_is_no_violation_by_rounding(angle: float):
    def begun(outwards: float) -> satsym.Instance:
        out, way = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
        start = (np.array([0.3, -0.05]) + 0.2 * out, way + outwards * out)
        return round_discs(initial=dict(zip(("x", "y", "vx", "vy"), np.concatenate(start).tolist(), strict=True)))

    refuse(begun(0.0).case)
    with pytest.raises(BadInput, match="violated just after the start"):
        refuse(begun(-1e-6).case)


@pytest.mark.slow
def test_constraints_against_each_other_are_infeasible():
    found = solved(GATE, **AT_REST)
    said = found.to_dict()
    assert said["status"] == "infeasible", said["message"]
    assert "ceiling" in said["message"]
    assert "floor" in said["message"]


def test_a_motion_that_rests_on_its_boundary_is_admissible():
    found = certified(
        solved(SPEED, parameters={"l": 0.9}, initial={"x": 0, "v": 0.9}, final={"x": 0.9, "v": 0.9}, tf=1)
    )
    assert found.objective == pytest.approx(0.0, abs=1e-20)


@pytest.mark.slow
def test_what_only_a_coarse_mesh_cannot_reach_is_not_infeasible():
    """v <= 0.1 + sin(pi t) reaches 0.1 + 2 / pi = 0.73662 and not more, 0.73657 on a hundred trapezoids."""
    ends = {"initial": {"x": 0.0, "v": 0.1}, "tf": 1.0}
    found = certified(solved(LANE, final={"x": 0.7366, "v": 0.1}, **ends))
    assert {one.kind for one in found.events} == {"entry", "exit"}
    beyond = solved(LANE, final={"x": 0.75, "v": 0.1}, **ends)
    assert beyond.to_dict()["status"] == "infeasible"


@pytest.mark.parametrize(
    ("of", "given", "impossible"),
    [
        (SPEED, {"parameters": {"l": 1.2}, **ACROSS}, False),
        (SPEED, {"parameters": {"l": 0.99}, **ACROSS}, True),
        (FLOOR, AT_REST, False),
    ],
)
def test_only_what_no_motion_can_keep_is_a_contradiction(of: Problem, given: dict[str, Any], impossible: bool):
    """The distance of one in a time of one cannot be covered at a speed of 0.99 at most."""
    case = satsym.Instance.of(of, **given).case
    assert bool(contradiction(case, watched(case, None)[0])) == impossible


def test_relaxed_path_and_arcs_have_one_time_together():
    said = solved(SPEED, parameters={"l": 1.2}, solver={"max_seconds": 1e-9}, **ACROSS).to_dict()
    assert said["status"] == "time limit"
    assert said["message"].startswith("the time limit was reached before an extremal was found")


def test_other_methods_refuse_path_constraints_and_this_one_what_has_none():
    with pytest.raises(BadInput, match='use "boundary-arcs"'):
        satsym.solve("bryson-denham", method="collocation")
    with pytest.raises(BadInput, match="no path constraints"):
        satsym.solve("return-to-orbit", method="boundary-arcs")


def test_arcs_between_nodes_follow_the_boundary():
    found = satsym.solve("bryson-denham")
    between = np.linspace(0.34, 0.66, 57)
    assert np.abs(found.x["x"](between) - 1 / 9).max() < 1e-12
    first = between[between < 1 / 3]
    assert np.allclose(found.x["x"](first), 1 / 9 * (1 - (1 - 3 * first) ** 3))


@pytest.mark.slow
@pytest.mark.parametrize("damage", ["multiplier", "later", "without", "violated"])
def test_the_certificate_sees_what_is_no_extremal(damage: str):
    """Jumps of the wrong sign, junctions at other times, and trajectories that pass the wall."""
    good = satsym.solve("bryson-denham").found
    assert certify(good) is not None
    bad = good
    if damage == "multiplier":
        lam = good.lam.copy()
        lam[0, np.searchsorted(good.times, 1 / 3, side="right") + 1 :] += 1.0
        bad = replace(good, lam=lam)
    elif damage == "later":
        moved = tuple(replace(one, t=one.t + 1e-4) for one in good.events)
        times = good.times.copy()
        for one, other in zip(good.events, moved, strict=True):
            times[np.abs(times - one.t) < 1e-12] = other.t
        bad = replace(good, events=moved, times=times)
    elif damage == "without":
        bad = replace(good, events=())
    else:
        bad = replace(good, instance=replace(good.instance, parameters=(0.11,)))
    found = certify(bad)
    assert found is not None
    assert found.verdict is Verdict.FAILED
    assert math.isfinite(good.objective)


OSCILLATOR = replace(LINE, name="oscillator", title="van der Pol's", rates={x: v, v: (1 - x**2) * v - x + u})
DAMPED = Problem(
    name="damped",
    title="damped",
    model=OSCILLATOR,
    running_cost=x**2 + v**2 + u**2,
    path_constraints={"low": -v - wall_at},
)


@pytest.mark.study
@pytest.mark.parametrize(("least", "near"), [(0.4, [0.628, 1.469]), (0.2, [0.2947, 3.624])])
def test_van_der_pols_oscillator_keeps_to_a_lowest_velocity_as_by_shooting(least: float, near: list[float]):
    """Of order one, so that lambda_v = -2 u on the boundary; at 0.2 the end, which is free, is on it as well."""

    def rates(bounded: bool) -> Any:
        def found(t: float, z: np.ndarray) -> list[float]:
            a, b, p, q, _ = z
            control = -(1 - a * a) * b + a if bounded else -q / 2
            q = -2 * control
            moved = [b, (1 - a * a) * b - a + control, -2 * a + q * (2 * a * b + 1), -2 * b - p - q * (1 - a * a)]
            return [*moved, a * a + b * b + control**2]

        return found

    def simulated(unknown: np.ndarray) -> tuple[np.ndarray, list[float]]:
        costates, entry, leave = unknown[:2], *unknown[2:]
        z, missed = np.array([1.0, 0.0, *costates, 0.0]), list[float]()
        for bounded, times in ((False, (0.0, entry)), (True, (entry, leave)), (False, (leave, 5.0))):
            z = solve_ivp(rates(bounded), times, z, method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
            pushed = -2 * (z[0] - (1 - z[0] ** 2) * z[1])
            if times[1] == entry:
                missed += [z[1] + least, z[3] - pushed]
            z[3] = pushed if bounded else z[3]
        return z, [*missed, z[2], z[3] if least > 0.3 else z[1] + least]

    found = certified(solved(DAMPED, parameters={"l": least}, initial={"x": 1.0, "v": 0.0}, tf=5.0))
    begun = [*np.round(found.found.lam[:, 0], 3), *near]
    shot = root(lambda unknown: simulated(unknown)[1], begun, tol=1e-12)
    z, missed = simulated(shot.x)
    assert np.abs(missed).max() < 1e-9
    assert found.objective == pytest.approx(z[4], rel=1e-9)
    kinds = ["entry", "exit"] if least > 0.3 else ["entry", "exit", "touch"]
    assert [one.kind for one in found.events] == kinds
    assert [one.t for one in found.events[:2]] == pytest.approx(shot.x[2:], abs=1e-7)


@pytest.mark.parametrize("wall", [1 / 9, 0.2])
def test_the_second_variation_of_an_effort_is_that_of_the_control(wall: float):
    """Nothing but u^2 is in it, and where a touch point moves with the variation that makes it larger, not smaller."""
    found = solved("bryson_denham", parameters={"l": wall}, **THERE_AND_BACK).found
    again = replay(found)
    assert again is not None
    assert curvature(found, again) == pytest.approx(1.0, abs=1e-9)


@pytest.mark.slow
def test_along_a_continuation_the_structure_changes():
    case = satsym.Instance.of("bryson_denham", parameters={"l": 0.3}, **THERE_AND_BACK)
    case = case.with_(continuation={"l": [0.3, 0.05]})
    found = certified(satsym.solve(case))
    assert found.objective == pytest.approx(80 / 9, rel=1e-9)
    kinds = {tuple(event.kind for event in one.events) for one in found.found.intermediate}
    assert {(), ("entry", "exit")} <= kinds


@pytest.mark.slow
def test_an_arc_from_which_the_multiplier_lifts_begins_later_after_a_touch_point():
    """Pinned: 0.011195977 by Ipopt on 640 intervals, whose last doubling changed it by a millionth."""
    case = satsym.Instance.of(
        "return_above",
        parameters={"r_min": 0.9946662309934723},
        initial={
            "r": 1.1060166201578943,
            "r_dot": 0.000516680782543,
            "theta": -0.04454054504182,
            "theta_dot": 0.82659681729,
        },
        final=dict.fromkeys(("r", "r_dot", "theta", "theta_dot"), "reference"),
        tf=5.703254505575884,
    )
    found = certified(satsym.solve(case))
    assert found.objective == pytest.approx(0.011195977, rel=5e-6)
    assert [one.kind for one in found.events] == ["touch", "entry", "exit"]


@pytest.mark.parametrize("height", [3e-4, 5e-4])
def test_a_touch_right_before_a_given_end_off_the_boundary_is_not_taken_for_the_end(height: float):
    """The least effort from (1/2, 0) to (h, 1/10) through (0, 0) at the best time."""
    ends = {"initial": {"x": 0.5, "v": 0.0}, "final": {"x": height, "v": 0.1}, "tf": 1.0}
    found = certified(solved(kept("ground", ground=-x), **ends))

    def effort(begin: tuple[float, float], end: tuple[float, float], lasting: float) -> float:
        d, w = end[0] - begin[0] - begin[1] * lasting, end[1] - begin[1]
        return 2 * (3 * d**2 - 3 * d * w * lasting + w**2 * lasting**2) / lasting**3

    best = minimize_scalar(
        lambda time: effort((0.5, 0.0), (0.0, 0.0), time) + effort((0.0, 0.0), (height, 0.1), 1.0 - time),
        bounds=(1.0 - 35 * height, 1.0 - 15 * height),
        options={"xatol": 1e-10},
    )
    assert [one.kind for one in found.events] == ["touch"]
    assert found.events[0].t == pytest.approx(best.x, abs=1e-5)
    assert found.objective == pytest.approx(best.fun, rel=1e-9)
