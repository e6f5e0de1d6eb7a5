"""Certificates of exact switching times: what is certified, and that tampering with any part of a solution fails."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from satsym import solvers as solve
from satsym.report.results.objects import solution_object
from satsym.solution import Solution
from satsym.solvers import certificate
from satsym.solvers.by_search import bang_bang
from satsym.solvers.certificate.reintegration.flow import typical
from satsym.solvers.certificate.second_variation import Quadratic, units
from satsym.solvers.certificate.switching.conditions import _terms
from satsym.solvers.certificate.switching.integration import Integration
from satsym.solvers.certificate.switching.replay import replay
from satsym.solvers.certificate.switching.second_variation import form_of
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.trajectory import PANELS, POINTS, _panels
from tests.support.switching_closed_forms import FUEL, TIME, Known, case, least_fuel, minimum_time, starts


@pytest.fixture(scope="module")
def fuel() -> Solution:
    """The shipped problem of least fuel, solved."""
    return bang_bang(case(FUEL))


@pytest.mark.slow
@pytest.mark.parametrize("start", starts(3))
def test_least_times_are_certified(start: tuple[float, float]) -> None:
    found = solve.solve(case(TIME, initial=start))
    assert found.certificate is not None
    assert found.certificate.verdict == "certified", found.certificate.checks
    printed = solution_object(found)
    assert printed["switching_times"] == pytest.approx(minimum_time(*start).switches, abs=1e-10)
    assert printed["certificate"]["legendre_clebsch"] is None


def test_where_the_speed_at_the_end_is_free_the_thrust_never_switches() -> None:
    # 1 + t/2 - t^2/2 = 0 at t = 2. The switching function vanishes there, as the costate of a free state must.
    found = solve.solve(case(TIME, initial=(1.0, 0.5), final={"q": 0.0}))
    assert found.objective == pytest.approx(2.0, abs=1e-10)
    assert found.switching_times == ((),)
    assert abs(found.lam[1, -1]) < 1e-12
    assert found.certificate is not None
    assert found.certificate.verdict == "certified", found.certificate.checks


def failures(tampered: Solution) -> list[str]:
    """What the certificate finds wrong, which it has to find at all."""
    verdict = certificate.certify(tampered)
    assert verdict is not None
    assert verdict.verdict == "failed", verdict.checks
    return [c.name for c in verdict.checks if not c.passed]


def test_costates_that_are_not_those_of_the_extremal_fail(fuel: Solution) -> None:
    assert "switching times" in failures(replace(fuel, lam=fuel.lam * 1.001))


@pytest.mark.parametrize("factor", [0.9, 1.0 + 1e-6])
def test_a_stated_cost_that_is_not_that_of_the_motion_fails(fuel: Solution, factor: float) -> None:
    assert failures(replace(fuel, objective=factor * fuel.objective)) == ["cost"]


@pytest.mark.parametrize("values", ["x", "lam"])
@pytest.mark.parametrize("place", ["a node between stations", "after a switch"])
def test_a_single_node_off_the_extremal_fails(fuel: Solution, values: str, place: str) -> None:
    switch = fuel.switching_times[0][0]
    (node,) = np.flatnonzero(fuel.times == switch)[1:] if place == "after a switch" else (501,)
    table = getattr(fuel, values).copy()
    table[0, node] += 1e-5
    assert failures(replace(fuel, **{values: table})) == ["dynamics defect"]


def test_a_switching_time_that_is_not_where_the_law_switches_fails(fuel: Solution) -> None:
    first, last = fuel.switching_times[0]
    altered = replace(fuel, switching_times=((first + 1e-6, last),))
    assert failures(altered) == ["switching times", "stated times of events"]


@pytest.mark.parametrize("kept", [(), (0,), (0, 0, 1)])
def test_another_structure_than_that_of_the_extremal_fails(fuel: Solution, kept: tuple[int, ...]) -> None:
    times = tuple(fuel.switching_times[0][k] + 1e-3 * i for i, k in enumerate(kept))
    assert failures(replace(fuel, switching_times=(times,))) == ["switching times", "stated times of events"]


def test_a_control_that_does_not_minimise_h_fails(fuel: Solution) -> None:
    assert "stationarity" in failures(replace(fuel, u=np.where(fuel.u == 0.0, 0.1, fuel.u)))


def test_an_extremal_that_is_no_minimum_is_not_certified() -> None:
    # With the signs of the control and of the costates changed, the motion is one of greatest time.
    found = bang_bang(case(TIME))
    assert "stationarity" in failures(replace(found, lam=-found.lam))


def test_the_second_variation_is_that_of_the_closed_form() -> None:
    # With time weighed against fuel, the final time is chosen: along the controls that arrive the cost is
    # c T + a(T) + b(T), and its second derivative must be what the reduced Hessian says along the same direction.
    weight = 0.7
    found = bang_bang(case(FUEL, initial=(1.3, 0.4), tf=None, parameters=(weight,)))
    again = replay(found)
    assert again is not None
    by = Integration(np.concatenate(typical(found)), Limits(10**6, math.inf))
    second = form_of(found, again, by, 20)
    duration, step = float(found.times[-1]), 1e-3

    def known(t: float) -> Known:
        one = least_fuel(1.3, 0.4, t)
        assert one is not None
        return one

    before, here, after = (known(duration + k * step) for k in (-1, 0, 1))
    assert here.cost + weight * duration == pytest.approx(found.objective, abs=1e-9)
    curvature = (after.cost - 2.0 * here.cost + before.cost) / step**2
    (direction,) = second.reduced()[1].T
    direction = direction / direction.sum()  # of the lengths of arcs, in units of the duration
    slopes = [(b - a) / (2.0 * step) for a, b in zip(before.switches, after.switches, strict=True)]
    assert np.cumsum(direction)[:2] == pytest.approx(slopes, rel=1e-5)
    unit = units(found, typical(found)[0])[1] / duration**2
    assert 2.0 * unit * (direction @ second.form @ direction) == pytest.approx(curvature, rel=1e-5)


def test_a_shift_in_time_is_the_reason_where_the_form_vanishes_along_it_alone() -> None:
    """All arcs but the last, to which none is added here, begin later where the first one lasts longer."""
    later, rest, other = np.eye(3)
    kept, tied = np.zeros((0, 3)), later[None]

    def flat(form: np.ndarray, ties: np.ndarray) -> bool:
        return Quadratic((), form, 3, ties, free_time=True).flat_by_shift(1e-7)

    across = np.eye(3) - np.outer(later, later)
    assert flat(across, kept)
    assert not flat(np.eye(3), kept)
    assert not flat(np.eye(3) - np.outer(rest, rest), kept)
    assert not flat(across - np.outer(other, other), kept)  # flat across it as well
    assert not flat(across, tied)  # the end does not allow it


def test_h_is_compared_with_its_own_terms_at_one_time() -> None:
    """Along a double integrator they are the costates times speed and force."""
    found = bang_bang(case(TIME))
    times = np.linspace(found.times[0], found.times[-1], 301)
    x, lam, u = (
        np.array([np.interp(times, found.times, row) for row in each]) for each in (found.x, found.lam, found.u)
    )
    expected = (np.abs(lam[0] * x[1]) + np.abs(lam[1] * u[0])).max()
    assert _terms(found.instance, times, x, lam, u) == pytest.approx(expected, rel=1e-12)


def test_panels_of_an_arc_are_counted_by_its_share_of_the_whole_in_any_unit_of_time() -> None:
    for unit in (1e-3, 1.0, 86400.0):
        arc = SimpleNamespace(start=2.0 * unit, end=3.0 * unit)
        times, weights = _panels(arc, 4.0 * unit)
        assert len(times) == POINTS * math.ceil(PANELS / 4.0)
        assert weights @ times**2 == pytest.approx((27.0 - 8.0) / 3.0 * unit**3, rel=1e-12)
