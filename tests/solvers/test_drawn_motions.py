"""Motions that are drawn from a start and towards an end are extremals, with what they cost, in their domain."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from satsym import instance
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.scaling import two_point
from satsym.solvers.drawn_beside import Bundle, simulated

STEPS = 200
"""Of each motion."""


def drawn(problem: TwoPoint, size: float, *, backwards: bool) -> tuple[np.ndarray, Bundle]:
    """Extremals from the initial state, or backwards from it, by small costates, and where they begin."""
    costates = size * np.random.default_rng(3).normal(size=(problem.states, 6))
    begun = np.concatenate([np.repeat(problem.initial[:, None], 6, axis=1), costates])
    return begun, simulated(problem, begun, -problem.duration if backwards else problem.duration, STEPS)


def unbounded(**changed: object) -> TwoPoint:
    case = replace(instance.load("return-to-orbit"), **changed)  # type: ignore[arg-type]
    free = replace(case, lower=(-np.inf,) * 2, upper=(np.inf,) * 2)
    return two_point(free, 1.0)


@pytest.mark.parametrize("backwards", [False, True])
def test_they_are_those_of_an_adaptive_integrator(backwards: bool) -> None:
    problem = unbounded(tf=1.0)
    begun, found = drawn(problem, 0.1, backwards=backwards)
    ends, theta = ((1.0, 0.0) if backwards else (0.0, 1.0)), problem.theta
    for k in range(begun.shape[1]):

        def rates(tau: float, y: np.ndarray) -> np.ndarray:
            at, z = np.array([tau]), y[:-1, None]
            cost = problem.running_cost(at, z, theta)
            return problem.duration * np.append(problem.rates(at, z, theta)[:, 0], cost[0])

        run = solve_ivp(rates, ends, np.append(begun[:, k], 0.0), rtol=1e-10, atol=1e-12)
        there = found.z[0 if backwards else -1][:, k]
        assert there == pytest.approx(run.y[:-1, -1], rel=1e-5, abs=1e-5)
        costs = found.costs[:, k]
        assert costs[0 if backwards else -1] == pytest.approx(abs(run.y[-1, -1]), rel=2.0 / STEPS, abs=1e-6)
        assert (np.diff(costs) * (-1.0 if backwards else 1.0) >= 0.0).all()


def test_radii_are_positive_and_nothing_more() -> None:
    """Close to the centre motions have a cost, whatever a radius of one is, and through it they have none."""
    problem = unbounded(initial=(0.4, 0.0, 0.0, 4.0), tf=0.3)
    _, found = drawn(problem, 1e-3, backwards=False)
    assert np.isfinite(found.costs).all()
    falling = unbounded(initial=(0.4, -30.0, 0.0, 0.0), tf=1.0)
    _, through = drawn(falling, 1e-3, backwards=False)
    assert np.isinf(through.costs[-1]).all()
