"""Cold starts of random returns to an orbit: all are solved, integrate to the end, and are minima."""

from __future__ import annotations

from dataclasses import replace
from itertools import islice

import numpy as np
import pytest

from satsym.solvers import by_search
from satsym.solvers.certificate import certify, conditions
from satsym.solvers.certificate.jacobi import conjugate
from satsym.solvers.certificate.reintegration.flow import flow
from satsym.solvers.certificate.reintegration.segments import segments
from satsym.solvers.collocation.arclength import extremals
from satsym.solvers.collocation.newton import newton
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.scaling import final_argument
from satsym.solvers.collocation.scaling import two_point as to_scaled
from satsym.solvers.collocation.second_variation import negative_directions
from satsym.solvers.iteration import Limits, computed
from satsym.solvers.two_point import cold_start
from satsym.status import Status
from tests.support.samples import EASY, HARD, Population

EACH, STUDY, SHARE = 6, 204, 17
"""Cases of a test, and of all of them; every so many tests one that always runs.

One case of a test has a whole certificate: competitors take longer than solving.
"""

SECONDS = 60.0


def scaled(number: int) -> TwoPoint:
    case = HARD.case(number)
    assert case.tf is not None
    return to_scaled(case, case.tf).relaxed(float("inf"))


@pytest.mark.slow
@pytest.mark.parametrize(
    "first",
    [
        pytest.param(first, marks=[pytest.mark.study] if number % SHARE else [])
        for number, first in enumerate(range(0, STUDY, EACH))
    ],
)
def test_hard_returns_are_solved_from_a_cold_start(first: int) -> None:
    check(HARD, range(first, first + EACH))


@pytest.mark.slow
def test_easy_returns_are_solved_from_a_cold_start() -> None:
    check(EASY, range(20))


def check(population: Population, numbers: range) -> None:
    for number in numbers:
        found = by_search.collocation(population.case(number))
        assert found.status is Status.CONVERGED, (number, found.message)
        again = flow(found)
        assert again is not None
        assert conditions.boundary_residual(found, again) < 1e-9, number
        field = conjugate(found, segments(found))
        assert field.resolved, number
        assert field.time is None, number
        assert again.x[0].min() > 0.0
        if number == numbers[0]:
            certificate = certify(found)
            assert certificate is not None
            assert certificate.verdict == "certified", (number, certificate)


@pytest.mark.slow
def test_a_return_with_five_turns_inwards_from_far_out_is_solved() -> None:
    found = by_search.collocation(HARD.case(1704))
    assert found.status is Status.CONVERGED, found.message
    again = flow(found)
    assert again is not None
    assert conditions.boundary_residual(found, again) < 1e-9


def test_extremals_are_followed_round_a_fold() -> None:
    """Where the minima of this return end, they meet extremals with one negative direction, which lead back."""
    wanted = scaled(1206)
    angle = wanted.instance.final["theta"]
    assert isinstance(angle, float)

    def at(fraction: float) -> TwoPoint:
        final = {**wanted.instance.final, "theta": angle + 0.5 * (1.0 - fraction)}
        moved = replace(wanted.instance, final=final)
        return replace(wanted, instance=moved, final=final_argument(moved))

    found = cold_start(at(0.0), Limits(500, computed() + SECONDS)).found
    assert found.minimum
    points = list(islice(extremals(at, found.curve), 12))
    fractions = np.array([point.fraction for point in points])
    fold = int(fractions.argmax())
    assert 0 < fold < len(points) - 1
    assert fractions[fold] < 1.0
    assert (np.diff(fractions[: fold + 1]) > 0.0).all()
    assert (np.diff(fractions[fold:]) < 0.0).all()
    directions = [negative_directions(p.problem, p.curve, p.linearised.matching) for p in points]
    assert set(directions[:fold]) == {0}
    assert set(directions[fold + 1 :]) == {1}
    for point in (points[0], points[fold], points[-1]):
        outcome = newton(point.system, point.curve)
        assert outcome is not None
        assert outcome.solved
        assert outcome.curve.nodes == pytest.approx(point.curve.nodes, rel=1e-4, abs=1e-4)
