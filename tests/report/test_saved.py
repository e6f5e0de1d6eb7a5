"""Saved results read back: the same numbers, the same pictures, and one line about what cannot be used."""

from __future__ import annotations

import io
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from satsym import instance
from satsym.analysis.regulator.feedback import simulate as under_law
from satsym.cli.app import program
from satsym.cli.saving import save, trajectory_files
from satsym.instance.numbers import changed
from satsym.report.look import SCREEN
from satsym.report.results import trajectory
from satsym.report.results.objects import simulation_object, solution_object
from satsym.solution import Simulation, Solution
from satsym.solvers import simulate
from satsym.status import BadInput
from tests.support.damage import signed
from tests.support.solved import solve

NAME = "return-to-orbit-006"


@pytest.fixture(scope="module")
def solution() -> Solution:
    """With bounds that are met."""
    return solve(instance.load(NAME))


@pytest.fixture(scope="module")
def simulation() -> Simulation:
    return simulate(instance.load("its-thesis"))


@pytest.fixture
def folder(solution: Solution, tmp_path: Path) -> Path:
    save(tmp_path, solution_object(solution), trajectory_files(tmp_path, solution, look=None))
    return tmp_path


def kept(found: Solution | Simulation) -> dict[str, Any]:
    """The fields of a result that are saved, arrays as lists; of a simulation, why it failed is not."""
    left_out = {"instance", "certificate"} | ({"message"} if isinstance(found, Simulation) else set())
    fields = {name: value for name, value in vars(found).items() if name not in left_out}
    return {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in fields.items()}


def test_a_solution_comes_back_with_every_number(solution: Solution, folder: Path) -> None:
    found, _ = trajectory.read(solution.instance, folder)
    assert isinstance(found, Solution)
    assert any(solution.switching_times)
    assert len(solution.history) > 2
    assert kept(found) == kept(solution)


def test_a_simulation_comes_back_with_every_number(simulation: Simulation, tmp_path: Path) -> None:
    save(tmp_path, simulation_object(simulation), trajectory_files(tmp_path, simulation, look=None))
    found, _ = trajectory.read(simulation.instance, tmp_path)
    assert isinstance(found, Simulation)
    assert kept(found) == kept(simulation)


def plotted(*arguments: str | Path) -> str:
    done = CliRunner().invoke(program, ["plot", *map(str, arguments)], standalone_mode=False)
    assert done.return_value == 0, done.output
    return done.stdout


@pytest.mark.slow
def test_a_motion_that_begins_with_an_impulse_comes_back(tmp_path: Path) -> None:
    """Its first state is not the initial one of the instance, which has not changed all the same."""
    found = under_law(instance.load("lapan-classical"), "classical")
    assert found.x[2, 0] != found.instance.initial[2]
    save(tmp_path, simulation_object(found), trajectory_files(tmp_path, found, look=None))
    again, _ = trajectory.read(found.instance, tmp_path)
    assert np.array_equal(again.x, found.x)
    other = changed(found.instance, {"initial.theta_dot": 1e-3})
    with pytest.raises(BadInput, match="does not start from the initial state of"):
        trajectory.read(other, tmp_path)


@pytest.mark.slow
def test_pictures_are_those_of_the_run_itself(solution: Solution, tmp_path: Path) -> None:
    files = trajectory_files(tmp_path / "run", solution, look=SCREEN)
    first = save(tmp_path / "run", solution_object(solution), files)
    drawn = json.loads(plotted(NAME, "--from", tmp_path / "run", "--out", tmp_path / "again", "--json"))
    pictures = [path for path in first if path.suffix == ".png"]
    assert [Path(name).name for name in drawn["pictures"]] == [path.name for path in pictures]
    for path in pictures:
        assert (tmp_path / "again" / path.name).read_bytes() == path.read_bytes(), path.name


@pytest.mark.slow
@pytest.mark.parametrize(
    "command",
    [
        "lqr uny-lqr",
        "lqr geo-lqr --set initial.r=42200",
        "analyse itb-earth",
        "analyse clohessy_wiltshire",
        "compare lapan-minimum-energy lapan-classical",
    ],
)
def test_what_was_found_without_a_trajectory_is_drawn_again(command: str, tmp_path: Path) -> None:
    """With the bytes of the pictures that the command itself draws."""
    begun = [*command.split(), "--out", str(tmp_path / "run"), "--plot"]
    assert CliRunner().invoke(program, begun, standalone_mode=False).return_value == 0
    drawn = json.loads(plotted(command.split()[1], "--from", tmp_path / "run", "--out", tmp_path / "again", "--json"))
    names = sorted(path.name for path in (tmp_path / "run").glob("*.png"))
    assert sorted(Path(name).name for name in drawn["pictures"]) == names != []
    for name in names:
        assert (tmp_path / "again" / name).read_bytes() == (tmp_path / "run" / name).read_bytes(), name


def test_what_is_of_something_else_is_not_drawn(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    case, run = tmp_path / "own.toml", tmp_path / "run"
    case.write_bytes(instance.load("uny-lqr").path.read_bytes())
    assert CliRunner().invoke(program, ["lqr", str(case), "--out", str(run)], standalone_mode=False).return_value == 0

    def refused(subject: str, message: str) -> None:
        done = CliRunner().invoke(program, ["plot", subject, "--from", str(run)], standalone_mode=False)
        assert done.return_value == 3
        assert re.search(message, done.stderr), done.stderr

    monkeypatch.chdir(tmp_path)
    assert json.loads(plotted("run", "--out", tmp_path / "named", "--json"))["instance"] == "own"
    refused("uny-lqr", "belongs to own .*, not to uny-lqr .*; `satsym lqr X")
    refused("clohessy_wiltshire", "belongs to own .*, not to clohessy_wiltshire .*; `satsym lqr X")
    case.write_text(case.read_text(encoding="utf-8") + "# changed\n", encoding="utf-8")
    refused(str(case), "was computed from own before its file was changed; `satsym lqr X")
    listing = run / "result.json"
    listing.write_text(
        listing.read_text(encoding="utf-8").replace('"instance": "own"', '"instance": 7'), encoding="utf-8"
    )
    refused(str(case), "cannot be read")
    assert not list(run.glob("*.png"))


@pytest.mark.study
def test_a_folder_names_what_its_result_is_of(folder: Path) -> None:
    drawn = json.loads(plotted(folder, "--out", folder.parent / "drawn", "--json"))
    assert drawn["instance"] == NAME
    assert [Path(name).parent for name in drawn["pictures"]] == [folder.parent / "drawn"] * len(drawn["pictures"])
    (folder / "result.json").write_text("{", encoding="utf-8")
    done = CliRunner().invoke(program, ["plot", str(folder)], standalone_mode=False)
    assert (done.return_value, done.stderr.count("\n")) == (3, 1)
    assert "result.json: cannot be read" in done.stderr


@pytest.mark.slow
def test_pictures_are_drawn_for_print_too(folder: Path) -> None:
    plotted(NAME, "--from", folder, "--format", "pdf")
    pictures = list(folder.glob("*.pdf"))
    assert "overview.pdf" in {path.name for path in pictures}
    assert all(path.read_bytes().startswith(b"%PDF") for path in pictures)


def damaged(folder: Path, **changes: Any) -> None:
    """The saved arrays with others in their places; ``None`` for none."""
    with np.load(folder / "trajectory.npz") as file:
        arrays = {name: file[name] for name in file.files} | changes
    np.savez(folder / "trajectory.npz", **{name: value for name, value in arrays.items() if value is not None})
    signed(folder)


@pytest.mark.parametrize(
    "changes",
    [
        {"times": None},
        {"status": None},
        {"history": None},
        {"status": np.array("happy")},
        {"x": np.zeros((3, 5))},
        {"u": np.zeros(7)},
        {"lam": np.array([["a"]])},
        {"switching": np.zeros((3, 3))},
        {"states": np.array(["r", "v", "theta", "theta_dot"])},
        {"times": np.array([None, 1.0], dtype=object)},
        {"times": np.zeros((2, 2))},
        {"times": np.full(1001, np.nan)},
        {"times": np.linspace(1.0, 0.0, 1001)},
        {"times": np.full(1001, 5e-324)},
        {"switching": np.full((2, 1), np.nan)},
        {"more": np.zeros(1)},
    ],
    ids=(
        "no times,no status,no history,unknown status,x,u,lam,switching,states,objects,times,nan,backwards,standing,"
        "nan switching,more"
    ).split(","),
)
def test_other_arrays_are_refused(solution: Solution, folder: Path, changes: dict[str, Any]) -> None:
    damaged(folder, **changes)
    with pytest.raises(BadInput, match=r"trajectory\.npz: .*; `satsym solve X --out .*` writes it again"):
        trajectory.read(solution.instance, folder)


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04", b"\x80\x04.", b"times, x, u", b"\x93NUMPY\x01\x00"])
def test_a_file_that_holds_no_arrays_is_refused(solution: Solution, folder: Path, content: bytes) -> None:
    (folder / "trajectory.npz").write_bytes(content)
    signed(folder)
    with pytest.raises(BadInput, match=r"trajectory\.npz: "):
        trajectory.read(solution.instance, folder)


def test_a_single_array_is_refused(solution: Solution, folder: Path) -> None:
    alone = io.BytesIO()
    np.save(alone, np.zeros(3))
    (folder / "trajectory.npz").write_bytes(alone.getvalue())
    signed(folder)
    with pytest.raises(BadInput, match=r"trajectory\.npz: "):
        trajectory.read(solution.instance, folder)


NO_RESULTS = ["", "{", "[]", '{"files": {}, "model": 3}', '{"files": {}, "command": "solve", "instance": null}']


@pytest.mark.parametrize("content", NO_RESULTS)
def test_a_result_that_is_none_is_refused(solution: Solution, folder: Path, content: str) -> None:
    (folder / "result.json").write_text(content, encoding="utf-8")
    with pytest.raises(BadInput, match=r"result\.json: cannot be read"):
        trajectory.read(solution.instance, folder)


def test_results_of_another_instance_are_refused(folder: Path) -> None:
    with pytest.raises(BadInput, match=f"belongs to {NAME} .*, not to its-thesis"):
        trajectory.read(instance.load("its-thesis"), folder)


def test_results_of_an_instance_that_was_changed_are_refused(solution: Solution, folder: Path) -> None:
    with np.load(folder / "trajectory.npz") as file:
        moved = file["x"] + 0.01
    damaged(folder, x=moved)
    with pytest.raises(BadInput, match="which has changed since"):
        trajectory.read(solution.instance, folder)


def test_nothing_there_is_said_so(solution: Solution, tmp_path: Path) -> None:
    with pytest.raises(BadInput, match=r"result\.json: cannot be opened \(No such file or directory\)"):
        trajectory.read(solution.instance, tmp_path / "nowhere")
