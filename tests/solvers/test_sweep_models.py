"""Small problems whose answers are known in closed form, derived, generated, loaded by path and swept for."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq, root
from sympy import exp, sin, sympify

from satsym.instance import Instance
from satsym.kernels import load as load_kernels
from satsym.solution import Solution
from satsym.solvers import solve
from satsym.spec import Variable
from satsym.status import Status
from satsym.symbolic import FirstOrder, Problem, symbols_of, t
from tests.support.canonical import Orbit, collocation
from tests.support.cases import parameters, shipped, sweeping
from tests.support.models import build, k, q, scalar, w


def swept(case: Instance, **options: object) -> Solution:
    solution = solve(sweeping(case, **options))
    assert solution.status is Status.CONVERGED
    return solution


def test_the_simplest_problem_has_a_constant_control(tmp_path: Path):
    """q' = w, J = integral of w^2/2 + k (q - 1)^2 / 2: the costate is constant, w = -lambda."""
    problem = scalar("simplest", w, w**2 / 2, k * (q - 1) ** 2 / 2, "free")
    case = build(tmp_path, problem, "[parameters]\nk = 4.0\n[initial]\nq = 3.0\n[time]\nt0 = 1.0\ntf = 2.5\n")
    solution = swept(case, steps=10, tolerance=1e-14)
    lam = 4.0 * 2.0 / (1.0 + 4.0 * 1.5)
    assert case.model.spec.control_set == "free"
    assert case.control_set.arguments == ()
    assert solution.switching_times == ((),)
    assert np.abs(solution.lam - lam).max() <= 1e-13
    assert np.abs(solution.u + lam).max() <= 1e-13
    assert np.abs(solution.x - (3.0 - lam * (solution.times - 1.0))).max() <= 1e-13
    assert solution.objective == pytest.approx(lam**2 * 1.5 / 2.0 + lam**2 / 8.0, rel=1e-13)


def regulator(folder: Path, control_set: str, bounds: str) -> Instance:
    """q' = w, J = integral of (q^2 + w^2)/2 from q = 2 over a time of 2."""
    problem = scalar(f"regulator_{control_set}", w, (q**2 + w**2) / 2, sympify(0), control_set)
    return build(folder, problem, f"[initial]\nq = 2.0\n[time]\ntf = 2.0\n{bounds}")


def test_the_linear_quadratic_regulator_follows_riccatis_equation(tmp_path: Path):
    """P' = P^2 - 1, P(2) = 0, so w = -tanh(2 - t) q."""
    solution = swept(regulator(tmp_path, "free", ""), tolerance=1e-12)
    left = 2.0 - solution.times
    assert np.abs(solution.x[0] - 2.0 * np.cosh(left) / math.cosh(2.0)).max() <= 1e-11
    assert np.abs(solution.lam[0] - 2.0 * np.sinh(left) / math.cosh(2.0)).max() <= 1e-11
    assert np.abs(solution.u[0] + np.tanh(left) * solution.x[0]).max() <= 1e-11
    assert solution.objective == pytest.approx(2.0 * math.tanh(2.0), rel=1e-11)


@pytest.mark.parametrize("limit", [0.2, 0.5, 1.2])
def test_the_bounded_regulator_switches_where_the_feedback_meets_the_bound(tmp_path: Path, limit: float):
    """At the lower bound until (2 - limit t) tanh(2 - t) = limit, from then on the feedback of the free problem."""
    solution = swept(regulator(tmp_path, "box", f"[control]\nw = [{-limit}, {limit}]\n"), tolerance=1e-12)
    switch = brentq(lambda s: (2.0 - limit * s) * math.tanh(2.0 - s) - limit, 0.0, 2.0, xtol=1e-15)
    there = 2.0 - limit * switch
    on_bound = (8.0 - there**3) / (3.0 * limit) / 2.0 + limit**2 * switch / 2.0
    assert solution.switching_times[0] == pytest.approx((switch,), abs=1e-9)
    assert solution.objective == pytest.approx(on_bound + there**2 * math.tanh(2.0 - switch) / 2.0, rel=1e-10)
    held = solution.times <= switch
    assert (solution.u[0, held] == -limit).all()
    after = there * np.sinh(2.0 - solution.times) / math.cosh(2.0 - switch)
    assert np.abs(solution.u[0] + after)[~held].max() <= 1e-10


def test_time_may_enter_the_motion_and_both_costs(tmp_path: Path):
    """q' = t w, L = e^t w^2/2, S = k (q - sin t)^2 / 2: lambda is constant and w = -lambda t e^(-t)."""
    problem = scalar("in_time", t * w, exp(t) * w**2 / 2, k * (q - sin(t)) ** 2 / 2, "free")
    case = build(tmp_path, problem, "[parameters]\nk = 3.0\n[initial]\nq = -0.5\n[time]\nt0 = 0.5\ntf = 2.0\n")
    assert not case.model.spec.autonomous
    solution = swept(case, steps=400, tolerance=1e-13)
    reach = sum(s * (b**2 + 2.0 * b + 2.0) * math.exp(-b) for s, b in ((1.0, 0.5), (-1.0, 2.0)))
    lam = 3.0 * (-0.5 - math.sin(2.0)) / (1.0 + 3.0 * reach)
    assert np.abs(solution.lam - lam).max() <= 1e-10
    assert np.abs(solution.u[0] + lam * solution.times * np.exp(-solution.times)).max() <= 1e-10
    assert solution.x[0, -1] == pytest.approx(-0.5 - lam * reach, abs=1e-10)
    assert solution.objective == pytest.approx(lam**2 * reach / 2.0 + lam**2 / 6.0, rel=1e-10)


PLANE = ("px", "py", "vx", "vy")


def rendezvous() -> Problem:
    """A point in the plane, pushed with a force of limited norm, is to come to rest at the origin."""
    states, controls = (tuple(Variable(s, s) for s in names) for names in (PLANE, ("ax", "ay")))
    px, py, vx, vy = symbols_of(states)
    ax, ay = symbols_of(controls)
    return Problem(
        name="rendezvous",
        title="Double integrator in the plane",
        model=FirstOrder(
            name="plane",
            title="Double integrator",
            states=states,
            controls=controls,
            parameters=(Variable("k", "k", default=1.0),),
            rates={px: vx, py: vy, vx: ax, vy: ay},
        ),
        running_cost=(ax**2 + ay**2) / 2,
        terminal_cost=k * (px**2 + py**2 + vx**2 + vy**2) / 2,
        control_set="ball",
    )


class Rendezvous:
    """By quadrature: the costate of the velocity is linear in time, the control is minus it, shortened to the ball."""

    def __init__(self, start: tuple[float, ...], tf: float, weight: float, limit: float) -> None:
        self.start, self.tf, self.weight, self.limit = np.array(start), tf, weight, limit
        self.final_costate = root(self._miss, np.zeros(4), tol=1e-14).x
        assert np.abs(self._miss(self.final_costate)).max() <= 1e-12

    def velocity_costate(self, costate: np.ndarray, times: np.ndarray) -> np.ndarray:
        return costate[2:, None] + costate[:2, None] * (self.tf - times)

    def corners(self, costate: np.ndarray) -> list[float]:
        """Where its norm is the limit: the zeros of a quadratic."""
        slope, end = costate[:2], costate[2:]
        roots = np.roots([slope @ slope, 2.0 * slope @ end, end @ end - self.limit**2]) if slope @ slope else []
        return sorted(self.tf - s.real for s in roots if abs(s.imag) < 1e-14 and 0.0 < s.real < self.tf)

    def control(self, costate: np.ndarray, times: np.ndarray) -> np.ndarray:
        lam = self.velocity_costate(costate, times)
        return -lam * np.minimum(1.0, self.limit / np.maximum(np.linalg.norm(lam, axis=0), 1e-300))

    def end_and_effort(self, costate: np.ndarray) -> tuple[np.ndarray, float]:
        nodes, weights = np.polynomial.legendre.leggauss(10)
        end = self.start.copy()
        end[:2] += end[2:] * self.tf
        effort = 0.0
        edges = sorted({*np.linspace(0.0, self.tf, 101).tolist(), *self.corners(costate)})
        for low, high in pairwise(edges):
            times, fraction = low + (high - low) * (nodes + 1.0) / 2.0, weights * (high - low) / 2.0
            u = self.control(costate, times)
            end[:2] += (u * (self.tf - times)) @ fraction
            end[2:] += u @ fraction
            effort += float(0.5 * (u**2).sum(axis=0) @ fraction)
        return end, effort

    def _miss(self, costate: np.ndarray) -> np.ndarray:
        return costate - self.weight * self.end_and_effort(costate)[0]

    @property
    def cost(self) -> float:
        end, effort = self.end_and_effort(self.final_costate)
        return effort + 0.5 * self.weight * float(end @ end)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "limit", "switches"),
    [
        ((1.0, -0.5, 0.3, 0.4), 0.6, 2),
        ((1.0, -0.5, 0.3, 0.4), 0.9, 1),
        ((2.0, 0.0, 0.0, 0.0), 1.0, 2),
        ((1.0, 0.5, -1.5, 1.0), 0.8, 0),
        ((1.0, -0.5, 0.3, 0.4), 50.0, 0),
    ],
)
def test_a_control_in_a_ball_is_shortened_where_it_would_leave_it(tmp_path, start, limit, switches):
    values = "".join(f"{name} = {value}\n" for name, value in zip(PLANE, start, strict=True))
    text = f"[parameters]\nk = 10.0\n[initial]\n{values}[time]\ntf = 3.0\n[control]\nmax_norm = {limit}\n"
    solution, right = swept(build(tmp_path, rendezvous(), text), tolerance=1e-11), Rendezvous(start, 3.0, 10.0, limit)
    assert len(right.corners(right.final_costate)) == switches
    assert solution.switching_times[0] == solution.switching_times[1]
    assert solution.switching_times[0] == pytest.approx(right.corners(right.final_costate), abs=1e-7)
    assert np.linalg.norm(solution.u, axis=0).max() <= limit * (1.0 + 1e-15)
    assert solution.objective == pytest.approx(right.cost, rel=1e-9)
    assert np.abs(solution.lam[:, -1] - right.final_costate).max() <= 1e-8 * np.abs(right.final_costate).max()
    assert np.abs(solution.u - right.control(right.final_costate, solution.times)).max() <= 1e-7


@pytest.mark.slow
@pytest.mark.parametrize("limit", [0.015, 0.0125, 0.01, 0.005])
def test_a_satellite_with_one_engine_turns_it_as_collocation_does(limit):
    """Its thrust is at the limit for most of the time or all of it, and turns all the while."""
    case = shipped("soft-return")
    engine = load_kernels("polar_orbit_ball")
    given = parameters(case)
    ball = replace(
        case, model=engine, parameters=tuple(given[name] for name in engine.spec.parameter_names), max_norm=limit
    )
    solution, right = swept(ball), collocation(Orbit(max_norm=limit), 1e-8)
    assert np.linalg.norm(solution.u, axis=0).max() <= limit * (1.0 + 1e-15)
    assert solution.iterations <= 150
    assert solution.objective == pytest.approx(right.cost, rel=1e-8)
    assert np.abs(solution.lam[:, 0] - right.costate).max() <= 1e-6 * np.abs(right.costate).max()
