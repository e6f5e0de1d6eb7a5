"""The F-8 aircraft, cubic in its elevator (Garrard and Jordan, Automatica 13, 1977): H has several minimisers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from sympy import Expr, Rational

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers import solve
from satsym.status import Status, Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from tests.support.models import build

STATES = (
    Variable("alpha", "alpha", typical=(-0.5, 0.5)),
    Variable("theta", "theta", typical=(-0.5, 0.5)),
    Variable("rate", "q", typical=(-1.0, 1.0)),
)
ELEVATOR = Variable("elevator", "delta", typical=(-0.05, 0.05))
attack, pitch, rate = symbols_of(STATES)
(u,) = symbols_of((ELEVATOR,))


def polynomial(*terms: tuple[str, Expr]) -> Expr:
    """With decimals that are what is written."""
    return sum(Rational(factor) * power for factor, power in terms)


RATES = {
    attack: polynomial(("-0.877", attack), ("1", rate), ("-0.088", attack * rate), ("0.47", attack**2))
    + polynomial(("-0.019", pitch**2), ("-1", attack**2 * rate), ("3.846", attack**3), ("-0.215", u))
    + polynomial(("0.28", attack**2 * u), ("0.47", attack * u**2), ("0.63", u**3)),
    pitch: rate,
    rate: polynomial(("-4.208", attack), ("-0.396", rate), ("-0.47", attack**2), ("-3.564", attack**3))
    + polynomial(("-20.967", u), ("6.265", attack**2 * u), ("46", attack * u**2), ("61.4", u**3)),
}


def f8(folder: Path, cost: Expr | int, text: str) -> Instance:
    motion = FirstOrder(name="f8", title="An F-8", states=STATES, controls=(ELEVATOR,), parameters=(), rates=RATES)
    problem = Problem(name="levelled", title="An F-8 levelled", model=motion, running_cost=cost, control_set="box")
    return build(folder, problem, text)


def levelled(folder: Path, cost: Expr | int, text: str) -> Solution:
    found = solve(f8(folder, cost, text))
    assert found.status is Status.CONVERGED
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED, found.certificate.checks
    return found


@pytest.mark.slow
def test_levelling_costs_what_it_costs_a_direct_method(tmp_path: Path) -> None:
    """CasADi and Ipopt, straight lines between 800 and 1600 knots: 0.01964853975 and 0.01964853626, to fourth order."""
    start = "[initial]\nalpha = 0.3\ntheta = 0.0\nrate = 0.0\n[time]\ntf = 10.0\n[control]\nelevator = [-0.5, 0.5]\n"
    found = levelled(tmp_path, (attack**2 + pitch**2 + rate**2) / 4 + u**2 / 2, start)
    assert found.objective == pytest.approx((16.0 * 0.019648536261164657 - 0.01964853974571359) / 15.0, rel=2e-9)


ENDS = "[initial]\nalpha = 0.4655\ntheta = 0.0\nrate = 0.0\n[final]\nalpha = 0.0\ntheta = 0.0\nrate = 0.0\n"
HURRIED = f'{ENDS}[time]\ntf = "free"\n[control]\nelevator = [-0.05236, 0.05236]\n[solver]\nmax_seconds = 300.0\n'

QUICKEST, SLOW = 3.78086, 5.72864575840
"""Least times by Ipopt, steps of constant control on phases of free length, and near another strict minimum, with the
costates at its start."""
COSTATES = (26.841081135395438, -7.531763056827809, 0.8848835422691439)


def follows(case: Instance, costates: tuple[float, ...], times: Array) -> tuple[Array, Array]:
    """Where the law leads from the start, by an adaptive integrator: states and costates at times, and controls."""
    model, p, bounds = case.model, case.parameters, case.control_set.arguments

    def rates(t: float, z: Array) -> Array:
        return np.array(model.canonical(t, tuple(z[:3].tolist()), tuple(z[3:].tolist()), p, bounds))

    start, ends = np.array([*case.initial, *costates]), (times[0], times[-1])
    z = solve_ivp(rates, ends, start, t_eval=times, method="DOP853", rtol=1e-9, atol=1e-11, max_step=0.02).y
    return z, np.asarray(model.control_law_batch(times, z[:3], z[3:], p, bounds))


@pytest.mark.slow
def test_levelling_in_least_time_jumps_twice(tmp_path: Path) -> None:
    """The first extremal that is found is the slow one."""
    found = levelled(tmp_path, 1, HURRIED)
    assert [one.kind for one in found.events] == ["jump", "jump"]
    assert found.objective == pytest.approx(QUICKEST, rel=2e-6)
