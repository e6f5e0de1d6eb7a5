"""Singular arcs so long that one flow along them loses its way: against flows written apart."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import root
from sympy import Rational

from satsym.instance import Instance
from satsym.solvers import solve
from satsym.solvers.certificate.switching.replay import replay
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.answers import answered
from satsym.solvers.switching.attempt import attempt
from satsym.solvers.switching.structure import LOWER, SINGULAR, UPPER, Course, Guess, Structure
from satsym.status import Status, Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from tests.support.models import build

STATES, CONTROLS = (Variable("a", "a"), Variable("b", "b")), (Variable("w", "w"),)
a, b = symbols_of(STATES)
(w,) = symbols_of(CONTROLS)

FISHING = Problem(
    name="fishing",
    title="Two species that are fished such that they come to their equilibrium",
    model=FirstOrder(
        name="lotka_volterra",
        title="Prey and predators",
        states=STATES,
        controls=CONTROLS,
        parameters=(),
        rates={a: a - a * b - Rational("0.4") * a * w, b: -b + a * b - Rational("0.2") * b * w},
    ),
    running_cost=(a - 1) ** 2 + (b - 1) ** 2,
    control_set="box",
)

END, NODES, NUDGE = 12.0, 41, 1e-30
LIMITS = Limits(1000, float("inf"))
Rates = Callable[[float, np.ndarray], np.ndarray]


def fished(t: float, z: np.ndarray, rate: float) -> np.ndarray:
    """Species, what has been added up, and costates."""
    x, y, _, p, q = z
    f = x - x * y - 0.4 * x * rate, -y + x * y - 0.2 * y * rate
    cost = (x - 1.0) ** 2 + (y - 1.0) ** 2
    back = p * (1.0 - y - 0.4 * rate) + q * y + 2.0 * (x - 1.0)
    down = -p * x + q * (x - 1.0 - 0.2 * rate) + 2.0 * (y - 1.0)
    return np.array([*f, cost, -back, -down])


def costate(x: complex, y: complex) -> complex:
    """That of the prey where the switching function and its rate vanish; that of the predators is -2 x / y of it."""
    return (0.8 * x * (x - 1.0) + 0.4 * y * (y - 1.0)) / (0.2 * x * y + 0.8 * x * x)


def on_singular(z: np.ndarray) -> np.ndarray:
    p = costate(z[0], z[1])
    return np.array([*z[:3], p, -2.0 * z[0] / z[1] * p])


def singular_rate(z: np.ndarray) -> float:
    """The rate of fishing with which the costate stays so."""
    both = on_singular(z)
    misfit = []
    for rate in (0.0, 1.0):
        f = fished(0.0, both, rate)
        along = costate(z[0] + 1j * NUDGE * f[0], z[1] + 1j * NUDGE * f[1]).imag / NUDGE
        misfit.append(along - f[3])
    return misfit[0] / (misfit[0] - misfit[1])


def simulated(start: float, end: float, z: np.ndarray, rates: Rates) -> np.ndarray:
    """At some times on the way, shape (5, N)."""
    times = np.linspace(start, end, NODES)
    return solve_ivp(rates, (start, end), z, method="DOP853", t_eval=times, rtol=1e-12, atol=1e-13).y


def motion(times: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """No fishing, full and singular fishing; costates of the former two from those where the latter begins."""
    first, second = times
    resting = simulated(0.0, first, np.array([0.5, 0.7, 0.0, 0.0, 0.0]), lambda t, z: fished(t, z, 0.0))
    full = simulated(first, second, resting[:, -1], lambda t, z: fished(t, z, 1.0))
    begin = on_singular(full[:, -1])
    last = simulated(second, END, begin, lambda t, z: fished(t, on_singular(z), singular_rate(z)))
    full = simulated(second, first, begin, lambda t, z: fished(t, z, 1.0))[:, ::-1]
    return simulated(first, 0.0, full[:, 0], lambda t, z: fished(t, z, 0.0))[:, ::-1], full, last


@cache
def least() -> tuple[float, np.ndarray, Course]:
    """Two conditions on two times: no switching function at the first, and no costates at the end."""

    def missed(times: np.ndarray) -> list[float]:
        _, full, last = motion(times)
        return [costate(*last[:2, -1]).real, 0.4 * full[0, 0] * full[3, 0] + 0.2 * full[1, 0] * full[4, 0]]

    found = root(missed, [2.4367, 3.94197], tol=1e-12)
    assert np.abs(missed(found.x)).max() < 1e-9
    resting, full, last = motion(found.x)
    last[3:] = np.array([on_singular(z)[3:] for z in last.T]).T
    edges = (0.0, *found.x, END)
    course = Course(
        np.concatenate([np.linspace(*span, NODES) for span in pairwise(edges)]),
        np.concatenate([resting, full, last], axis=1)[[0, 1, 3, 4]],
    )
    return float(last[2, -1]), found.x, course


def read(folder: Path, start: float = 0.0) -> Instance:
    text = f"""
        [initial]
        a = 0.5
        b = 0.7
        [time]
        t0 = {start}
        tf = {start + 12.0}
        [control]
        w = [0.0, 1.0]
        """
    return build(folder, FISHING, text)


@pytest.mark.parametrize("start", [0.0, pytest.param(-7.0, marks=pytest.mark.study)])
@pytest.mark.slow
def test_fishing_is_singular_up_to_the_end(tmp_path: Path, start: float) -> None:
    """The control comes as near to its bound as it likes, and is never on it: 1.34408 in Sager's collection."""
    found = solve(read(tmp_path, start))
    assert found.status is Status.CONVERGED, found.message
    assert "structure -+s," in found.message
    cost, times, _ = least()
    assert cost == pytest.approx(1.34408, abs=5e-6)
    assert found.objective == pytest.approx(cost, rel=1e-10)
    assert np.array(found.switching_times[0]) - start == pytest.approx(times, abs=1e-8)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED


@pytest.mark.slow
def test_what_one_flow_does_not_find_is_found_where_it_begins_anew(tmp_path: Path) -> None:
    """A guess that is off by a percent; where arcs begin anew no time is listed twice, as those of switches are."""
    instance = read(tmp_path)
    cost, times, course = least()
    rng = np.random.default_rng(1)
    z = course.z * (1.0 + 0.01 * rng.uniform(-1.0, 1.0, (4, 1)))
    rough = Guess(Structure(((LOWER, UPPER, SINGULAR),)), 1.01 * times, z[2:, 0], 12.0, Course(course.times, z))
    alone = attempt(instance, replace(rough, course=None), LIMITS)
    assert alone is None
    exact = attempt(instance, rough, LIMITS)
    assert exact is not None
    assert exact.refined.at.times == pytest.approx(times, abs=1e-8)
    found = answered(instance, exact, (), 0.0)
    assert found.objective == pytest.approx(cost, rel=1e-10)
    assert found.times[1:][np.diff(found.times) == 0.0] == pytest.approx(times, abs=1e-8)


@pytest.mark.slow
def test_an_extremal_that_begins_anew_has_no_gaps(tmp_path: Path) -> None:
    """Costates that are wrong from some node on are no extremal, wherever it is integrated again."""
    _, times, course = least()
    rough = Guess(Structure(((LOWER, UPPER, SINGULAR),)), times, course.z[2:, 0], 12.0, course)
    exact = attempt(read(tmp_path), rough, LIMITS)
    assert exact is not None
    found = answered(exact.trajectory.arcs[0].field.instance, exact, (), 0.0)
    again = replay(found, closely=True)
    assert again is not None
    assert again.gap < 1e-10
    assert len(again.pieces) == 3
    lam = found.lam + np.where(found.times > 9.0, 1e-6, 0.0)
    again = replay(replace(found, lam=lam), closely=True)
    assert again is None or again.gap > 1e-8
