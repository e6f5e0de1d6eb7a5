"""Bounds at which a control rests by itself: no arc is made of them, and they do not spoil a certificate.

The truth is by hand: multiplier by multiplier, with DOP853 up to where a boundary is met, and quadratures along it.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import root

from satsym.solution import Solution
from satsym.solvers import solve
from satsym.status import Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from tests.support.models import build

EFFORT = (Variable("u", "u"),)
(u,) = symbols_of(EFFORT)
BEDS, CONTACTS, RECOVERY = 0.1, 0.3, 0.1


def certified(found: Solution, cost: float, events: list[tuple[str, float]]) -> None:
    assert [one.name for one in found.events] == [name for name, _ in events]
    assert [one.t for one in found.events] == pytest.approx([time for _, time in events], abs=1e-7)
    assert found.objective == pytest.approx(cost, rel=1e-10)
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED, found.certificate.checks


@pytest.mark.slow
def test_an_epidemic_whose_contacts_need_no_limit_any_more_once_the_beds_suffice(tmp_path: Path) -> None:
    """On the boundary contacts are cut by 1 - gamma/(beta S), until there is nothing left to be cut."""
    states = (Variable("sus", "s", positive=True), Variable("inf", "I", positive=True))
    sus, infected = symbols_of(states)
    caught = CONTACTS * (1 - u) * sus * infected
    rates = {sus: -caught, infected: caught - RECOVERY * infected}
    spread = FirstOrder(name="epidemic", title="E", states=states, controls=EFFORT, parameters=(), rates=rates)
    problem = Problem(
        name="sir",
        title="S",
        model=spread,
        running_cost=u**2,
        path_constraints={"beds": infected - BEDS},
        control_set="box",
    )
    text = "[initial]\nsus = 0.999\ninf = 0.001\n[time]\ntf = 100.0\n[control]\nu = [0.0, 0.8]\n"
    found = solve(build(tmp_path, problem, text))

    def moved(_: float, z: np.ndarray) -> list[float]:
        s, i, a, b, _ = z
        met = CONTACTS * s * i
        cut = met * (b - a) / 2
        return [
            -(1 - cut) * met,
            (1 - cut) * met - RECOVERY * i,
            (a - b) * (1 - cut) * CONTACTS * i,
            (a - b) * (1 - cut) * CONTACTS * s + b * RECOVERY,
            cut**2,
        ]

    def kept(s: float) -> float:
        return 1 - RECOVERY / (CONTACTS * s)

    def along(begun: np.ndarray) -> np.ndarray:
        tight = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-14}
        return solve_ivp(moved, (0.0, begun[2]), [0.999, 0.001, *begun[:2], 0.0], **tight).y[:, -1]

    def missed(begun: np.ndarray) -> list[float]:
        """The beds are full, the cut goes on without a jump, and a costate is the slope of what is still to be paid."""
        s, i, a, b, _ = along(begun)
        return [i - BEDS, CONTACTS * s * i * (b - a) / 2 - kept(s), a - kept(s) ** 2 / (RECOVERY * BEDS)]

    first = root(missed, [40.0, 60.0, 32.0], tol=1e-13)
    assert np.abs(first.fun).max() < 1e-10
    s, *_, cost = along(first.x)
    immune = RECOVERY / CONTACTS
    cost += quad(lambda s: kept(s) ** 2 / (RECOVERY * BEDS), immune, s, epsabs=1e-13)[0]
    entry = float(first.x[2])
    certified(found, cost, [("beds", entry), ("beds", entry + (s - immune) / (RECOVERY * BEDS))])
