"""The reader of LaTeX on displays of textbooks: read as a person reads them, or refused; never misread."""

from __future__ import annotations

import random
import tomllib
from pathlib import Path

import pytest
import sympy as sp

from satsym.auditing.latex.grammar import read
from satsym.auditing.latex.tokens import Unread, tokens
from satsym.auditing.latex.words import NOT_COMPARED
from satsym.auditing.latex.writing import in_latex
from satsym.formula import reading as safe
from satsym.formula.tree import Equality, Node, calls_in, symbols
from satsym.formula.writing import written

FOLDER = Path(__file__).parent / "displays"
LISTS = {path.stem: tomllib.loads(path.read_text(encoding="utf-8")) for path in sorted(FOLDER.glob("*.toml"))}


@pytest.mark.parametrize(("latex", "meant"), [tuple(pair) for one in LISTS.values() for pair in one["read"]])
def test_a_display_is_read_as_it_is_meant(latex: str, meant: str) -> None:
    found = read(tokens(latex), latex)
    assert "; ".join(map(written, found.statements)) == meant


@pytest.mark.parametrize(("latex", "meant"), [tuple(pair) for pair in LISTS["textbooks"]["numbers"]])
def test_a_display_has_the_value_that_a_reader_works_out(latex: str, meant: str) -> None:
    (tree,) = read(tokens(latex), latex).statements
    assert not isinstance(tree, Equality)
    drawn = random.Random(latex)
    letters = {name: drawn.uniform(0.2, 0.9) for name in sorted(symbols(tree) - {"pi"})}
    found, wanted = (float(sp.sympify(text, locals=letters)) for text in (written(tree), meant))
    assert found == pytest.approx(wanted)


@pytest.mark.parametrize(("latex", "reason"), [tuple(pair) for one in LISTS.values() for pair in one["refused"]])
def test_what_is_not_in_the_grammar_is_refused_at_its_place(latex: str, reason: str) -> None:
    with pytest.raises(Unread) as caught:
        read(tokens(latex), latex)
    assert reason in str(caught.value)
    assert 0 <= caught.value.at <= len(latex)


@pytest.mark.parametrize("latex", [pair[0] for one in LISTS.values() for pair in one["read"]])
def test_what_is_written_is_read_as_the_same(latex: str) -> None:
    found = read(tokens(latex), latex)
    write = in_latex({name: letter.latex for name, letter in found.letters.items()})
    places = any(call.function == "value" for statement in found.statements for call in calls_in(statement))
    groups = [found.statements] if places else [[statement] for statement in found.statements]
    for group in groups:  # where something is taken at several places, one equation tells what the other means
        text = r", \quad ".join(map(write, group))
        assert [written(tree) for tree in read(tokens(text), text).statements] == [written(tree) for tree in group]


def test_what_is_read_can_stand_in_a_ledger() -> None:
    count = 0
    for latex, _ in LISTS["seen"]["read"]:
        for statement in read(tokens(latex), latex).statements:
            if NOT_COMPARED & {call.function for call in calls_in(statement)}:
                continue
            sides: list[Node] = [statement.lhs, statement.rhs] if isinstance(statement, Equality) else [statement]
            for side in sides:
                assert safe.expression(written(side), judging=True)
                count += 1
    assert count > 90
