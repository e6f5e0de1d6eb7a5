"""Ascents from the Moon, where only the final mass counts: against shooting that is written apart."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import root
from sympy import Expr, Float, cos, sin, sqrt

from satsym.instance import Instance
from satsym.solvers import solve
from satsym.status import Status, Verdict
from satsym.symbolic import Angle, FirstOrder, Problem, Variable, symbols_of
from tests.support.models import build

STATES = tuple(Variable(name, name, positive=name in ("r", "m")) for name in ("r", "v_r", "v_t", "m"))
r, v_r, v_t, m = symbols_of(STATES)
THRUST, FLOW = 2.009328897, 1.0 / 1.815715
"""In units of the Moon's radius, of the speed of its circular orbit and of the mass at the start: the largest thrust,
and the mass that flows for each unit of it."""

START, END = (1.0, 0.0, 0.0, 1.0), (1.01065, 0.0, 1.00425)
TEXT = """
[initial]
r = 1.0
v_r = 0.0
v_t = 0.0
m = 1.0
[final]
r = 1.01065
v_r = 0.0
v_t = 1.00425
[time]
"""
PRECISE = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13}


def motion(controls: dict[str, Literal["real", "angle"]], up: Expr, along: Expr, size: Expr) -> FirstOrder:
    names = tuple(Variable(name, name, kind=kind) for name, kind in controls.items())
    rates = {r: v_r, v_r: v_t**2 / r - 1 / r**2 + up / m, v_t: -v_r * v_t / r + along / m, m: -FLOW * size}
    return FirstOrder(name="ascending", title="A", states=STATES, controls=names, parameters=(), rates=rates)


def steered(folder: Path) -> Instance:
    """The thrust is turned only."""
    (angle,) = symbols_of((Variable("b", "b", kind="angle"),))
    moving = motion({"b": "angle"}, THRUST * sin(angle), THRUST * cos(angle), Float(THRUST))
    problem = Problem(
        name="steered",
        title="T",
        model=moving,
        running_cost=0,
        terminal_cost=m,
        maximise=True,
        control_sets={"b": Angle("b")},
    )
    return build(folder, problem, f'{TEXT}tf = "free"\ntf_guess = 0.43\n')


def throttled(folder: Path) -> Instance:
    """It is throttled as well."""
    up, along = symbols_of((Variable("p", "p"), Variable("s", "s")))
    moving = motion({"p": "real", "s": "real"}, up, along, sqrt(up**2 + along**2))
    problem = Problem(
        name="throttled", title="T", model=moving, running_cost=0, terminal_cost=m, maximise=True, control_set="ball"
    )
    return build(folder, problem, f"{TEXT}tf = 0.435\n[control]\nmax_norm = {THRUST}\n")


def rates(_: float, z: np.ndarray, thrust: float) -> list[float]:
    """States, the costates of the first three, and how far the motion is from a switch."""
    radius, up, along, mass, a, b, c, _ = z
    size = np.hypot(b, c)
    pull = [
        b * (along**2 / radius**2 - 2.0 / radius**3) - c * up * along / radius**2,
        -a + c * along / radius,
        -2.0 * b * along / radius + c * up / radius,
    ]
    return [
        up,
        along**2 / radius - 1.0 / radius**2 - thrust * b / (size * mass),
        -up * along / radius - thrust * c / (size * mass),
        -FLOW * thrust,
        *pull,
        (b * pull[1] + c * pull[2]) / (size * mass),  # |p| / m less FLOW times the costate of the mass, whatever burns
    ]


def moved(costates: np.ndarray, arcs: list[tuple[float, float]]) -> tuple[np.ndarray, list[float]]:
    """The end, and how much the switching function has grown at the end of each arc of a duration and a thrust."""
    z, grown = np.array([*START, *costates, 0.0]), []
    for duration, thrust in arcs:
        z = solve_ivp(rates, (0.0, duration), z, args=(thrust,), **PRECISE).y[:, -1]
        grown.append(float(z[7]))
    return z, grown


@pytest.mark.slow
def test_the_least_mass_is_burnt_where_only_the_end_costs(tmp_path: Path) -> None:
    """All thrust all the time: the costates' size is free, and the Hamiltonian of the least time vanishes."""

    def missed(unknown: np.ndarray) -> np.ndarray:
        return moved(np.array([unknown[0], unknown[1], -1.0]), [(unknown[2], THRUST)])[0][:3] - END

    expected = root(missed, [-3.0, -0.9, 0.406], tol=1e-13)
    assert expected.success
    found = solve(steered(tmp_path))
    assert found.status is Status.CONVERGED, found.message
    assert found.times[-1] == pytest.approx(expected.x[2], rel=1e-9)
    assert found.objective == pytest.approx(-(1.0 - FLOW * THRUST * expected.x[2]), rel=1e-9)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED


def coasted(start: np.ndarray, end: float) -> tuple[float, np.ndarray]:
    """Burn, coast, burn, from costates of two states and two times: the objective and the times."""

    def missed(unknown: np.ndarray) -> list[float]:
        first, second = unknown[2:]
        arcs = [(first, THRUST), (second - first, 0.0), (end - second, THRUST)]
        z, grown = moved(np.array([unknown[0], unknown[1], -1.0]), arcs)
        return [*(z[:3] - END), grown[1] - grown[0]]

    found = root(missed, start, tol=1e-13).x
    assert np.abs(missed(found)).max() < 1e-10
    return FLOW * THRUST * (end - found[3] + found[2]) - 1.0, found[2:]


@pytest.mark.slow
def test_hardly_any_time_to_spare_is_no_failure(tmp_path: Path) -> None:
    """In a coast so short the switching function is flat: its sign tells the times of the switches to nine digits."""
    end = 0.40609721
    found = solve(replace(throttled(tmp_path), tf=end))
    lam = found.lam[:, 0] / abs(found.lam[2, 0])
    least, switches = coasted(np.array([*lam[:2], *found.switching_times[0]]), end)
    assert found.objective == pytest.approx(least, rel=1e-9)
    assert found.switching_times[0] == pytest.approx(switches, abs=1e-7)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.EXTREMAL_ONLY
    failed = [check.name for check in found.certificate.checks if not check.passed]
    assert failed == ["second variation with respect to arc lengths and directions"]


@pytest.mark.study
def test_little_time_to_spare_makes_a_short_coast_and_less_than_the_least_is_infeasible(tmp_path: Path) -> None:
    """Burn, coast, burn: the switching function is as large at the end of the coast as at its start."""
    case = throttled(tmp_path)
    found = solve(case)
    assert found.status is Status.CONVERGED, found.message
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED, found.certificate.checks

    lam = found.lam[:, 0] / abs(found.lam[2, 0])
    least, switches = coasted(np.array([*lam[:2], 0.36, 0.39]), 0.435)
    assert found.objective == pytest.approx(least, rel=1e-9)
    assert found.switching_times[0] == pytest.approx(switches, abs=1e-8)
    hurried = solve(replace(case, tf=0.38))
    assert hurried.status is Status.INFEASIBLE, hurried.message
    assert "the best of 8 local searches misses" in hurried.message
    assert np.isnan(hurried.x).all()
