"""The page on the architecture says what the contracts on imports say."""

from __future__ import annotations

import re
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from types import ModuleType

import pytest


@pytest.fixture(scope="module")
def floors(repository: Path) -> ModuleType:
    spec = spec_from_file_location("floors", repository / "docs" / "_ext" / "floors.py")
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_picture_is_made_from_the_contracts(floors: ModuleType, repository: Path) -> None:
    shown = floors.PICTURE.read_text("utf-8")
    assert shown == floors.picture(repository), "run: python docs/_ext/floors.py"
    names = [name for rooms in floors.floors(repository) for name in rooms]
    assert {"front", "solvers", "kernels", "spec"} <= set(names)
    titles = " ".join(re.findall(r'class="name"[^>]*>([^<]*)<', shown))
    assert re.findall(r"\w+", titles) == [*names, "codegen", "symbolic"]


def test_every_room_of_satsym_is_in_the_picture(floors: ModuleType, repository: Path) -> None:
    rooms = {path.name.removesuffix(".py") for path in (repository / "satsym").iterdir() if path.suffix in ("", ".py")}
    shown = {name for names in floors.floors(repository) for name in names} | {"codegen", "symbolic"}
    assert rooms - shown <= {"__init__", "__main__", "__pycache__", "instances", "templates"}
    assert shown <= rooms


def test_what_the_page_names_is_there(repository: Path) -> None:
    text = (repository / "docs" / "architecture.md").read_text("utf-8")
    places = re.findall(r"`((?:satsym|tests|derivations|generated|docs)/[\w./]*)`", text)
    assert len(places) > 20
    there = [one for one in places if not re.search(r"KEY|XX|NAME", one)]
    assert [one for one in there if not (repository / one).exists()] == []


@pytest.mark.parametrize(("name", "most"), [("CONTRIBUTING.md", 150), ("CHANGELOG.md", 200)])
def test_what_people_read_first_is_short(name: str, most: int, repository: Path) -> None:
    assert len((repository / name).read_text("utf-8").splitlines()) <= most
