"""The pages of the gallery state problems in words, and leave nothing in them unexplained."""

from __future__ import annotations

import re
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from types import ModuleType

import pytest

from satsym import instance


@pytest.fixture(scope="module")
def statements(repository: Path) -> Iterator[ModuleType]:
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(repository / "docs" / "_ext")
        yield import_module("statements")


def test_every_formula_to_be_typeset_is_in_a_derivation_file(statements: ModuleType, repository: Path) -> None:
    texts = [" ".join(path.read_text("utf-8").split()) for path in (repository / "derivations").rglob("*.py")]
    assert [plain for plain in statements.TYPESET if not any(plain in text for text in texts)] == []


def test_problems_with_a_cost_are_stated_in_words(statements: ModuleType, repository: Path) -> None:
    for name in instance.shipped():
        case = instance.load(name)
        text = statements.statement(case, "solve", repository / "generated")
        if text == statements.LONG or not case.model.spec.has_cost:
            continue
        words = re.sub(r"\$\$.*?\$\$", "", text, flags=re.DOTALL)
        assert re.match(r"(Minimise|Maximise)\s+with the (running|terminal) cost", words), name
        assert "subject to the equations of motion" in words, name
        assert text.count("\\frac{d ") + text.count("\\ddot{") >= len(case.model.spec.states), name


def test_statements_leave_out_outputs_and_constants_that_do_not_occur(statements: ModuleType, repository: Path) -> None:
    text = statements.statement(instance.load("inspection"), "solve", repository / "generated")
    assert "g_{1}" not in text
    assert "\\mu" not in text
    assert "N_{11} = x_1 - a = 0" in text
    text = statements.statement(instance.load("return-to-geo"), "solve", repository / "generated")
    assert "where $\\mu = \\sigma^{3} \\omega^{2}$ is the gravitational parameter" in text


def test_formulas_in_docstrings_are_typeset(statements: ModuleType, repository: Path) -> None:
    text = statements.about(repository / "derivations" / "polar_orbit.py")
    assert "only if $\\mu = \\sigma^3 \\omega^2$; this relation therefore defines $\\mu$." in text
