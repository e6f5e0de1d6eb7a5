"""Monodromy matrices and multipliers: their structure, two other routes to them, and what their scatter means."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm
from scipy.optimize import minimize_scalar

from satsym import instance, kernels
from satsym.analysis.orbits.elements import Elements, elements
from satsym.analysis.orbits.floquet import FASTER, NEARLY_CIRCULAR, VERDICT, floquet, hill_equations
from satsym.analysis.orbits.kepler import propagate
from satsym.analysis.orbits.monodromy import SYMPLECTIC, Monodromy, monodromy, transition
from satsym.analysis.subject import survey
from tests.analysis.test_orbit_analysis import started, turned


def flow(states: np.ndarray, mu: float, duration: float) -> np.ndarray:
    """The closed form as a function of the state, shape (6, ...)."""
    return np.concatenate(propagate(states[:3], states[3:], mu, duration))


def differentiated_flow(start: np.ndarray, mu: float, duration: float, units: np.ndarray) -> np.ndarray:
    """The derivative of the closed form by central differences of sixth order."""
    step = 5e-4
    weights = {1: 45.0 / 60.0, 2: -9.0 / 60.0, 3: 1.0 / 60.0}
    found = np.zeros((6, 6))
    for j in range(6):
        for k, weight in weights.items():
            aside = np.zeros(6)
            aside[j] = k * step * units[j]
            ahead, behind = flow(start + aside, mu, duration), flow(start - aside, mu, duration)
            found[:, j] += weight * (ahead - behind) / (step * units[j])
    return found


@settings(max_examples=12)
@given(
    e=st.floats(0.0, 0.8),
    anomaly=st.floats(-3.1, 3.1),
    inclination=st.floats(0.0, math.pi),
    node=st.floats(0.0, 6.0),
    from_apoapsis=st.booleans(),
)
def test_a_revolution_has_the_structure_of_the_closed_form(e, anomaly, inclination, node, from_apoapsis) -> None:
    if not from_apoapsis:
        e *= 0.6  # elsewhere deviations grow much more, and rounding with them
    found = monodromy(started(e, anomaly, turned(node, inclination, 1.0)), from_apoapsis)
    assert abs(found.determinant - 1.0) < 1e-10
    assert found.symplectic_defect < 1e-10
    assert found.second_singular < 1e-10
    assert found.square < 1e-10
    assert found.error < 1e-10 * found.growth
    assert found.growth > 1.0  # or all this would say nothing


@pytest.mark.parametrize("name", ["itb-earth", "itb-earth-kicked", "molniya"])
@pytest.mark.parametrize("from_apoapsis", [True, False])
def test_the_shipped_orbits_reach_what_is_claimed(name: str, from_apoapsis: bool) -> None:
    orbit = survey(instance.load(name)).elements
    found = monodromy(orbit, from_apoapsis)
    assert abs(found.determinant - 1.0) < 1e-10
    assert found.symplectic_defect < 1e-12
    M, J = found.original, SYMPLECTIC  # both scale alike: the same in km and km/s
    unit = np.outer(found.units, found.units)
    assert np.abs((M.T @ J @ M - J) * unit).max() / unit[0, 3] < 1e-12 * np.abs(found.matrix).max() ** 2
    assert found.second_singular < 1e-11
    assert found.square < 1e-11
    # rank one and nilpotent, in the orbit's own units
    mu = orbit.mu
    pull = mu * found.start[:3] / np.linalg.norm(found.start[:3]) ** 3
    per_energy = 3.0 * orbit.period * orbit.semi_major_axis / mu
    # dT/dE by differences of Kepler's third law
    energies = orbit.energy * np.array([1.0 - 1e-5, 1.0 + 1e-5])
    periods = 2.0 * np.pi * mu / (-2.0 * energies) ** 1.5
    assert per_energy == pytest.approx(np.diff(periods)[0] / np.diff(energies)[0], rel=1e-8)
    expected = -per_energy * np.outer([*found.start[3:], *-pull], [*pull, *found.start[3:]])
    assert np.abs((M - np.eye(6) - expected) * found.units / found.units[:, None]).max() < 1e-9 * found.growth


@pytest.mark.parametrize("e", [0.0, 0.0167, 0.4])
def test_the_closed_form_of_the_flow_differentiates_to_the_same_matrix(e: float) -> None:
    orbit = started(e, 0.8, turned(1.0, 0.7, 2.0))
    found = monodromy(orbit, from_apoapsis=False)
    by_differences = differentiated_flow(found.start, orbit.mu, orbit.period or 0.0, np.ones(6))
    assert np.abs(by_differences - found.original).max() < 1e-8 * found.growth


def test_other_times_than_a_revolution_agree_as_well() -> None:
    """On open orbits, too: nothing in the variational equations knows about periods."""
    model = kernels.load("two_body")
    for e, anomaly in ((0.3, 1.0), (1.0, -1.0), (2.5, 0.5)):
        orbit = started(e, anomaly, turned(0.3, 1.1, 0.6))
        start = np.concatenate([orbit.position, orbit.velocity])
        end, found = transition(model, (orbit.mu,), start, 1.7)
        assert end == pytest.approx(flow(start, orbit.mu, 1.7), abs=1e-12)
        assert np.abs(differentiated_flow(start, orbit.mu, 1.7, np.ones(6)) - found).max() < 1e-8
        assert np.abs(found.T @ SYMPLECTIC @ found - SYMPLECTIC).max() < 1e-11


def test_the_generated_kernels_of_polar_coordinates_give_the_same_structure() -> None:
    """Another chart: a revolution brings the angle back modulo a turn; M is I less a nilpotent matrix of rank one."""
    model = kernels.load("polar_orbit")
    p = tuple(float(v.default or 1.0) for v in model.spec.parameters)
    mu = p[0] ** 3 * p[1] ** 2
    start = np.array([1.1, 0.05, 0.3, 0.9])
    r, v2 = start[0], start[1] ** 2 + (start[0] * start[3]) ** 2
    axis = 1.0 / (2.0 / r - v2 / mu)
    period = 2.0 * np.pi * math.sqrt(axis**3 / mu)
    end, M = transition(model, p, start, period)
    assert end - start == pytest.approx([0.0, 0.0, 2.0 * np.pi, 0.0], abs=1e-11)
    rest = (0.0,) * len(model.spec.controls)
    rates = np.array(model.dynamics(0.0, start.tolist(), rest, p))
    gradient = np.array([r * start[3] ** 2 + mu / r**2, start[1], 0.0, r**2 * start[3]])
    assert pytest.approx(np.eye(4) - 3.0 * period * axis / mu * np.outer(rates, gradient), abs=1e-10) == M
    assert np.linalg.det(M) == pytest.approx(1.0, abs=1e-10)


def test_in_turning_axes_the_matrix_is_the_exponential_of_hills_equations() -> None:
    """On a circle, in axes that turn with it: the constant change of variables at the start is that at the end."""
    length, mu = 7000.0, 398600.4418
    rate = math.sqrt(mu / length**3)
    orbit = elements((length, 0.0, 0.0), (0.0, math.sqrt(mu / length), 0.0), mu)
    found, turning = monodromy(orbit), hill_equations(orbit)
    assert turning is not None
    spin = rate * np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    change = np.block([[np.eye(3), np.zeros((3, 3))], [-spin, np.eye(3)]])
    seen = change @ found.original @ np.linalg.inv(change)
    by_hill = expm(turning.system.A * orbit.period)
    scale = found.units[:, None] / found.units
    assert np.abs((seen - by_hill) / scale).max() < 1e-10 * found.growth
    listed = [(each.value, each.blocks) for each in turning.eigenvalues]
    assert [blocks for _, blocks in listed] == [(2,), (1, 1), (1, 1)]
    assert [value for value, _ in listed] == pytest.approx([0.0, 1j * rate, -1j * rate])


def test_hills_equations_are_left_out_far_from_circles() -> None:
    assert hill_equations(started(0.9 * NEARLY_CIRCULAR, 0.3)) is not None
    assert hill_equations(started(1.1 * NEARLY_CIRCULAR, 0.3)) is None
    assert hill_equations(started(1.5, 0.3)) is None


@pytest.mark.parametrize("size", [1e-6, 1e-8, 1e-10])
def test_multipliers_scatter_by_the_root_of_an_error_put_in(size: float) -> None:
    """An eigenvalue in a block of size 2 moves by the root of y'dx, with its eigenvectors y and x (Lidskii)."""
    exact = monodromy(started(0.3, 1.0, turned(1.0, 0.7, 2.0))).exact
    rng = np.random.default_rng(5)
    left, _, right = np.linalg.svd(exact - np.eye(6))
    growth = float(np.linalg.norm(exact - np.eye(6), 2))
    for _ in range(20):
        error = rng.normal(size=(6, 6))
        error *= size / np.linalg.norm(error, 2)
        scatter = np.abs(np.linalg.eigvals(exact + error) - 1.0).max()
        predicted = math.sqrt(growth * abs(right[0] @ error @ left[:, 0]))
        assert scatter == pytest.approx(predicted, rel=0.2, abs=40.0 * size)
        assert scatter <= 1.05 * math.sqrt(growth * size) + 40.0 * size


@pytest.mark.parametrize("name", ["itb-earth", "itb-earth-kicked", "molniya"])
def test_the_scatter_is_stated_with_the_multipliers(name: str) -> None:
    found = survey(instance.load(name)).floquet
    assert found.multipliers is not None
    assert (found.status, found.verdict) == ("computed", VERDICT)
    assert found.scatter == np.abs(found.multipliers - 1.0).max()
    assert found.expected_scatter is not None
    assert found.scatter is not None
    assert 1e-9 < found.scatter < 1.05 * found.expected_scatter < 1e-4
    assert np.prod(found.multipliers) == pytest.approx(found.monodromy.determinant if found.monodromy else 0.0)
    assert f"{found.scatter:.2g}" in found.note
    assert f"{found.expected_scatter:.2g}" in found.note


@pytest.mark.parametrize("name", ["itb-earth", "itb-earth-kicked", "molniya"])
def test_a_neighbour_drifts_along_the_track_in_proportion_to_time_but_its_orbit_stays_near(name: str) -> None:
    """The verdict by the closed form of the motion, which no monodromy matrix takes part in."""
    found = survey(instance.load(name))
    orbit, lag = found.elements, found.floquet.lag
    assert orbit.period is not None
    assert lag is not None
    faster = orbit.velocity * (1.0 + FASTER)
    turns = np.array([1.0, 2.0, 4.0, 8.0])
    place, _ = propagate(orbit.position[:, None], faster[:, None], orbit.mu, turns * orbit.period)
    away = place - orbit.position[:, None]
    along = away.T @ orbit.velocity / np.linalg.norm(orbit.velocity)
    assert along == pytest.approx(-turns * lag, rel=1e-2)
    neighbour, _ = propagate(orbit.position, faster, orbit.mu, 50.3 * orbit.period)

    def apart(time: float) -> float:
        return float(np.linalg.norm(propagate(orbit.position, orbit.velocity, orbit.mu, time)[0] - neighbour))

    times = np.linspace(0.0, 1.0, 2001) * orbit.period
    curve, _ = propagate(orbit.position[:, None], orbit.velocity[:, None], orbit.mu, times)
    near = int(np.linalg.norm(curve - neighbour[:, None], axis=0).argmin())
    nearest = minimize_scalar(apart, bounds=(times[near - 1], times[near + 1]), options={"xatol": 1e-6 * times[1]})
    assert orbit.apoapsis is not None
    assert nearest.fun < 10.0 * FASTER * orbit.apoapsis
    assert apart(0.3 * orbit.period) > 10.0 * lag  # the neighbour itself is not there
    assert nearest.fun < 0.02 * apart(0.3 * orbit.period)


@pytest.mark.parametrize(
    ("orbit", "status", "word"),
    [
        (started(1.5, 0.3), "no period", "hyperbola"),
        (elements((1.0, 0.0, 0.0), (1.0, 0.6, 0.8), 1.0), "no period", "parabola"),
        (elements((1.0, 0.0, 0.0), (2.0, 0.0, 0.0), 1.0), "no period", "rectilinear"),
        (elements((1.0, 0.0, 0.0), (-2.0, 0.0, 0.0), 1.0), "collision", "reaches the centre"),
        (elements((1.0, 0.0, 0.0), (1.0, 0.0, 0.0), 1.0), "collision", "reaches the centre"),
        (elements((1.0, 0.0, 0.0), (0.0, 0.0, 0.0), 1.0), "collision", "reaches the centre"),
    ],
)
def test_open_and_colliding_orbits_have_no_multipliers_and_say_why(orbit: Elements, status: str, word: str) -> None:
    found = floquet(orbit)
    assert (found.status, found.verdict, found.multipliers, found.monodromy) == (status, None, None, None)
    assert (found.scatter, found.expected_scatter, found.lag) == (None, None, None)
    assert word in found.note
    assert re.search(r"(no|neither a) monodromy matrix (and no|nor) multipliers", found.note)
    with pytest.raises(ValueError, match="no monodromy matrix"):
        monodromy(orbit)


def test_what_rounding_leaves_nothing_of_is_not_shown() -> None:
    found = floquet(started(1.0 - 1e-5, math.pi))
    assert (found.status, found.verdict, found.multipliers) == ("not resolved", VERDICT, None)
    assert "rounding errors dominate" in found.note


def test_a_wrong_matrix_is_noticed() -> None:
    """The measures can fail: on a matrix that is a little off, each of them does."""
    found = monodromy(started(0.2, 0.0))
    off = 1e-3 * np.random.default_rng(1).normal(size=(6, 6))
    wrong = Monodromy(found.start, found.matrix + off, found.exact, found.units)
    assert wrong.error == pytest.approx(np.linalg.norm(off, 2), rel=1e-6)
    assert min(abs(wrong.determinant - 1.0), wrong.symplectic_defect, wrong.second_singular, wrong.square) > 1e-6
