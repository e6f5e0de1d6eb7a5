"""Shipped instances of the two-body model, and starts that are none."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from satsym import instance
from satsym.cli import main
from satsym.solvers import simulate
from satsym.status import BadInput, Status
from tests.support.cases import two_body_case

EARTHS = ("itb-earth", "itb-earth-kicked", "itb-earth-escape")
G, M_SUN = 6.67430e-11, 1.989e30


@pytest.mark.parametrize("name", EARTHS)
def test_earths_start_as_the_paper_states_them(name: str) -> None:
    case = instance.load(name)
    faster = {"itb-earth": 0.0, "itb-earth-kicked": 5e3, "itb-earth-escape": 12.6e3}[name]
    expected = (1.496e11, 0.0, 0.0, 0.0, 29.78e3 + faster, 0.0)
    np.testing.assert_allclose(np.array(case.initial) * 1e3, expected, rtol=1e-15)
    assert math.isclose(case.parameters[0] * 1e9, G * M_SUN, rel_tol=1e-15)
    assert case.tf == 3.154e7


@pytest.mark.parametrize("name", EARTHS)
def test_earths_go_where_the_paper_integrates_them(name: str) -> None:
    """The paper's equations in metres and seconds, by DOP853."""
    case = instance.load(name)

    def rates(_time: float, state: np.ndarray) -> np.ndarray:
        return np.concatenate([state[3:], -G * M_SUN * state[:3] / np.linalg.norm(state[:3]) ** 3])

    start = np.array(case.initial) * 1e3
    expected = solve_ivp(rates, (0.0, 3.154e7), start, method="DOP853", rtol=1e-12, atol=1e-3).y[:, -1] / 1e3
    simulated = simulate(case)
    assert simulated.status is Status.CONVERGED
    np.testing.assert_allclose(simulated.x[:3, -1], expected[:3], atol=1e-9 * np.linalg.norm(expected[:3]))
    np.testing.assert_allclose(simulated.x[3:, -1], expected[3:], atol=1e-9 * np.linalg.norm(expected[3:]))
    for kept in simulated.invariants.values():
        assert kept.drift <= 1e-9 * (1.0 + abs(kept.initial))


def test_molniya_is_an_inclined_ellipse_that_closes() -> None:
    case = instance.load("molniya")
    position, speed = np.split(np.array(case.initial), 2)
    (strength,) = case.parameters
    momentum = np.cross(position, speed)
    eccentricity = np.cross(speed, momentum) / strength - position / np.linalg.norm(position)
    axis = 1.0 / (2.0 / np.linalg.norm(position) - speed @ speed / strength)
    assert math.isclose(np.linalg.norm(eccentricity), 0.74, rel_tol=1e-6)
    assert math.isclose(momentum[2] / np.linalg.norm(momentum), 1.0 / math.sqrt(5.0), rel_tol=1e-9)
    assert math.isclose(2.0 * 2.0 * math.pi * math.sqrt(axis**3 / strength), case.tf or 0.0, rel_tol=1e-6)
    simulated = simulate(case)
    assert simulated.status is Status.CONVERGED
    assert np.abs(simulated.x[:3, -1] - position).max() <= 1e-5 * np.linalg.norm(position)


@pytest.mark.parametrize("value", ["0.0", "-1.0", "nan", "inf", '"1 kg"'])
def test_a_mass_that_is_none_is_refused(tmp_path: Path, value: str) -> None:
    with pytest.raises(BadInput, match="mu") as refusal:
        instance.load(str(two_body_case(tmp_path, mu=value)))
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize("key", ["x", "v_y"])
def test_a_state_that_is_no_number_is_refused(tmp_path: Path, key: str) -> None:
    with pytest.raises(BadInput, match=key) as refusal:
        instance.load(str(two_body_case(tmp_path, **{key: "nan"})))
    assert "\n" not in str(refusal.value)


def test_starting_in_the_centre_is_not_finite(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = two_body_case(tmp_path, x=0.0)
    simulated = simulate(instance.load(str(path)))
    assert (simulated.status, simulated.invariants) == (Status.NON_FINITE, {})
    assert main(["simulate", str(path)]) == 4
    assert "not finite" in capsys.readouterr().out


def test_falling_into_the_centre_is_no_answer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """From rest at distance 1 the collision comes at pi/sqrt(8), before the end."""
    monkeypatch.setattr(
        "satsym.solvers.simulation.simulating.MOST_STEPS", 2**13
    )  # a million would take a while, to no avail
    simulated = simulate(instance.load(str(two_body_case(tmp_path, v_y=0.0))))
    assert simulated.status in (Status.NOT_CONVERGED, Status.NON_FINITE)
    assert "singularity" in simulated.message or "not finite" in simulated.message
    assert simulated.metrics["steps"] <= 2**12, "given up before the steps are used up: they could not become enough"
