"""Plain relaxation: stable below a limit that its message names, and then with the same answer."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from satsym.grid import Grid
from satsym.instance import Instance
from satsym.solvers import solve
from satsym.solvers.sweep.solving import largest_stable
from satsym.solvers.sweep.sweeps import SweepProblem, forward
from satsym.status import Status
from tests.support.cases import shipped

DIVERGING = 0.9
"""For the horizons here far above the limit."""


def short(tf: float, **options: object) -> Instance:
    return replace(shipped("soft-return", steps=60, **options), tf=tf)


@cache
def advised(tf: float) -> float:
    """The limit that the message of a relaxation states which diverges."""
    solution = solve(short(tf, relaxation=DIVERGING))
    assert solution.status is Status.NOT_CONVERGED
    found = re.search(
        r"relaxation 0\.9 (diverges|makes the sweeps repeat themselves); here the iteration converges only if "
        r"relaxation is below about (\S+);",
        solution.message,
    )
    assert found, solution.message
    assert "leave out relaxation to use a method without this limit" in solution.message
    return float(found[2])


def test_half_the_new_control_diverges_over_a_revolution_and_is_told_why():
    solution = solve(shipped("soft-return", steps=200, relaxation=0.5))
    assert solution.status is Status.NOT_CONVERGED
    assert solution.message.startswith(
        "relaxation 0.5 diverges; here the iteration converges only if relaxation is below about 0.009"
    )
    assert "leave out relaxation to use a method without this limit" in solution.message
    assert solution.iterations < 20, "it is given up early"


@pytest.mark.slow
@pytest.mark.parametrize("tf", [1.0, 2.0, 3.0])
def test_the_limit_is_sharp(tf):
    limit = advised(tf)
    below, above = (solve(short(tf, relaxation=fraction * limit)) for fraction in (0.9, 1.1))
    assert below.status is Status.CONVERGED
    assert above.status is Status.NOT_CONVERGED
    assert re.search("diverges|repeat themselves", above.message)


@pytest.mark.parametrize(("tf", "fraction"), [(0.5, 0.8), (1.0, 0.4), (2.0, 0.07)])
def test_both_methods_find_the_same_optimum(tf, fraction):
    relaxed, best = (solve(short(tf, relaxation=fraction, tolerance=1e-10)) for fraction in (fraction, None))
    assert relaxed.status is best.status is Status.CONVERGED
    assert relaxed.method == best.method == "sweep"
    assert relaxed.objective == pytest.approx(best.objective, rel=1e-12)
    for name in ("x", "u", "lam"):
        ours, theirs = getattr(relaxed, name), getattr(best, name)
        assert np.abs(ours - theirs).max() <= 1e-8 * np.abs(theirs).max()


def test_both_methods_find_the_same_optimum_with_bounds():
    bounds = {"lower": (-0.04, -0.05), "upper": (0.01, 0.05)}
    relaxed, best = (solve(replace(short(1.5, relaxation=fraction), **bounds)) for fraction in (0.1, None))
    assert relaxed.status is best.status is Status.CONVERGED
    assert any(best.switching_times)
    for ours, theirs in zip(relaxed.switching_times, best.switching_times, strict=True):
        assert ours == pytest.approx(theirs, abs=1e-7)
    assert relaxed.objective == pytest.approx(best.objective, rel=1e-10)


def test_the_limit_is_two_over_one_plus_the_largest_response():
    """Measured another way: the response of the law, assembled column by column, and its eigenvalues."""
    from satsym.solvers.sweep.sweeps import backward, unbounded_law

    case = replace(shipped("soft-return", steps=12), tf=1.5)
    best = solve(case)
    problem = SweepProblem(case, case.model, Grid.uniform(0.0, 1.5, 12))
    u = np.array([np.interp(problem.times, best.times, row) for row in best.u])

    def law(control: np.ndarray) -> np.ndarray:
        return unbounded_law(problem, backward(problem, forward(problem, control))).ravel()

    columns = []
    for i in range(u.size):
        push = np.zeros(u.size)
        push[i] = 1e-5
        push = push.reshape(u.shape)
        columns.append((law(u + push) - law(u - push)) / 2e-5)
    largest = -np.linalg.eigvals(np.transpose(columns)).real.min()
    assert largest_stable(problem, forward(problem, u)) == pytest.approx(2.0 / (1.0 + largest), rel=1e-3)


def test_relaxation_needs_no_share_where_control_and_law_agree_at_once():
    solution = solve(shipped("its-thesis", relaxation=1.0))
    assert solution.status is Status.CONVERGED
    assert solution.iterations == 0


def test_a_relaxation_that_leaves_the_domain_is_given_up_with_the_last_good_sweep():
    case = replace(shipped("soft-return", steps=100, relaxation=1.0), tf=4.0, initial=(1.3, 0.0, 0.0, 0.9))
    solution = solve(case)
    assert solution.status is Status.NOT_CONVERGED
    assert "diverges" in solution.message
    assert np.isfinite(solution.x).all()
    assert case.model.in_domain(solution.x)


def test_too_few_relaxations_are_not_converged():
    solution = solve(short(1.0, relaxation=0.1, max_iterations=3))
    assert solution.status is Status.NOT_CONVERGED
    assert solution.message == "no convergence in 3 iterations"
    assert solution.iterations == 3
