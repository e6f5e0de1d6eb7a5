"""What a reader of a typeset derivation trips over: letters with two meanings, gaps, words for many where one is."""

from __future__ import annotations

import re

import pytest

from satsym.report.latex.document import render
from satsym.report.latex.references import cited
from satsym.report.texts import languages
from satsym.symbolic import notation as n
from satsym.symbolic.model import symbols_of, variables_of, with_origins
from satsym.symbolic.principle import path_notation
from tests.support.derived import each, shipped


@pytest.mark.parametrize("name", each())
def test_letters_of_indicators_and_constraints_are_no_variables_of_the_model(name: str) -> None:
    derivation = shipped(name)
    if derivation.problem is None:
        return
    own = {v.latex.partition("_")[0] for model in with_origins(derivation.model) for v in variables_of(model)}
    derived = [path_notation.rate(constraint, 0) for constraint in derivation.problem.path_constraints]
    for state in symbols_of(derivation.model.states):
        derived += [n.given(state), n.on_reference(state)]
    letters = {re.split("[_^]", derivation.notation[s.name])[0] for s in derived}
    assert letters <= {r"\iota", r"\Gamma"}
    assert not letters & own


def test_an_index_joins_the_one_that_is_there() -> None:
    assert n.indexed("x_1", "0") == "x_{1,0}"
    assert n.indexed(r"\omega_{x}", "0") == r"\omega_{x,0}"
    assert n.indexed(r"\dot r", "0") == r"{\dot r}_0"
    assert n.barred("x_1") == r"\bar{x}_{1}"
    assert n.barred(r"\dot r") == r"\bar{\dot r}"


@pytest.mark.parametrize("language", languages())
@pytest.mark.parametrize("name", ["beam", "approach_cone", "goddard"])
def test_no_blank_line_parts_a_sentence_from_its_equations(name: str, language: str) -> None:
    text = render(shipped(name), language)
    assert re.findall(r"[^}\n]\n\n+\\begin\{(?:align|equation)\*?\}", text) == []


@pytest.mark.parametrize("name", ["cart_pole", "goddard"])
def test_a_single_control_is_spoken_of_as_one(name: str) -> None:
    text = render(shipped(name))
    assert "Each control" not in text
    assert "The control is bounded" in text
    assert "The control stays between its bounds" in text


def test_of_free_controls_no_bounds_are_spoken_of() -> None:
    assert "bound is active" in render(shipped("cart_pole"))
    assert "bound is active" not in render(shipped("bryson_denham"))


def test_the_boundary_value_problem_leads_to_every_step_of_an_active_constraint() -> None:
    derivation = shipped("approach_cone")
    collected = render(derivation).rpartition(r"\section{The boundary-value problem}")[2]
    for step in ("boundary_control", "constraint_multiplier", "constrained_costates", "junction_conditions"):
        assert step in derivation
        assert rf"\ref{{approach_cone:{step}}}" in collected


def test_a_figure_is_referred_to_before_it_and_stands_before_the_quantities() -> None:
    text = render(shipped("polar_orbit"))
    label = re.search(r"\\label\{([^}]*figure)\}", text)
    assert label
    assert text.index(rf"\ref{{{label[1]}}}") < text.index(r"\begin{figure}") < text.index(r"\begin{longtable}")


def test_works_cited_together_are_in_the_order_of_their_numbers() -> None:
    body, _ = cited(r"\cite{bryson} \cite{hartl,bryson}", "it")
    assert body.endswith(r"\cite{it:bryson,it:hartl}")
