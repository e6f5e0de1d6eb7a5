"""Vectors that are throttled, and thrust that is singular: against shooting written apart, and closed forms."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from satsym.derivations.examples.transfer_fuel import m, transfer_fuel
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, root
from sympy import Rational, sqrt

from satsym import instance
from satsym.instance import Instance
from satsym.solution import Kind, Solution
from satsym.solvers import solve
from satsym.solvers.certificate import certify
from satsym.solvers.certificate.competitors import comparing
from satsym.solvers.certificate.competitors.comparison import UNCOMPARED
from satsym.solvers.certificate.reintegration.flow import typical
from satsym.solvers.certificate.second_variation import units
from satsym.solvers.certificate.switching.conditions import LATER
from satsym.solvers.certificate.switching.integration import Integration
from satsym.solvers.certificate.switching.replay import replay
from satsym.solvers.certificate.switching.second_variation import form_of
from satsym.solvers.iteration import Limits
from satsym.status import Status, Verdict
from satsym.symbolic import Annulus, Ball, FirstOrder, Problem, Variable, symbols_of
from tests.support.models import build

PRECISE = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-15}


@cache
def shipped(name: str) -> Solution:
    return solve(instance.load(name))


def failed(found: Solution) -> list[str]:
    assert found.certificate is not None
    return [check.name for check in found.certificate.checks if not check.passed]


def cartesian(t: float, y: np.ndarray, thrust: float) -> np.ndarray:
    """Position, velocity, mass and their costates, the primer vector being the costate of the velocity."""
    place, speed, mass, pull, primer = y[:2], y[2:4], y[4], y[5:7], y[7:9]
    distance, size = np.hypot(*place), np.hypot(*primer)
    push = -place / distance**3 - thrust * primer / (size * mass)
    turn = primer / distance**3 - 3.0 * place * (primer @ place) / distance**5
    return np.concatenate([speed, push, [-thrust], turn, -pull, [-thrust * size / mass**2]])


@pytest.mark.slow
def test_the_transfer_of_minimum_fuel_agrees_with_shooting_in_cartesian_coordinates():
    """Coast, burn, coast, burn, coast, burn: ten conditions on five costates and five switching times."""
    radius, angle = 1.5, 8.5
    across, along = np.array([-math.sin(angle), math.cos(angle)]), np.array([math.cos(angle), math.sin(angle)])
    end = np.concatenate([radius * along, across / math.sqrt(radius)])

    def motion(unknown: np.ndarray) -> tuple[np.ndarray, list[float]]:
        y, switching = np.concatenate([[1.0, 0.0, 0.0, 1.0, 1.0], unknown[:5]]), []
        for k, span in enumerate(zip([0.0, *unknown[5:]], [*unknown[5:], 9.0], strict=True)):
            y = solve_ivp(cartesian, span, y, args=(0.1 * (k % 2),), **PRECISE).y[:, -1]
            switching.append(1.0 - y[9] - np.hypot(*y[7:9]) / y[4])
        return y, switching[:-1]

    def missed(unknown: np.ndarray) -> list[float]:
        y, switching = motion(unknown)
        return [*(y[:4] - end), y[9], *switching]

    start = [0.742, -0.076, 0.013, 0.676, 0.254, 0.931, 1.31, 4.502, 5.528, 8.067]
    expected = root(missed, start, tol=1e-13)
    assert np.abs(missed(expected.x)).max() < 1e-12
    found = shipped("transfer-fuel")
    assert found.status is Status.CONVERGED
    assert found.objective == pytest.approx(1.0 - motion(expected.x)[0][4], rel=1e-11)
    assert found.switching_times == (pytest.approx(expected.x[5:], abs=1e-10),) * 2


@pytest.mark.slow
def test_the_transfer_of_minimum_fuel_is_a_strict_minimum():
    found = shipped("transfer-fuel")
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED, failed(found)
    norms = np.hypot(*found.u)
    assert np.minimum(norms, np.abs(norms - 0.1)).max() < 1e-15


@pytest.mark.slow
def test_switching_times_that_are_wrong_fail():
    found = shipped("transfer-fuel")
    moved = tuple((row[0] + 1e-6, *row[1:]) for row in found.switching_times)
    again = certify(replace(found, switching_times=moved))
    assert again is not None
    assert again.verdict is Verdict.FAILED


def drag(h: float, v: float) -> float:
    return 310.0 * v * v * math.exp(-500.0 * (h - 1.0))


def rocket(thrust: object) -> object:
    def rates(t: float, y: np.ndarray) -> list[float]:
        h, v, mass = y
        force = thrust(y) if callable(thrust) else thrust
        return [v, (force - drag(h, v)) / mass - 1.0 / h**2, -2.0 * force]

    return rates


def surface(y: np.ndarray) -> float:
    """D (1 + v / c) = m g, where the thrust is singular, the final time being free."""
    h, v, mass = y
    return drag(h, v) * (1.0 + 2.0 * v) - mass / h**2


def on_the_surface(y: np.ndarray) -> float:
    """The thrust that keeps the former at zero."""
    h, v, mass = y
    d = drag(h, v)
    by_h, by_v, by_mass = -500.0 * d * (1.0 + 2.0 * v) + 2.0 * mass / h**3, d * (2.0 / v + 6.0), -1.0 / h**2
    return -(by_h * v - by_v * (d / mass + 1.0 / h**2)) / (by_v / mass - 2.0 * by_mass)


def on_the_boundary(y: np.ndarray) -> float:
    """The thrust that keeps v^2 exp(-500 (h - 1)) as it is."""
    h, v, mass = y
    return mass * (250.0 * v**2 + 1.0 / h**2) + drag(h, v)


def simulated(
    legs: Sequence[tuple[Any, Callable[[np.ndarray], float], tuple[float, float]]],
) -> tuple[np.ndarray, list[float]]:
    """Where legs lead, each until its event, and when that is."""
    y, t, times = np.array([1.0, 0.0, 1.0]), 0.0, []
    for rates, event, around in legs:

        def at(end: float, rates: Any = rates, t: float = t, y: np.ndarray = y) -> np.ndarray:
            return solve_ivp(rates, (t, end), y, **PRECISE).y[:, -1]

        t = brentq(lambda end, at=at, event=event: event(at(end)), *around, xtol=1e-16)
        y = at(t)
        times.append(t)
    return y, times


@pytest.mark.slow
def test_with_bounded_pressure_goddards_rocket_keeps_to_the_bound_until_it_follows_the_singular_surface():
    """Half the initial weight of drag, then the surface, 0.6 of the mass, and the top: nothing has to be iterated."""
    legs = (
        (rocket(3.5), lambda y: drag(y[0], y[1]) - 0.5, (0.01, 0.02)),
        (rocket(on_the_boundary), surface, (0.06, 0.08)),
        (rocket(on_the_surface), lambda y: y[2] - 0.6, (0.075, 0.08)),
        (rocket(0.0), lambda y: y[1], (0.19, 0.21)),
    )
    y, times = simulated(legs)
    found = shipped("goddard-pressure")
    assert found.status is Status.CONVERGED
    assert -found.objective == pytest.approx(y[0], rel=1e-12)
    assert (*found.switching_times[0], found.times[-1]) == pytest.approx(times, rel=1e-8)
    assert [(one.kind, one.t) for one in found.events] == [
        ("entry", pytest.approx(times[0], rel=1e-8)),
        ("exit", pytest.approx(times[1], rel=1e-8)),
    ]
    assert not failed(found)


@pytest.mark.slow
def test_thrust_that_comes_to_its_bound_on_the_boundary_stays_there_until_the_fuel_is_spent():
    """At a pressure of 9 the bound on thrust is met before the singular surface: costates jump there."""
    legs = (
        (rocket(3.5), lambda y: drag(y[0], y[1]) - 0.45, (0.01, 0.02)),
        (rocket(on_the_boundary), lambda y: on_the_boundary(y) - 3.5, (0.07, 0.09)),
        (rocket(3.5), lambda y: y[2] - 0.6, (0.0815, 0.09)),
        (rocket(0.0), lambda y: y[1], (0.19, 0.22)),
    )
    y, times = simulated(legs)
    case = instance.load("goddard-pressure")
    lower = tuple(
        9.0 if one.symbol == "q_max" else p for one, p in zip(case.model.spec.parameters, case.parameters, strict=True)
    )
    found = solve(replace(case, parameters=lower))
    assert -found.objective == pytest.approx(y[0], rel=1e-12)
    assert (*found.switching_times[0], found.times[-1]) == pytest.approx(times, rel=1e-8)
    assert failed(found) == ["not resolved: second variation where costates jump"]


@pytest.mark.slow
def test_goddards_rocket_agrees_with_events_alone():
    """Full thrust up to the singular surface, along it until 0.6 of the mass is left, and a coast to the top."""
    legs = (
        (rocket(3.5), surface, (0.02, 0.03)),
        (rocket(on_the_surface), lambda y: y[2] - 0.6, (0.06, 0.08)),
        (rocket(0.0), lambda y: y[1], (0.19, 0.21)),
    )
    y, times = simulated(legs)
    found = shipped("goddard")
    assert found.status is Status.CONVERGED
    assert -found.objective == pytest.approx(y[0], rel=1e-11)
    assert y[0] == pytest.approx(1.01284, abs=5e-6)
    assert (*found.switching_times[0], found.times[-1]) == pytest.approx(times, rel=1e-8)
    assert not failed(found)


PLACE = tuple(Variable(name, name) for name in ("x", "y", "vx", "vy"))
PUSH = tuple(Variable(name, name) for name in ("ux", "uy"))
x, y, vx, vy = symbols_of(PLACE)
ux, uy = symbols_of(PUSH)


def pushed(name: str, rates: dict[object, object], **fields: object) -> Problem:
    states = tuple(v for v in PLACE if symbols_of((v,))[0] in rates)
    model = FirstOrder(name=f"{name}_point", title="A point", states=states, controls=PUSH, parameters=(), rates=rates)
    sets = {"control_sets": {"thrust": Ball("ux", "uy")}}
    return Problem(name=name, title="Pushed", model=model, running_cost=sqrt(ux**2 + uy**2), **{**sets, **fields})


FREELY = {x: vx, y: vy, vx: ux, vy: uy}
BETWEEN = """
[initial]
x = 0.0
y = 0.0
vx = 0.0
vy = 0.0
[final]
x = 1.0
y = 2.0
vx = 0.0
vy = 0.0
[time]
t0 = 3.0
tf = 10.0
[control.thrust]
max_norm = 1.0
"""


@pytest.mark.slow
def test_a_point_is_pushed_coasts_and_is_stopped(tmp_path: Path):
    """In a time T over a distance d with thrust one each push lasts b with b (T - b) = d, and costs that."""
    burn = (7.0 - math.sqrt(49.0 - 4.0 * math.sqrt(5.0))) / 2.0
    found = solve(build(tmp_path, pushed("stopped", FREELY), BETWEEN))
    assert found.objective == pytest.approx(2.0 * burn, rel=1e-11)
    assert found.switching_times[0] == pytest.approx((3.0 + burn, 10.0 - burn), abs=1e-10)
    assert failed(found) == []


@pytest.mark.slow
def test_fuel_alone_has_no_minimiser_in_a_free_time_and_has_one_where_time_is_weighed(tmp_path: Path):
    """The longer it takes the shorter are the pushes; with a weight w of time T / sqrt(T^2 - 4 d) = 1 + w."""
    free = BETWEEN.replace("tf = 10.0", 'tf = "free"')
    endless = solve(build(tmp_path, pushed("endless", FREELY), free))
    assert endless.status is Status.NO_MINIMISER, endless.message
    assert "a longer duration is always cheaper: cost" in endless.message
    weight, d = 0.1, math.sqrt(5.0)
    weighed = replace(pushed("timed", FREELY), running_cost=sqrt(ux**2 + uy**2) + weight)
    timed = solve(build(tmp_path, weighed, free))

    def cost(duration: float) -> float:
        return duration - math.sqrt(duration**2 - 4.0 * d) + weight * duration

    best = (1.0 + weight) * math.sqrt(4.0 * d / ((1.0 + weight) ** 2 - 1.0))
    assert cost(best) < min(cost(0.99 * best), cost(1.01 * best))
    assert timed.times[-1] - 3.0 == pytest.approx(best, rel=1e-9)
    assert timed.objective == pytest.approx(cost(best), rel=1e-11)
    assert failed(timed) == []


@pytest.mark.slow
def test_a_vector_in_an_annulus_has_its_least_or_its_largest_norm(tmp_path: Path):
    ring = pushed("ring", FREELY, control_sets={"thrust": Annulus("ux", "uy")})
    start = BETWEEN.replace("vy = 0.0\n[final]", "vy = 0.3\n[final]").replace("x = 1.0", "x = 2.0")
    found = solve(build(tmp_path, ring, start + "min_norm = 0.05\n"))
    free = solve(build(tmp_path, pushed("disc", FREELY), start))
    norms = np.hypot(*found.u)
    assert found.objective > free.objective
    assert np.minimum(np.abs(norms - 0.05), np.abs(norms - 1.0)).max() < 1e-14
    assert failed(found) == []


@pytest.mark.study
def test_a_norm_that_nothing_decides_has_no_strict_minimum(tmp_path: Path):
    """A velocity that is steered: any course at any speeds along the straight line costs its length.

    A body that falls straight down needs the same impulse however it is spread over the time.
    """
    text = BETWEEN.replace("vx = 0.0\nvy = 0.0\n", "")
    found = solve(build(tmp_path, pushed("steered", {x: ux, y: uy}), text))
    assert found.objective == pytest.approx(np.sqrt(5.0), rel=1e-12)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.EXTREMAL_ONLY
    assert found.certificate.because == "not strict: other controls have the same cost"
    falling = pushed("falling", {x: vx, y: vy, vx: ux, vy: uy - Rational("1.62")})
    down = """
        [initial]
        x = 0.0
        y = 100.0
        vx = 0.0
        vy = -5.0
        [final]
        y = 0.0
        vx = 0.0
        vy = 0.0
        [time]
        tf = 12.0
        [control]
        max_norm = 4.0
        """
    found = solve(build(tmp_path, falling, down))
    assert found.status is Status.NOT_CONVERGED
    assert "no law is known for the norm of a vector on an interval" in found.message


@pytest.mark.study
def test_a_transfer_that_may_begin_at_any_time_is_no_strict_minimum():
    """From circle to circle with time to spare and the place on the second one left open."""
    met = instance.load("transfer-fuel")
    found = solve(replace(met, final={k: v for k, v in met.final.items() if k != "theta"}))
    assert found.status is Status.CONVERGED
    assert failed(found) == ["second variation with respect to arc lengths and directions", LATER.name]


@pytest.mark.study
def test_fuel_may_be_what_is_left_at_the_end(tmp_path: Path):
    left = replace(transfer_fuel, name="left", running_cost=0, terminal_cost=-m)
    met: Instance = instance.load("transfer-fuel")
    stated = build(tmp_path, left, met.path.read_text(encoding="utf-8").split("\n", 2)[2])
    found = solve(stated)
    assert found.objective == pytest.approx(shipped("transfer-fuel").objective - 1.0, rel=1e-11)
    assert failed(found) == []


@pytest.mark.study
def test_full_thrust_all_the_time_needs_no_switches(tmp_path: Path):
    hurried = replace(transfer_fuel, name="hurried", running_cost=transfer_fuel.running_cost / 10 + 1)
    text = instance.load("transfer-fuel").path.read_text(encoding="utf-8").split("\n", 2)[2]
    found = solve(build(tmp_path, hurried, text.replace("tf = 9.0", 'tf = "free"').replace("theta = 8.5\n", "")))
    assert found.method == "collocation"
    assert found.objective == pytest.approx(1.01 * found.times[-1], rel=1e-10)
    assert failed(found) == []


def critical_gain() -> float:
    """The weight of y^2 from which on leaving the straight line pays: the smallest eigenvalue, by piecewise constants.

    From rest to rest over 2 in a time 4: |primer| = |t - 2| / (2 - b) weighs turns w on the burns, and y'' = w there.
    """
    burn, pieces = 2.0 - math.sqrt(2.0), 200
    h = burn / pieces
    middles = (np.arange(pieces) + 0.5) * h
    middles = np.concatenate([middles, 4.0 - burn + middles])
    times = np.linspace(0.0, 4.0, 2001)
    moved = np.maximum(times[:, None] - middles, 0.0) * h
    free = np.linalg.svd([moved[-1], np.full(len(middles), h)])[2][2:].T
    cost = free.T * (np.abs(middles - 2.0) / (2.0 - burn) * h) @ free
    gained = (moved @ free).T @ (moved @ free) * (times[1] - times[0])
    return 1.0 / float(np.linalg.eigvals(np.linalg.solve(cost, gained)).real.max())


@pytest.mark.slow
def test_a_minimum_ends_where_leaving_the_straight_line_pays(tmp_path: Path):
    """The straight way satisfies the minimum principle whatever y^2 earns."""
    gain = Variable("q", "q", default=0.0)
    straight = pushed("straight", FREELY)
    problem = replace(
        straight,
        model=replace(straight.model, parameters=(gain,)),
        running_cost=straight.running_cost - symbols_of((gain,))[0] * y**2 / 2,
    )
    text = BETWEEN.replace("x = 1.0\ny = 2.0", "x = 2.0\ny = 0.0").replace("t0 = 3.0\ntf = 10.0", "tf = 4.0")
    found = solve(build(tmp_path, problem, text))
    assert failed(found) == []
    critical = critical_gain()
    for share in (0.97, 1.03):
        again = certify(replace(found, instance=replace(found.instance, parameters=(share * critical,))))
        assert again is not None
        passed = {check.name: check.passed for check in again.checks}
        assert passed["stationarity"]
        assert passed["second variation with respect to arc lengths and directions"] == (share < 1.0)


@pytest.mark.slow
def test_the_form_in_the_lengths_of_arcs_is_that_of_differences(tmp_path: Path):
    """A spring along the way; costs and what the end misses, weighed with its costates, over other lengths."""
    sprung = pushed("sprung", {**FREELY, vx: ux - x / 2, vy: uy - y / 2})
    text = BETWEEN.replace("x = 1.0\ny = 2.0", "x = 2.0\ny = 0.0").replace("t0 = 3.0\ntf = 10.0", "tf = 4.0")
    found = solve(build(tmp_path, sprung, text.replace("max_norm = 1.0", "max_norm = 1.5")))
    again = replay(found)
    assert again is not None
    lengths = np.array([piece.end - piece.start for piece in again.pieces])
    thrusts = [float(piece.field.control(piece.start, piece.before.tolist())[0]) for piece in again.pieces]

    def merit(change: np.ndarray) -> float:
        z = np.zeros(2)
        for thrust, length in zip(thrusts, lengths + change, strict=True):
            z = solve_ivp(lambda t, s, u=thrust: [s[1], u - s[0] / 2.0], (0.0, length), z, **PRECISE).y[:, -1]
        burned = sum(abs(u) * length for u, length in zip(thrusts, lengths + change, strict=True))
        return float(burned + found.lam[[0, 2], -1] @ z)

    step, unit = 1e-3, np.eye(len(lengths))
    hessian = [
        [sum(s * r * merit(step * (s * a + r * b)) for s in (-1, 1) for r in (-1, 1)) / (2.0 * step) ** 2 for a in unit]
        for b in unit
    ]
    by = Integration(np.concatenate(typical(found)), Limits(10**6, math.inf))
    form, cost = form_of(found, again, by, 20).form, units(found, typical(found)[0])[1]
    in_lengths = 2.0 * cost * form[: len(lengths), : len(lengths)] / 4.0**2
    assert in_lengths == pytest.approx(np.array(hessian), rel=1e-4, abs=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("arrived", [0, 1])
def test_what_no_competitor_that_arrived_was_compared_with_is_not_certified(
    arrived: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = shipped("transfer-fuel")
    cheapest = found.objective if arrived else math.nan
    monkeypatch.setattr(comparing, "searched", lambda *_: ({Kind.STARTS: [math.nan, cheapest]}, None, set()))
    again = certify(found)
    assert again is not None
    assert [check.name for check in again.checks if not check.passed] == ([] if arrived else [UNCOMPARED])
    assert again.verdict is (Verdict.CERTIFIED if arrived else Verdict.EXTREMAL_ONLY)
    assert (Kind.STARTS in again.not_checked) is not bool(arrived)
