"""What is computed again after an edit: the modules that a module is made of, found without importing them."""

from __future__ import annotations

import ast
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from satsym import source_files

JUDGING = ("satsym.auditing.run", "satsym.auditing.judged")
WRITING = ("satsym.report.artefacts",)


def by_the_parser(text: str) -> set[str]:
    found: set[str] = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            found |= {str(node.module), *(f"{node.module}.{alias.name}" for alias in node.names)}
    return found


def test_no_import_of_satsym_is_overlooked(repository: Path) -> None:
    files = sorted((repository / "satsym").rglob("*.py"))
    assert len(files) > 200
    for path in files:
        text = path.read_text(encoding="utf-8")
        assert by_the_parser(text) <= source_files.imports(text), path


def test_imports_are_read_however_they_are_written() -> None:
    text = (
        "from a.b import (  # one (1)\n    c,  # two\n    d as e,\n)\nif x:\n    import f.g as h, i\nfrom . import j\n"
    )
    assert {"a.b.c", "a.b.d", "f.g", "i", "satsym.k.j"} <= source_files.imports(text, "satsym.k.l")
    assert source_files.imports("from ..m import n", "satsym.k.l") == {"satsym.m", "satsym.m.n"}


@pytest.mark.parametrize(
    ("modules", "code"),
    [
        (
            JUDGING,
            "from satsym import auditing; auditing.audit(auditing.read(auditing.locate('lapan_pitch')), ['abstract'])",
        ),
        (
            WRITING,
            "import pathlib; from satsym.report import artefacts; from satsym.symbolic import loader\n"
            "stated = loader.find('small_systems').read_text().partition('PROBLEMS = ')[0]\n"
            "path = pathlib.Path('one.py'); path.write_text(f'{stated}PROBLEMS = (van_der_pol,)\\n')\n"
            "artefacts.render([path], path.parent)",
        ),
    ],
    ids=["judging", "writing"],
)
@pytest.mark.slow
def test_what_really_runs_is_among_what_is_read(modules: tuple[str, ...], code: str, tmp_path: Path) -> None:
    show = "import sys; print(*(m.__file__ for n, m in sys.modules.items() if n.startswith('satsym.') and m.__file__))"
    done = subprocess.run(
        [sys.executable, "-c", f"{code}\n{show}"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    home = Path(source_files.__file__).parent
    loaded = {Path(name) for name in done.stdout.split() if Path(name).is_relative_to(home)}
    assert len(loaded) > 50
    assert loaded <= {*source_files.reached(modules), home / "__init__.py", home / "version.py"}


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    home = tmp_path_factory.mktemp("copy") / "satsym"
    shutil.copytree(Path(source_files.__file__).parent, home, ignore=shutil.ignore_patterns("__pycache__"))
    return home


@pytest.fixture
def edited(copy: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[str, tuple[str, ...]], bool]]:
    """Whether an edit of some file in a folder of satsym changes the digest of some modules."""
    monkeypatch.setattr(source_files, "_HOME", copy)
    forget()

    def differs(place: str, modules: tuple[str, ...]) -> bool:
        path = copy / place
        if path.is_dir():
            path = next(each for each in sorted(path.rglob("*.py")) if each.stem != "__init__")
        before, text = source_files.digest(modules), path.read_text(encoding="utf-8")
        path.write_text(f"{text}\n# edited\n", encoding="utf-8")
        forget()
        after = source_files.digest(modules)
        path.write_text(text, encoding="utf-8")
        return before != after

    yield differs
    forget()


def forget() -> None:
    for each in (source_files.reached, source_files._modules, source_files._data):
        each.cache_clear()


@pytest.mark.parametrize(
    "place", ["symbolic", "auditing/measurements", "solvers", "kernels", "formula", "analysis/linear", "auditing/judge"]
)
def test_an_edit_of_what_judges_makes_verdicts_stale(
    edited: Callable[[str, tuple[str, ...]], bool], place: str
) -> None:
    assert edited(place, JUDGING)


@pytest.mark.parametrize("place", ["report/plots", "report/terminal", "report/latex", "cli", "__main__.py"])
def test_an_edit_of_what_shows_leaves_verdicts_as_they_are(
    edited: Callable[[str, tuple[str, ...]], bool], place: str
) -> None:
    assert not edited(place, JUDGING)


@pytest.mark.parametrize(
    "place", ["symbolic", "codegen", "report/latex/document.py", "report/texts/en.toml", "kernels/contract.py"]
)
def test_an_edit_of_what_derives_makes_what_is_written_stale(
    edited: Callable[[str, tuple[str, ...]], bool], place: str
) -> None:
    assert edited(place, WRITING)


@pytest.mark.parametrize("place", ["report/plots", "solvers", "cli", "auditing/measurements"])
def test_an_edit_of_what_solves_leaves_what_is_written_as_it_is(
    edited: Callable[[str, tuple[str, ...]], bool], place: str
) -> None:
    assert not edited(place, WRITING)
