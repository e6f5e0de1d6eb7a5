"""JSON objects, result files and summaries of solutions and simulations."""

from __future__ import annotations

import csv
import json
import os
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from satsym import instance
from satsym.instance import Instance
from satsym.report.results import files, sets, trajectory
from satsym.report.results.objects import model_object, simulation_object, solution_object
from satsym.report.terminal.solution import simulation_text, solution_text, with_files
from satsym.report.terminal.table import figure, table
from satsym.solution import Invariant, Simulation, Solution
from satsym.status import BadInput, Status

SOLUTION_KEYS = (
    "satsym schema command model instance status units instance_file method message boundary_type objective t_final "
    "x_final costate_initial switching_times iterations wall_s certificate x_initial t_initial parameters_found events"
).split()
SIMULATION_KEYS = (
    "satsym schema command model instance status units instance_file feedback t_final x_final invariants metrics"
).split()
STATES = ["r", "r_dot", "theta", "theta_dot"]


@pytest.fixture(scope="module")
def case() -> Instance:
    return instance.load("its-thesis")


@pytest.fixture
def solution(case: Instance) -> Solution:
    times = np.linspace(0.0, 60.0, 5)
    return Solution(
        instance=case,
        method="sweep",
        status=Status.CONVERGED,
        message="the message",
        objective=1.0 / 3.0,
        times=times,
        x=np.arange(20.0).reshape(4, 5) / 7.0,
        u=np.array([[0.0, 0.0, 0.5, 1.0, 1.0], [0.25, 0.5, 0.25, 0.5, 0.25]]),
        lam=-0.0 * np.ones((4, 5)),
        switching_times=((30.5, 15.25), (15.25,)),
        iterations=1,
        history=(),
        wall_s=0.25,
    )


@pytest.fixture
def failed(solution: Solution) -> Solution:
    nothing = np.full((4, 5), np.nan)
    return replace(solution, status=Status.NON_FINITE, objective=float("nan"), x=nothing, lam=nothing, iterations=0)


@pytest.fixture
def simulation(case: Instance) -> Simulation:
    return Simulation(
        instance=case,
        feedback="none",
        status=Status.CONVERGED,
        message="the message",
        times=np.array([0.0, 60.0]),
        x=np.ones((4, 2)),
        u=np.zeros((2, 2)),
        invariants={"energy": Invariant(-0.5, 1e-15)},
        metrics={"r_min": 1.0, "odd": float("inf")},
    )


def test_solution_has_the_keys_of_the_contract_in_their_order(solution: Solution) -> None:
    found = solution_object(solution)
    assert list(found) == SOLUTION_KEYS
    assert list(found["x_final"]) == list(found["costate_initial"]) == STATES
    assert found["model"] == "polar_orbit"
    assert found["instance"] == "its-thesis"
    assert found["status"] == "converged"
    assert found["certificate"] is None


def test_solution_tells_final_states_and_initial_costates(solution: Solution) -> None:
    solution.lam[:, 0] = [1.0, 2.0, 3.0, 4.0]
    found = solution_object(solution)
    assert found["t_final"] == 60.0
    assert found["x_final"] == dict(zip(STATES, solution.x[:, -1].tolist(), strict=True))
    assert list(found["costate_initial"].values()) == [1.0, 2.0, 3.0, 4.0]


def test_switching_times_of_all_controls_are_one_sorted_list(solution: Solution) -> None:
    assert solution_object(solution)["switching_times"] == [15.25, 30.5]


def test_numbers_that_are_not_finite_are_null(failed: Solution, simulation: Simulation) -> None:
    found = solution_object(failed)
    assert found["objective"] is None
    assert set(found["x_final"].values()) == set(found["costate_initial"].values()) == {None}
    assert simulation_object(simulation)["metrics"] == {"r_min": 1.0, "odd": None}
    json.dumps([found, simulation_object(simulation)], allow_nan=False)


def test_zero_has_no_sign(solution: Solution) -> None:
    assert "-0.0" not in json.dumps(solution_object(solution))


def test_solution_without_nodes_is_told_all_the_same(solution: Solution) -> None:
    empty = np.empty(0)
    bare = replace(solution, times=empty, x=np.empty((4, 0)), u=np.empty((2, 0)), lam=np.empty((4, 0)))
    assert solution_object(bare)["t_final"] is None
    assert set(solution_object(bare)["x_final"].values()) == {None}
    assert "its-thesis" in solution_text(bare)


def test_every_status_is_spelt_as_the_contract_has_it(solution: Solution) -> None:
    told = [solution_object(replace(solution, status=status))["status"] for status in Status]
    assert told == [
        "converged",
        "not converged",
        "infeasible",
        "no minimiser",
        "left domain",
        "non-finite",
        "time limit",
    ]


def test_simulation_has_the_keys_of_the_contract_in_their_order(simulation: Simulation) -> None:
    found = simulation_object(simulation)
    assert list(found) == SIMULATION_KEYS
    assert list(found["x_final"]) == STATES
    assert found["invariants"] == {"energy": {"initial": -0.5, "drift": 1e-15}}


def test_model_is_told_with_units_and_defaults(case: Instance) -> None:
    found = model_object(case.model.spec)
    assert found["states"][2] == {
        "name": "theta",
        "unit": "rad",
        "meaning": "polar angle in the inertial plane",
        "kind": "angle",
    }
    assert found["parameters"][0]["default"] == 1.0


@pytest.mark.parametrize(
    ("tf", "final", "expected"),
    [
        (1.0, dict.fromkeys(STATES, 1.0), 1),
        (None, dict.fromkeys(STATES, 1.0), 2),
        (1.0, {}, 3),
        (1.0, {"r": 1.0}, 3),
        (None, dict.fromkeys(STATES, "reference"), 4),
        (None, {}, 5),
    ],
)
def test_boundary_type_follows_from_what_is_given(
    case: Instance, tf: float | None, final: dict[str, Any], expected: int
) -> None:
    assert replace(case, tf=tf, final=final).boundary_type == expected


def test_trajectory_files_give_back_every_number(solution: Solution, tmp_path: Path) -> None:
    sets.write(tmp_path, {}, trajectory.contents(solution))
    with np.load(tmp_path / "trajectory.npz", allow_pickle=False) as stored:
        for name in ("times", "x", "u", "lam"):
            np.testing.assert_array_equal(stored[name], getattr(solution, name))
        assert stored["states"].tolist() == STATES
        assert stored["controls"].tolist() == ["u1", "u2"]
    with (tmp_path / "trajectory.csv").open(encoding="utf-8", newline="") as stream:
        header, *rows = csv.reader(stream)
    assert [name.partition(" [")[0] for name in header] == ["t", *STATES, "u1", "u2", *(f"lambda_{s}" for s in STATES)]
    assert {"t [s]", "r_dot [km/s]", "u2 [km/s**2]", "lambda_r [km/s**3]"} <= set(header)
    columns = np.array(rows, dtype=float).T
    np.testing.assert_array_equal(columns, np.vstack([solution.times, solution.x, solution.u, solution.lam]))


def test_trajectory_of_a_simulation_has_no_costates(simulation: Simulation, tmp_path: Path) -> None:
    sets.write(tmp_path, {}, trajectory.contents(simulation))
    assert "lambda" not in (tmp_path / "trajectory.csv").read_text(encoding="utf-8")
    with np.load(tmp_path / "trajectory.npz") as stored:
        assert "lam" not in stored


def test_same_solution_gives_the_same_bytes(solution: Solution, tmp_path: Path) -> None:
    for folder in ("one", "two"):
        sets.write(tmp_path / folder, {}, trajectory.contents(solution))
    for name in ("trajectory.npz", "trajectory.csv"):
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes()


def test_text_file_is_written_through_a_link(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to("target")
    files.write_text(tmp_path / "link", "θ\n")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "target").read_text(encoding="utf-8") == "θ\n"


def test_what_a_killed_process_left_of_a_text_file_is_removed(tmp_path: Path) -> None:
    (tmp_path / ".a.tex.4194305.tmp").touch()  # no system has so many processes
    (tmp_path / f".a.tex.{os.getppid()}.tmp").touch()
    (tmp_path / ".b.tex.4194305.tmp").touch()
    files.write_text(tmp_path / "a.tex", "text")
    assert {path.name for path in tmp_path.iterdir()} == {
        "a.tex",
        f".a.tex.{os.getppid()}.tmp",
        ".b.tex.4194305.tmp",
    }


def test_device_is_written_to_and_not_replaced() -> None:
    files.write_text(Path("/dev/null"), "text")
    assert Path("/dev/null").is_char_device()


@pytest.mark.parametrize("place", ["file/below", "file"])
def test_place_that_is_no_folder_is_refused_before_anything_is_made(tmp_path: Path, place: str) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(BadInput, match="not a folder"):
        files.check_writable(tmp_path / place)
    files.check_writable(tmp_path / "new" / "folder")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_summary_tells_outcome_states_bounds_and_switches(solution: Solution) -> None:
    told = solution_text(solution)
    assert told.startswith("ITS thesis, weights 10 and 10, as printed\nits-thesis, model polar_orbit: converged (sweep")
    assert "the message" in told
    assert "0.3333333333" in told
    (line,) = [line for line in told.splitlines() if line.split()[:1] == ["u1"]]
    assert line.split() == ["u1", "0", "1", "[0,", "1]", "75", "%"]
    assert "u1  from 0 to 15.25, from 30.5 to 60" in told
    assert "\x1b" not in told


def test_summary_of_a_failure_advises(failed: Solution) -> None:
    told = " ".join(solution_text(failed).split())
    assert "non-finite" in told
    assert Status.NON_FINITE.advice in told
    assert "nan" not in told


def test_status_is_coloured_on_request(solution: Solution, failed: Solution) -> None:
    assert "\x1b[32mconverged\x1b[0m" in solution_text(solution, colour=True)
    assert "\x1b[31mnon-finite\x1b[0m" in solution_text(failed, colour=True)


def test_summary_of_a_simulation_tells_what_is_conserved(simulation: Simulation) -> None:
    told = simulation_text(simulation)
    assert "energy" in told
    assert "1e-15" in told
    assert "costate" not in told


def test_summary_says_where_files_are(solution: Solution) -> None:
    told = with_files("summary", [Path("a/x.png"), Path("a/y.png")])
    assert told == "summary\n\n  written to a: x.png, y.png"
    assert with_files("summary", [Path("x.png"), Path("y.png")]) == "summary\n\n  written: x.png, y.png"
    assert with_files("summary", []) == "summary"


def test_table_aligns_and_leaves_out_empty_columns() -> None:
    rows = [("name", "value", "unit"), ("a", "1", ""), ("long", "10.5", "")]
    assert table(rows, right=(1,), indent="") == ["name  value", "a         1", "long   10.5"]


@pytest.mark.parametrize(("value", "shown"), [(-0.0, "0"), (float("nan"), "-"), (1 / 3, "0.333333"), (1e-9, "1e-09")])
def test_figures_are_short(value: float, shown: str) -> None:
    assert figure(value) == shown
