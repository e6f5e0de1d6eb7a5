"""What is installed: a wheel with every file at its place, that solves far from the checkout."""

from __future__ import annotations

import importlib.metadata
import importlib.resources
import json
import re
import shutil
import subprocess
import sys
import sysconfig
import tomllib
import venv
import zipfile
from pathlib import Path

import pytest

import satsym
from satsym.cli.requirements import Requirement

SOURCES = {"satsym": "satsym", "derivations": "satsym/derivations", "generated": "satsym/generated"}


def run(*command: str | Path, cwd: Path) -> str:
    done = subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
    assert done.returncode == 0, f"{command[-1]}: exit {done.returncode}\n{done.stdout}{done.stderr}"
    return done.stdout


@pytest.fixture(scope="module")
def wheel(repository: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Built from a copy, so that the checkout stays clean."""
    copy = tmp_path_factory.mktemp("copy")
    for name in SOURCES:
        shutil.copytree(repository / name, copy / name, ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("pyproject.toml", "LICENSE", "README.md"):
        shutil.copy(repository / name, copy)
    run(sys.executable, "-m", "pip", "wheel", ".", "--no-deps", "--no-build-isolation", "-w", "dist", cwd=copy)
    (path,) = (copy / "dist").glob("*.whl")
    return path


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of programs of an environment with the wheel, and the dependencies of this one.

    They come in by a path file. Path files that lie in there are not read, so the editable install of
    the checkout stays out of sight.
    """
    home = tmp_path_factory.mktemp("environment")
    venv.create(home, with_pip=False)
    place = {name: Path(sysconfig.get_path(name, "venv", {"base": str(home)})) for name in ("scripts", "purelib")}
    python = place["scripts"] / Path(sys.executable).name
    run(sys.executable, "-m", "pip", "--python", python, "install", "--no-deps", "--no-index", wheel, cwd=home)
    ours = dict.fromkeys((sysconfig.get_path("purelib"), sysconfig.get_path("platlib")))
    (place["purelib"] / "dependencies.pth").write_text("\n".join(ours) + "\n", encoding="utf-8")
    return place["scripts"]


def test_list_of_packages_names_every_folder_with_modules(repository: Path) -> None:
    named = tomllib.loads((repository / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["setuptools"]["packages"]
    found = {
        ".".join((Path(target) / path.parent.relative_to(repository / source)).parts)
        for source, target in SOURCES.items()
        for path in (repository / source).rglob("*.py")
    }
    assert sorted(named) == sorted(found)


@pytest.mark.slow
def test_wheel_has_every_source_and_data_file_and_nothing_else(wheel: Path, repository: Path) -> None:
    expected = {
        f"{target}/{path.relative_to(repository / source).as_posix()}"
        for source, target in SOURCES.items()
        for path in (repository / source).rglob("*")
        if path.is_file() and path.parent.name != "__pycache__"
    }
    with zipfile.ZipFile(wheel) as archive:
        packed = {name for name in archive.namelist() if ".dist-info/" not in name}
    assert packed == expected


@pytest.mark.slow
@pytest.mark.parametrize("program", [["satsym"], [f"python{sys.version_info.major}", "-m", "satsym"]], ids=" ".join)
def test_wheel_solves_from_an_empty_folder(installed: Path, tmp_path: Path, program: list[str]) -> None:
    answer = json.loads(run(installed / program[0], *program[1:], "solve", "its-thesis", "--json", cwd=tmp_path))
    assert answer["instance"] == "its-thesis"
    assert answer["status"] == "converged"
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_wheel_carries_kernels_and_their_typeset_derivations(installed: Path, tmp_path: Path) -> None:
    code = (
        "import importlib.resources, satsym.generated.polar_orbit as kernel, satsym.derivations\n"
        "print(kernel.__file__, importlib.resources.files('satsym.generated').joinpath('polar_orbit.tex').is_file())"
    )
    file, has_tex = run(installed / "python", "-c", code, cwd=tmp_path).split()
    assert Path(file).is_relative_to(installed.parent)
    assert has_tex == "True"


def test_checkout_is_imported_under_the_installed_names(repository: Path) -> None:
    for name in ("generated", "derivations"):
        module = importlib.import_module(f"satsym.{name}.polar_orbit")
        assert Path(module.__file__) == repository / name / "polar_orbit.py"
        assert importlib.resources.files(f"satsym.{name}").joinpath("__init__.py").is_file()


def test_version_is_the_installed_one() -> None:
    assert importlib.metadata.version("satsym") == satsym.__version__


def test_the_citation_names_this_version_and_the_changelog_dates_it(repository: Path) -> None:
    citation = (repository / "CITATION.cff").read_text(encoding="utf-8")
    stated = dict(re.findall(r"^([a-z-]+): (\S.*)$", citation, re.MULTILINE))
    assert stated["version"] == satsym.__version__
    heading = f"## {stated['version']} - {stated['date-released']}"
    assert heading in (repository / "CHANGELOG.md").read_text(encoding="utf-8").splitlines()


def test_the_version_of_sympy_that_generated_is_written_with_is_one_that_users_may_have(repository: Path) -> None:
    with (repository / "pyproject.toml").open("rb") as file:
        project = tomllib.load(file)["project"]
    (pin,) = project["optional-dependencies"]["derive"]
    (range_,) = (one for one in project["dependencies"] if one.startswith("sympy"))
    assert pin.startswith("sympy==")
    allowed = Requirement("sympy", range_.removeprefix("sympy"))
    assert allowed.allows(pin.removeprefix("sympy=="))
    assert not allowed.allows("1.13.2")
    assert not allowed.allows("1.15.0")
    assert "satsym[derive]" in project["optional-dependencies"]["dev"]
