"""Controls that jump from one minimiser of H to another: quadrature, an independent flow with events, and Ipopt."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq
from sympy import Rational

from satsym.arrays import Array
from satsym.solution import Event, Solution
from satsym.solvers import solve
from satsym.solvers.certificate.jacobi import FULL, followed
from satsym.solvers.certificate.reintegration.flow import flow as canonical_flow
from satsym.solvers.certificate.reintegration.segments import segments
from satsym.status import Status, Verdict
from tests.support.models import build, q, scalar, w

WELL, TILT = (w**2 - 1) ** 2, Rational(3, 10)
START, END, LASTING = 0.0, 0.6, 2.0
GIVEN = f"[initial]\nq = {START}\n[final]\nq = {END}\n[time]\ntf = {LASTING}\n[control]\nw = [-2, 2]\n"


@pytest.fixture(scope="module")
def bent(tmp_path_factory: pytest.TempPathFactory) -> Solution:
    """Where the control acts the more the farther it has come, both minimisers are equally good for another costate."""
    problem = scalar("bent", w * (1 + q / 4), WELL + TILT * w + q, 0, "box")
    return solve(build(tmp_path_factory.mktemp("bent"), problem, GIVEN))


def speed(side: float, slope: float) -> float:
    """The minimiser of the double well with a slope in one of the wells, to which it falls."""
    return side * brentq(lambda v: 4.0 * v * (v**2 - 1.0) + side * slope, 0.6, 3.0, xtol=1e-15)


def certified(found: Solution, jumps: int) -> None:
    assert found.status is Status.CONVERGED
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED, found.certificate.checks
    assert [(one.kind, one.name) for one in found.events] == [("jump", "w")] * jumps


@pytest.mark.slow
def test_the_jump_is_where_quadrature_has_it(tmp_path: Path) -> None:
    """q' = w at the cost of the double well and of q: lambda = a - t, and w jumps at t = a, where lambda vanishes."""
    found = solve(build(tmp_path, scalar("wells", w, WELL + q, 0, "box"), GIVEN))
    certified(found, 1)

    def integral(a: float, along: Callable[[float, float], float]) -> float:
        def value(t: float) -> float:
            return along(t, speed(-1.0 if t < a else 1.0, a - t))

        return quad(value, 0.0, a, epsabs=1e-13)[0] + quad(value, a, LASTING, epsabs=1e-13)[0]

    a = brentq(lambda a: integral(a, lambda _, v: v) - (END - START), 0.2, 1.8, xtol=1e-14)
    cost = integral(a, lambda t, v: (v**2 - 1.0) ** 2 + (LASTING - t) * v)  # the integral of q, by parts
    assert found.events[0].t == pytest.approx(a, rel=1e-11)
    assert found.objective == pytest.approx(cost, rel=1e-10)
    before, after = (found.u[0, found.times < a][-1], found.u[0, found.times > a][0])
    assert (before, after) == pytest.approx((-1.0, 1.0), abs=1e-8)


@pytest.mark.slow
def test_what_begins_with_a_jump_is_followed_to_its_end(bent: Solution) -> None:
    """Begun at the node just before its jump, a solution goes on as it did."""
    node = int(np.searchsorted(bent.times, bent.events[0].t)) - 1
    instance = replace(bent.instance, initial=tuple(bent.x[:, node].tolist()))
    rest = {name: getattr(bent, name)[..., node:] for name in ("times", "x", "lam", "u")}
    whole, begun = canonical_flow(bent), canonical_flow(replace(bent, instance=instance, **rest))
    assert whole is not None
    assert begun is not None
    assert begun.times[0] == bent.times[node] > bent.times[0]
    assert begun.x[:, -1] == pytest.approx(whole.x[:, -1], abs=1e-10)
    assert begun.lam[:, -1] == pytest.approx(whole.lam[:, -1], abs=1e-10)


def flow(z: Array) -> tuple[Array, list[float]]:
    """States and costates at the end from those at the start, and when the control jumps."""

    def rates(t: float, z: Array, side: float) -> list[float]:
        u = speed(side, 0.3 + z[1] * (1.0 + z[0] / 4.0))
        return [u * (1.0 + z[0] / 4.0), -1.0 - z[1] * u / 4.0]

    def excess(t: float, z: Array, side: float) -> float:
        slope = 0.3 + z[1] * (1.0 + z[0] / 4.0)
        one, other = ((v**2 - 1.0) ** 2 + slope * v for v in (speed(1.0, slope), speed(-1.0, slope)))
        return one - other

    excess.terminal = True  # type: ignore[attr-defined]
    given = {"rtol": 1e-12, "atol": 1e-13, "method": "DOP853"}
    first = solve_ivp(rates, (0.0, LASTING), z, args=(-1.0,), events=excess, **given)
    (jump,) = first.t_events[0]
    second = solve_ivp(rates, (jump, LASTING), first.y[:, -1], args=(1.0,), **given)
    return second.y[:, -1], [float(jump)]


@pytest.mark.slow
def test_neighbouring_extremals_jump_at_times_of_their_own(bent: Solution) -> None:
    """The linearised flow across the jump against differences of a flow that locates it anew each time."""
    certified(bent, 1)
    begun = np.array([bent.x[0, 0], bent.lam[0, 0]])
    reached, jumped = flow(begun)
    assert reached == pytest.approx(np.array([bent.x[0, -1], bent.lam[0, -1]]), abs=1e-10)
    assert bent.events == (Event("jump", "w", pytest.approx(jumped[0], rel=1e-10)),)
    along = segments(bent)
    assert along is not None
    product = np.eye(2)
    for matrix in along.transition:
        product = matrix @ product
    step = 1e-4
    columns = [(flow(begun + step * unit)[0] - flow(begun - step * unit)[0]) / (2.0 * step) for unit in np.eye(2)]
    assert product * along.scale[:, None] / along.scale == pytest.approx(np.array(columns).T, rel=1e-5)
    assert len(along.jumped) == 1


@pytest.mark.slow
def test_no_other_steering_is_as_cheap(bent: Solution) -> None:
    """CasADi and Ipopt: speeds constant on as many pieces before the jump as after it, whose time is free."""
    ca = pytest.importorskip("casadi")
    pieces = 60
    opti = ca.Opti()
    u, jump = opti.variable(2 * pieces), opti.variable()
    x, cost = ca.MX(START), ca.MX(0.0)
    for k in range(2 * pieces):
        h = (jump if k < pieces else LASTING - jump) / pieces
        grown = (4.0 + x) * ca.exp(u[k] * h / 4.0)  # q' = u (1 + q / 4), u constant
        cost += h * ((u[k] ** 2 - 1) ** 2 + 0.3 * u[k] - 4.0) + 4.0 * (grown - 4.0 - x) / u[k]
        x = grown - 4.0
    opti.minimize(cost)
    opti.subject_to(x == END)
    opti.subject_to(opti.bounded(0.1, jump, 1.9))
    opti.set_initial(u, np.repeat([-1.0, 1.0], pieces))
    opti.set_initial(jump, 1.0)
    opti.solver("ipopt", {"ipopt.print_level": 0, "print_time": False, "ipopt.tol": 1e-11})
    found = opti.solve()
    assert found.value(jump) == pytest.approx(bent.events[0].t, rel=1e-4)
    assert bent.objective < found.value(cost) < bent.objective + 1e-4 * abs(bent.objective)


@pytest.mark.parametrize("weak", [1e-3, 1.0, 1e3])
def test_phases_go_on_across_a_jump_and_by_less_than_a_turn(weak: float) -> None:
    """x may pass zero at the jump alone: seen there, once, however strong it is."""
    leap, along = np.array([1.0, 0.0]), np.array([0.0, 1.0])

    def matrix(passed: float) -> Array:
        return np.eye(2) - passed * np.outer(leap, along)

    began = np.array([[1.0, -1.0], [0.0, 1.0]])  # as a regular arc moves it
    turned = np.array([[1.0, 0.0], [1.5, 1.0]])  # and the weight of the state, so that costates change their sign
    stations = np.array([began, turned, matrix(weak)])
    phases = followed(stations, {2})
    assert phases is not None
    x = (matrix(weak) @ turned @ began)[0, 1]
    assert int(phases.passed[-1]) == int(x > 0.0)
    assert 0.0 <= phases.values[-1, 0] - phases.values[-2, 0] < 2.0 * np.pi * FULL


@pytest.mark.slow
def test_a_jump_at_the_last_instant_changes_nothing(tmp_path: Path) -> None:
    """With a free end lambda = tf - t vanishes there, where both wells become equally good."""
    text = f"[initial]\nq = {START}\n[time]\ntf = {LASTING}\n[control]\nw = [-2, 2]\n"
    found = solve(build(tmp_path, scalar("wells", w, WELL + q, 0, "box"), text))
    certified(found, 0)

    def running(t: float) -> float:
        v = speed(-1.0, LASTING - t)
        return (v**2 - 1.0) ** 2 + (LASTING - t) * v

    assert found.objective == pytest.approx(quad(running, 0.0, LASTING)[0], rel=1e-10)
