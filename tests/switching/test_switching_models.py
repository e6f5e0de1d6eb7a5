"""Exact switching times of other motions: several switches, several controls, nonlinear ones, singular arcs."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from sympy import Expr, Integer, sin

from satsym import solvers as solve
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers.switching.solving import refuse
from satsym.status import BadInput, Status
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from tests.support.models import build

NAMES = ("x", "y", "v", "w")
x, y, v, w = symbols_of(Variable(name, name) for name in NAMES)


def problem(name: str, rates: dict[object, Expr], cost: Expr, controls: Sequence[str]) -> Problem:
    """A problem with states x and y (as many as have rates) in a box."""
    return Problem(
        name=name,
        title=name,
        model=FirstOrder(
            name=f"{name}_motion",
            title=name,
            states=tuple(Variable(s, s) for s in NAMES[: len(rates)]),
            controls=tuple(Variable(c, c) for c in controls),
            parameters=(),
            rates=rates,
        ),
        running_cost=cost,
        control_set="box",
    )


def case(folder: Path, one: Problem, initial: Sequence[float], final: Sequence[float] | None, tf: str) -> Instance:
    """An instance with all controls between -1 and 1."""
    states = [variable.symbol for variable in one.model.states]
    lines = ["[initial]", *(f"{s} = {value!r}" for s, value in zip(states, initial, strict=True))]
    if final is not None:
        lines += ["[final]", *(f"{s} = {value!r}" for s, value in zip(states, final, strict=True))]
    lines += ["[time]", f"tf = {tf}", "[control]", *(f"{c.symbol} = [-1.0, 1.0]" for c in one.model.controls)]
    return build(folder, one, "\n".join(lines) + "\n")


FREE = '"free"'
OSCILLATOR = problem("oscillator", {x: y, y: -x + v}, Integer(1), ("v",))
PENDULUM = problem("pendulum", {x: y, y: -sin(x) + v}, Integer(1), ("v",))
TWO = problem("two_thrusters", {x: y + w, y: -x + v}, Integer(1), ("v", "w"))


def test_a_deviation_that_begins_at_zero_costs_something(tmp_path: Path):
    """Fuller's problem from (0, 1): no state along a multiple of this start costs anything."""
    fuller = problem("fuller", {x: y, y: v}, x**2 / 2, ("v",))
    refuse(case(tmp_path, fuller, (0.0, 1.0), (0.0, 0.0), "5.0"))
    nothing = problem("nothing", {x: y, y: v}, Integer(1), ("v",))
    with pytest.raises(BadInput, match="with a given final time, all controls have the same cost"):
        refuse(case(tmp_path, nothing, (0.0, 1.0), (0.0, 0.0), "5.0"))


def backwards(rates: Callable[[np.ndarray, float], list[float]], arcs: Sequence[tuple[float, float]]) -> list[float]:
    """The state from which arcs of (control, length) lead to rest at the origin."""
    state = np.zeros(2)
    for control, length in reversed(arcs):
        state = solve_ivp(
            lambda _t, z, u=control: rates(z, u), (length, 0.0), state, method="DOP853", rtol=1e-13, atol=1e-14
        ).y[:, -1]
    return [float(value) for value in state]


@pytest.mark.slow
@pytest.mark.parametrize(
    "arcs",
    [
        (0.7, 1.1),
        (0.4, math.pi, 2.0),
        pytest.param((2.5, math.pi, math.pi, 0.9), marks=pytest.mark.slow),
    ],
)
def test_an_oscillator_switches_every_half_period(tmp_path: Path, arcs: tuple[float, ...]) -> None:
    # Bushaw: the switching function is a sine, so that arcs last pi but for a shorter first and last one.
    signs = [(-1.0) ** k for k in range(len(arcs))]
    start = backwards(lambda z, u: [z[1], -z[0] + u], list(zip(signs, arcs, strict=True)))
    found = solve.solve(case(tmp_path, OSCILLATOR, start, (0.0, 0.0), FREE))
    assert found.status is Status.CONVERGED, found.message
    assert found.objective == pytest.approx(sum(arcs), abs=1e-9)
    assert found.switching_times[0] == pytest.approx(np.cumsum(arcs)[:-1], abs=1e-10)
    assert_certified(found)


def test_a_pendulum_is_brought_to_rest_with_the_arcs_it_was_led_away_by(tmp_path: Path) -> None:
    arcs = [(-1.0, 0.9), (1.0, 1.2)]
    start = backwards(lambda z, u: [z[1], -math.sin(z[0]) + u], arcs)
    found = solve.solve(case(tmp_path, PENDULUM, start, (0.0, 0.0), FREE))
    assert found.status is Status.CONVERGED, found.message
    assert found.objective == pytest.approx(2.1, abs=1e-9)
    assert found.switching_times[0] == pytest.approx((0.9,), abs=1e-10)
    assert_certified(found)


@pytest.mark.slow
def test_two_controls_switch_each_at_its_own_times(tmp_path: Path) -> None:
    # Costates of the rotation turn with it: with the final ones at an angle, both switching functions are sines.
    angle, duration = 0.6, 2.4

    def costates(t: float) -> tuple[float, float]:
        back = t - duration
        return math.cos(angle + back), -math.sin(angle + back)  # l_x' = l_y, l_y' = -l_x

    switches: list[list[float]] = []
    for part in (1, 0):  # v acts on y, w on x
        grid = np.linspace(0.0, duration, 500)
        values = [costates(t)[part] for t in grid]
        switches.append(
            [
                brentq(lambda t, part=part: costates(t)[part], grid[k], grid[k + 1], xtol=1e-15)
                for k in range(len(grid) - 1)
                if values[k] * values[k + 1] < 0.0
            ]
        )
    edges = sorted({0.0, *switches[0], *switches[1], duration})
    state = np.zeros(2)
    for start, end in reversed(list(itertools.pairwise(edges))):
        lx, ly = costates((start + end) / 2.0)
        u, q = -math.copysign(1.0, ly), -math.copysign(1.0, lx)
        state = solve_ivp(
            lambda _t, z, u=u, q=q: [z[1] + q, -z[0] + u], (end, start), state, method="DOP853", rtol=1e-13, atol=1e-14
        ).y[:, -1]
    found = solve.solve(case(tmp_path, TWO, state.tolist(), (0.0, 0.0), FREE))
    assert found.status is Status.CONVERGED, found.message
    assert found.objective == pytest.approx(duration, abs=1e-9)
    for own, known in zip(found.switching_times, switches, strict=True):
        assert own == pytest.approx(known, abs=1e-10)
    assert sum(map(len, switches)) >= 2
    assert_certified(found)


@pytest.mark.study
def test_an_orbit_is_raised_in_least_time_by_two_thrusters(tmp_path: Path) -> None:
    states = (Variable("r", "r", positive=True), Variable("r_dot", "s"), Variable("rotation", "n"))
    controls = (Variable("radial", "a"), Variable("tangential", "b"))
    r, r_dot, rotation, radial, tangential = symbols_of((*states, *controls))
    raising = Problem(
        name="raising",
        title="From one circular orbit to another",
        model=FirstOrder(
            name="raising_motion",
            title="Polar motion without the angle",
            states=states,
            controls=controls,
            parameters=(),
            rates={
                r: r_dot,
                r_dot: r * rotation**2 - 1 / r**2 + radial,
                rotation: (tangential - 2 * r_dot * rotation) / r,
            },
        ),
        running_cost=Integer(1),
        control_set="box",
    )
    goal = (1.1, 0.0, 1.1**-1.5)
    text = (
        "[initial]\nr = 1.0\nr_dot = 0.0\nrotation = 1.0\n"
        f"[final]\nr = {goal[0]}\nr_dot = {goal[1]}\nrotation = {goal[2]!r}\n"
        '[time]\ntf = "free"\n[control]\nradial = [-0.05, 0.05]\ntangential = [-0.05, 0.05]\n'
    )
    found = solve.solve(build(tmp_path, raising, text))
    assert found.status is Status.CONVERGED, found.message
    assert_certified(found)
    # The controls as constants between their switching times, simulated by other means, lead to the goal.
    edges = sorted({0.0, float(found.times[-1]), *(t for own in found.switching_times for t in own)})
    state = np.array([1.0, 0.0, 1.0])
    for start, end in pairwise(edges):
        a, b = found.u[:, int(np.searchsorted(found.times, (start + end) / 2.0))]
        assert {abs(a), abs(b)} == {0.05}
        state = solve_ivp(
            lambda _t, z, a=a, b=b: [z[1], z[0] * z[2] ** 2 - 1.0 / z[0] ** 2 + a, (b - 2.0 * z[1] * z[2]) / z[0]],
            (start, end),
            state,
            method="DOP853",
            rtol=1e-13,
            atol=1e-14,
        ).y[:, -1]
    assert state == pytest.approx(goal, abs=1e-11)


def test_a_regulator_that_costs_nothing_stays_at_zero_once_there(tmp_path: Path) -> None:
    regulator = problem("regulator", {x: v}, x**2 / 2, ("v",))
    found = solve.solve(case(tmp_path, regulator, (1.2,), None, "3.0"))
    assert found.status is Status.CONVERGED, found.message
    assert found.switching_times[0] == pytest.approx((1.2,), abs=1e-9)
    assert found.objective == pytest.approx(1.2**3 / 6.0, abs=1e-9)
    assert np.abs(found.u[0, found.times > 1.2 + 1e-9]).max() < 1e-9
    assert_certified(found)
    assert found.certificate is not None
    assert found.certificate.legendre_clebsch == pytest.approx(1.0, abs=1e-9)


def test_a_singular_arc_follows_its_feedback(tmp_path: Path) -> None:
    # On the singular arc the costate of y vanishes with its rates: l_x = -y, u = x, x'' = x, and l_x = 0 at the free
    # end, so x = C cosh(T - t), y = -C sinh(T - t). It is met along the first arc with u = -1.
    regulator = problem("damper", {x: y, y: v}, (x**2 + y**2) / 2, ("v",))
    start, duration = (1.0, 0.5), 4.0
    met = brentq(
        lambda t: (
            (start[1] - t) * math.cosh(duration - t) + (start[0] + start[1] * t - t * t / 2.0) * math.sinh(duration - t)
        ),
        0.5,
        3.0,
        xtol=1e-15,
    )
    found = solve.solve(case(tmp_path, regulator, start, None, str(duration)))
    assert found.status is Status.CONVERGED, found.message
    assert found.switching_times[0] == pytest.approx((met,), abs=1e-9)
    after = found.times > met + 1e-9
    assert found.u[0, after] == pytest.approx(found.x[0, after], abs=1e-8)
    assert_certified(found)


def test_a_singular_arc_of_a_problem_that_is_not_convex_has_a_second_variation(tmp_path: Path) -> None:
    # The way to zero takes sqrt(10) atan(x / sqrt(10)); the control acts more strongly where x is large.
    regulator = problem("uneven", {x: v * (1 + x**2 / 10)}, x**2 / 2, ("v",))
    found = solve.solve(case(tmp_path, regulator, (1.2,), None, "3.0"))
    assert found.status is Status.CONVERGED, found.message
    assert found.switching_times[0] == pytest.approx((math.sqrt(10.0) * math.atan(1.2 / math.sqrt(10.0)),), abs=1e-9)
    assert found.certificate is not None
    assert found.certificate.verdict == "certified"
    assert found.certificate.legendre_clebsch == pytest.approx(1.0, abs=1e-9)
    assert "Goh" in found.certificate.because


@pytest.mark.slow
def test_an_extremal_is_found_again_from_any_of_its_points(tmp_path: Path) -> None:
    # Bellman: what is left of an optimum is optimal.
    base = case(tmp_path, PENDULUM, (2.0, 1.0), (0.0, 0.0), FREE)
    whole = solve.solve(base)
    assert whole.status is Status.CONVERGED, whole.message
    for fraction in (0.2, 0.5, 0.9):
        k = int(fraction * len(whole.times))
        rest = solve.solve(replace(base, initial=tuple(whole.x[:, k].tolist())))
        assert rest.objective == pytest.approx(whole.objective - whole.times[k], abs=1e-9)


def assert_certified(found: Solution) -> None:
    assert found.certificate is not None
    assert found.certificate.verdict == "certified", [c for c in found.certificate.checks if not c.passed]
