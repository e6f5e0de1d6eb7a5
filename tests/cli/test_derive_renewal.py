"""`satsym derive` derives what has changed, and nothing else."""

from __future__ import annotations

import re
from collections.abc import Callable
from importlib import metadata
from pathlib import Path
from typing import Any

import pytest

from satsym import kernels
from satsym.cli import main, requirements
from satsym.report import artefacts, stamps
from satsym.status import BadInput

OTHER = """
from satsym.symbolic import FirstOrder, Variable, symbols_of
STATES = (Variable("place", "s", "m", "place on the road"),)
CONTROLS = (Variable("speed", "v", "m/s", "speed"),)
(place,), (speed,) = map(symbols_of, (STATES, CONTROLS))
walk = FirstOrder(name="walk", title="A walk", states=STATES, controls=CONTROLS, parameters=(), rates={place: speed})
PROBLEMS = (walk,)
"""
OWN = """
from dataclasses import replace
from pathlib import Path
from satsym.symbolic.loader import find, load
(walk,) = load(find("walking", Path(__file__).parent))
TITLES = Path(__file__).with_name("titles.txt").read_text(encoding="utf-8").split()
PROBLEMS = tuple(replace(walk, name=title, title=title) for title in TITLES)
"""


REALLY = artefacts._rendered
RENDERED: dict[tuple[Any, ...], dict[str, str]] = {}
"""The files that problems led to, by what the files beside the derivation file contain."""


def rendered(job: artefacts.Job) -> dict[str, str]:
    """What is derived, once from the same files: the tests are about when something is."""
    path, name, folder, seconds = job
    files = sorted(one for one in path.parent.iterdir() if one.suffix in (".py", ".txt"))
    stated = tuple((one.name, one.read_bytes()) for one in files)
    key = (path.name, name, folder.relative_to(path.parent), seconds, stated)
    if key not in RENDERED:
        RENDERED[key] = REALLY(job)
    return RENDERED[key]


@pytest.fixture
def derived(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Callable[..., list[str]]:
    """Names of the problems that a run of the command has derived."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.delenv("SATSYM_DEBUG", raising=False)
    (tmp_path / "walking.py").write_text(OTHER, encoding="utf-8")
    (tmp_path / "own.py").write_text(OWN, encoding="utf-8")
    (tmp_path / "titles.txt").write_text("strolling hiking", encoding="utf-8")
    names: list[str] = []
    monkeypatch.setattr(artefacts, "_rendered", lambda job: (names.append(job[1]), rendered(job))[1])

    def run(*options: str, code: int = 0) -> list[str]:
        names.clear()
        assert main(["derive", str(tmp_path / "own.py"), "--out", str(tmp_path / "made"), *options]) == code
        return list(names)

    assert run() == ["strolling", "hiking"]
    return run


def edit(path: Path, old: str, new: str) -> None:
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")


def test_unchanged_nothing_is_derived_unless_all_is_asked_for(derived: Callable[..., list[str]]) -> None:
    assert derived() == []
    assert derived("--fresh") == ["strolling", "hiking"]


def test_check_relies_on_nothing_that_was_kept(derived: Callable[..., list[str]], tmp_path: Path) -> None:
    assert derived("--check") == ["strolling", "hiking"]
    edit(tmp_path / "made" / "hiking.tex", "hiking", "riding")
    assert derived("--check", code=6) == ["strolling", "hiking"]


def test_what_was_edited_or_removed_is_written_anew(derived: Callable[..., list[str]], tmp_path: Path) -> None:
    made = {path: path.read_bytes() for path in (tmp_path / "made").iterdir()}
    edit(tmp_path / "made" / "hiking.tex", "hiking", "riding")
    assert derived() == ["hiking"]
    (tmp_path / "made" / "strolling.py").unlink()
    assert derived() == ["strolling"]
    assert {path: path.read_bytes() for path in (tmp_path / "made").iterdir()} == made


def test_of_several_problems_those_are_derived_that_state_something_else(
    derived: Callable[..., list[str]], tmp_path: Path
) -> None:
    edit(tmp_path / "own.py", "PROBLEMS", "# a remark\nPROBLEMS")
    assert derived() == []
    edit(tmp_path / "titles.txt", "hiking", "riding")
    assert derived() == ["riding"]
    edit(tmp_path / "own.py", "title=title", "title=title.upper() if title == 'riding' else title")
    assert derived() == ["riding"]
    assert "RIDING" in (tmp_path / "made" / "riding.tex").read_text(encoding="utf-8")
    assert derived() == []


def test_a_file_that_another_reaches_counts_too(derived: Callable[..., list[str]], tmp_path: Path) -> None:
    before = (tmp_path / "made" / "hiking.py").read_bytes()
    edit(tmp_path / "walking.py", "{place: speed}", "{place: 2 * speed}")
    assert derived() == ["strolling", "hiking"]
    assert (tmp_path / "made" / "hiking.py").read_bytes() != before


@pytest.mark.slow
def test_a_file_that_comes_first_in_the_search_counts_too(
    derived: Callable[..., list[str]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    edit(tmp_path / "own.py", 'find("walking", Path(__file__).parent)', 'find("two_body", Path(__file__).parent)')
    edit(tmp_path / "own.py", "(walk,)", "(walk, *_)")
    edit(tmp_path / "titles.txt", "strolling hiking", "orbit")
    assert derived() == ["orbit"]
    (tmp_path / "two_body.py").write_text(OTHER, encoding="utf-8")
    assert derived() == ["orbit"]
    assert "speed" in (tmp_path / "made" / "orbit.py").read_text(encoding="utf-8")


def test_what_holds_code_of_its_own_is_derived_with_every_change_of_its_file(
    derived: Callable[..., list[str]], tmp_path: Path
) -> None:
    own = "\nclass Walk(type(walk)):\n    pass\n\nPROBLEMS = (Walk(**{**vars(PROBLEMS[0]), 'name': 'strolling'}),)\n"
    edit(tmp_path / "own.py", "for title in TITLES)\n", f"for title in TITLES)\n{own}")
    assert derived() == ["strolling"]
    assert derived() == []
    edit(tmp_path / "own.py", "    pass", "    pass  # one")
    assert derived() == ["strolling"]


def test_an_engine_that_changed_derives_everything(
    derived: Callable[..., list[str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(stamps, "version", lambda name: "0")
    assert derived() == ["strolling", "hiking"]
    monkeypatch.setattr(stamps.source_files, "digest", lambda modules: "edited")
    assert derived() == ["strolling", "hiking"]
    assert derived() == []


@pytest.mark.slow
@pytest.mark.parametrize("content", [b"", b"{}", b"\xff\xfe", b'{"engine": 3}', b"[" * 100_000])
def test_a_damaged_stamp_is_none(derived: Callable[..., list[str]], tmp_path: Path, content: bytes) -> None:
    (kept,) = (tmp_path / "cache").rglob("own-*.json")
    kept.write_bytes(content)
    assert derived() == ["strolling", "hiking"]
    assert derived() == []


def test_where_nothing_can_be_kept_everything_is_derived(
    derived: Callable[..., list[str]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "a file").touch()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "a file"))
    assert derived() == derived() == ["strolling", "hiking"]


def test_what_is_checked_in_is_written_with_one_version_of_sympy_and_own_models_with_any(
    derived: Callable[..., list[str]], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (pinned,) = [one for one in requirements.requirements() if one.extra == "derive"]
    real = metadata.version
    monkeypatch.setattr(metadata, "version", lambda name: "1.13.3" if name == "sympy" else real(name))
    capsys.readouterr()
    for options in ([], ["--check"], ["--fresh"]):
        assert main(["derive", *options]) == 3
        error = capsys.readouterr().err
        assert error.count("\n") == 1
        assert "sympy 1.13.3" in error
        assert f"sympy{pinned.versions}" in error
    assert derived("--fresh") == ["strolling", "hiking"]


def refusal(folder: Path) -> str:
    """What an instance beside the model file is told of its model; empty where it can be used."""
    try:
        kernels.load("made/hiking", folder)
    except BadInput as error:
        return str(error)
    return ""


@pytest.mark.parametrize("file", ["own.py", "walking.py"])
def test_a_module_older_than_its_model_is_not_used(
    derived: Callable[..., list[str]], tmp_path: Path, file: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    text = (tmp_path / file).read_text(encoding="utf-8")
    assert not refusal(tmp_path)
    edit(tmp_path / file, "import", "import (")
    told = (
        f'"made/hiking": {file} has changed since this module was derived from it; run `satsym derive own.py --out '
        "made`"
    )
    assert refusal(tmp_path) == told
    derived(code=3)
    assert refusal(tmp_path) == told
    (tmp_path / file).write_bytes(text.replace("\n", "\r\n").encode())
    assert not refusal(tmp_path), "the ends of lines say nothing"
    (tmp_path / file).write_text(f"{text}# no more than a remark\n", encoding="utf-8")
    assert refusal(tmp_path) == told
    assert derived() == []
    assert not refusal(tmp_path)
    assert derived() == []
    derived("--check")
    (tmp_path / file).unlink()
    assert not refusal(tmp_path), "a module may travel alone"


def test_a_module_that_users_save_from_python_knows_its_model_too(
    derived: Callable[..., list[str]], tmp_path: Path
) -> None:
    import satsym

    made = (tmp_path / "made" / "hiking.py").read_text(encoding="utf-8")
    found = satsym.derive(f"{tmp_path / 'own.py'}:hiking")
    found.save(tmp_path / "made")
    assert (tmp_path / "made" / "hiking.py").read_text(encoding="utf-8") == made
    edit(tmp_path / "own.py", "PROBLEMS", "ALL = PROBLEMS")
    found.save(tmp_path / "made")
    assert "has changed" in refusal(tmp_path)


def test_every_shipped_module_names_its_model() -> None:
    for name in kernels.shipped():
        text = (Path(__file__).parents[2] / "generated" / f"{name}.py").read_text(encoding="utf-8")
        (source, *_) = re.findall(r"^Source: \.\./(\S+) \w{32}$", text, re.MULTILINE)
        assert f"satsym derive {source}\n" in text
