"""Saved results examined again from their files alone: what holds is said to hold, and every altered number is seen."""

from __future__ import annotations

import copy
import json
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from satsym import instance
from satsym.cli import main
from satsym.cli.saving import save, trajectory_files
from satsym.instance import Instance
from satsym.report.results import problem
from satsym.report.results.examination import NOT_COMPARED, examine
from satsym.report.results.objects import solution_object
from satsym.status import BadInput, Verdict
from tests.support.models import build, q, scalar, w
from tests.support.solved import solve

NAMES = ("soft-return", "return-to-orbit-005", "double-integrator-time", "bryson-denham")
"""Smooth, with bounds that are met, with a switch, and with a boundary arc."""


def saved(case: Instance, folder: Path) -> Path:
    found = solve(case)
    save(folder, solution_object(found), trajectory_files(folder, found, look=None))
    return folder


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    home = tmp_path_factory.mktemp("saved")
    return {name: saved(instance.load(name), home / name) for name in NAMES}


def leaves(value: Any, keys: tuple[Any, ...] = ()) -> Iterator[tuple[tuple[Any, ...], Any]]:
    """Numbers and texts of an object, with the keys that lead to them."""
    pairs = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else None
    if pairs is None:
        yield keys, value
    for key, one in pairs or ():
        yield from leaves(one, (*keys, key))


def altered(value: Any, keys: tuple[Any, ...]) -> Any:
    if isinstance(value, str):
        return f"{value}x"
    return value + 1e-3 if keys[0] == "events" else value * (1.0 + 1e-5) or 1e-6


def judged(folder: Path) -> str:
    """What becomes of a result whose competitors are left out."""
    try:
        found = examine(problem.read(folder), folder, compared=False)
    except BadInput:
        return "unusable"
    if found.differences:
        return "differs"
    assert found.certificate is not None
    return found.certificate.verdict.value


@pytest.mark.parametrize("name", NAMES)
def test_a_saved_result_holds(name: str, folders: dict[str, Path]):
    found = examine(problem.read(folders[name]), folders[name], compared=False)
    assert found.differences == ()
    assert found.stated is Verdict.CERTIFIED
    assert found.certificate is not None
    assert found.certificate.verdict in (Verdict.LOCAL_MINIMUM, Verdict.CERTIFIED)


@pytest.mark.parametrize("name", NAMES)
def test_every_altered_number_is_seen(name: str, folders: dict[str, Path], tmp_path: Path):
    folder = tmp_path / "altered"
    shutil.copytree(folders[name], folder)
    result = json.loads((folder / "result.json").read_text())
    left_out = NOT_COMPARED | {"schema", "units", "files", "command"}
    numbers = [(keys, one) for keys, one in leaves(result) if keys[0] not in left_out and one is not None]
    assert len(numbers) > 10
    for keys, one in numbers:
        other = copy.deepcopy(result)
        place = other
        for key in keys[:-1]:
            place = place[key]
        place[keys[-1]] = altered(one, keys)
        (folder / "result.json").write_text(json.dumps(other))
        assert judged(folder) in ("failed", "differs", "unusable"), keys


def test_an_event_that_is_left_out_is_missed(folders: dict[str, Path], tmp_path: Path):
    folder = tmp_path / "altered"
    shutil.copytree(folders["bryson-denham"], folder)
    result = json.loads((folder / "result.json").read_text())
    del result["events"][0]
    (folder / "result.json").write_text(json.dumps(result))
    assert judged(folder) == "failed"


def test_a_result_of_ones_own_model_needs_nothing_else(tmp_path: Path):
    """The generated module is saved as well, so that the folder can be moved to another machine."""
    home = tmp_path / "home"
    home.mkdir()
    case = build(home, scalar("drift", -q + w, w**2 / 2, q**2, "free"), "[initial]\nq = 1.0\n[time]\ntf = 1.0\n")
    folder = saved(case, home / "result")
    elsewhere = tmp_path / "elsewhere"
    shutil.move(folder, elsewhere)
    shutil.rmtree(home)
    assert {path.name for path in elsewhere.iterdir()} >= {"instance.toml", "drift.py"}
    assert judged(elsewhere) in ("local minimum", "certified")


def test_a_module_that_was_tampered_with_is_not_executed(tmp_path: Path):
    case = build(tmp_path, scalar("drift", -q + w, w**2 / 2, q**2, "free"), "[initial]\nq = 1.0\n[time]\ntf = 1.0\n")
    folder = saved(case, tmp_path / "result")
    mark = tmp_path / "executed"
    module = (folder / "drift.py").read_text() + f"\nopen({str(mark)!r}, 'w')\n"
    result = json.loads((folder / "result.json").read_text())
    (folder / "drift.py").write_text(module)
    with pytest.raises(BadInput, match="missing or has changed"):
        problem.read(folder)
    from satsym.report.results.set_list import listed_as

    listed = listed_as(folder / "drift.py")
    result["files"]["drift.py"] = {"bytes": listed.bytes, "sha256": listed.sha256}
    (folder / "result.json").write_text(json.dumps(result))
    with pytest.raises(BadInput):
        problem.read(folder)
    assert not mark.exists()


def test_the_command_says_what_holds(folders: dict[str, Path], capsys: pytest.CaptureFixture[str]):
    assert main(["certify", str(folders["bryson-denham"]), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["command"], found["stated"], found["differences"]) == ("certify", "certified", [])
    assert (found["certificate"]["verdict"], found["certificate"]["scope"]) == ("certified", "global")
    assert main(["certify", str(folders["bryson-denham"])]) == 0
    assert "result.json agrees with the other files" in capsys.readouterr().out


def test_a_cost_that_the_trajectory_contradicts_is_named(
    folders: dict[str, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "altered"
    shutil.copytree(folders["bryson-denham"], folder)
    result = json.loads((folder / "result.json").read_text())
    result["objective"] *= 2.0
    (folder / "result.json").write_text(json.dumps(result))
    assert main(["certify", str(folder)]) == 5
    shown = capsys.readouterr().out
    assert "the trajectory contradicts these numbers in result.json: cost" in " ".join(shown.split())
    assert "agrees" not in shown


def test_the_command_says_what_differs(folders: dict[str, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    folder = tmp_path / "altered"
    shutil.copytree(folders["bryson-denham"], folder)
    text = (folder / "result.json").read_text()
    result = json.loads(text)
    result["x_final"]["x"] += 0.5
    (folder / "result.json").write_text(json.dumps(result))
    assert main(["certify", str(folder)]) == 5
    out = capsys.readouterr().out
    assert "one number in result.json does not agree" in out
    assert "x_final.x" in out


@pytest.mark.parametrize("kind", ["nothing", "a file", "truncated", "without problem", "no solution"])
def test_what_cannot_be_examined_gets_one_line(
    kind: str, folders: dict[str, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    folder = tmp_path / "one"
    shutil.copytree(folders["bryson-denham"], folder)
    code = 3
    if kind == "nothing":
        shutil.rmtree(folder)
    elif kind == "a file":
        folder = folder / "trajectory.csv"
    elif kind == "truncated":
        (folder / "trajectory.npz").write_bytes((folder / "trajectory.npz").read_bytes()[:500])
    elif kind == "without problem":
        result = json.loads((folder / "result.json").read_text())
        del result["files"]["instance.toml"]
        (folder / "result.json").write_text(json.dumps(result))
    else:
        text = (folder / "instance.toml").read_text().replace("tf = 1.0", "tf = 1.0").encode()
        own = tmp_path / "late.toml"
        own.write_bytes(text + b"\n[solver]\nmax_seconds = 1e-6\n")
        shutil.rmtree(folder)
        saved(instance.load(own), folder)
        code = 4
    capsys.readouterr()
    assert main(["certify", str(folder)]) == code
    found = capsys.readouterr()
    assert found.err.startswith("satsym: ")
    assert found.err.count("\n") == 1
