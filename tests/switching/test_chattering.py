"""Infinitely many switches in finite time: what the least cost lies between, held against closed forms and competitors.

Fuller's problem is the same in all sizes: with x2 smaller by q and x1 by q^2 it takes q of the time and costs q^5. Its
force switches where x1 = -XI x2 |x2|, and from one switch to the next x2 becomes smaller by Q.
"""

from __future__ import annotations

import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.polynomial import Polynomial
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
from tests.switching.test_switching_models import FREE, case, problem, v, w, x, y

XI = ((33.0**0.5 - 1.0) / 24.0) ** 0.5
Q = ((1.0 - 2.0 * XI) / (1.0 + 2.0 * XI)) ** 0.5
KNOWN = tomllib.loads((Path(__file__).parents[1] / "bench" / "optima.toml").read_text(encoding="utf-8"))
CHATTERS = "infinitely many switching times: chattering"
FULLER = problem("fullers", {x: y, y: v}, x**2, ("v",))


def spent(position: float, velocity: float, force: float, duration: float) -> float:
    """The integral of the squared position under a constant force."""
    return float((Polynomial([position, velocity, force / 2.0]) ** 2).integ()(duration))


def least(position: float, velocity: float) -> tuple[float, list[float], float]:
    """The least cost, the first switching times and when all is over, from where the force is to be -1 at first."""
    speed = ((velocity**2 / 2.0 + position) / (0.5 + XI)) ** 0.5
    first = velocity + speed
    lengths = [first, *(speed * (1.0 + Q) * Q**k for k in range(3))]
    cost = spent(position, velocity, -1.0, first) + spent(XI, -1.0, 1.0, 1.0 + Q) * speed**5 / (1.0 - Q**5)
    return cost, np.cumsum(lengths).tolist(), first + speed * (1.0 + Q) / (1.0 - Q)


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
    cost, times, over = least(0.0, 1.0)
    holds(found, cost, 1e-8)
    assert found.objective == pytest.approx(cost, rel=1e-8)
    assert cost == pytest.approx(KNOWN["fuller"]["optimum"], rel=1e-13)
    assert found.switching_times[0] == pytest.approx(times[:3], abs=1e-3)  # the last is smoothed
    assert found.switching_times[0][:2] == pytest.approx(times[:2], abs=2e-5)
    resting = found.times > over + 0.1
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


@pytest.mark.slow(in_turn=True)
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
    holds(found, least(*start)[0], 1e-7)
    estimate = ["lower end of the cost interval is an estimate: not convex"] if tf == FREE else []
    assert failed(found) == [CHATTERS, *estimate]


def test_in_less_time_the_switches_are_as_many_as_they_are(tmp_path: Path) -> None:
    found = solve.solve(case(tmp_path, FULLER, (0.0, 1.0), (0.0, 0.0), "2.7"))
    assert found.interval is None
    assert len(found.switching_times[0]) == 2
    assert found.objective > least(0.0, 1.0)[0]
    assert found.certificate is not None
    assert found.certificate.verdict is Verdict.CERTIFIED


def best_of(switches: int, damping: float, start: tuple[float, float]) -> float:
    """The least cost with so many switches, then rest: by the lengths of arcs, each a matrix exponential."""

    def run(lengths: np.ndarray) -> tuple[float, np.ndarray]:
        z, cost = np.array([*start, 0.0]), 0.0
        for k, h in enumerate(lengths):
            z[2] = -1.0 if k % 2 == 0 else 1.0
            a = np.array([[0.0, 1.0, 0.0], [0.0, -damping, 1.0], [0.0, 0.0, 0.0]])
            # Van Loan: the integral of a quadratic form along a linear motion
            block = expm(h * np.block([[-a.T, np.diag([1.0, 0.0, 0.0])], [np.zeros((3, 3)), a]]))
            cost += z @ block[3:, 3:].T @ block[:3, 3:] @ z
            z = block[3:, 3:] @ z
        return float(cost), z[:2]

    speed = ((start[1] ** 2 / 2.0 + start[0]) / (0.5 + XI)) ** 0.5
    begun = np.array([start[1] + speed, *(speed * (1.0 + Q) * Q**k for k in range(switches))])
    met = {"type": "eq", "fun": lambda lengths: run(lengths)[1]}
    options = {"ftol": 1e-15, "maxiter": 300}
    bounds, first = [(0.0, 10.0)] * len(begun), lambda lengths: run(lengths)[0]
    return float(minimize(first, begun, constraints=[met], bounds=bounds, method="SLSQP", options=options).fun)


@pytest.mark.study
def test_a_damped_body_cannot_be_undercut_by_six_switches(tmp_path: Path) -> None:
    assert best_of(6, 0.0, (0.0, 1.0)) == pytest.approx(least(0.0, 1.0)[0], rel=1e-8)
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
