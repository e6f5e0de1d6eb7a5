"""Free ends with two minima far apart: an epidemic that is isolated until it is over, or hardly at all.

No path from the straight line leads to the cheaper one. The truth is by a switching time that is minimised over
simulations by DOP853, and by a descent over controls in pieces.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import minimize, minimize_scalar

from satsym.solution import Solution
from satsym.solvers import solve
from satsym.status import Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from tests.support.models import build

STATES = (Variable("sus", "s", positive=True), Variable("inf", "I", positive=True))
CONTROLS, WEIGHT = (Variable("u", "u"),), (Variable("c", "c", positive=True),)
(sus, infected), (u,), (c,) = map(symbols_of, (STATES, CONTROLS, WEIGHT))
CONTACTS, RECOVERY, MOST, DAYS = 0.4, 0.1, 0.8, 100.0


def answer(folder: Path, effort: object, weight: float) -> Solution:
    caught = CONTACTS * (1 - u) * sus * infected
    rates = {sus: -caught, infected: caught - RECOVERY * infected}
    spread = FirstOrder(name="epidemic", title="E", states=STATES, controls=CONTROLS, parameters=WEIGHT, rates=rates)
    problem = Problem(name="isolated", title="S", model=spread, running_cost=infected + effort, control_set="box")
    text = f"[parameters]\nc = {weight}\n[initial]\nsus = 0.99\ninf = 0.01\n[time]\ntf = {DAYS}\n"
    return solve(build(folder, problem, f"{text}[control]\nu = [0.0, {MOST}]\n"))


def moved(z: NDArray[np.float64], u: NDArray[np.float64] | float) -> NDArray[np.float64]:
    caught = CONTACTS * (1 - u) * z[0] * z[1]
    return np.array([-caught, caught - RECOVERY * z[1], z[1]])


@pytest.mark.slow
@pytest.mark.parametrize("weight", [0.05, 0.1])
def test_a_switch_that_no_constant_control_shows_is_found(tmp_path: Path, weight: float) -> None:
    def cost(switch: float) -> float:
        z = np.array([0.99, 0.01, 0.0])
        for level, lasting in ((MOST, switch), (0.0, DAYS - switch)):
            z = solve_ivp(lambda _, z, u=level: moved(z, u), (0, lasting), z, "DOP853", rtol=1e-12, atol=1e-14).y[:, -1]
        return float(z[2] + weight * MOST * switch)

    least = minimize_scalar(cost, bounds=(60.0, 99.0), method="bounded", options={"xatol": 1e-7})
    assert least.fun < cost(0.0)
    found = answer(tmp_path, c * u, weight)
    assert found.objective == pytest.approx(least.fun, rel=1e-10)
    (times,) = found.switching_times
    assert times == pytest.approx((least.x,), abs=1e-4)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED, found.certificate.checks


@pytest.mark.slow
@pytest.mark.parametrize("weight", [0.33, 0.35])
def test_of_two_minima_far_apart_the_cheaper_one_is_the_answer(tmp_path: Path, weight: float) -> None:
    pieces, each = 100, 4

    def costs(u: NDArray[np.float64]) -> NDArray[np.float64]:
        """Of many controls at once, shape (pieces, K), by RK4."""
        z, h = np.repeat([[0.99], [0.01], [0.0]], u.shape[1], axis=1), DAYS / pieces / each
        for level in np.repeat(u, each, axis=0):
            a = moved(z, level)
            b = moved(z + h / 2 * a, level)
            d = moved(z + h / 2 * b, level)
            z = z + h / 6 * (a + 2 * b + 2 * d + moved(z + h * d, level))
        return z[2] + weight * (u**2).sum(axis=0) / 2 * DAYS / pieces

    def both(u: NDArray[np.float64]) -> tuple[float, NDArray[np.float64]]:
        found = costs(u[:, None] + 1e-7 * np.eye(pieces, pieces + 1, 1))
        return float(found[0]), (found[1:] - found[0]) / 1e-7

    bounds = [(0.0, MOST)] * pieces
    isolated, free = (
        minimize(both, np.full(pieces, start), jac=True, bounds=bounds, options={"maxiter": 500}).fun
        for start in (MOST, 0.0)
    )
    assert isolated < 0.98 * free
    found = answer(tmp_path, c * u**2 / 2, weight)
    assert found.objective == pytest.approx(isolated, rel=2e-4)
    assert found.objective < isolated
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED, found.certificate.checks
