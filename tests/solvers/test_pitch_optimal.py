"""Least time and least energy of the pitch manoeuvre against closed forms; the comparison with the classical law."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from satsym import instance
from satsym.analysis import comparison
from satsym.cli import main
from satsym.instance import Instance
from satsym.report.plots import comparison as plots
from satsym.solution import Solution
from satsym.solvers import solve
from satsym.status import BadInput, Status
from tests.support.pitch import BODY, DAMPING, STEP, WHEEL

PEAK = 3.0 * STEP * BODY * DAMPING**2
"""Largest torque of the classical law after its impulse."""

SCALED = """model = "{model}"
[parameters]
{parameters}
[initial]
X1 = {start}
X2 = 0.0
[final]
X1 = 0.0
X2 = 0.0
[time]
tf = {tf}
[control]
U = [-1.0, 1.0]
"""


def scaled(folder: Path, model: str, start: float, tf: float | str, parameters: str = "") -> Instance:
    path = folder / "case.toml"
    path.write_text(SCALED.format(model=model, start=start, tf=tf, parameters=parameters), encoding="utf-8")
    return instance.load(path)


def certified(case: Instance) -> Solution:
    solution = solve(case)
    assert solution.certificate is not None, solution.message
    assert solution.certificate.verdict == "certified"
    return solution


@pytest.mark.parametrize(
    ("name", "torque", "duration"),
    [
        ("lapan-minimum-time", PEAK, 2.0 / (math.sqrt(3.0) * DAMPING)),
        ("lapan-minimum-time-100s", 4.0 * STEP * BODY / 100.0**2, 100.0),
    ],
)
def test_least_time_is_one_switch_half_way(name: str, torque: float, duration: float) -> None:
    case = instance.load(name)
    assert case.upper[0] == pytest.approx(torque, rel=1e-14)
    solution = certified(case)
    assert solution.times[-1] == pytest.approx(duration, rel=1e-10)
    assert solution.switching_times[0] == pytest.approx((duration / 2.0,), rel=1e-10)


@pytest.mark.parametrize(("weight", "tf"), [(0.0, 2.6), (0.1, 2.1), (0.5, 2.4), (1.0, 2.1), (1.0, 2.6)])
def test_least_energy_is_a_straight_line_within_the_bounds_whatever_the_weight(
    tmp_path: Path, weight: float, tf: float
) -> None:
    # 2 < tf < sqrt(6): the bounds hold at both ends; from sqrt(6) = 2.449 on they do not matter
    start = -1.0
    solution = certified(scaled(tmp_path, "pitch_scaled_energy", start, tf, f"C_p = {weight}"))
    t, half = solution.times, tf / 2.0
    if 6.0 * abs(start) / tf**2 <= 1.0:
        expected, cost, switches = 6.0 / tf**2 * (1.0 - 2.0 * t / tf), 12.0 / tf**3, []
    else:
        # U = 1 until half - w, then a straight line; the angle it turns in the first half is half^2/2 - w^2/6 = 1/2
        w = math.sqrt(3.0 * (half**2 - 1.0))
        expected, cost = np.clip((half - t) / w, -1.0, 1.0), 2.0 * (half - w) + 2.0 * w / 3.0
        switches = [half - w, half + w]
    assert np.abs(solution.u[0] - expected).max() <= 1e-9
    assert solution.objective == pytest.approx(cost, rel=1e-9)
    assert solution.switching_times[0] == pytest.approx(switches, rel=1e-9)
    # the costate carries the weight: lambda = mu - C_p X2 with mu = -2 U where no bound is met
    free = np.abs(solution.u[0]) < 1.0 - 1e-9
    assert solution.lam[1, free] == pytest.approx(-2.0 * solution.u[0, free] - weight * solution.x[1, free], abs=1e-8)


def test_least_energy_in_real_units_is_that_of_the_scaled_motion() -> None:
    solution = certified(instance.load("lapan-minimum-energy"))
    width = math.sqrt(3.0 * (60.0**2 - STEP * BODY / PEAK))
    assert solution.switching_times[0] == pytest.approx((60.0 - width, 60.0 + width), rel=1e-9)
    assert np.abs(solution.u[0] - PEAK * np.clip((60.0 - solution.times) / width, -1.0, 1.0)).max() <= 1e-9 * PEAK
    heat = 10.0 / 0.05**2 * (1.0 - WHEEL / BODY) ** 2 * PEAK**2 * (2.0 * (60.0 - width) + 2.0 * width / 3.0)
    assert solution.objective == pytest.approx(heat, rel=1e-9)


def test_too_short_a_time_is_infeasible_and_a_free_one_has_no_minimiser(tmp_path: Path) -> None:
    assert solve(scaled(tmp_path, "pitch_scaled_energy", -1.0, 1.99)).status is Status.INFEASIBLE
    assert solve(scaled(tmp_path, "pitch_scaled_energy", -1.0, '"free"')).status is Status.NO_MINIMISER


def test_an_empty_control_set_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = instance.load("lapan-minimum-time").path.read_text(encoding="utf-8")
    path = tmp_path / "case.toml"
    path.write_text(text.replace("[-5.085e-3, 5.085e-3]", "[5.085e-3, -5.085e-3]"), encoding="utf-8")
    assert main(["solve", str(path)]) == 3
    assert "wheel_torque" in capsys.readouterr().err


@pytest.fixture(scope="module")
def compared() -> list[comparison.Case]:
    names = ("lapan-classical", "lapan-minimum-time", "lapan-minimum-time-100s", "lapan-minimum-energy")
    return comparison.compare([instance.load(name) for name in names])


@pytest.mark.slow
def test_the_totals_of_the_comparison_are_those_of_the_closed_forms(compared: list[comparison.Case]) -> None:
    _, fast, hundred, sparing = (case.metrics for case in compared)
    unit = STEP * BODY * DAMPING
    assert fast["wheel_torque_total"] == pytest.approx(2.0 * math.sqrt(3.0) * unit, rel=1e-9)
    assert fast["wheel_speed_peak"] == pytest.approx(math.sqrt(3.0) * unit / WHEEL, rel=1e-9)
    assert fast["wheel_torque_effort"] == pytest.approx(PEAK**2 * fast["transition_time"], rel=1e-9)
    assert hundred["wheel_torque_total"] == pytest.approx(4.0 * STEP * BODY / 100.0, rel=1e-9)
    width = math.sqrt(3.0 * (60.0**2 - STEP * BODY / PEAK))
    assert sparing["wheel_torque_total"] == pytest.approx(PEAK * (120.0 - width), rel=1e-9)
    assert sparing["power_energy"] == pytest.approx(solve(compared[3].instance).objective, rel=1e-8)


def test_every_law_brings_the_wheel_back_to_its_nominal_speed(compared: list[comparison.Case]) -> None:
    # the paper has the classical law leave 4 P_c I_y E / I_wy = 7.5 rad/s
    for case in compared:
        assert abs(case.metrics["wheel_speed_final"]) < 1e-5


def test_least_time_takes_less_impulse_than_the_classical_law_at_its_torque(compared: list[comparison.Case]) -> None:
    classical, fast, hundred, sparing = (case.metrics["wheel_torque_total"] for case in compared)
    assert sparing < fast < hundred < classical


def test_a_range_scales_with_damping_and_command_and_finds_what_passes_the_limit() -> None:
    case = instance.load("lapan-classical")
    over = comparison.ranged(case, [0.005, 0.01, 0.02], [0.025, 0.1])
    damping, command = np.meshgrid(over.dampings, over.commands, indexing="ij")
    assert over.control_peak == pytest.approx(3.0 * command * BODY * damping**2, rel=1e-9)
    assert over.peaks["wheel_speed"] == pytest.approx(2.0 * command * BODY * damping / WHEEL, rel=1e-9)
    assert ((over.peaks["wheel_speed"] > case.limits["wheel_speed"]) == (command * damping > 6.95e-4)).all()


def test_instances_of_different_systems_are_not_compared() -> None:
    with pytest.raises(BadInput, match="does not have the states and controls of"):
        comparison.compare([instance.load("lapan-classical"), instance.load("return-to-orbit")])


@pytest.mark.usefixtures("full_resolution")
@pytest.mark.slow
def test_compare_prints_a_table_and_draws_a_page(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    names = ["lapan-classical", "lapan-minimum-time"]
    assert main(["compare", *names, "--range", "--out", str(tmp_path), "--plot"]) == 0
    said = capsys.readouterr().out
    assert "transition_time" in said
    assert "beyond the limit of wheel_speed" in said
    assert (tmp_path / "comparison.png").stat().st_size > 20_000
    assert main(["compare", *names, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert [each["instance"] for each in found["instances"]] == names
    assert list(found)[:7] == "satsym schema command model instance status units".split()
    assert (found["model"], found["instance"], found["status"]) == (None, None, "converged")
    assert found["units"]["wheel_torque"] == "N*m"
    assert found["metrics"]["power_energy"]["lapan-classical"] is None  # an impulse takes infinite energy


def test_a_law_that_does_not_settle_is_drawn_beside_others(
    compared: list[comparison.Case], monkeypatch: pytest.MonkeyPatch
) -> None:
    slow = replace(compared[0].instance, tf=200.0)
    cases = [*comparison.compare([slow]), compared[1]]
    assert math.isnan(cases[0].metrics["transition_time"])
    monkeypatch.setattr(plots, "_range", lambda *_: None)  # takes long, and is drawn elsewhere
    page = plots.page(cases)
    assert page is not None
    assert any(text.get_text() == " not settled" for axes in page.axes for text in axes.texts)
    assert page.axes[0].get_xlim()[1] == pytest.approx(plots.SHOWN * 200.0)


def test_without_any_answer_nothing_is_drawn(compared: list[comparison.Case]) -> None:
    assert plots.pictures([replace(compared[1], answered=False)]) == {}


def test_a_solved_manoeuvre_past_the_limit_of_the_wheel_says_so() -> None:
    case = instance.load("lapan-minimum-time")
    (found,) = comparison.compare([replace(case, limits={"wheel_speed": 3.0})])
    assert "wheel_speed reaches 3.26203 rad/s, which exceeds its limit of 3" in found.message
