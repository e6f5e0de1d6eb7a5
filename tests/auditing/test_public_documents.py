"""Two public documents that are not of the five: what stands and what falls, and the same by a second route."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from satsym import auditing
from satsym.auditing import Judged, audit
from satsym.auditing.causes import Weight, findings

EXAMPLES = Path(__file__).parents[2] / "derivations" / "examples"


@pytest.fixture(scope="module")
def velocity_frame() -> list[Judged]:
    return audit(auditing.read(EXAMPLES / "velocity_frame.ledger.toml"))


@pytest.fixture(scope="module")
def three_bodies() -> list[Judged]:
    return audit(auditing.read(EXAMPLES / "three_bodies.ledger.toml"))


@pytest.mark.slow
def test_of_the_velocity_frame_the_normal_alone_falls(velocity_frame: list[Judged]) -> None:
    assert {row.key: row.verdict for row in velocity_frame if row.verdict != "confirmed"} == {"7b": "misprint"}
    (finding,) = findings(velocity_frame)
    assert finding.weight is Weight.SLIP


@pytest.mark.parametrize(("eccentricity", "anomaly"), [(0.3, 1.0), (0.7, 2.5), (0.3, math.pi), (0.0, 1.2)])
def test_the_printed_normal_is_of_unit_length_at_apses_and_on_circles_alone(
    eccentricity: float, anomaly: float
) -> None:
    place = np.array([math.cos(anomaly), math.sin(anomaly), 0.0]) / (1.0 + eccentricity * math.cos(anomaly))
    velocity = np.array([-math.sin(anomaly), eccentricity + math.cos(anomaly), 0.0])  # mu = p = 1
    length = np.linalg.norm(np.cross(place, velocity)) / np.linalg.norm(place) / np.linalg.norm(velocity)
    special = eccentricity == 0.0 or abs(math.sin(anomaly)) < 1e-12
    assert (abs(float(length) - 1.0) < 1e-12) is special


def test_the_velocity_turns_as_the_conclusion_says() -> None:
    eccentricity = 0.3

    def direction(anomaly: float) -> float:
        return math.atan2(eccentricity + math.cos(anomaly), -math.sin(anomaly))

    for anomaly in (0.2, 1.0, 2.0):
        turned = (direction(anomaly + 1e-5) - direction(anomaly - 1e-5)) / 2e-5
        cosine = math.cos(anomaly)
        printed = (1 + eccentricity * cosine) / (1 + eccentricity**2 + 2 * eccentricity * cosine)
        assert turned == pytest.approx(printed, rel=1e-9)


@pytest.mark.slow
def test_of_the_three_bodies_one_line_falls(three_bodies: list[Judged]) -> None:
    fallen = {row.part: row for row in three_bodies if row.verdict != "confirmed"}
    assert set(fallen) == {"second line, left", "second line, right"}
    assert {row.verdict for row in fallen.values()} == {"misprint"}
    assert "The sign of `2*n**2*R*xs_dot` is reversed." in fallen["second line, left"].diagnosis
    assert "`V_xs` should be `V_ys`" in fallen["second line, right"].diagnosis


def test_the_printed_integral_is_kept_by_motion_in_axes_that_do_not_turn() -> None:
    share = 0.01215

    def bodies(time: float) -> tuple[np.ndarray, np.ndarray]:
        along = np.array([math.cos(time), math.sin(time), 0.0])
        return -share * along, (1.0 - share) * along

    def rates(time: float, state: np.ndarray) -> np.ndarray:
        first, second = (state[:3] - body for body in bodies(time))
        pull = (1.0 - share) * first / np.linalg.norm(first) ** 3 + share * second / np.linalg.norm(second) ** 3
        return np.concatenate([state[3:], -pull])

    def integral(time: float, state: np.ndarray) -> float:
        first, second = (float(np.linalg.norm(state[:3] - body)) for body in bodies(time))
        relative = state[3:] - np.cross([0.0, 0.0, 1.0], state[:3])
        potential = (state[0] ** 2 + state[1] ** 2) / 2 + (1.0 - share) / first + share / second
        return float(relative @ relative / 2 - potential)

    start = np.array([0.5, 0.1, 0.05, -0.1, 1.1, 0.0])
    moved = solve_ivp(rates, (0.0, 3.0), start, rtol=1e-11, atol=1e-12)
    assert integral(3.0, moved.y[:, -1]) == pytest.approx(integral(0.0, start), abs=1e-8)
