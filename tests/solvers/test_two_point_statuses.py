"""What comes of instances that numbers, bounds or guesses make hard: a status with its reason, or the answer."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import msgspec
import numpy as np
import pytest

from satsym import instance
from satsym import solvers as solve
from satsym.instance import Instance
from satsym.instance.types import Guess
from satsym.solution import Solution
from satsym.solvers import by_search
from satsym.solvers.cold_start import paths
from satsym.solvers.collocation.scaling import two_point as scaled
from satsym.status import Status
from tests.support.cases import with_parameters

RETURN = instance.load("return-to-orbit")
COST = 0.0031946551089


def starting(**changed: float) -> Instance:
    names = RETURN.model.spec.state_names
    return replace(RETURN, initial=tuple(changed.get(n, x) for n, x in zip(names, RETURN.initial, strict=True)))


@pytest.mark.parametrize("method", [by_search.collocation, by_search.shooting], ids=["collocation", "shooting"])
@pytest.mark.parametrize(
    "case",
    [
        starting(r=1e30),
        starting(theta_dot=1e200),
        replace(RETURN, tf=1e300),
        with_parameters(RETURN, sigma=1e200),
    ],
    ids=["far", "fast", "long", "wide"],
)
def test_numbers_beyond_arithmetic_end_as_not_finite(case: Instance, method: Any) -> None:
    found: Solution = method(case)
    assert found.status is Status.NON_FINITE
    assert "an arithmetic operation failed" in found.message
    assert np.isnan(found.x).all()
    assert np.isnan(found.objective)


@pytest.mark.slow
@pytest.mark.parametrize("method", [by_search.collocation, by_search.shooting], ids=["collocation", "shooting"])
def test_where_a_control_can_only_brake_too_much_speed_is_not_reached(method: Any) -> None:
    """The angular momentum h cannot grow, and without it growing the end asked for is out of reach.

    At the start h = 0.7793; at the end it would be 1.183.
    """
    start, end = (0.9141, 0.0482, -0.0978, 0.9326), {"r": 1.3, "theta_dot": 0.7}
    assert start[0] ** 2 * start[3] < end["r"] ** 2 * end["theta_dot"]
    lower, upper = (-float("inf"), -0.3), (float("inf"), 0.0)
    patient = msgspec.structs.replace(RETURN.solver, max_seconds=300.0)  # what is claimed depends on no processor
    asked = replace(RETURN, initial=start, final=end, tf=2.132, lower=lower, upper=upper, solver=patient)
    found: Solution = method(asked)
    assert found.status is Status.INFEASIBLE
    assert "misses r by" in found.message


@pytest.mark.parametrize(
    "guess",
    [
        Guess(state={"r": (1.1, 1.2, 1.0)}),
        Guess(state={"r": (1.1, 3.0, 1.0), "theta": (0.0, 1.0, 6.0)}, costate={"r": (0.14,), "r_dot": (0.03, 0.1)}),
        Guess(costate={"theta": (5.0, -5.0)}),
    ],
    ids=["one state", "states and costates", "a costate"],
)
def test_a_guess_is_where_the_way_begins(guess: Guess) -> None:
    case = replace(RETURN, guess=guess)
    start = paths.start(scaled(case, RETURN.tf or 0.0))
    values = start.nodes * scaled(case, RETURN.tf or 0.0).scale.both
    names = RETURN.model.spec.state_names
    for k, table in enumerate((guess.state, guess.costate)):
        for name, wanted in table.items():
            row = values[4 * k + names.index(name)]
            assert row[[0, -1]] == pytest.approx([wanted[0], wanted[-1]], rel=1e-12)
    found = by_search.collocation(case)
    assert "starting from the guess" in found.message
    assert found.objective == pytest.approx(COST, rel=1e-10)


@pytest.mark.slow
def test_weights_next_to_nothing_leave_no_warnings() -> None:
    found = solve.solve(with_parameters(RETURN, c1=1e-300, c2=1e-300))
    assert found.objective == pytest.approx(1e-300 * COST, rel=1e-10)


INFINITE = float("inf")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("initial", "tf", "lower", "upper"),
    [
        pytest.param(
            (0.8491, -0.1921, 0.3358, 0.7491), 9.091, (0.0, -INFINITE), (0.2, INFINITE), marks=pytest.mark.study
        ),
        ((0.9082, -0.2891, -0.2995, 0.7092), 6.316, (-0.05, -0.1), (0.05, 0.1)),
        pytest.param(
            (1.1855, 0.2077, -0.3183, 1.1539), 6.882, (-INFINITE, -0.3), (INFINITE, 0.0), marks=pytest.mark.study
        ),
    ],
)
def test_bounds_met_at_many_times_leave_no_error_that_is_not_told(
    initial: tuple[float, ...], tf: float, lower: tuple[float, ...], upper: tuple[float, ...]
) -> None:
    """Nodes that stay where a coarse solution meets its bounds are off by 1e-5 of the duration."""
    base = with_parameters(RETURN, k1=0.1, k2=0.1, k3=0.02, k4=0.1)
    case = replace(base, initial=initial, tf=tf, final={"theta": "reference"}, lower=lower, upper=upper)
    found, other = solve.solve(case), by_search.shooting(case)
    assert found.certificate is not None
    assert found.certificate.verdict == "certified"
    assert found.objective == pytest.approx(other.objective, rel=1e-12)
    for own, theirs in zip(found.switching_times, other.switching_times, strict=True):
        assert own == pytest.approx(theirs, abs=1e-9)
