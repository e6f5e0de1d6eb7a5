"""Cold starts of random returns to an orbit: all are solved, integrate to the end, and are minima."""

from __future__ import annotations

import pytest

from satsym.solve import two_point
from satsym.solve.certificate import certify, conditions
from satsym.solve.certificate.flow import flow
from satsym.status import Status
from tests.samples import EASY, HARD, Population

CHUNK, WHOLE = 50, 5
"""Cases of a test, and how many of them share one whole certificate: competitors take longer than solving."""


@pytest.mark.slow
@pytest.mark.parametrize("first", range(0, 200, CHUNK))
def test_hard_returns_are_solved_from_nothing(first: int) -> None:
    check(HARD, first)


def test_easy_returns_are_solved_from_nothing() -> None:
    check(EASY, 0)


def check(population: Population, first: int) -> None:
    for number in range(first, first + CHUNK):
        found = two_point.solve(population.case(number))
        assert found.status is Status.CONVERGED, (number, found.message)
        again = flow(found)
        assert again is not None
        assert conditions.boundary_residual(found, again) < 1e-9, number
        assert conditions.conjugate_time(again) is None, number
        assert again.x[0].min() > 0.0
        if number % WHOLE == 0:
            certificate = certify(found)
            assert certificate is not None
            assert certificate.verdict == "certified", (number, certificate)
