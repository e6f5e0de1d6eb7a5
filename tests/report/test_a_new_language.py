"""The worked example of CONTRIBUTING: a language is one file, and nothing else knows of it."""

from __future__ import annotations

import json
import subprocess
import sys
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest

from satsym.report import texts
from satsym.report.latex.document import render
from satsym.report.texts import MissingText, languages, load
from satsym.symbolic import Derivation
from satsym.symbolic.lookup import library
from tests.support.contributing import example

DUTCH = tomllib.loads(example("A language", "toml"))
SHIPPED = Path(texts.__file__).parent


@pytest.fixture(scope="module")
def derivation() -> Derivation:
    return library.derivation("double_integrator_energy")


def written(tables: Mapping[str, Mapping[str, str]]) -> str:
    lines = [
        line
        for name, table in tables.items()
        for line in (f"[{name}]", *(f"{json.dumps(key)} = {json.dumps(text)}" for key, text in table.items()))
    ]
    return "\n".join(lines)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Where the texts are, with the file that CONTRIBUTING begins."""
    for path in SHIPPED.glob("*.toml"):
        (tmp_path / path.name).write_text(path.read_text("utf-8"), "utf-8")
    (tmp_path / "nl.toml").write_text(example("A language", "toml"), "utf-8")
    monkeypatch.setattr(texts, "_FOLDER", tmp_path)
    load.cache_clear()
    yield tmp_path
    load.cache_clear()


def finished(folder: Path) -> None:
    """English where nothing has been translated yet."""
    tables = load("en").with_own(DUTCH).tables
    (folder / "nl.toml").write_text(written(tables), "utf-8")
    load.cache_clear()


def test_a_file_is_a_language(folder: Path) -> None:
    assert languages() == ["en", "id", "nl"]
    assert load("nl").listed(["a", "b", "c"]) == "a, b en c"


def test_what_it_does_not_say_yet_is_named(folder: Path, derivation: Derivation) -> None:
    with pytest.raises(MissingText, match=r"nl\.toml: there is no text for \".+\" in \[\w+\]"):
        render(derivation, "nl")


def test_what_it_says_is_typeset(folder: Path, derivation: Derivation) -> None:
    finished(folder)
    document = render(derivation, "nl")
    for said in ("Vraagstelling", "De hamiltoniaan", "Stap"):
        assert said in document
        assert said not in render(derivation, "en")


@pytest.mark.slow
def test_the_command_line_lists_and_takes_it(folder: Path) -> None:
    finished(folder)

    def run(*arguments: str) -> str:
        code = f"import sys, pathlib\nfrom satsym.report import texts\nplace = pathlib.Path({str(folder)!r})\n"
        code += f"texts._FOLDER = place\nfrom satsym.cli import main\nsys.exit(main({list(arguments)!r}))"
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout

    assert "[en|id|nl]" in run("latex", "--help")
    assert "Vraagstelling" in run("latex", "double_integrator_energy", "--lang", "nl")
