"""Cold starts of random returns to an orbit: everything is solved, and certified."""

from __future__ import annotations

import pytest

from satsym.solve import solve
from satsym.status import Status
from tests.samples import EASY, HARD, Population

CHUNK = 50


@pytest.mark.slow
@pytest.mark.parametrize("first", range(0, 200, CHUNK))
def test_hard_returns_are_certified_from_nothing(first: int) -> None:
    check(HARD, first)


def test_easy_returns_are_certified_from_nothing() -> None:
    check(EASY, 0)


def check(population: Population, first: int) -> None:
    for number in range(first, first + CHUNK):
        found = solve(population.case(number))
        assert found.status is Status.CONVERGED, (number, found.message)
        assert found.certificate is not None
        assert found.certificate.verdict == "certified", (number, found.certificate)
        assert found.certificate.boundary_residual < 1e-9
        assert found.x[0].min() > 0.0
