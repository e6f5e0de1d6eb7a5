"""The sweep with bounds: switching times, admissible controls, and fourth order with nodes at the corners."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from satsym.grid import Grid
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers import solve
from satsym.solvers.iteration import Limits, iterate
from satsym.solvers.sweep.quasi_newton import QuasiNewton
from satsym.solvers.sweep.sweeps import Sweep, SweepProblem, forward
from satsym.status import Status
from tests.support.canonical import Extremal, Orbit, collocation, shooting
from tests.support.cases import shipped

Bounds = tuple[tuple[float, float], tuple[float, float]]
BOUNDS: tuple[Bounds, ...] = (
    ((-0.01, -0.01), (0.01, 0.01)),
    ((-0.014, -0.010), (0.006, 0.012)),
    ((-0.012, -0.0115), (0.001, 0.009)),
    ((-0.005, -0.004), (0.006, 0.005)),
    ((0.0, 0.0), (1.0, 0.005)),
)
SEPARATE = BOUNDS[1:3]
"""Those whose corners lie far enough apart for 40 steps."""


@cache
def known(bounds: Bounds) -> Extremal:
    """By shooting over arcs between the corners."""
    orbit = Orbit(lower=bounds[0], upper=bounds[1])
    return shooting(orbit, collocation(orbit, 1e-6).costate)


def bounded(bounds: Bounds, **options: object) -> Instance:
    return replace(shipped("soft-return", **options), lower=bounds[0], upper=bounds[1])


@cache
def solved(bounds: Bounds) -> Solution:
    return solve(bounded(bounds, tolerance=1e-10))


def wanted(bounds: Bounds, y: np.ndarray) -> np.ndarray:
    """The optimal control at states and costates."""
    return np.clip(Orbit().wanted(y), *(np.array(side)[:, None] for side in bounds))


def on_uniform_grid(case: Instance) -> Sweep:
    """The first round of a solution, before any node is moved to a corner."""
    assert case.tf is not None
    problem = SweepProblem(case, case.model, Grid.uniform(case.t0, case.tf, case.solver.steps))
    none = np.clip(np.zeros((2, len(problem.times))), *(np.array(side)[:, None] for side in (case.lower, case.upper)))
    method = QuasiNewton(problem, forward(problem, none), case.solver.tolerance)
    return iterate(method, Limits(500, math.inf), None).state.sweep


def slopes(steps: tuple[int, ...], errors: list[list[float]]) -> np.ndarray:
    """Fitted orders, one a column."""
    return -np.polyfit(np.log(steps), np.log(errors), 1)[0]


@pytest.mark.slow
@pytest.mark.parametrize("bounds", BOUNDS)
def test_switching_times_cost_and_costates_are_those_of_shooting(bounds):
    solution = solved(bounds)
    assert solution.status is Status.CONVERGED
    assert [len(times) for times in solution.switching_times] == [len(times) for times in known(bounds).switches]
    assert any(solution.switching_times)
    for found, right in zip(solution.switching_times, known(bounds).switches, strict=True):
        assert np.abs(np.subtract(found, right)).max(initial=0.0) <= 1e-7
    assert solution.objective == pytest.approx(known(bounds).cost, rel=1e-7)
    y = known(bounds).at(solution.times)
    assert np.abs(solution.lam - y[4:8]).max() <= 1e-7 * np.abs(y[4:8]).max()
    assert np.abs(solution.x - y[:4]).max() <= 1e-7
    assert np.abs(solution.u - wanted(bounds, y)).max() <= 1e-7


@pytest.mark.parametrize("bounds", BOUNDS)
def test_the_control_is_admissible_everywhere_and_its_corners_are_nodes(bounds):
    solution = solved(bounds)
    for row, low, high, switches in zip(solution.u, *bounds, solution.switching_times, strict=True):
        assert (row >= low).all()
        assert (row <= high).all()
        assert bool(switches) == bool({low, high} & {row.min(), row.max()}), "a bound is met exactly, or not at all"
    horizon = solution.times[-1]
    for t in (t for times in solution.switching_times for t in times):
        assert np.abs(solution.times - t).min() <= 1e-8 * horizon


@pytest.mark.slow
@pytest.mark.parametrize("bounds", SEPARATE)
def test_with_nodes_at_the_corners_bounds_leave_it_fourth_order(bounds):
    steps, errors = (40, 80, 160, 320, 640), []
    for n in steps:
        solution = solve(bounded(bounds, steps=n, tolerance=1e-10))
        assert solution.status is Status.CONVERGED
        y = known(bounds).at(solution.times)
        errors.append(
            [
                np.abs(solution.x - y[:4]).max(),
                np.abs(solution.lam - y[4:8]).max(),
                abs(solution.objective - known(bounds).cost),
            ]
        )
    found = slopes(steps, errors)
    assert (found >= 3.75).all(), found
    assert (found <= 4.25).all(), found


@pytest.mark.slow
def test_without_nodes_at_the_corners_it_is_second_order():
    """A step across a corner is wrong by its square; J, being least at the optimum, only by the square of that."""
    steps, errors = tuple(round(40 * 2 ** (i / 2)) for i in range(9)), []
    for n in steps:
        sweep = on_uniform_grid(bounded(BOUNDS[0], steps=n, tolerance=1e-9))
        times = np.linspace(0.0, 2.0 * math.pi, 2 * n + 1)[::2]
        y = known(BOUNDS[0]).at(times)
        errors.append(
            [
                np.abs(sweep.forward.x[:, ::2] - y[:4]).max(),
                np.abs(sweep.lam[:, ::2] - y[4:8]).max(),
                abs(sweep.objective - known(BOUNDS[0]).cost),
            ]
        )
    states, costates, cost = slopes(steps, errors)
    # measured: 2.1, 2.2 and 3.8, with ups and downs as the corner lies in its step
    assert 1.5 <= states <= 2.8
    assert 1.5 <= costates <= 2.8
    assert 3.0 <= cost <= 5.0


def test_bounds_that_are_never_met_change_nothing():
    free, wide = solve(shipped("soft-return")), solve(bounded(((-1.0, -1.0), (1.0, 1.0))))
    assert wide.switching_times == ((), ())
    assert wide.objective == pytest.approx(free.objective, rel=1e-12)
    assert np.abs(wide.u - free.u).max() <= 1e-9 * np.abs(free.u).max()


@pytest.mark.parametrize("thrust", [0.0, 0.003, -0.01])
def test_a_control_with_equal_bounds_is_fixed_and_the_other_makes_the_best_of_it(thrust):
    bounds = ((-math.inf, thrust), (math.inf, thrust))
    solution, right = solve(bounded(bounds)), collocation(Orbit(lower=bounds[0], upper=bounds[1]))
    assert solution.status is Status.CONVERGED
    assert (solution.u[1] == thrust).all()
    assert solution.switching_times == ((), ()), "a fixed control does not switch"
    assert solution.objective == pytest.approx(right.cost, rel=1e-8)
    assert np.abs(solution.lam[:, 0] - right.costate).max() <= 1e-8 * np.abs(right.costate).max()


def test_controls_that_are_both_fixed_leave_nothing_to_choose():
    case = bounded(((0.002, 0.003), (0.002, 0.003)))
    solution = solve(case)
    assert solution.status is Status.CONVERGED
    assert solution.iterations == 0
    assert (solution.u == [[0.002], [0.003]]).all()
    assert solution.switching_times == ((), ())
