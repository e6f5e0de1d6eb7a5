"""Motion without control is Kepler's: simulations against the closed-form solution, for every conic."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from satsym.instance import Instance
from satsym.solution import Simulation
from satsym.solvers import simulate
from satsym.status import Status
from tests.support.cases import shipped, with_parameters
from tests.support.examples import examples
from tests.support.kepler import State, angular_momentum, eccentricity, energy, propagate

EARTH = 398600.4418
"""Gravitational parameter, km^3/s^2."""


def conic(mu: float, p: float, e: float, anomaly: float, backwards: bool) -> State:
    """A state on a conic of parameter p; the motion goes backwards where asked."""
    r = p / (1.0 + e * math.cos(anomaly))
    sense = -1.0 if backwards else 1.0
    return r, math.sqrt(mu / p) * e * math.sin(anomaly), sense * anomaly, sense * math.sqrt(mu * p) / r**2


def of_orbit(start: State, tf: float, mu: float = 1.0, t0: float = 0.0, steps: int = 500) -> Instance:
    """An instance of the polar model; only sigma^3 omega^2 matters where there is no control."""
    base = with_parameters(shipped("soft-return", steps=steps), sigma=2.0, omega=math.sqrt(mu / 8.0))
    return replace(base, initial=start, t0=t0, tf=tf)


def exact(simulation: Simulation, mu: float) -> np.ndarray:
    start, t0 = simulation.instance.initial, simulation.instance.t0
    return np.transpose([propagate(mu, start, t - t0) for t in simulation.times])


def error(simulation: Simulation, mu: float) -> float:
    """Largest error of each state, relative to its size."""
    known = exact(simulation, mu)
    return float((np.abs(simulation.x - known).max(axis=1) / np.abs(known).max(axis=1)).max())


def assert_kepler(start: State, tf: float, mu: float = 1.0, t0: float = 0.0) -> Simulation:
    simulation = simulate(of_orbit(start, tf, mu, t0))
    assert simulation.status is Status.CONVERGED
    assert error(simulation, mu) <= 1e-9
    assert not simulation.u.any()
    energies, momenta = simulation.invariants["energy"], simulation.invariants["angular_momentum"]
    kinetic = energy(mu, start) + mu / start[0]
    assert abs(energies.initial - energy(mu, start)) <= 1e-14 * kinetic
    assert abs(momenta.initial / angular_momentum(start) - 1.0) <= 1e-14
    assert energies.drift <= 1e-9 * max(kinetic, mu / simulation.x[0].min())
    assert momenta.drift <= 3e-9 * abs(momenta.initial)  # of r^2 theta_dot: r counts twice
    return simulation


anomalies = st.floats(-3.1, 3.1)
sizes = st.floats(0.5, 2.0)


@examples(25)
@given(st.floats(0.001, 0.7), sizes, anomalies, st.floats(0.1, 2.5), st.floats(0.3, 3.0), st.booleans())
def test_on_any_ellipse_the_simulation_is_the_closed_form(e, p, anomaly, turns, mu, backwards):
    period = 2.0 * math.pi * math.sqrt((p / (1.0 - e**2)) ** 3 / mu)
    assert_kepler(conic(mu, p, e, anomaly, backwards), turns * period, mu)


@examples(15)
@given(sizes, st.floats(-2.2, 2.2), st.floats(0.5, 40.0), st.booleans())
def test_on_any_parabola_the_simulation_is_the_closed_form(p, anomaly, duration, backwards):
    simulation = assert_kepler(conic(1.0, p, 1.0, anomaly, backwards), duration)
    assert abs(simulation.invariants["energy"].initial) <= 1e-14 / simulation.x[0, 0]


@examples(15)
@given(st.floats(1.05, 5.0), sizes, st.floats(-0.85, 0.85), st.floats(0.5, 40.0), st.floats(0.3, 3.0), st.booleans())
def test_on_any_hyperbola_the_simulation_is_the_closed_form(e, p, fraction, duration, mu, backwards):
    assert_kepler(conic(mu, p, e, fraction * math.acos(-1.0 / e), backwards), duration, mu)


@pytest.mark.parametrize(
    ("start", "tf"),
    [
        pytest.param((42169.17, 0.0, 0.00035, 7.2921159e-5), 86400.0, id="geostationary, 5 km too high"),
        pytest.param((42164.17, 0.01, 1.0, 7.2921159e-5), 3 * 86400.0, id="geostationary, drifting, three days"),
        pytest.param(conic(EARTH, 26600.0 * (1 - 0.74**2), 0.74, 0.0, False), 86164.0, id="Molniya, two turns"),
        pytest.param(conic(EARTH, 6778.0, 0.001, 2.0, True), 6 * 3600.0, id="low, backwards"),
        pytest.param(conic(EARTH, 2 * 6678.0, 1.0, 0.0, False), 2 * 86400.0, id="parabolic escape"),
        pytest.param(conic(EARTH, 2.4 * 6778.0, 1.4, -1.7, False), 86400.0, id="hyperbolic flyby"),
    ],
)
def test_simulations_round_the_earth_in_kilometres_and_seconds_are_the_closed_form(start, tf):
    assert_kepler(start, tf, EARTH)


def test_a_later_start_changes_nothing():
    start = conic(1.0, 1.0, 0.3, 0.5, False)
    early, late = simulate(of_orbit(start, 5.0)), assert_kepler(start, 12.0, t0=7.0)
    assert np.abs(early.x - late.x).max() <= 1e-9


def test_the_start_of_the_thesis_is_parabolic_and_after_60_it_is_25_away():
    start = (1.0, 1.0, 1.0, 1.0)
    assert (energy(1.0, start), angular_momentum(start), eccentricity(1.0, start)) == (0.0, 1.0, 1.0)
    # Barker's equation: D + D^3/3 = 2 t + 4/3, and 7 + 7^3/3 = 2 * 60 + 4/3
    end = (25.0, 7.0 / 25.0, 1.0 + 2.0 * (math.atan(7.0) - math.atan(1.0)), 1.0 / 625.0)
    assert np.allclose(propagate(1.0, start, 60.0), end, rtol=1e-15, atol=0.0)
    simulation = simulate(shipped("its-thesis", tolerance=1e-11))
    assert simulation.status is Status.CONVERGED
    assert simulation.invariants["energy"].initial == 0.0
    assert np.allclose(simulation.x[:, -1], end, rtol=1e-11, atol=0.0)


@examples(50)
@given(st.floats(0.0, 3.0), sizes, st.floats(-0.85, 0.85), st.floats(-20.0, 20.0), st.booleans())
def test_the_closed_form_obeys_newtons_law(e, p, fraction, time, backwards):
    anomaly = fraction * math.acos(max(-1.0, -1.0 / e)) if e > 0.0 else 3.0 * fraction
    start = conic(1.0, p, e, anomaly, backwards)
    before, now, after = (np.array(propagate(1.0, start, time + h)) for h in (-1e-4, 0.0, 1e-4))
    r, r_dot, _, theta_dot = now
    rates = (r_dot, r * theta_dot**2 - 1.0 / r**2, theta_dot, -2.0 * r_dot * theta_dot / r)
    scale = 1.0 + theta_dot**2 + 1.0 / r**2
    assert np.abs((after - before) / 2e-4 - rates).max() <= 3e-6 * scale**2


@examples(50)
@given(st.floats(0.0, 3.0), sizes, st.floats(-0.85, 0.85), st.floats(-20.0, 20.0), st.floats(-20.0, 20.0))
def test_the_closed_form_simulated_in_two_parts_is_the_whole(e, p, fraction, first, second):
    start = conic(1.0, p, e, fraction * math.acos(max(-1.0, -1.0 / e)) if e > 0.0 else 3.0 * fraction, False)
    halfway = propagate(1.0, start, first)
    both, whole = propagate(1.0, halfway, second), propagate(1.0, start, first + second)
    assert np.allclose(both, whole, rtol=1e-9, atol=1e-10)
    assert abs(energy(1.0, whole) - energy(1.0, start)) <= 1e-12 * (1.0 + 1.0 / whole[0])
    assert math.isclose(angular_momentum(whole), angular_momentum(start), rel_tol=1e-13)
