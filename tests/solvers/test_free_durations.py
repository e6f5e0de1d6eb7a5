"""Free final times over five decades of the weight of time, held against given final times.

The weight c0 adds c0 (tf - t0) to a cost and nothing else, so the least effort E(tf) of given times, solved for without
it, gives the cost of every weight: c0 tf + E(tf). Where that is least, E'(tf) = -c0.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from sympy import Rational, nsolve

import satsym
from satsym import instance
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers import by_search, solve
from satsym.status import Status
from satsym.symbolic import FirstOrder, Problem, Variable, symbols_of
from tests.support.cases import with_parameters
from tests.support.models import build

TWO, FOUR, FIVE = "ends-2-given-state", "ends-4-rendezvous", "ends-5-free"
AROUND = (0.7, 0.98, 1.02, 1.4)
"""Shares of the best final time at which it is held against given ones; efforts of the first two kinds have one
valley, that of free ends has two."""

COLD_START = tuple(np.geomspace(0.01, 14.0, 24).tolist())
"""Given times at which free ends are looked at as well."""

WEIGHTS = np.geomspace(1e-3, 100.0, 20).tolist()
FRACTIONS = (0.5, 0.8, 1.25, 2.0)
"""Of the best final time, as a guess of it."""

UNMOVED = 0.5 * (0.1 / 1.1) ** 2
"""For the fifth kind of end, at no time at all: by how much a unit of time can lower the cost. The cost is
S + tf (c0 + min_u (u1^2 + u2^2) / 2 + S_x f), and S_x f = k4 (theta_dot - omega) u2 / r at the given initial state."""


def weighed(name: str, c0: float, guess: float | None = None) -> Instance:
    return replace(with_parameters(instance.load(name), c0=float(c0)), tf_guess=guess)


@cache
def effort(name: str, tf: float) -> float:
    """The least cost with the final time given, without a weight on it."""
    found = by_search.collocation(replace(weighed(name, 0.0), tf=tf))
    return found.objective if found.status is Status.CONVERGED else math.inf


def golden(cost: Callable[[float], float], low: float, high: float, width: float) -> float:
    """Where a function with one minimum is least."""
    fraction = (math.sqrt(5.0) - 1.0) / 2.0
    while high - low > width:
        a, b = high - fraction * (high - low), low + fraction * (high - low)
        low, high = (low, b) if cost(a) < cost(b) else (a, high)
    return (low + high) / 2.0


def assert_least(found: Solution, name: str, c0: float) -> None:
    """The same time given costs the same, and other given times cost more."""
    tf = float(found.times[-1])
    assert found.status is Status.CONVERGED, found.message
    assert found.objective == pytest.approx(c0 * tf + effort(name, tf), rel=1e-7)
    others = [fraction * tf for fraction in AROUND]
    for other in (*others, *COLD_START) if name == FIVE else others:
        assert c0 * other + effort(name, other) > found.objective


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "c0"),
    [
        pytest.param(name, c0, marks=[] if c0 in WEIGHTS[:13:6] else pytest.mark.study)
        for c0 in WEIGHTS[::6]
        for name in (TWO, FOUR)
    ],
)
def test_every_weight_of_time_gives_the_minimum_from_every_guess(name, c0):
    best = solve(weighed(name, c0))
    assert_least(best, name, c0)
    for fraction in FRACTIONS[::3]:
        found = solve(weighed(name, c0, fraction * float(best.times[-1])))
        assert found.status is Status.CONVERGED, found.message
        assert found.times[-1] == pytest.approx(best.times[-1], rel=1e-6)
        assert found.objective == pytest.approx(best.objective, rel=1e-9)


@pytest.mark.parametrize(
    ("name", "c0", "near"),
    [
        (FOUR, 0.07, (1.0, 1.7)),
        (FOUR, 5.0, (0.35, 0.6)),
    ],
)
def test_the_best_final_time_is_what_golden_section_finds(name, c0, near):
    tf = golden(lambda tf: c0 * tf + effort(name, tf), *near, 4e-3)
    found = by_search.collocation(weighed(name, c0))
    assert found.times[-1] == pytest.approx(tf, abs=4e-3)
    assert_least(found, name, c0)


@pytest.mark.slow
@pytest.mark.parametrize("fraction", FRACTIONS)
@pytest.mark.parametrize("c0", WEIGHTS[:3])
def test_free_ends_have_a_best_final_time_where_moving_pays(c0, fraction):
    best = float(solve(weighed(FIVE, c0)).times[-1])
    found = solve(weighed(FIVE, c0, fraction * best))
    assert_least(found, FIVE, c0)


@pytest.mark.slow
@pytest.mark.parametrize("c0", [1.01 * UNMOVED, WEIGHTS[4], 1.0, 100.0])
def test_free_ends_have_none_where_time_costs_more_than_moving_saves(c0):
    for guess in (None, 0.3):
        found = by_search.collocation(weighed(FIVE, c0, guess))
        assert found.status is Status.NO_MINIMISER
        assert "shorter duration is always cheaper" in found.message


def test_free_ends_have_a_short_best_time_where_moving_just_pays():
    found = by_search.collocation(weighed(FIVE, 0.99 * UNMOVED))
    assert found.status is Status.CONVERGED
    assert found.times[-1] < 0.05
    # What staying costs: S of the initial state, k1 (r - 1)^2 / 2 + k4 (theta_dot - 1)^2 / 2.
    assert found.objective < 0.01


@pytest.mark.parametrize("t0", [0.0, 3.0])
def test_a_minimum_next_to_no_time_at_all_is_found_beyond_a_costlier_one(tmp_path: Path, t0: float) -> None:
    """A body that drifts with speed one goes d for d at the best speed, 1.01; the end costs the rest of two valleys."""
    place, rate = Variable("q", "q"), Variable("u", "u")
    q, u = symbols_of((place, rate))
    valleys = ((q - Rational("0.02")) * (q - Rational("0.9"))) ** 2 + q / 1000
    drifting = FirstOrder(
        name="drifting", title="A drift", states=(place,), controls=(rate,), parameters=(), rates={q: 1 + u}
    )
    cost = Rational("1.005") + 50 * u**2
    problem = Problem(name="valleys", title="Two valleys", model=drifting, running_cost=cost, terminal_cost=valleys - q)
    best = float(min((nsolve(valleys.diff(q), near) for near in (0.02, 0.9)), key=lambda d: valleys.subs(q, d)))
    found = solve(build(tmp_path, problem, f'[initial]\nq = 0.0\n[time]\nt0 = {t0}\ntf = "free"\n'))
    assert 0.0 < best < 0.02
    assert found.objective == pytest.approx(float(valleys.subs(q, best)), rel=1e-9)
    assert found.times[-1] - t0 == pytest.approx(best / 1.01, rel=1e-6)
    assert found.certificate is not None
    assert found.certificate.verdict == "certified"


@pytest.mark.parametrize("guess", [None, 2.0, 0.3, 6.0])
def test_a_minimum_beyond_long_durations_is_found(guess):
    initial = (0.998493, -0.014321, -0.046177, 1.003848)
    final = {"r": 1.0, "r_dot": 0.0, "theta": "reference", "theta_dot": 1.0}
    case = replace(weighed(FOUR, 0.002, guess), initial=initial, final=final)
    found = by_search.collocation(case)
    assert found.status is Status.CONVERGED

    def cost(tf: float) -> float:
        return by_search.collocation(replace(case, tf=tf, tf_guess=None)).objective

    tf = golden(cost, 1.6, 2.4, 2e-3)
    assert found.times[-1] == pytest.approx(tf, abs=2e-3)
    assert found.objective == pytest.approx(cost(float(found.times[-1])), rel=1e-7)


@pytest.mark.parametrize("guess", [pytest.param(0.05, marks=pytest.mark.slow), 60.0])
def test_a_guess_that_leads_nowhere_does_no_harm(guess):
    found = by_search.collocation(weighed(TWO, 0.07, guess))
    assert_least(found, TWO, 0.07)


@pytest.mark.slow
def test_without_a_weight_on_time_nothing_is_said_to_be_cheaper_when_shorter():
    for name in (TWO, FOUR):
        assert "shorter" not in by_search.collocation(weighed(name, 0.0)).message


def test_a_cold_start_does_not_depend_on_the_units() -> None:
    """In kilometres and seconds a thrust of one is a hundred times gravity, and no guess of what is worth its cost."""
    plain = satsym.solve(FOUR)
    radius, rate = 6778.14, 0.0011313
    case = plain.instance.case
    units = np.array([radius, radius * rate, 1.0, rate])
    initial = dict(zip(("r", "r_dot", "theta", "theta_dot"), (units * case.initial).tolist(), strict=True))
    weights = dict(zip((one.symbol for one in case.model.spec.parameters), case.parameters, strict=True))
    weight = weights["c0"] * radius**2 * rate**4
    final = dict.fromkeys(initial, "reference")
    parameters = {"sigma": radius, "omega": rate, "c0": weight}
    found = satsym.solve(
        satsym.Instance.of(case.model.spec.name, parameters=parameters, initial=initial, final=final, tf="free")
    )
    assert found.objective == pytest.approx(plain.objective * radius**2 * rate**3, rel=1e-9)
    assert found.found.times[-1] == pytest.approx(plain.found.times[-1] / rate, rel=1e-8)


@pytest.mark.slow
def test_a_state_that_hardly_has_to_move_does_not_tell_how_long_all_take() -> None:
    """The angle is almost where it is to be, and the radius is not. Shorter and longer times cost more."""
    start = {"r": 1.2872205337385993, "r_dot": 0.10399556602310338}
    start |= {"theta": 0.02299817537359017, "theta_dot": 0.6845587803464064}
    given = satsym.Instance.of(
        "polar_orbit_timed",
        initial=start,
        final=dict.fromkeys(start, "reference"),
        tf="free",
        parameters={"c0": 0.0005350861598462447},
    )
    found = satsym.solve(given)
    assert found.to_dict()["certificate"]["verdict"] == "certified"
    best, least = float(found.found.times[-1]), found.objective
    for share in AROUND:
        assert solve(replace(given.case, tf=share * best)).objective > least
