"""Infinitely many switches in finite time: what the least cost lies between, held against closed forms and competitors.

The closed forms are in :mod:`tests.support.fuller`.
"""

from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import minimize
from sympy import sin

from satsym import instance
from satsym import solvers as solve
from satsym.cli.saving import save, trajectory_files
from satsym.report.results import trajectory
from satsym.report.results.objects import solution_object
from satsym.solution import Solution
from satsym.solvers import certificate
from satsym.status import Status, Verdict
from satsym.symbolic.switching.singular import chattering
from tests.support import switching_models as models
from tests.support.fuller import coefficient, least, ratios
from tests.switching.test_switching_models import FREE, case, problem, v, w, x, y

KNOWN = tomllib.loads((Path(__file__).parents[1] / "bench" / "optima.toml").read_text(encoding="utf-8"))
CHATTERS = "infinitely many switching times: chattering"
FULLER = problem("fullers", {x: y, y: v}, x**2, ("v",))


def failed(found: Solution) -> list[str]:
    """Checks that do not pass."""
    assert found.certificate is not None
    return [check.name for check in found.certificate.checks if not check.passed]


def holds(found: Solution, cost: float, width: float) -> None:
    """The stated interval must have the least cost in it, and be so narrow, relative to it."""
    assert found.status is Status.CONVERGED, found.message
    assert CHATTERS in found.message
    assert found.interval is not None
    assert found.interval.lower <= cost <= found.interval.upper == found.objective
    assert found.interval.upper - found.interval.lower <= width * cost


def test_fullers_least_cost_is_within_what_is_stated_and_comes_back_from_its_files(tmp_path: Path) -> None:
    found = solve.solve(instance.load("fuller"))
    known = least(0.0, 1.0)
    holds(found, known.cost, 1e-8)
    assert found.objective == pytest.approx(known.cost, rel=1e-8)
    assert known.cost == pytest.approx(KNOWN["fuller"]["optimum"], rel=1e-13)
    assert found.switching_times[0] == pytest.approx(known.times[:3], abs=1e-3)  # the last is smoothed
    assert found.switching_times[0][:2] == pytest.approx(known.times[:2], abs=2e-5)
    resting = found.times > known.over + 0.1
    assert np.abs(found.u[0, resting]).max() < 1e-2
    assert failed(found) == [CHATTERS]
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.EXTREMAL_ONLY
    stated = solution_object(found)
    assert found.interval is not None
    assert stated["cost_interval"] == [found.interval.lower, found.interval.upper]
    save(tmp_path, stated, trajectory_files(tmp_path, found, look=None))
    again, _ = trajectory.read(found.instance, tmp_path)
    assert isinstance(again, Solution)
    assert again.interval == found.interval


def test_a_narrower_interval_than_the_motion_allows_is_refused() -> None:
    found = solve.solve(instance.load("fuller"))
    assert found.interval is not None
    middle = (found.interval.lower + found.interval.upper) / 2.0
    again = certificate.certify(replace(found, interval=replace(found.interval, lower=middle)))
    assert again is not None
    assert again.verdict is Verdict.FAILED
    assert [c.name for c in again.checks if not c.passed] == ["cost interval too narrow", CHATTERS]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "end", "tf"),
    [
        ((0.0, 1.0), (0.0, 0.0), FREE),
        pytest.param((100.0, 0.0), (0.0, 0.0), "60.0", marks=pytest.mark.slow),
        pytest.param((0.0, 1e-3), (0.0, 0.0), "0.01", marks=pytest.mark.slow),
        pytest.param((1.0, 0.0), None, "5.0", marks=pytest.mark.slow),
        pytest.param((0.0, 1.0), (0.0, 0.0), "2.95", marks=pytest.mark.slow),
    ],
    ids=["free time", "large", "small", "free end", "little rest"],
)
def test_the_least_cost_is_within_the_interval_in_all_sizes(
    tmp_path: Path, start: tuple[float, float], end: tuple[float, float] | None, tf: str
) -> None:
    found = solve.solve(case(tmp_path, FULLER, start, end, tf))
    holds(found, least(*start).cost, 1e-7)
    estimate = (
        ["the lower end of the cost interval is only an estimate, because the problem is not convex"]
        if tf == FREE
        else []
    )
    assert failed(found) == [CHATTERS, *estimate]


def test_in_less_time_the_switches_are_as_many_as_they_are(tmp_path: Path) -> None:
    found = solve.solve(case(tmp_path, FULLER, (0.0, 1.0), (0.0, 0.0), "2.7"))
    assert found.interval is None
    assert len(found.switching_times[0]) == 2
    assert found.objective > least(0.0, 1.0).cost
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED


def best_of(switches: int, damping: float, start: tuple[float, float], a: float = 1.0, b: float = 1.0) -> float:
    """The least cost with so many switches, then rest: by the lengths of arcs, each a matrix exponential."""

    def run(lengths: np.ndarray) -> tuple[float, np.ndarray]:
        z, cost = np.array([*start, 0.0]), 0.0
        for k, h in enumerate(lengths):
            z[2] = -a if k % 2 == 0 else b
            rates = np.array([[0.0, 1.0, 0.0], [0.0, -damping, 1.0], [0.0, 0.0, 0.0]])
            # Van Loan: the integral of a quadratic form along a linear motion
            block = expm(h * np.block([[-rates.T, np.diag([1.0, 0.0, 0.0])], [np.zeros((3, 3)), rates]]))
            cost += z @ block[3:, 3:].T @ block[:3, 3:] @ z
            z = block[3:, 3:] @ z
        return float(cost), z[:2]

    begun = np.diff([0.0, *least(*start, a, b).times[: switches + 1]])
    met = {"type": "eq", "fun": lambda lengths: run(lengths)[1]}
    options = {"ftol": 1e-15, "maxiter": 300}
    bounds, first = [(0.0, 10.0)] * len(begun), lambda lengths: run(lengths)[0]
    return float(minimize(first, begun, constraints=[met], bounds=bounds, method="SLSQP", options=options).fun)


def test_the_closed_form_is_fullers_where_bounds_are_alike() -> None:
    xi = ((33.0**0.5 - 1.0) / 24.0) ** 0.5
    assert ratios(1.0, 1.0) == pytest.approx([((1.0 - 2.0 * xi) / (1.0 + 2.0 * xi)) ** 0.5] * 2, rel=1e-12)
    assert coefficient(ratios(1.0, 1.0)[0]) == pytest.approx(xi, rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("a", "b", "tf", "width", "apart"),
    [
        (1.0, 0.1, 10.0, 1e-5, 1e-3),
        (0.1, 1.0, 60.0, 1e-7, 1e-2),
        (1.0, 0.3, 8.0, 1e-6, 1e-4),
        pytest.param(1.0, 0.01, 60.0, 1e-4, 1e-3, marks=pytest.mark.study),
    ],
)
def test_between_bounds_that_are_unlike_the_force_chatters_as_well(
    a: float, b: float, tf: float, width: float, apart: float
) -> None:
    found = solve.solve(replace(instance.load("fuller"), lower=(-a,), upper=(b,), tf=tf))
    known = least(0.0, 1.0, a, b)
    holds(found, known.cost, width)
    assert found.switching_times[0][0] == pytest.approx(known.times[0], rel=apart)
    assert failed(found) == [CHATTERS]


@pytest.mark.parametrize(("a", "b"), [(1.0, 0.1), (0.1, 1.0)])
def test_a_time_too_short_for_such_bounds_is_infeasible(a: float, b: float) -> None:
    """From x = 0 with x' = 1: stop, and back by two arcs, of which the speed w between follows from the way."""
    found = solve.solve(replace(instance.load("fuller"), lower=(-a,), upper=(b,)))
    w = (1.0 / a / (1.0 / a + 1.0 / b)) ** 0.5
    assert found.status is Status.INFEASIBLE
    least_time = found.message.partition("final state is ")[2].partition(" ")[0]
    assert float(least_time) == pytest.approx((1.0 + w) / a + w / b, rel=1e-9)


@pytest.mark.study
def test_six_switches_cost_no_less_than_the_closed_form_and_hardly_more() -> None:
    assert best_of(6, 0.0, (0.0, 1.0), 1.0, 0.3) == pytest.approx(least(0.0, 1.0, 1.0, 0.3).cost, rel=1e-6)


@pytest.mark.study
def test_a_damped_body_cannot_be_undercut_by_six_switches(tmp_path: Path) -> None:
    assert best_of(6, 0.0, (0.0, 1.0)) == pytest.approx(least(0.0, 1.0).cost, rel=1e-8)
    damped = problem("damped", {x: y, y: -0.3 * y + v}, x**2, ("v",))
    found = solve.solve(case(tmp_path, damped, (1.0, 0.5), (0.0, 0.0), "6.0"))
    six = best_of(6, 0.3, (1.0, 0.5))
    assert found.interval is not None
    assert found.interval.lower <= six
    assert found.objective == pytest.approx(six, rel=1e-8)
    assert failed(found) == [CHATTERS]


@pytest.mark.study
@pytest.mark.parametrize(
    ("one", "start", "tf"),
    [
        (problem("swung", {x: y, y: -sin(x) + v}, x**2, ("v",)), (1.0, 0.0), "6.0"),
        (problem("pulled", {x: y, y: v - 0.25}, x**2, ("v",)), (0.0, 1.0), "5.0"),
        (problem("twofold", {x: y, y: v + w / 2}, x**2, ("v", "w")), (1.0, 0.5), "6.0"),
    ],
    ids=lambda one: getattr(one, "name", ""),
)
def test_other_motions_to_rest_chatter_as_well(
    tmp_path: Path, one: models.Problem, start: tuple[float, float], tf: str
) -> None:
    found = solve.solve(case(tmp_path, one, start, (0.0, 0.0), tf))
    assert found.interval is not None, found.message
    assert found.interval.upper - found.interval.lower <= 1e-6 * found.objective
    assert failed(found) == [CHATTERS]


def test_what_chatters_is_derived_from_the_order_of_singular_arcs() -> None:
    assert chattering(models.derived(models.FULLER)) == ("u1",)
    for other in (models.DAMPER, models.REGULATOR, models.WORST, models.MINIMUM_TIME, models.LEAST_FUEL):
        assert chattering(models.derived(other)) == ()
    against = models.switching(models.CHAIN, -(models.x1**2) / 2)
    assert chattering(models.derived(against)) == ()  # Kelley's condition fails
    assert chattering(models.derived(models.switching(models.CHAIN, -(models.x1**2), maximise=True))) == ("u1",)
    assert chattering(models.derived(models.FULLER, "maximum")) == ("u1",)
