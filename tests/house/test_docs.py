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

import satsym
from satsym import cli

DOCS = Path(__file__).parents[2] / "docs"
READMES = [DOCS.parent / "README.md", DOCS.parent / "README.id.md"]
SINGLE = ("index", "start", "howto", "asked", "models_without_cost", "conditions", "models", "proved", "studies")
PAGES = [*(DOCS / f"{name}.md" for name in SINGLE), *sorted((DOCS / "tutorials").glob("*.md"))]
ELLIPSIS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


TIMED = re.compile(r"(?<=\s)[\d.]+\s+m?s(?=\))")
"""What differs from run to run: how long solving took."""
ROUNDING = re.compile(r"(?<![\d.])\d(?:\.\d+)?e-[1-9]\d\b|(?<= )(?:0|\d(?:\.\d+)?e-\d\d)(?= +1e-0\d$)", re.MULTILINE)
"""What differs from machine to machine: residuals at the level of rounding."""
COUNTED = re.compile(
    r"\d+(?= (?:iterations?|iterasi),\s)|(?<=none of )\d+(?= competing)|(?<=dari )\d+(?= penyelesaian)"
    r"|(?<=seeded starts)(?: +\d+){2}(?= )"
)
"""How many iterations Newton's method needed, and how many starts led to an extremal: rounding may decide about the
last iteration, and about starts that are hardly solved."""


def settled(text: str) -> str:
    """The text without what differs from run to run and from machine to machine."""
    return COUNTED.sub("N", ROUNDING.sub("R", TIMED.sub("T", text)))


def sessions(text: str) -> Iterator[tuple[str, str]]:
    """Each command of the shell, with what it is said to print."""
    for block in re.findall(r"```(?:console)?\n(\$ .*?)```", text, re.DOTALL):
        yield from re.findall(r"^\$ (.*)\n((?:(?!\$ ).*\n)*)", block, re.MULTILINE)


def files(text: str) -> Iterator[tuple[str, str]]:
    """Each file that is shown whole, by the name that its first line or the line before it says."""
    yield from re.findall(r"`(\w+\.py)`[^\n]*:\n\n```python\n(.*?)```", text, re.DOTALL)
    yield from re.findall(r"```(?:toml|python)\n# (\w+\.(?:toml|py))\n(.*?)```", text, re.DOTALL)
    for name, content in re.findall(r"```latex\n% (\w+\.tex)\n(.*?)```", text, re.DOTALL):
        yield name, f"% {name}\n{content}"


@pytest.mark.slow
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_commands_print_what_the_page_says(
    page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")  # as the pages have it
    text = page.read_text(encoding="utf-8")
    for name, content in files(text):
        Path(name).write_text(content, encoding="utf-8")
    for command, printed in sessions(text):
        program, *arguments = shlex.split(command)
        assert program == "satsym"
        assert cli.main(arguments) == 0, command
        told = settled(capsys.readouterr().out)
        assert doctest.OutputChecker().check_output(settled(printed), told, ELLIPSIS), f"{command}\n{told}"


@pytest.mark.parametrize("page", [DOCS / "start.md", *sorted((DOCS / "tutorials").glob("*.md"))], ids=lambda p: p.stem)
def test_tutorials_leave_nothing_out_of_what_is_printed(page: Path) -> None:
    assert "\n...\n" not in page.read_text(encoding="utf-8")


@pytest.mark.slow
@pytest.mark.parametrize("page", READMES, ids=lambda page: page.name)
def test_commands_print_what_the_readme_says_but_for_times(
    page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "130")  # as wide as the longest line that is shown
    shown = list(sessions(page.read_text(encoding="utf-8")))
    assert shown
    for command, printed in shown:
        assert "\n  ...\n" in printed, "what is left out is marked"
        assert cli.main(shlex.split(command)[1:]) == 0
        told = settled(capsys.readouterr().out)
        wanted = f"{settled(printed)}...\n"
        assert doctest.OutputChecker().check_output(wanted, told, ELLIPSIS), f"{command}\n{told}"


@pytest.mark.slow
@pytest.mark.parametrize("page", READMES, ids=lambda page: page.name)
def test_what_the_readme_shows_of_python_runs_and_answers_what_its_comments_say(
    page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    known: dict[str, Any] = {}
    for block in re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL):
        for one in ast.parse(block).body:
            said = re.search(r"# (.*)$", block.splitlines()[one.lineno - 1])
            if not isinstance(one, ast.Expr):
                exec(compile(ast.Module([one], []), "README.md", "exec"), known)  # noqa: S102
                continue
            value = eval(compile(ast.Expression(one.value), "README.md", "eval"), known)  # noqa: S307
            if said and ";" in said[1]:
                verdict, times = value
                text = f"{verdict.value}; ({', '.join(f'{t:.4f}' for t in times)})"
                assert text == said[1]
            elif said and "=" in said[1]:
                assert f"{value.lhs} = {value.rhs}" == said[1]
    assert (known["solution"].certificate.verdict.value, known["answer"].status.value) == ("certified", "converged")


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
    solution, verdict, picture, _, equation, costlier = shown
    assert picture.axes
    assert "<table>" in solution._repr_html_()
    assert verdict == ("certified", pytest.approx(0.0031946551089, rel=1e-10))  # of CasADi with Ipopt
    assert equation._repr_latex_().startswith("$")
    assert costlier


def test_the_reference_of_python_has_a_place_for_every_public_name() -> None:
    text = (DOCS / "_ext" / "reference.py").read_text("utf-8")
    groups = ast.literal_eval(re.search(r"^GROUPS = (\{.*?^\})", text, re.MULTILINE | re.DOTALL)[1])
    assert set(satsym.__all__) <= set(" ".join(groups.values()).split())


def test_all_notebooks_are_pages() -> None:
    stated = re.search(r"^NOTEBOOKS = (.*)$", (DOCS / "_ext" / "notebooks.py").read_text("utf-8"), re.MULTILINE)
    assert set(ast.literal_eval(stated[1])) == {path.stem for path in DOCS.glob("*.ipynb")}


@pytest.mark.slow
@pytest.mark.parametrize("name", ["class", "system", "study"])
def test_the_other_notebooks_run_and_every_cell_ends_with_something(name: str) -> None:
    cells = json.loads((DOCS / f"notebook_{name}.ipynb").read_text(encoding="utf-8"))["cells"]
    known: dict[str, Any] = {}
    for source in ("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"):
        *before, last = ast.parse(source).body
        assert isinstance(last, ast.Expr)
        exec(compile(ast.Module(before, []), "notebook", "exec"), known)  # noqa: S102
        assert eval(compile(ast.Expression(last.value), "notebook", "eval"), known) is not None  # noqa: S307
    if name == "class":
        assert known["answer"].verdict == "wrong"
    if name == "system":
        assert known["solution"].certificate.verdict.value == "certified"
        assert "1/[time]" in known["refusal"]
    if name == "study":
        cheapest = min(zip(known["found"]["objective"], known["found"]["initial.r"], strict=True))[1]
        assert 1.04 < float(cheapest) < 0.9 ** (-2 / 3)


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
    written = {"gallery", *(path.stem for path in DOCS.glob("*.ipynb")), "reference/commands", "reference/python"}
    by_hand = {name for name in there if not name.startswith(("_", "gallery/"))} - {"index"}
    assert set(listed) == by_hand | written
