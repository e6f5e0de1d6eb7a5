"""The page on models names every field there is, and what it shows runs."""

from __future__ import annotations

import re
from dataclasses import fields
from pathlib import Path

import pytest

from satsym.symbolic import FirstOrder, Model, Newton, Problem, Variable, loader
from satsym.symbolic.model import Particle

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "models.md").read_text(encoding="utf-8")
SECTIONS = {
    "`Variable`": (Variable, None),
    "All models": (Model, None),
    "`FirstOrder`": (FirstOrder, Model),
    "`Newton`": (Newton, Model),
    "`Problem`": (Problem, None),
}


@pytest.mark.parametrize("title", SECTIONS)
def test_every_field_has_its_line_and_no_other(title: str) -> None:
    stated, known = SECTIONS[title]
    table = PAGE.partition(f"## {title}\n")[2].partition("\n## ")[0]
    lines = re.findall(r"^\| (`[^|]*) \|", table, re.MULTILINE)
    named = [name for line in lines for name in re.findall(r"`(\w+)`", line)]
    inherited = {f.name for f in fields(known)} if known else set()
    assert sorted(named) == sorted({f.name for f in fields(stated)} - inherited)


def test_the_particle_has_no_fields_but_those_of_newton() -> None:
    assert {f.name for f in fields(Particle)} < {f.name for f in fields(Newton)}


def test_the_example_is_derived_solved_and_certified(tmp_path: Path) -> None:
    (example,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    file = tmp_path / "ascent.py"
    file.write_text(example, encoding="utf-8")
    (problem,) = loader.load(file)
    import satsym

    assert isinstance(problem, Problem)
    climb = satsym.Instance.of(problem, initial={"h": 85.0, "v": 0.1}, final={"h": 110.0, "v": 0.2}, tf="2 min")
    assert satsym.solve(climb).certificate.verdict == "certified"


def test_refusals_are_quoted_as_they_are_given() -> None:
    files = [path for room in ("symbolic", "codegen") for path in (ROOT / "satsym" / room).rglob("*.py")]
    source = "".join(path.read_text(encoding="utf-8") for path in files)
    text = re.sub(r'"\s*\n\s*f?"', "", source)
    quoted = re.findall(r"^\| ([^|`]+?) \|", PAGE.partition("## When it is refused")[2], re.MULTILINE)[1:]
    quoted = [line for line in quoted if line != "---"]
    assert quoted
    for message in quoted:
        for part in message.split("..."):
            assert part.strip(" ,;") in text, part
