"""Where no law names the time, what begins later is the same problem: answers, certificates and all move with it."""

from __future__ import annotations

from dataclasses import replace

import msgspec
import numpy as np
import pytest

from satsym import instance, solvers
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers.continued import _guessed
from satsym.status import Status
from tests.solvers.test_search import programme_of

BY = 5.0

ALIKE = (
    "beam",
    "bryson-denham",
    "breakwell",
    "double-integrator-fuel",
    "double-integrator-time",
    "ends-5-free",
    "lapan-minimum-time",
    "linear-tangent",
    "zermelo",
)
"""Of all methods for given ends, with final times that are given and free."""


def later(case: Instance) -> Instance:
    """The same some time later; states of the end are numbers, not places of a reference that moves on."""
    tf, guess = (None if time is None else time + BY for time in (case.tf, case.tf_guess))
    return replace(case, t0=case.t0 + BY, tf=tf, tf_guess=guess)


def assert_moved(found: Solution, moved: Solution) -> None:
    assert (found.status, found.method) == (moved.status, moved.method)
    assert moved.objective == pytest.approx(found.objective, rel=1e-9, abs=1e-15)
    assert moved.times[[0, -1]] == pytest.approx(found.times[[0, -1]] + BY, rel=1e-8)
    for part in ("x", "lam"):  # at the ends: nodes between them that all but meet are one or two by rounding
        own = getattr(found, part)
        assert getattr(moved, part)[:, [0, -1]] == pytest.approx(own[:, [0, -1]], abs=1e-7 * float(np.abs(own).max()))
    for own, other in zip(found.switching_times, moved.switching_times, strict=True):
        assert other == pytest.approx([t + BY for t in own], rel=1e-8)
    assert [(e.kind, e.name) for e in moved.events] == [(e.kind, e.name) for e in found.events]
    assert [e.t for e in moved.events] == pytest.approx([e.t + BY for e in found.events], rel=1e-8)


@pytest.mark.slow
@pytest.mark.parametrize("name", ALIKE)
def test_answers_and_certificates_move_with_the_start(name: str) -> None:
    case = instance.load(name)
    found, moved = solvers.solve(case), solvers.solve(later(case))
    assert found.status.answered
    assert_moved(found, moved)
    own, other = found.certificate, moved.certificate
    assert own is not None
    assert other is not None
    assert own.verdict is other.verdict
    assert [(c.name, c.passed) for c in other.checks] == [(c.name, c.passed) for c in own.checks]
    # how many starts there are depends on the work that each takes, and this on rounding
    assert [c.kind for c in other.competitors] == [c.kind for c in own.competitors]
    assert all(c.tried for c in (*own.competitors, *other.competitors))


def test_sweeps_move_with_the_start() -> None:
    case = instance.load("rayleigh")
    case = replace(case, final={}, solver=msgspec.structs.replace(case.solver, method="sweep"))
    found, moved = (solvers.solve(each, examined=False) for each in (case, later(case)))
    assert found.status.answered
    assert_moved(found, moved)


def test_that_an_end_is_too_far_does_not_depend_on_when_one_begins() -> None:
    case = instance.load("double-integrator-fuel")
    case = replace(case, tf=case.t0 + 0.7)
    found, moved = solvers.solve(case), solvers.solve(later(case))
    assert found.status is Status.INFEASIBLE
    assert (moved.status, moved.message) == (found.status, found.message)


def test_guesses_on_a_way_through_problems_have_the_duration_of_the_last_answer() -> None:
    case = later(instance.load("ends-5-free"))
    found = solvers.solve(case, examined=False)
    assert found.times[-1] - found.times[0] > 0.0
    guessed = _guessed(replace(case, continuation=()), 1.0, found)
    assert guessed.tf_guess == pytest.approx(found.times[-1], rel=1e-12)


@pytest.mark.parametrize("name", ["beam", "double-integrator-fuel", "double-integrator-time"])
def test_limits_of_the_search_do_not_depend_on_when_one_begins(name: str) -> None:
    case = instance.load(name)
    for own, moved in zip(programme_of(case).bounds, programme_of(later(case)).bounds, strict=True):
        assert moved == pytest.approx(own)
