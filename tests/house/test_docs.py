"""What the documentation shows runs, and prints what it says."""

from __future__ import annotations

import ast
import doctest
import json
import re
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from satsym import cli

DOCS = Path(__file__).parents[2] / "docs"
PAGES = [DOCS / "start.md", DOCS / "howto.md", *sorted((DOCS / "tutorials").glob("*.md"))]
ELLIPSIS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


def sessions(text: str) -> Iterator[tuple[str, str]]:
    """Each command of the shell, with what it is said to print."""
    for block in re.findall(r"```console\n(.*?)```", text, re.DOTALL):
        yield from re.findall(r"^\$ (.*)\n((?:(?!\$ ).*\n)*)", block, re.MULTILINE)


def files(text: str) -> Iterator[tuple[str, str]]:
    """Each file that is shown whole, by the name that its first line says."""
    yield from re.findall(r"```toml\n# (\w+\.toml)\n(.*?)```", text, re.DOTALL)


@pytest.mark.slow
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_commands_print_what_the_page_says(
    page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    text = page.read_text(encoding="utf-8")
    for name, content in files(text):
        Path(name).write_text(content, encoding="utf-8")
    for command, printed in sessions(text):
        program, *arguments = shlex.split(command)
        assert program == "satsym"
        assert cli.main(arguments) == 0, command
        told = capsys.readouterr().out
        assert doctest.OutputChecker().check_output(printed, told, ELLIPSIS), f"{command}\n{told}"


@pytest.mark.slow
@pytest.mark.parametrize("page", [p for p in PAGES if ">>>" in p.read_text(encoding="utf-8")], ids=lambda p: p.stem)
def test_python_answers_what_the_page_says(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    text = page.read_text(encoding="utf-8")
    failed, tried = doctest.testfile(str(page), module_relative=False, optionflags=ELLIPSIS, encoding="utf-8")
    assert tried == text.count(">>> ")
    assert failed == 0


@pytest.mark.slow
def test_the_notebook_runs_from_top_to_bottom_and_shows_what_each_cell_ends_with() -> None:
    cells = json.loads((DOCS / "notebook.ipynb").read_text(encoding="utf-8"))["cells"]
    known: dict[str, Any] = {}
    shown = []
    for source in ("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"):
        *before, last = ast.parse(source).body
        assert isinstance(last, ast.Expr)
        exec(compile(ast.Module(before, []), "notebook", "exec"), known)  # noqa: S102
        shown.append(eval(compile(ast.Expression(last.value), "notebook", "eval"), known))  # noqa: S307
    solution, verdict, _, equation, costlier = shown
    assert "<table>" in solution._repr_html_()
    assert verdict == ("certified", pytest.approx(0.0031946551089, rel=1e-10))  # of CasADi with Ipopt
    assert equation._repr_latex_().startswith("$")
    assert costlier


def test_the_readmes_show_the_same_commands() -> None:
    english, indonesian = ((DOCS.parent / name).read_text(encoding="utf-8") for name in ("README.md", "README.id.md"))
    blocks = ("".join(re.findall(r"```sh\n(.*?)```", text, re.DOTALL)) for text in (indonesian, english))
    shown, there = (re.findall(r"^((?:make|satsym) [^#\n]*?) *(?:#.*)?$", block, re.MULTILINE) for block in blocks)
    assert len(shown) > 20
    assert shown == there
    text = re.sub(r"```.*?```", "", indonesian, flags=re.DOTALL)
    assert all((DOCS.parent / link).exists() for link in re.findall(r"\]\(([^)#:]+)\)", text))


def test_every_page_is_in_the_table_of_contents() -> None:
    listed = re.findall(r"^(?!:)([\w./]+)$", (DOCS / "index.md").read_text(encoding="utf-8"), re.MULTILINE)
    there = [path.relative_to(DOCS).with_suffix("").as_posix() for path in DOCS.rglob("*.md")]
    written = {"gallery", "reference/commands", "reference/python"}
    assert set(listed) == {name for name in there if not name.startswith("_")} - {"index"} | written
