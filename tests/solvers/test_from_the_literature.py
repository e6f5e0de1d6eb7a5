"""Problems of the literature as a user would state them, against switching times and costates found by hand."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve
from sympy import Expr, Matrix, Rational, cos, exp, sin

import satsym
from satsym.status import Verdict
from satsym.symbolic import DerivationError, FirstOrder, Problem, Variable, derive, symbols_of

Rates = Callable[[Sequence[float], Sequence[float]], list[float]]


def certified(asked: satsym.Instance) -> satsym.Solution:
    found = satsym.solve(asked)
    assert found.certificate is not None, found.message
    assert found.certificate.verdict is Verdict.CERTIFIED, found.certificate
    return found


def switched(found: satsym.Solution, rates: Rates, start: Sequence[float], goal: Sequence[float]) -> np.ndarray:
    """Switching times and duration at which controls at their bounds lead to the goal, in the order that was found."""
    every = [(t, k) for k, own in enumerate(found.switching_times.values()) for t in own]
    order = [k for _, k in sorted(every)]
    first = [float(found.u[name](0.0)) for name in found.switching_times]

    def missed(times: np.ndarray) -> np.ndarray:
        z, u, begun = np.array(start), list(first), 0.0
        for end, k in zip(times, [*order, None], strict=True):
            z = solve_ivp(lambda _, z, u: rates(z, u), (begun, end), z, "DOP853", args=(u,), rtol=1e-12, atol=1e-13)
            z, begun = z.y[:, -1], end
            u = [-v if j == k else v for j, v in enumerate(u)]
        return z - goal

    times = fsolve(missed, np.round([*sorted(t for t, _ in every), found.times[-1]], 2), xtol=1e-13)
    assert np.abs(missed(times)).max() < 1e-10
    return np.asarray(times)


def reactor(rate: str, rates: Callable[[Expr, Expr, Expr], list[Expr]], typical: tuple[float, float]) -> Problem:
    states = tuple(Variable(name, name, "mol/l") for name in "ab")
    control = Variable("k", "k", rate, positive=True, typical=typical)
    a, b = symbols_of(states)
    (k,) = symbols_of((control,))
    moving = FirstOrder(
        name="reactor",
        title="R",
        states=states,
        controls=(control,),
        parameters=(UNIT, HOUR),
        rates=dict(zip((a, b), rates(a, b, k), strict=True)),
    )
    return Problem(
        name="batch", title="R", model=moving, running_cost=0, terminal_cost=b, control_set="box", maximise=True
    )


UNIT = Variable("c", "c", "l/mol", default=1.0, positive=True)
HOUR = Variable("h", "h", "hour", default=1.0, positive=True)
(c, h) = symbols_of((UNIT, HOUR))


def test_the_control_that_makes_h_a_polynomial_is_asked_for():
    """Two reactions whose rates a temperature sets (Ray, Advanced Process Control, 1981)."""

    def heated(a: Expr, b: Expr, warm: Expr) -> list[Expr]:
        first, second = 4000 * exp(-2500 / warm) * c * a**2 / h, 620000 * exp(-5000 / warm) * b / h
        return [-first, first - second]

    with pytest.raises(DerivationError, match=re.escape("a quantity in which H is a polynomial")):
        derive(reactor("1", heated, (298.0, 398.0)))


@pytest.mark.slow
def test_most_of_an_intermediate_product():
    """The same by the rate of the first reaction, which starts where the second has none; 0.610775 is printed.

    CasADi and Ipopt, Radau points of degree 4 on 39 intervals, in temperatures: 0.61080292.
    """
    share, ends = 620000 / 4000**2, [4000 * math.exp(-2500 / T) for T in (298.0, 398.0)]
    second = Rational("0.03875") * h / c**2
    stated = reactor("l/mol/hour", lambda a, b, k: [-k * a**2, k * a**2 - second * k**2 * b], (1.0, 7.0))
    found = certified(satsym.Instance.of(stated, initial={"a": 1, "b": 0}, tf=1, control={"k": ends}))

    def rates(_: float, z: np.ndarray) -> list[float]:
        a, b, p, q = z
        push, bent = (q - p) * a * a, -2.0 * share * q * b  # H = push k + bent k^2 / 2
        k = float(np.clip(-push / bent, *ends)) if bent > 0.0 else ends[int(push < 0.0)]
        return [-k * a * a, k * a * a - share * k * k * b, 2.0 * k * a * (p - q), share * k * k * q]

    def end(costates: np.ndarray) -> np.ndarray:
        z = [1.0, 0.0, *costates]
        return solve_ivp(rates, (0.0, 1.0), z, "DOP853", rtol=1e-11, atol=1e-13, max_step=2e-3).y[:, -1]

    costates = fsolve(lambda lam: end(lam)[2:] - [0.0, -1.0], np.round(found.lam(0.0), 3), xtol=1e-12)
    assert found.objective == pytest.approx(end(costates)[1], rel=1e-8)


@pytest.mark.slow
def test_an_arm_of_two_links_by_its_mass_matrix():
    """Least time with bounded torques (Luus, Iterative Dynamic Programming, 2000), who has 2.98; M(q) w' = Q."""
    states = tuple(Variable(name, name, "rad/s" if name[0] == "w" else "rad") for name in ("w1", "w2", "q1", "q2"))
    torques = tuple(Variable(name, name, "1/s**2") for name in ("u1", "u2"))
    w1, w2, q1, _ = symbols_of(states)
    u1, u2 = symbols_of(torques)
    coupled = 3 * cos(q1) / 2
    mass = Matrix([[Rational(7, 3), coupled], [coupled, Rational(4, 3)]])
    turning = Matrix([u1 - u2 + 3 * sin(q1) * w2**2 / 2, u2 - 3 * sin(q1) * w1**2 / 2])
    rates = dict(zip(symbols_of(states), [*mass.LUsolve(turning), w2 - w1, w1], strict=True))
    arm = FirstOrder(name="links", title="A", states=states, controls=torques, parameters=(), rates=rates)
    asked = satsym.Instance.of(
        Problem(name="two_links", title="A", model=arm, running_cost=1, control_set="box"),
        initial={"w1": 0, "w2": 0, "q1": 0.5, "q2": 0},
        final={"w1": 0, "w2": 0, "q1": 0.5, "q2": 0.522},
        tf="free",
        control={"u1": (-1, 1), "u2": (-1, 1)},
    )
    found = certified(asked)

    def printed(z: Sequence[float], u: Sequence[float]) -> list[float]:
        s, k, v, w = math.sin(z[2]), math.cos(z[2]), z[0], z[1]
        below = 31 / 36 + 9 / 4 * s * s
        first = s * (9 / 4 * k * v * v + 2 * w * w) + 4 / 3 * (u[0] - u[1]) - 3 / 2 * k * u[1]
        second = s * (9 / 4 * k * w * w + 7 / 2 * v * v) - 7 / 3 * u[1] + 3 / 2 * k * (u[0] - u[1])
        return [first / below, -second / below, w - v, v]

    times = switched(found, printed, [0.0, 0.0, 0.5, 0.0], [0.0, 0.0, 0.5, 0.522])
    assert found.objective == pytest.approx(times[-1], rel=1e-10)
    assert found.objective == pytest.approx(2.98, abs=5e-3)


@pytest.mark.study
def test_the_robot_arm_of_cops():
    """Three motors of two units (COPS 3, problem 8), least time: 9.14093 is printed."""
    names = (("rho", "m"), ("theta", "rad"), ("phi", "rad"))
    states = tuple(Variable(name, name, unit) for name, unit in names)
    states += tuple(Variable(f"{name}_dot", f"{name}_dot", f"{unit}/s") for name, unit in names)
    motors = (Variable("u_rho", "u_rho", "m**2/s**2"), *(Variable(u, u, "m**3/s**2") for u in ("u_theta", "u_phi")))
    length = Variable("reach", "l", "m", default=5, positive=True)
    (reach,), (rho, _, phi, *rates) = symbols_of((length,)), symbols_of(states)
    along, round_, up = symbols_of(motors)
    inertia = ((reach - rho) ** 3 + rho**3) / 3
    moved = [*rates, along / reach, round_ / (inertia * sin(phi) ** 2), up / inertia]
    arm = FirstOrder(
        name="arm",
        title="A",
        states=states,
        controls=motors,
        parameters=(length,),
        rates=dict(zip(symbols_of(states), moved, strict=True)),
    )
    still = {"rho": 4.5, "phi": "45 deg", "rho_dot": 0, "theta_dot": 0, "phi_dot": 0}
    found = certified(
        satsym.Instance.of(
            Problem(name="robot_arm", title="A", model=arm, running_cost=1, control_set="box"),
            initial={**still, "theta": 0},
            final={**still, "theta": "120 deg"},
            tf="free",
            control=dict.fromkeys(("u_rho", "u_theta", "u_phi"), (-1, 1)),
        )
    )

    def printed(z: Sequence[float], u: Sequence[float]) -> list[float]:
        body = ((5.0 - z[0]) ** 3 + z[0] ** 3) / 3.0
        return [*z[3:], u[0] / 5.0, u[1] / (body * math.sin(z[2]) ** 2), u[2] / body]

    start, goal = ([4.5, turned, math.pi / 4, 0.0, 0.0, 0.0] for turned in (0.0, 2.0 * math.pi / 3.0))
    assert found.objective == pytest.approx(switched(found, printed, start, goal)[-1], rel=1e-10)
    assert found.objective == pytest.approx(9.14093, abs=5e-5)
