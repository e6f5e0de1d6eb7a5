"""The sweep without bounds: right, fourth order, a true gradient, a descent, and clear about why it stops."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from satsym.grid import Grid
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers import solve
from satsym.solvers.sweep.quasi_newton import CLOSE_RESIDUAL
from satsym.solvers.sweep.sweeps import SweepProblem, backward, forward
from satsym.status import BadInput, Status
from tests.support.canonical import Extremal, Orbit, collocation, shooting
from tests.support.cases import parameters, shipped, with_parameters

STEPS = (40, 80, 160, 320, 640)


@cache
def soft_return() -> Extremal:
    """By shooting, to the last digits that doubles allow."""
    return shooting(Orbit(), collocation(Orbit()).costate)


def problem_of(case: Instance) -> SweepProblem:
    assert case.tf is not None
    return SweepProblem(case, case.model, Grid.uniform(case.t0, case.tf, case.solver.steps))


def waves(times: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Smooth random functions of time, shape (2, M), of size about 1."""
    frequencies, phases = rng.uniform(0.2, 3.0, (2, 6, 1)), rng.uniform(0.0, 2.0 * math.pi, (2, 6, 1))
    return (rng.normal(size=(2, 6, 1)) * np.sin(frequencies * times + phases)).sum(axis=1) / 2.0


def errors(solution: Solution, known: Extremal) -> tuple[float, float, float]:
    """Largest errors of states and costates, and the error of the cost."""
    y = known.at(solution.times)
    states, costates = np.abs(solution.x - y[:4]).max(), np.abs(solution.lam - y[4:8]).max()
    return float(states), float(costates), abs(solution.objective - known.cost)


def order(steps: tuple[int, ...], values: list[float]) -> float:
    return float(-np.polyfit(np.log(steps), np.log(values), 1)[0])


def test_the_soft_return_costs_what_collocation_finds():
    known, solution = collocation(Orbit()), solve(shipped("soft-return"))
    assert solution.status is Status.CONVERGED
    assert f"{solution.objective:.11f}" == "0.00042658941", "pinned"
    assert abs(solution.objective / known.cost - 1.0) <= 1e-7
    y = known.at(solution.times)
    assert np.abs(solution.lam - y[4:8]).max() <= 1e-7 * np.abs(y[4:8]).max()
    assert np.abs(solution.lam[:, 0] - known.costate).max() <= 1e-7 * np.abs(known.costate).max()
    assert np.abs(solution.x - y[:4]).max() <= 1e-7
    assert np.abs(solution.u - Orbit().wanted(y)).max() <= 1e-7 * np.abs(solution.u).max()


def test_collocation_and_shooting_agree_on_what_is_to_be_found():
    known = collocation(Orbit())
    assert abs(soft_return().cost / known.cost - 1.0) <= 1e-10
    assert np.abs(soft_return().costate - known.costate).max() <= 1e-10


def test_states_costates_and_cost_are_fourth_order():
    found = [solve(shipped("soft-return", steps=n, tolerance=1e-11)) for n in STEPS]
    assert all(solution.status is Status.CONVERGED for solution in found)
    for row in zip(*(errors(solution, soft_return()) for solution in found), strict=True):
        assert 3.8 <= order(STEPS, list(row)) <= 4.2
        assert min(np.log2(np.divide(row[:-1], row[1:]))) >= 3.7


@pytest.mark.parametrize("seed", range(3))
def test_the_gradient_of_the_sweep_is_that_of_the_cost(seed):
    rng = np.random.default_rng(seed)
    mismatch = []
    for steps in (400, 800):
        problem = problem_of(shipped("soft-return", steps=steps))
        u, v = 0.05 * waves(problem.times, np.random.default_rng(seed + 10)), waves(problem.times, rng)
        rng = np.random.default_rng(seed)
        slope = float(np.sum(problem.weights * backward(problem, forward(problem, u)).gradient * v))

        def central(h: float, u=u, v=v, problem=problem) -> float:
            up, down = forward(problem, u + h * v), forward(problem, u - h * v)
            assert up.usable
            assert down.usable
            return (up.objective - down.objective) / (2.0 * h)

        measured = (4.0 * central(1e-4) - central(2e-4)) / 3.0
        mismatch.append(abs(slope / measured - 1.0))
    assert mismatch[1] <= 1e-6
    assert mismatch[1] <= mismatch[0] / 8.0 + 1e-9, "they differ by the error of the discretisation"


@pytest.mark.parametrize("case", ["soft-return", "geo", "bounded", "angle", "far"])
def test_the_cost_never_increases_while_far_from_the_optimum(case):
    base = shipped("soft-return", steps=300)
    instances = {
        "soft-return": base,
        "geo": shipped("soft-return-geo", steps=300),
        "bounded": replace(base, lower=(-0.01, -0.004), upper=(0.006, 0.02)),
        "angle": with_parameters(base, k3=10.0, c1=0.2),
        "far": replace(base, initial=(1.4, 0.1, 0.0, 0.7), tf=4.0),
    }
    history = solve(instances[case]).history
    assert len(history) > 5
    for before, after in pairwise(history):
        if before.residual >= CLOSE_RESIDUAL:
            assert after.objective < before.objective
    assert [entry.number for entry in history] == list(range(len(history)))


@pytest.mark.slow
@pytest.mark.parametrize("bounds", [((-math.inf,) * 2, (math.inf,) * 2), ((-0.005, -0.004), (0.006, 0.005))])
def test_no_admissible_perturbation_of_the_optimum_costs_less(bounds):
    case = replace(shipped("soft-return", steps=400, tolerance=1e-10), lower=bounds[0], upper=bounds[1])
    solution, problem = solve(case), problem_of(case)
    known = shooting(orbit := Orbit(lower=bounds[0], upper=bounds[1]), collocation(orbit, 1e-6).costate)
    limits = [np.array(side)[:, None] for side in bounds]
    best = np.clip(orbit.wanted(known.at(problem.times)), *limits)
    least = forward(problem, best).objective
    assert least == pytest.approx(solution.objective, rel=1e-6)
    rng = np.random.default_rng(3)
    for size in (0.3, 0.1, 0.03):
        for _ in range(10):
            other = np.clip(best + size * np.abs(best).max() * waves(problem.times, rng), *limits)
            assert np.abs(other - best).max() > 0.0
            assert forward(problem, other).objective > least


def test_python_and_numba_agree_to_rounding():
    pytest.importorskip("numba")
    case = replace(shipped("soft-return", steps=400), lower=(-0.005, -0.004), upper=(0.006, 0.005))
    problem = problem_of(case)
    u = 0.05 * waves(problem.times, np.random.default_rng(5))
    one, other = (
        backward(p := replace(problem, kernels=k), forward(p, u)) for k in (case.model, case.model.compiled())
    )
    for name in ("lam", "law", "gradient"):
        ours, theirs = getattr(one, name), getattr(other, name)
        assert np.abs(ours - theirs).max() <= 1e-12 * np.abs(ours).max()
    assert np.abs(one.forward.x - other.forward.x).max() <= 1e-12
    assert one.objective == pytest.approx(other.objective, rel=1e-12)
    slow, fast = (
        solve(replace(case, solver=shipped("soft-return", steps=400, tolerance=1e-11, backend=b).solver))
        for b in ("python", "numba")
    )
    assert slow.status is fast.status is Status.CONVERGED
    assert slow.objective == pytest.approx(fast.objective, rel=1e-12)
    # both stop somewhere below the tolerance
    assert np.abs(slow.lam - fast.lam).max() <= 1e-10 * np.abs(slow.lam).max()


@cache
def geo() -> Solution:
    return solve(shipped("soft-return-geo"))


@pytest.mark.slow
def test_the_geostationary_satellite_is_back_in_its_slot_within_a_day():
    solution = geo()
    assert solution.status is Status.CONVERGED
    r, r_dot, theta, theta_dot = solution.x[:, -1]
    assert solution.instance.tf == 86400.0
    slot = 7.2921159e-5 * 86400.0
    away = math.hypot(r * math.cos(theta - slot) - 42164.17, r * math.sin(theta - slot))
    assert away <= 0.1, "km"
    assert math.hypot(r_dot, r * (theta_dot - 7.2921159e-5)) <= 1e-5, "km/s"


@pytest.mark.slow
def test_the_answer_does_not_depend_on_the_units():
    """Lengths in sigma and times in 1/omega: the same problem with weights in those units, solved anew.

    The final errors, which the costates multiply, are a millionth of sigma: so much less can be asked of costates.
    """
    sigma, omega = 42164.17, 7.2921159e-5
    case, solution = shipped("soft-return-geo"), geo()
    speed, effort = sigma * omega, sigma**2 * omega**3
    scale = np.array([sigma, speed, 1.0, omega])
    given = parameters(case)
    weights = [given[f"k{i + 1}"] * scale[i] ** 2 / effort for i in range(4)]
    normalised = with_parameters(case, sigma=1.0, omega=1.0, **{f"k{i + 1}": weights[i] for i in range(4)})
    start = tuple((np.array(case.initial) / scale).tolist())
    unit = solve(replace(normalised, initial=start, tf=case.tf * omega))
    assert unit.status is Status.CONVERGED
    assert np.allclose(solution.times * omega, unit.times, rtol=1e-14)
    assert solution.objective / effort == pytest.approx(unit.objective, rel=1e-9)
    assert np.abs(solution.x / scale[:, None] - unit.x).max() <= 1e-10
    assert np.abs(solution.u / (sigma * omega**2) - unit.u).max() <= 1e-6 * np.abs(unit.u).max()
    costates = solution.lam * scale[:, None] / effort
    assert np.abs(costates - unit.lam).max() <= 1e-6 * np.abs(unit.lam).max()
    # and it is what collocation finds
    known = collocation(Orbit(k=tuple(weights), start=start, tf=case.tf * omega), 1e-9)
    assert unit.objective == pytest.approx(known.cost, rel=1e-7)
    assert np.abs(unit.lam[:, 0] - known.costate).max() <= 1e-6 * np.abs(known.costate).max()


def test_too_little_time_is_a_time_limit_with_advice():
    solution = solve(shipped("soft-return", max_seconds=1e-9))
    assert solution.status is Status.TIME_LIMIT
    assert solution.message == "time limit reached after 0 iterations"
    assert "max_seconds" in solution.status.advice
    assert np.isfinite(solution.objective)


def test_too_few_iterations_are_not_converged_with_advice():
    solution = solve(shipped("soft-return", max_iterations=1))
    assert solution.status is Status.NOT_CONVERGED
    assert solution.message == "no convergence in 1 iteration"
    assert "guess" in solution.status.advice
    assert solution.iterations == 1
    assert solution.history[1].objective < solution.history[0].objective


@pytest.mark.parametrize(
    ("start", "status", "what"),
    [
        ((1.0, -5.0, 0.0, 0.0), Status.LEFT_DOMAIN, "leaves the domain"),
        ((1e-200, 0.0, 0.0, 1.0), Status.NON_FINITE, "is not finite"),
        ((1e200, 0.0, 0.0, 1e200), Status.NON_FINITE, "is not finite"),
    ],
)
def test_a_start_that_leads_nowhere_is_named_with_advice(start, status, what):
    solution = solve(replace(shipped("soft-return", steps=50), initial=start))
    assert solution.status is status
    assert solution.message == f"the motion under the initial guess of the control {what}"
    assert "initial state" in solution.status.advice
    assert np.isnan(solution.objective)
    assert np.isnan(solution.lam).all()
    assert (solution.iterations, solution.history, solution.switching_times) == (0, (), ((), ()))


def test_progress_is_told_every_iteration():
    told = []
    solution = solve(shipped("soft-return", steps=100), told.append)
    assert [entry.residual for entry in told] == [entry.residual for entry in solution.history]
    assert told[-1].residual <= 1e-9 < told[0].residual


def test_a_guess_of_the_control_is_where_it_starts():
    from satsym.instance import Guess

    case = shipped("soft-return", steps=200)
    cold = solve(case)
    middle = cold.u[:, ::20]
    warm = solve(replace(case, guess=Guess(control={"u1": tuple(middle[0]), "u2": tuple(middle[1])})))
    assert warm.history[0].objective < cold.history[0].objective
    assert warm.objective == pytest.approx(cold.objective, rel=1e-9)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"final": {"r": 1.0, "theta": "reference"}}, "a given final r, theta is not supported by the sweep method"),
        ({"tf": None}, "free final time"),
    ],
)
def test_what_cannot_be_swept_for_is_refused(changed, message):
    with pytest.raises(BadInput, match=message):
        solve(replace(shipped("soft-return"), **changed))


def test_a_descent_that_is_stuck_far_from_the_optimum_is_not_converged(monkeypatch):
    monkeypatch.setattr("satsym.solvers.sweep.quasi_newton.QuasiNewton._search", lambda *_: None)
    solution = solve(shipped("soft-return", steps=100))
    assert solution.status is Status.NOT_CONVERGED
    assert solution.message == "no step decreases the cost further; residual 1.0e+00"


def test_a_tolerance_below_rounding_is_met_as_far_as_rounding_allows():
    solution = solve(shipped("soft-return", steps=200, tolerance=1e-15))
    assert solution.status is Status.CONVERGED
    assert "as far as rounding allows" in solution.message
    assert 1e-15 < solution.history[-1].residual <= 1e-9
