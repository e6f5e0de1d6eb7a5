"""What a document names was introduced before: in its table, in words, or as the left side of an equation."""

from __future__ import annotations

import re

import pytest

from satsym.report.latex.document import render
from satsym.report.texts import languages
from satsym.symbolic import Problem
from satsym.symbolic.latex.typeset import Typesetter
from satsym.symbolic.model import translated, variables_of, with_origins
from tests.support.derived import document, each, names, shipped, stated

MATHEMATICS = re.compile(r"\$([^$]*)\$|\\begin\{(align|equation)\*?\}(.*?)\\end\{\2|\\\[(.*?)\\\]", re.DOTALL)
DRESS = r"(?:d*dot|bar|hat|math\w+|boldsymbol|text|[lr]vert|frac|left|right|label|eqref)"
RATE = re.compile(r"\\frac\{d (.+?)\}\{dt\}")
LETTER = re.compile(rf"\\(?!{DRESS}(?![a-z]))[A-Za-z]+|(?<![\\A-Za-z])[A-Za-z]")


def letters(tex: str) -> set[str]:
    """The letters of a formula, without accents and indices: where a family is introduced, each of it is."""
    plain = re.sub(rf"\\(?:label|ref|eqref)\{{[^}}]*\}}|\\{DRESS}(?![a-z])", " ", tex)
    return set(LETTER.findall(plain))


def first_letter(tex: str) -> set[str]:
    """That of a symbol; a rate has that of what changes."""
    return set(LETTER.findall(RATE.sub(r"\1", tex))[:1])


@pytest.mark.parametrize("name", each())
def test_every_symbol_is_introduced_before_it_is_used(name: str) -> None:
    derivation = shipped(name)
    typeset, text = Typesetter(derivation), render(derivation)
    left: set[str] = set()
    missing = []
    for step in derivation.steps:
        start = text.index(rf"\satsymstep{{{name}:{step.name}}}")
        end = re.compile(r"\\begin\{(?:align|equation)").search(text, start)
        assert end
        left |= {letter for e in step.equations for letter in letters(typeset.tex(e.lhs))}
        known = left.union(*(letters(a or b or c) for a, _, b, c in MATHEMATICS.findall(text[: end.start()])))
        used = {s.name: typeset.symbol(s.name) for e in step.equations for s in e.rhs.free_symbols}
        missing += [f"{step.name}: {s}" for s, tex in used.items() if not first_letter(tex) <= known]
    assert missing == []


@pytest.mark.parametrize("language", [language for language in languages() if language != "en"])
def test_shipped_models_have_their_titles_and_meanings_in_every_language(language: str) -> None:
    said, known = set(), {}
    for name in names():
        subject = stated(name)
        models = with_origins(subject.model if isinstance(subject, Problem) else subject)
        known |= translated(models[0], language)
        said |= {subject.title, *(text for m in models for text in (m.title, *(v.meaning for v in variables_of(m))))}
        lines = [line for m in models for paragraph in m.statement() for line in paragraph.lines]
        said |= {line.index for line in lines}
        said |= {word for line in lines for word in re.findall(r"\\mathrm\{([a-z]\w+)", str(line.left))}
    assert {text for text in said if text} == set(known)


def test_documents_have_them() -> None:
    text = document("polar_orbit", "id")
    assert "kecepatan radial" in text
    assert "radial velocity" not in text
