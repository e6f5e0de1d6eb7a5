"""Files to start from run as they are, and nothing is written over."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from satsym.cli import main
from satsym.instance import load, shipped
from satsym.instance.files import SHIPPED

Run = Callable[..., tuple[int, str, str]]


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Run:
    monkeypatch.chdir(tmp_path)

    def run(*arguments: str) -> tuple[int, str, str]:
        code = main(list(arguments))
        return code, *capsys.readouterr()

    return run


@pytest.mark.slow
def test_the_commands_that_new_names_run_as_they_stand(run: Run, tmp_path: Path):
    code, out, _ = run("new", "my_model")
    assert code == 0
    commands = [line.split() for line in out.partition("Next:\n")[2].splitlines()]
    derive, solve, test = commands
    assert run(*derive[1:])[0] == 0
    code, out, _ = run(*solve[1:])
    assert code == 0
    assert "certificate: certified" in out
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    ended = subprocess.run([sys.executable, *test[1:], "-q"], cwd=tmp_path, env=environment, capture_output=True)
    assert ended.returncode == 0, ended.stdout.decode()


@pytest.mark.slow
def test_the_test_of_a_new_model_notices_another_model(run: Run, tmp_path: Path):
    run("new", "my_model")
    model = tmp_path / "my_model" / "my_model.py"
    text = model.read_text(encoding="utf-8")
    model.write_text(text.replace("-gravity / length * sin(theta)", "-gravity / length * theta"), encoding="utf-8")
    assert text != model.read_text(encoding="utf-8")
    assert run("derive", "my_model/my_model.py", "--out", "my_model/generated")[0] == 0
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    ended = subprocess.run([sys.executable, "-m", "pytest", "-q", "my_model"], cwd=tmp_path, env=environment)
    assert ended.returncode == 1


@pytest.mark.parametrize("original", shipped())
def test_a_copied_instance_is_the_shipped_one(run: Run, tmp_path: Path, original: str):
    code, out, _ = run("new", "my-case", "--instance", original)
    assert code == 0
    command = "solve" if load(original).model.spec.has_cost else "analyse"
    assert out.endswith(f"  satsym {command} my-case.toml --plot\n")
    assert (tmp_path / "my-case.toml").read_bytes() == (SHIPPED / f"{original}.toml").read_bytes()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["two words"], 'NAME: got "two words"; use lower-case letters'),
        (["class"], "NAME: class is a Python keyword; choose another name, such as my_class"),
        (["random"], "NAME: random.py would hide a module that Python imports"),
        (["polar_orbit"], "NAME: polar_orbit is a model that comes with satsym"),
        (["a/b", "--instance", "soft-return"], 'NAME: got "a/b"; use letters'),
        (["mine", "--instance", "soft-retur"], 'no instance of this name; did you mean "soft-return"?'),
        (["mine", "--instance", "x/y.toml"], '--instance: "x/y.toml" is a path; give the name of a shipped instance'),
    ],
)
def test_names_that_will_not_do_are_refused(run: Run, tmp_path: Path, arguments: list[str], message: str):
    code, _, complaint = run("new", *arguments)
    assert code == 3
    assert message in complaint
    assert complaint.count("\n") == 1
    assert not any(tmp_path.iterdir())


def test_what_exists_is_kept(run: Run, tmp_path: Path):
    mine = tmp_path / "my_model" / "my_model.toml"
    mine.parent.mkdir()
    mine.write_text("mine", encoding="utf-8")
    code, _, complaint = run("new", "my_model")
    assert code == 3
    assert "my_model.toml: already exists" in complaint
    assert [path.name for path in mine.parent.iterdir()] == ["my_model.toml"]
    assert mine.read_text(encoding="utf-8") == "mine"
