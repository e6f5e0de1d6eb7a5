"""Least times of an aircraft that is brought back to level flight, among several local minima.

The motion is that of the F-8 (W. L. Garrard, J. M. Jordan, Design of nonlinear automatic flight control systems,
Automatica 13, 1977), the tail entering linearly. On 60 intervals CasADi with Ipopt leads to 5.7338 and 4.7667 from most
of its starts, and to 3.7197 and 2.8915 from a few.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve
from sympy import Rational

import satsym
from satsym.status import Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

STATES = tuple(Variable(name, name) for name in ("attack", "pitch", "rate"))
TAIL = (Variable("u", "u"),)
x, y, z = symbols_of(STATES)
(u,) = symbols_of(TAIL)
FORCES = (
    (-877, x),
    (1000, z),
    (-88, x * z),
    (470, x**2),
    (-19, y**2),
    (-1000, x**2 * z),
    (3846, x**3),
    (-215, u),
)
MOMENTS = ((-4208, x), (-396, z), (-470, x**2), (-3564, x**3), (-20967, u))
RATES = {
    x: sum(Rational(k, 1000) * term for k, term in FORCES),
    y: z,
    z: sum(Rational(k, 1000) * term for k, term in MOMENTS),
}


def moved(_: float, a: np.ndarray, tail: float) -> list[float]:
    """States, then costates, by hand."""
    p, q, r, by_p, by_q, by_r = a
    return [
        -0.877 * p + r - 0.088 * p * r + 0.47 * p**2 - 0.019 * q**2 - p**2 * r + 3.846 * p**3 - 0.215 * tail,
        r,
        -4.208 * p - 0.396 * r - 0.47 * p**2 - 3.564 * p**3 - 20.967 * tail,
        -by_p * (-0.877 - 0.088 * r + 0.94 * p - 2 * p * r + 11.538 * p**2)
        - by_r * (-4.208 - 0.94 * p - 10.692 * p**2),
        0.038 * by_p * q,
        -by_p * (1 - 0.088 * p - p**2) - by_q + 0.396 * by_r,
    ]


@pytest.mark.slow
@pytest.mark.parametrize(("limit", "ipopt"), [(0.05236, 3.7197), (0.1, 2.8915)])
def test_a_swing_to_the_other_side_is_found(limit: float, ipopt: float):
    plane = FirstOrder(name="aircraft", title="A", states=STATES, controls=TAIL, parameters=(), rates=RATES)
    level = Problem(name="levelled", title="L", model=plane, running_cost=1, control_set="box")
    start = {"attack": 0.4655, "pitch": 0.0, "rate": 0.0}
    found = satsym.solve(
        satsym.Instance.of(
            level, initial=start, final=dict.fromkeys(start, 0.0), tf="free", control={"u": (-limit, limit)}
        )
    )

    def missed(unknown: np.ndarray) -> list[float]:
        """Of H at the start, of what switches the tail, and at the end."""
        costates, lengths = unknown[:3], unknown[3:]
        a, out = np.array([0.4655, 0.0, 0.0, *costates]), list[float]()
        out.append(1 + float(np.dot(costates, moved(0.0, a, limit)[:3])))
        for tail, length in zip((limit, -limit, limit, -limit), lengths, strict=True):
            a = solve_ivp(moved, (0, length), a, args=(tail,), method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
            out.append(0.215 * a[3] + 20.967 * a[5])
        return [*out[:-1], *a[:3]]

    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED
    times = [0.0, *found.switching_times["u"], found.objective]
    exact = fsolve(missed, [*found.lam(0.0), *np.diff(times)], xtol=1e-13)
    assert np.abs(missed(exact)).max() < 1e-7
    assert found.objective == pytest.approx(sum(exact[3:]), rel=1e-8)
    assert ipopt * (1 - 2e-3) < found.objective < ipopt
