"""Bounds that differ by many orders of magnitude: exact where that is possible, and otherwise honest."""

from __future__ import annotations

import pytest

from satsym.solvers.by_search import bang_bang
from satsym.status import Status
from tests.support.switching_closed_forms import TIME, case


@pytest.mark.parametrize(
    ("push", "brake"),
    [
        (1e-1, 1e1),
        (1e1, 1e-1),
        (1e-3, 1e1),
        pytest.param(1e-6, 1e6, marks=pytest.mark.study),
        pytest.param(1e6, 1e-6, marks=pytest.mark.study),
    ],
)
def test_a_soft_push_and_a_hard_brake_take_the_time_of_the_closed_form(push: float, brake: float) -> None:
    # From q = 1 at rest: with -push until s and +brake from there; the speeds meet, and so do the ways.
    found = bang_bang(case(TIME, initial=(1.0, 0.0), lower=(-push,), upper=(brake,)))
    switch = (2.0 / (push * (1.0 + push / brake))) ** 0.5
    assert found.status in (Status.CONVERGED, Status.NOT_CONVERGED), found.message
    if max(push, brake) / min(push, brake) < 1e5:
        assert found.status is Status.CONVERGED, found.message
    if found.status is Status.CONVERGED:
        assert found.switching_times[0] == pytest.approx((switch,), rel=1e-9)
        assert found.objective == pytest.approx(switch * (1.0 + push / brake), rel=1e-9)
