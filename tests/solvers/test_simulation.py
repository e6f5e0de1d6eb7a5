"""Simulations keep to the accuracy they claim, also where rounding is large or steps are too long, or say so."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from satsym.instance import Instance
from satsym.solvers import simulate
from satsym.solvers.simulation.simulating import MOST_STEPS
from satsym.status import BadInput, Status
from tests.support.cases import parameters, shipped
from tests.support.kepler import propagate

SIGMA, OMEGA = 42164.17, 7.2921159e-5


def from_start(*start: float, **options: object) -> Instance:
    return replace(shipped("soft-return", **options), initial=start)


def errors(case: Instance, x: np.ndarray, times: np.ndarray) -> np.ndarray:
    mu = parameters(case)["sigma"] ** 3 * parameters(case)["omega"] ** 2
    return np.abs(x - np.transpose([propagate(mu, case.initial, t - case.t0) for t in times]))


@pytest.mark.parametrize("tolerance", [1e-5, 1e-7, 1e-9, 1e-11])
@pytest.mark.parametrize("start", [(1.1, 0.0, 0.0, 0.9), (1.0, 0.5, 0.0, 0.8), (1.0, 0.0, 0.0, 0.5)])
def test_the_error_is_below_the_tolerance_and_near_its_estimate(start, tolerance):
    simulated = simulate(from_start(*start, tolerance=tolerance, steps=64))
    assert simulated.status is Status.CONVERGED
    actual = (
        errors(simulated.instance, simulated.x, simulated.times) / np.abs(simulated.x).max(axis=1, keepdims=True)
    ).max()
    assert actual <= tolerance
    assert actual <= 2.0 * simulated.metrics["estimated_error"] + 1e-12


def test_the_simulation_has_the_steps_of_the_instance_however_many_were_needed():
    simulated = simulate(from_start(1.0, 0.0, 0.0, 0.5, steps=50))
    assert simulated.metrics["steps"] > 50
    assert simulated.times.shape == (51,)
    assert simulated.x.shape == (4, 51)
    assert simulated.u.shape == (2, 51)


@pytest.mark.parametrize("above", [1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1.0])
def test_a_nearly_circular_orbit_is_no_singularity(above):
    """The radial velocity is rounding there, in proportion to its size; its error must be judged by that."""
    case = replace(shipped("soft-return-geo"), initial=(SIGMA + above, 0.0, 0.0, OMEGA))
    simulated = simulate(case)
    assert simulated.status is Status.CONVERGED
    assert simulated.metrics["steps"] <= 8000
    wrong = errors(case, simulated.x, simulated.times).max(axis=1)
    assert (wrong <= 1e-12 * np.array([SIGMA, SIGMA * OMEGA, 2 * math.pi, OMEGA])).all()


def test_a_circular_orbit_stays_circular():
    case = replace(shipped("soft-return-geo"), initial=(SIGMA, 0.0, 0.0, OMEGA))
    simulated = simulate(case)
    assert simulated.status is Status.CONVERGED
    assert abs(simulated.metrics["r_max"] / SIGMA - 1.0) <= 1e-14
    assert abs(simulated.metrics["theta_error"]) <= 1e-12


@pytest.mark.slow
def test_steps_too_long_for_a_close_passage_are_halved_until_they_are_not():
    """500 equal steps take this ellipse (eccentricity 0.96) through the centre, to numbers that are not finite."""
    case = replace(from_start(1.0, 0.0, 0.0, 0.2, steps=500), tf=2.5)
    times, none = np.linspace(0.0, 2.5, 501), np.zeros((2, 501))
    assert not np.isfinite(case.model.forward(times, case.initial, none, none[:, 1:], case.parameters)[0]).all()
    simulated = simulate(case)
    assert simulated.status is Status.CONVERGED
    error = errors(case, simulated.x, simulated.times).max(axis=1) / np.abs(simulated.x).max(axis=1)
    assert error.max() <= 1e-9


def test_energy_and_angular_momentum_are_reported_only_without_control():
    free = simulate(from_start(1.1, 0.0, 0.0, 0.9))
    assert set(free.invariants) == {"energy", "angular_momentum"}
    pushed = replace(from_start(1.1, 0.0, 0.0, 0.9), lower=(0.01, 0.0), upper=(0.02, 1.0))
    simulated = simulate(pushed)
    assert simulated.invariants == {}
    assert (simulated.u == [[0.01], [0.0]]).all(), "the admissible control next to none"


def test_a_fall_through_the_centre_leaves_the_domain():
    simulated = simulate(from_start(1.0, -5.0, 0.0, 0.0, steps=50))
    assert simulated.status is Status.LEFT_DOMAIN
    assert "initial state" in simulated.message
    assert (simulated.x[0] <= 0.0).any()


@pytest.mark.parametrize("start", [(1e-200, 0.0, 0.0, 1.0), (1e200, 0.0, 0.0, 1e200), (1.0, 1e308, 0.0, 1.0)])
def test_numbers_that_overflow_are_not_finite(start):
    simulated = simulate(from_start(*start, steps=20))
    assert simulated.status is Status.NON_FINITE
    assert (
        "check the initial state and the parameters for values that cause a division by zero or an overflow"
        in simulated.message
    )
    assert simulated.invariants == {}


def test_a_tolerance_beyond_reach_is_not_called_converged(monkeypatch):
    monkeypatch.setattr("satsym.solvers.simulation.simulating.MOST_STEPS", 2000)
    simulated = simulate(from_start(1.0, 0.0, 0.0, 0.3, steps=500))
    assert simulated.status is Status.NOT_CONVERGED
    assert simulated.metrics["estimated_error"] > simulated.instance.solver.tolerance
    assert simulated.message.startswith("even 2000 steps leave an estimated error of")


def test_more_steps_than_usual_are_used_where_the_instance_asks_for_them(monkeypatch):
    monkeypatch.setattr("satsym.solvers.simulation.simulating.MOST_STEPS", 1000)
    assert MOST_STEPS > 1000
    simulated = simulate(from_start(1.1, 0.0, 0.0, 0.9, steps=1500))
    assert simulated.status is Status.CONVERGED
    assert simulated.metrics["steps"] == 3000


def test_metrics_are_extremes_and_the_final_distance_from_the_reference():
    simulated = simulate(from_start(1.1, 0.0, 0.0, 0.9))
    for name, row in zip(("r", "r_dot", "theta", "theta_dot"), simulated.x, strict=True):
        assert (simulated.metrics[f"{name}_min"], simulated.metrics[f"{name}_max"]) == (row.min(), row.max())
    assert simulated.metrics["theta_error"] == simulated.x[2, -1] - 2.0 * math.pi


def test_a_free_final_time_cannot_be_simulated():
    with pytest.raises(BadInput, match=r"time\.tf"):
        simulate(replace(from_start(1.1, 0.0, 0.0, 0.9), tf=None))


def test_a_simulation_ends_when_its_time_is_up():
    """What was simulated until then is shown, with the error it has."""
    case = from_start(1.0, 0.0, 0.0, 0.5, steps=100, max_seconds=1e-6)
    simulated = simulate(case)
    assert simulated.status is Status.TIME_LIMIT
    assert "max_seconds" in simulated.message
    assert simulated.metrics["steps"] == 200
    assert simulated.metrics["estimated_error"] > case.solver.tolerance
