"""Least time simulated as a feedback: by the switching curve with a deadband, and by pulses from the position alone."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given, settings

from satsym import instance
from satsym import solvers as solve
from satsym.analysis.regulator.feedback import simulate
from satsym.cli import main
from satsym.instance import Instance
from satsym.solution import Simulation
from satsym.status import BadInput, Status
from tests.support.body_on_a_line import BOUNDS, LINE, SPEED, case, generated, least

PITCH = instance.load("lapan-minimum-time")

# the relay


@settings(max_examples=25, deadline=None)
@given(q=SPEED, v=SPEED, q_f=SPEED, v_f=SPEED, bounds=BOUNDS)
def test_the_relay_takes_least_time_but_for_its_deadband(
    q: float, v: float, q_f: float, v_f: float, bounds: tuple[float, float]
) -> None:
    of = case((q, v), (q_f, v_f), bounds, deadband=1e-6)
    assume(abs(generated("beyond_switching_curve", (q, v), of)) > 1e-2)
    simulation = simulate(of, "switching")
    assert simulation.status is Status.CONVERGED
    assert simulation.metrics["switches"] <= 1.0
    assert abs(simulation.metrics["q_residual"]) <= 1.001e-6
    assert abs(simulation.metrics["q_dot_residual"]) <= 1e-9
    assert simulation.metrics["arrival_time"] == pytest.approx(least((q, v), (q_f, v_f), bounds)[0], abs=1e-3)


def test_the_time_converges_with_the_first_order_of_the_deadband() -> None:
    bounds, start = (-0.5, 2.0), (1.0, 0.3)
    exact = least(start, (0.0, 0.0), bounds)[0]
    widths = (1e-2, 1e-3, 1e-4, 1e-5)
    errors = [
        simulate(case(start, bounds=bounds, deadband=w), "switching").metrics["arrival_time"] - exact for w in widths
    ]
    orders = [math.log10(a / b) for a, b in pairwise(errors)]
    assert orders == pytest.approx([1.0] * 3, abs=0.01)


def test_from_rest_the_relay_acts_as_if_the_way_were_longer_by_the_deadband() -> None:
    simulation = simulate(case(deadband=0.21), "switching")
    assert simulation.metrics["arrival_time"] == pytest.approx(2.0 * math.sqrt(1.21), rel=1e-12)
    assert simulation.metrics["q_residual"] == pytest.approx(-0.21, rel=1e-9)
    assert simulation.metrics["u1_total"] == pytest.approx(2.2, rel=1e-9)


def test_a_start_beside_the_curve_needs_no_switch() -> None:
    simulation = simulate(case((0.4996, -1.0)), "switching")
    assert simulation.metrics["switches"] == 0.0
    assert simulation.metrics["arrival_time"] == pytest.approx(1.0, rel=1e-12)
    assert simulation.metrics["q_residual"] == pytest.approx(-4e-4, rel=1e-9)


def test_with_a_final_time_the_relay_coasts_within_the_deadband() -> None:
    simulation = simulate(case(tf=5.0), "switching")
    assert simulation.times[-1] == 5.0
    assert simulation.metrics["arrival_time"] == pytest.approx(2.0 * math.sqrt(1.001), rel=1e-12)
    assert abs(simulation.x[0, -1]) <= 1.001e-3
    assert simulation.u[0, -1] == 0.0
    short = simulate(case(tf=1.5), "switching")
    assert "arrival_time" not in short.metrics
    assert "the motion has not reached the deadband of" in short.message


def test_a_deadband_that_is_lost_in_rounding_is_said_to_be() -> None:
    simulation = simulate(case((1.0, 0.3), bounds=(-0.7, 1.1), deadband=1e-300), "switching")
    assert simulation.status is Status.NOT_CONVERGED
    assert "is below the rounding error" in simulation.message


# position alone


def test_from_rest_a_pair_of_pulses_is_least_time_as_the_solver_finds_it() -> None:
    solved = solve.solve(PITCH)
    simulation = simulate(PITCH, "pulses")
    assert simulation.metrics["pairs"] == 1.0
    assert simulation.metrics["arrival_time"] == pytest.approx(solved.times[-1], rel=1e-9)
    assert abs(simulation.metrics["theta_residual"]) < 1e-12
    assert abs(simulation.metrics["theta_dot_residual"]) < 1e-14
    relay = simulate(replace(PITCH, deadband=1e-9), "switching")
    assert relay.metrics["arrival_time"] == pytest.approx(solved.times[-1], rel=1e-7)
    assert simulation.metrics["wheel_torque_total"] == pytest.approx(5.085e-3 * solved.times[-1], rel=1e-9)


@settings(max_examples=15, deadline=None)
@given(q=SPEED, q_f=SPEED, bounds=BOUNDS)
def test_pulses_arrive_from_rest_whatever_the_bounds(q: float, q_f: float, bounds: tuple[float, float]) -> None:
    assume(abs(q - q_f) > 1e-2)
    simulation = simulate(case((q, 0.0), (q_f, 0.0), bounds), "pulses")
    assert simulation.metrics["arrival_time"] == pytest.approx(least((q, 0.0), (q_f, 0.0), bounds)[0], rel=1e-9)
    assert simulation.metrics["q_residual"] == pytest.approx(0.0, abs=1e-10)
    assert simulation.metrics["q_dot_residual"] == pytest.approx(0.0, abs=1e-10)


def test_a_rate_that_is_not_measured_stays_and_carries_the_position_off() -> None:
    of = case((1.0, 0.05))
    simulation = simulate(of, "pulses")
    assert simulation.metrics["q_dot_residual"] == pytest.approx(0.05, rel=1e-9)
    assert simulation.metrics["q_residual"] == pytest.approx(0.05 * 2.0, rel=1e-9)
    assert "the motion did not start at rest" in simulation.message
    relay = simulate(of, "switching")  # which looks at the rate as well
    assert abs(relay.metrics["q_dot_residual"]) < 1e-9


def test_no_number_of_pairs_takes_an_initial_rate_away() -> None:
    simulation = simulate(case((0.0, 0.01), deadband=0.02, tf=40.0), "pulses")
    assert simulation.metrics["pairs"] > 3.0
    assert simulation.times[-1] == 40.0
    rests = simulation.u[0] == 0.0
    assert np.abs(simulation.x[1, rests] - 0.01).max() < 1e-12


def test_pulses_wait_where_the_error_is_allowed() -> None:
    simulation = simulate(case((0.01, 0.0), deadband=0.02, tf=3.0), "pulses")
    assert simulation.metrics["pairs"] == 0.0
    assert not simulation.u.any()


# bad input


@pytest.mark.parametrize("feedback", ["switching", "pulses"])
@pytest.mark.parametrize(
    ("wrong", "named"),
    [
        (replace(LINE, deadband=None), "no [switching] table"),
        (replace(LINE, final={"q": 0.0}), "[final] q_dot: missing"),
        (replace(LINE, lower=(0.0,)), "with 0 between them"),
        (replace(LINE, upper=(math.inf,)), "the bounds -1 and inf must be finite"),
        (replace(LINE, initial=(5e-4, 0.0)), "is already within the deadband of its target"),
        (instance.load("double-integrator-fuel"), "no switching curve in closed form"),
    ],
    ids=["no table", "no target", "one way", "no bound", "there already", "no curve"],
)
def test_what_does_not_suit_a_switching_feedback_is_refused(feedback: str, wrong: Instance, named: str) -> None:
    with pytest.raises(BadInput) as refused:
        simulate(wrong, feedback)
    assert named in str(refused.value)
    assert "\n" not in str(refused.value)


def test_pulses_cannot_end_in_motion() -> None:
    with pytest.raises(BadInput, match="end at rest"):
        simulate(case(end=(0.0, 0.5)), "pulses")


@pytest.mark.parametrize(
    ("table", "named"),
    [
        ("deadband = 0.0", "is not positive"),
        ("deadband = -1e-3", "is not positive"),
        ('deadband = "1 s"', "[switching] deadband"),
        ("deadband = nan", "deadband"),
        ("dead_band = 1e-3", "unknown key"),
        ("", "deadband: missing"),
    ],
)
def test_a_wrong_table_is_one_line_and_exit_3(
    table: str, named: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = LINE.path.read_text(encoding="utf-8").split("[switching]")[0]
    path = tmp_path / "wrong.toml"
    path.write_text(f"{text}[switching]\n{table}\n", encoding="utf-8")
    assert main(["simulate", str(path), "--feedback", "switching"]) == 3
    out, err = capsys.readouterr()
    assert not out
    assert named in err
    assert len(err.strip().splitlines()) == 1


def test_a_table_for_a_model_without_a_curve_is_refused(tmp_path: Path) -> None:
    text = instance.load("double-integrator-fuel").path.read_text(encoding="utf-8")
    path = tmp_path / "fuel.toml"
    path.write_text(f"{text}\n[switching]\ndeadband = 1e-3\n", encoding="utf-8")
    with pytest.raises(BadInput, match="no switching curve"):
        instance.load(path)


def test_the_command_prints_the_simulation(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", "double-integrator-time", "--feedback", "pulses", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["feedback"] == "pulses"
    assert found["metrics"]["arrival_time"] == pytest.approx(2.0)


def test_a_simulation_is_sampled_within_its_bounds() -> None:
    simulation: Simulation = simulate(case(bounds=(-0.3, 0.7)), "switching")
    assert {*simulation.u[0].tolist()} == {-0.3, 0.7}
    assert simulation.x.shape == (2, LINE.solver.steps + 1)
