"""The page on models names every field there is, and what it shows runs."""

from __future__ import annotations

import re
from dataclasses import fields, is_dataclass
from pathlib import Path

import pytest

from satsym import symbolic
from satsym.symbolic import FirstOrder, Model, Newton, Problem, Variable, derive, loader
from satsym.symbolic.model import Particle
from satsym.symbolic.principle import set_laws
from tests.support.reserved import reserved

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "models.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
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
    file = tmp_path / "ascent.py"
    file.write_text(EXAMPLES[0], encoding="utf-8")
    (problem,) = loader.load(file)
    import satsym

    assert isinstance(problem, Problem)
    climb = satsym.Instance.of(problem, initial={"h": 85.0, "v": 0.1}, final={"h": 110.0, "v": 0.2}, tf="2 min")
    assert satsym.solve(climb).certificate.verdict == "certified"


def test_the_throttled_vector_is_derived(tmp_path: Path) -> None:
    file = tmp_path / "landing.py"
    file.write_text(EXAMPLES[2], encoding="utf-8")
    (problem,) = loader.load(file)
    assert set_laws.throttled(derive(problem))


def test_what_is_to_be_imported_is_there() -> None:
    lines = re.findall(r"^from satsym.symbolic import ([^#\n]*)", EXAMPLES[1], re.MULTILINE)
    imported = {name for line in lines for name in re.findall(r"\w+", line)}
    assert imported <= set(symbolic.__all__)
    classes = {name for name in symbolic.__all__ if is_dataclass(vars(symbolic)[name])}
    of_steps = {"Check", "Conclusion", "Derivation", "Equation", "Model", "Step"}
    assert classes - of_steps <= set(re.findall(r"`(\w+)`", PAGE)) | imported


@pytest.mark.parametrize("line", re.findall(r"^\| (`[A-Z]\w+`[^|]*) \| (`[^|]*) \|", PAGE, re.MULTILINE), ids=str)
def test_every_smaller_class_has_its_fields(line: tuple[str, str]) -> None:
    inherited = {f.name for f in fields(Model)}
    for name in re.findall(r"\w+", line[0]):
        kind = vars(symbolic)[name]
        own = {f.name for f in fields(kind)} - (inherited if issubclass(kind, Model) else set())
        assert sorted(re.findall(r"`(\w+)`", line[1])) == sorted(own)


def test_reserved_names_are_those_that_are_refused() -> None:
    section = PAGE.partition("## Reserved names\n")[2].partition("\n## ")[0]
    fixed, made = (part for part in section.split("\n\n") if part.startswith("`") and part.count("`, `") > 5)
    assert re.findall(r"`(\w+)`", fixed) + re.findall(r"`(\w+)`", made) == sorted(reserved(), key=of_users)


def of_users(name: str) -> bool:
    """Whether it is made of names that a model declares."""
    return bool(re.search("STATE|CONTROL|OUTPUT|SET|N$", name))


def test_refusals_are_quoted_as_they_are_given() -> None:
    files = [
        path
        for room in ("symbolic", "codegen", "kernels", "instance")
        for path in (ROOT / "satsym" / room).rglob("*.py")
    ]
    source = "".join(path.read_text(encoding="utf-8") for path in files)
    text = re.sub(r"""["']\s*\n\s*f?["']""", "", source)
    quoted = re.findall(r"^\| ([^|`]+?) \|", PAGE.partition("## When a model is rejected")[2], re.MULTILINE)[1:]
    quoted = [line for line in quoted if line != "---"]
    assert quoted
    for message in quoted:
        for part in message.split("..."):
            assert part.strip(" ,;") in text, part
