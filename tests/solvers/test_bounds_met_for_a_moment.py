"""Bounds that are met for a moment only: families of problems on whose way an arc at a bound shrinks to nothing.

The truth is a quadrature: linear motions under the law of two costates, cut off at the bounds, between whose corners
Gauss's rule is exact to the last digits; the costates are those under which the motion arrives.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import brentq, root

import satsym
from satsym import instance, solvers
from satsym.arrays import Array
from satsym.instance import Instance
from satsym.instance.numbers import changed
from satsym.solution import Solution
from satsym.solvers.control.corners import beyond, zeros
from satsym.status import Verdict
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of

POINTS, WEIGHTS = np.polynomial.legendre.leggauss(30)


@dataclass(frozen=True)
class Linear:
    """x' = A x + b u to the origin at the least integral of u**2 / 2, the control within a bound."""

    A: Array
    duration: float
    bound: float

    def law(self, costates: Array, t: float) -> float:
        """Without bounds: minus the second costate, which the transposed motion carries backwards."""
        return -float((expm(-self.A.T * t) @ costates)[1])

    def corners(self, costates: Array) -> list[float]:
        """Where the law meets a bound."""
        grid = np.linspace(0.0, self.duration, 400)
        found = []
        for bound in (-self.bound, self.bound):
            values = [self.law(costates, t) - bound for t in grid]
            places = np.flatnonzero(np.diff(np.sign(values)))
            found += [
                brentq(lambda t, b=bound: self.law(costates, t) - b, *grid[k : k + 2], xtol=1e-15) for k in places
            ]
        return sorted(found)

    def over(self, costates: Array) -> tuple[Array, float]:
        """What the control does to the end, and what it costs."""
        edges = [0.0, *self.corners(costates), self.duration]
        moved, cost = np.zeros(2), 0.0
        for a, b in pairwise(edges):
            for point, weight in zip(POINTS, WEIGHTS, strict=True):
                t = (a + b) / 2.0 + (b - a) / 2.0 * point
                u = float(np.clip(self.law(costates, t), -self.bound, self.bound))
                moved += (b - a) / 2.0 * weight * expm(self.A * (self.duration - t))[:, 1] * u
                cost += (b - a) / 4.0 * weight * u**2
        return moved, cost

    def optimum(self, initial: Array, near: Array) -> tuple[Array, float]:
        """Costates and cost, from costates nearby."""
        ends = expm(self.A * self.duration) @ initial
        found = root(lambda costates: ends + self.over(costates)[0], near, tol=1e-15)
        assert np.abs(ends + self.over(found.x)[0]).max() < 1e-12
        return found.x, self.over(found.x)[1]

    def without(self, costates: Array) -> Array:
        """From where the law without bounds leads to the origin."""
        free = Linear(self.A, self.duration, np.inf)
        return np.asarray(-np.linalg.solve(expm(self.A * self.duration), free.over(costates)[0]))


BODY = Linear(np.array([[0.0, 1.0], [0.0, 0.0]]), 2.25, 1.0)
SPRING = Linear(np.array([[0.0, 1.0], [-1.0, 0.0]]), 3.0, 1.0)

BEYOND = [-1e-6, 0.0, 1e-12, 1e-9, 1e-7, 1e-5, 1e-4, 1e-3, 3e-3, 1e-2, 0.1]
"""By how much the law without bounds exceeds one where it is largest."""


def body(initial: Array) -> Instance:
    return changed(instance.load("double-integrator-energy"), {"initial.q": initial[0], "initial.q_dot": initial[1]})


@pytest.fixture(scope="module")
def spring() -> Instance:
    states, controls = (Variable("x", "x"), Variable("v", "v")), (Variable("u", "u"),)
    (x, v), (u,) = symbols_of(states), symbols_of(controls)
    motion = FirstOrder(
        name="spring", title="A spring", states=states, controls=controls, parameters=(), rates={x: v, v: u - x}
    )
    effort = Problem(name="spring_effort", title="Effort", model=motion, running_cost=u**2 / 2, control_set="box")
    ends = {"initial": {"x": 1.0, "v": 0.0}, "final": {"x": 0.0, "v": 0.0}, "tf": SPRING.duration}
    return satsym.Instance.of(effort, **ends, control={"u": [-1.0, 1.0]}).case  # type: ignore[arg-type]


def agrees(solution: Solution, truth: Linear, near: Array) -> None:
    costates, cost = truth.optimum(np.array(solution.instance.initial), near)
    assert solution.objective == pytest.approx(cost, abs=1e-11)
    assert np.allclose(solution.lam[:, 0], costates, rtol=0.0, atol=1e-9)
    assert solution.certificate is not None
    assert solution.certificate.verdict is Verdict.CERTIFIED, solution.certificate.checks


@pytest.mark.slow
@pytest.mark.parametrize("excess", BEYOND)
def test_a_bound_that_is_met_at_an_end_only(excess: float) -> None:
    costates = np.array([0.8, 1.0]) * (1.0 + excess)
    one = body(BODY.without(costates))
    agrees(solvers.solve(one), BODY, costates)


@pytest.mark.slow
@pytest.mark.parametrize("excess", BEYOND)
@pytest.mark.parametrize("highest", [0.71, 1.234, 1.5])
def test_a_bound_that_is_touched_on_the_way(spring: Instance, excess: float, highest: float) -> None:
    """The law is minus a cosine, at its largest at that time."""
    size = 1.0 + excess
    costates = size * np.array([-np.sin(highest), np.cos(highest)])
    assert SPRING.law(costates, highest) == pytest.approx(-size, rel=1e-12)
    initial = SPRING.without(costates)
    one = changed(spring, {"initial.x": initial[0], "initial.v": initial[1]})
    agrees(solvers.solve(one), SPRING, costates)


@pytest.mark.slow
@pytest.mark.parametrize("where", np.linspace(0.0, 1.0, 7))
def test_one_that_failed_its_certificate(where: float) -> None:
    initial = np.array([0.784819558635354, 0.039975108020007616]) + where * np.array([0.01, -0.01])
    one = solvers.solve(body(initial))
    agrees(one, BODY, one.lam[:, 0])


def test_what_is_beyond_zero_between_samples_is_found_and_nothing_else() -> None:
    times = np.linspace(0.0, 1.0, 13)
    for least, crossed in ((-1e-8, 1), (1e-8, 0), (0.0, 0), (-0.5, 0)):
        for sign in (-1.0, 1.0):
            found = beyond(
                lambda t, s=sign, c=least: s * ((t - 0.3) ** 2 + c), times, sign * ((times - 0.3) ** 2 + least)
            )
            assert len(found) == crossed
            assert all(abs(t - 0.3) < 1e-4 for t in found)
    assert beyond(lambda t: np.inf, times, np.full(13, np.inf)) == []


def test_changes_of_sign_are_found_once_at_samples_between_them_and_not_at_ends() -> None:
    times = np.arange(-10.0, 11.0)
    for sign in (-1.0, 1.0):
        assert zeros(times, sign * (times - 3.5) * (times + 5.0) * (times - 7.0)) == pytest.approx([-5.0, 3.5, 7.0])
        assert zeros(times, sign * (times - 3.0) ** 2) == []
        assert zeros(times, sign * (times + 10.0)) == []
