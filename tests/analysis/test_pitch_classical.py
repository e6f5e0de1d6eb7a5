"""The classical law simulated: closed forms, filtered differentiators, conserved momentum, limits, and refusals."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import control
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from satsym import instance
from satsym.analysis.classical import law
from satsym.analysis.classical.signals import _crossing
from satsym.analysis.regulator.feedback import simulate
from satsym.cli import main
from satsym.status import BadInput
from tests.support.pitch import BODY, DAMPING, NOMINAL, STEP, WHEEL, classical

ROUNDING = 1e-9
"""Agreement asked for between closed forms and simulations."""


def test_the_simulation_agrees_with_the_closed_forms() -> None:
    simulation = simulate(classical())
    s = DAMPING * simulation.times
    theta = STEP * (1.0 + np.exp(-s) * (s - 1.0))
    speed = BODY / WHEEL * STEP * DAMPING * np.exp(-s) * (2.0 - s)
    torque = BODY * STEP * DAMPING**2 * np.exp(-s) * (s - 3.0)
    assert np.abs(simulation.x[0] - theta).max() <= ROUNDING * STEP
    assert np.abs(simulation.x[2] - speed).max() <= ROUNDING * speed[0]
    assert np.abs(simulation.u[0] - torque).max() <= ROUNDING * -torque[0]


def test_the_metrics_of_the_simulation_are_those_of_the_closed_forms() -> None:
    metrics = simulate(classical(tf=4000.0)).metrics
    unit = STEP * BODY * DAMPING
    assert metrics["first_reached"] == pytest.approx(1.0 / DAMPING, rel=ROUNDING)
    assert metrics["overshoot"] == pytest.approx(math.exp(-2.0), rel=ROUNDING)
    assert metrics["impulse"] == pytest.approx(2.0 * unit, rel=ROUNDING)
    assert metrics["wheel_torque_total"] == pytest.approx(unit * (4.0 + 2.0 * math.exp(-3.0)), rel=ROUNDING)
    assert metrics["wheel_torque_peak"] == pytest.approx(3.0 * unit * DAMPING, rel=ROUNDING)
    assert metrics["wheel_speed_peak"] == pytest.approx(2.0 * unit / WHEEL, rel=ROUNDING)
    assert abs(metrics["wheel_speed_final"]) < 1e-9 * metrics["wheel_speed_peak"]
    assert math.isinf(metrics["power_energy"])
    s = DAMPING * metrics["settling_time"]
    assert math.exp(-s) * (s - 1.0) == pytest.approx(0.02, rel=1e-8)
    assert s > 5.0  # and not 1, as the paper has it


def test_totals_do_not_depend_on_the_nodes_of_the_grid() -> None:
    damping = 5.0  # all is over before the third of 200 nodes
    simulation = simulate(classical(tf=300.0, damping=damping))
    unit = STEP * BODY * damping
    assert simulation.metrics["wheel_torque_total"] == pytest.approx(unit * (4.0 + 2.0 * math.exp(-3.0)), rel=1e-12)
    assert simulation.metrics["overshoot"] == pytest.approx(math.exp(-2.0), rel=ROUNDING)


@pytest.mark.parametrize("lag", [0.5, 5.0, 40.0])
def test_a_differentiator_that_lags_behind_flies_as_python_control_says(lag: float) -> None:
    simulation = simulate(classical(tf=600.0, differentiator=lag))
    k1, k2 = 2.0 * DAMPING * BODY, DAMPING**2 * BODY
    action = control.tf([k1 + k2 * lag, k2], [lag, 1.0])
    whole = control.feedback(control.tf([1.0], [BODY, 0.0, 0.0]) * action, 1)
    expected = control.step_response(whole, simulation.times).outputs * STEP
    assert np.abs(simulation.x[0] - expected).max() <= ROUNDING * STEP
    exact = law.loop(simulation.instance).linear(np.zeros(3), simulation.times)
    assert np.abs(simulation.x - exact[:3]).max(axis=1) == pytest.approx(0.0, abs=ROUNDING * 4.0)
    assert simulation.metrics["impulse"] == 0.0
    assert math.isfinite(simulation.metrics["power_energy"])


@pytest.mark.slow
def test_a_differentiator_that_hardly_lags_comes_near_the_ideal_one() -> None:
    ideal = simulate(classical(tf=120.0))
    apart = [
        np.abs(simulate(classical(tf=120.0, differentiator=lag)).x[0] - ideal.x[0]).max() for lag in (2.0, 1.0, 0.5)
    ]
    assert np.log2(apart[0] / apart[1]) == pytest.approx(1.0, abs=0.15)
    assert np.log2(apart[1] / apart[2]) == pytest.approx(1.0, abs=0.1)


@settings(max_examples=4)
@given(
    damping=st.floats(0.002, 0.05),
    command=st.floats(-0.1, 0.1).filter(lambda c: abs(c) > 1e-3),
    lag=st.sampled_from([0.0, 3.0]),
    roll=st.floats(300.0, 3000.0),
)
def test_the_momentum_of_body_and_wheel_changes_by_gravity_alone(
    damping: float, command: float, lag: float, roll: float
) -> None:
    case = classical(tf=5.0 / damping, damping=damping, command=command, differentiator=lag)
    names = case.model.spec.parameter_names
    turned = tuple(roll if name == "I_x" else v for name, v in zip(names, case.parameters, strict=True))
    symmetric, other = simulate(case), simulate(replace(case, parameters=turned))
    size = WHEEL * NOMINAL
    assert symmetric.invariants["angular_momentum"].drift <= 1e-12 * size
    assert other.invariants["angular_momentum"].drift <= 1e-9 * size


def test_the_momentum_is_kept_without_any_law_as_well() -> None:
    case = replace(classical(tf=3000.0), initial=(0.02, 1e-4, 1.0))
    simulation = simulate(case, "none")
    assert simulation.invariants["angular_momentum"].drift <= 1e-12 * WHEEL * NOMINAL
    names = case.model.spec.parameter_names
    turned = tuple(400.0 if name == "I_x" else v for name, v in zip(names, case.parameters, strict=True))
    assert simulate(replace(case, parameters=turned), "none").invariants["angular_momentum"].drift <= 1e-8


def test_what_gravity_does_is_undone_by_the_law_but_for_its_cubic_part() -> None:
    case = classical(tf=3000.0)
    names = case.model.spec.parameter_names
    turned = tuple(400.0 if name == "I_x" else v for name, v in zip(names, case.parameters, strict=True))
    simulation, symmetric = simulate(replace(case, parameters=turned)), simulate(case)
    assert np.abs(simulation.x[0] - symmetric.x[0]).max() < 1e-3 * STEP
    # holding the angle against gravity speeds the wheel up all the time
    torque = 3.0 * 7.26e-5**2 * (400.0 - 1356.0) * STEP
    assert simulation.x[2, -1] - simulation.x[2, -2] == pytest.approx(
        torque * np.diff(simulation.times)[-1] / WHEEL, rel=1e-3
    )


def test_gains_that_are_given_are_simulated() -> None:
    k1, k2 = 20.0, 0.05
    case = classical(tf=800.0, damping=None, gains=(k1, k2))
    expected = control.step_response(control.tf([k1, k2], [BODY, k1, k2]), simulate(case).times).outputs * STEP
    assert np.abs(simulate(case).x[0] - expected).max() <= ROUNDING * STEP


def test_the_feedback_of_an_instance_with_a_law_is_that_law_unless_another_is_asked_for() -> None:
    assert simulate(classical(tf=50.0)).feedback == "classical"
    assert simulate(classical(tf=50.0), "none").feedback == "none"


def test_a_wheel_that_is_driven_past_its_limit_is_reported_with_the_limit() -> None:
    simulation = simulate(classical(command=0.1))
    assert "wheel_speed reaches 15.0667 rad/s, which exceeds its limit of 10.472" in simulation.message
    assert "limit" not in simulate(classical()).message


def test_a_loop_that_has_not_settled_says_so() -> None:
    simulation = simulate(classical(tf=200.0))
    assert math.isnan(simulation.metrics["settling_time"])
    assert "theta has not settled by the final time" in simulation.message
    assert "settled" not in simulate(classical()).message


def test_a_command_to_stay_leaves_everything_at_rest() -> None:
    simulation = simulate(classical(command=0.0))
    assert not simulation.x.any()
    assert not simulation.u.any()


@pytest.mark.parametrize("options", [{"damping": 1e6}, {"differentiator": 1e-9}])
def test_a_loop_that_is_too_fast_to_be_followed_is_refused(options: dict[str, float]) -> None:
    with pytest.raises(BadInput, match=r"shortest time constant of the loop, 1e-0\d, is too short"):
        simulate(classical(**options))


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        ("damping = 0.01", "damping = 0.0", "[classical] damping: 0 is not positive"),
        ("damping = 0.01", "damping = -0.01", "[classical] damping: -0.01 is not positive"),
        ("damping = 0.01", "gains = [1.0, -1.0]", "[classical] gains"),
        ("damping = 0.01", "", "write either the damping"),
        ("damping = 0.01", "damping = 0.01\ndifferentiator = -1.0", "[classical] differentiator"),
        ('follows = "theta"', 'follows = "phi"', "the model has no state"),
        ('follows = "theta"', 'follows = "wheel_speed"', "[classical] follows"),
        ("command = 0.025", 'command = "3 km"', "[classical] command"),
        ("[limits]", "[parameters]\nI_y = 0.0\n[limits]", "I_y"),
        ("[limits]", "[parameters]\nI_wy = -0.09\n[limits]", "I_wy"),
        ("wheel_speed = 10.47", "wheel_speed = -10.47", "[limits] wheel_speed"),
        ("wheel_speed = 10.47", "speed = 10.47", "limits"),
        ("damping = 0.01", "dumping = 0.01", "unknown key"),
    ],
)
def test_what_makes_no_law_is_refused_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], old: str, new: str, complaint: str
) -> None:
    text = instance.load("lapan-classical").path.read_text(encoding="utf-8")
    assert old in text
    path = tmp_path / "case.toml"
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    assert main(["simulate", str(path)]) == 3
    said = capsys.readouterr().err.strip()
    assert complaint in said
    assert "\n" not in said


def test_a_law_is_not_simulated_where_none_is_stated(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", "return-to-orbit", "--feedback", "classical"]) == 3
    assert "no [classical] table" in capsys.readouterr().err


def test_a_crossing_is_where_the_sign_changes_or_at_the_node_that_is_only_just_reached() -> None:
    times = np.array([2.0, 3.0, 4.0])
    assert _crossing(times, lambda t: t - 3.25, 2) == pytest.approx(1.25, rel=1e-12)
    assert _crossing(times, lambda t: 1e-17, 2) == 2.0, "rounding left both ends on one side"
    assert _crossing(times, lambda t: t, 0) == 0.0
