"""What a reader of a typeset derivation trips over: letters with two meanings, gaps, words for many where one is."""

from __future__ import annotations

import re

import pytest
import sympy as sp

from satsym.report.latex.document import render
from satsym.report.latex.equations import (
    ROW_FRACTIONS,
    ROW_ONE_FRACTION,
    ROW_PLAIN,
    ROW_SMALL_FRACTIONS,
    Context,
    Row,
    array,
    display,
)
from satsym.report.latex.preamble import cited
from satsym.report.latex.statement import _vector
from satsym.report.latex.steps import shown
from satsym.report.texts import languages, load
from satsym.spec import Variable
from satsym.symbolic import notation as n
from satsym.symbolic.derivation import Equation, Step
from satsym.symbolic.latex.products import plain
from satsym.symbolic.latex.rewriting import readable
from satsym.symbolic.latex.typeset import Typesetter
from satsym.symbolic.model import symbols_of, variables_of, with_origins
from satsym.symbolic.principle.path import notation as path_notation
from tests.support.derived import document, each, shipped


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


@pytest.mark.parametrize("name", each())
def test_no_symbol_of_a_document_stands_for_two_things(name: str) -> None:
    derivation = shipped(name)
    typeset, text = Typesetter(derivation), render(derivation)
    sides = [side for step in derivation.steps for e in step.equations for side in (e.lhs, e.rhs)]
    used = {s.name for side in sides for s in side.free_symbols}
    used = {s for s in used if not s.startswith("d_switching")}  # the first of the derivatives has two names
    looks = [re.sub(r"[{} ]", "", typeset.symbol(s)) for s in used]
    assert sorted(look for look in set(looks) if looks.count(look) > 1) == []
    shown = {typeset.symbol(s) for s in used if s in derivation.notation}
    entries = set(re.findall(r"(?<![A-Za-z\\])[a-z]_\{[1-9]\d*,?[1-9]\d*\}", text)) - shown
    assert not {entry[0] for entry in entries} & {
        n.letter_of(tex) for tex in shown if "_" in tex and r"\mathbf" not in tex
    }


def test_letters_that_the_machine_chooses_are_free() -> None:
    assert n.letter_of(r"{\dot r}_0") == "r"
    assert n.letter_of(r"\bar{\boldsymbol{\omega}}_{x}") == r"\omega"
    assert r"A_{21} &=" in document("gyrostat")  # where direction cosines are a_xy, and so on
    assert r"a_{21} = " in document("goddard")
    variables = (Variable("x", "x_1"), Variable("s", r"\dot s"))
    assert n.free_letter("xsv", variables) == "v"
    assert n.free_letter("xs", variables) == "s"


def test_an_index_joins_the_one_that_is_there() -> None:
    assert n.indexed("x_1", "0") == "x_{1,0}"
    assert n.indexed(r"\omega_{x}", "0") == r"\omega_{x,0}"
    assert n.indexed(r"\dot r", "0") == r"{\dot r}_0"
    assert n.barred("x_1") == r"\bar{x}_{1}"
    assert n.barred(r"\dot r") == r"\bar{\dot r}"


@pytest.mark.parametrize("language", languages())
@pytest.mark.parametrize("name", ["beam", "approach_cone", "goddard"])
def test_no_blank_line_parts_a_sentence_from_its_equations(name: str, language: str) -> None:
    text = document(name, language)
    assert re.findall(r"[^}\n]\n\n+\\begin\{(?:align|equation)\*?\}", text) == []


@pytest.mark.parametrize("name", ["cart_pole", "goddard"])
def test_a_single_control_is_spoken_of_as_one(name: str) -> None:
    text = document(name)
    assert "Each control" not in text
    assert "The control is bounded" in text
    assert "The control must lie between its bounds" in text


def test_a_single_control_has_one_switching_function() -> None:
    text = document("double_integrator_fuel")
    assert "{Switching function}" in text
    assert r"is linear in the control and in its magnitude, $H = H_0 + \sigma u_1 + w |u_1|$" in text
    assert r"$\tfrac{1}{2} \varepsilon u_1^2$ with $\varepsilon > 0$ is added" in text
    assert r"\sum_i" not in text


def test_what_there_is_one_of_is_spoken_of_as_one() -> None:
    text = document("hypersensitive")
    assert r"The state $x$ obeys the equation of motion~\eqref{hypersensitive:first_order.x}, and" in text
    assert "The control is not bounded." in text
    assert "satisfies the path constraint\n" in document("beam")
    assert "satisfies the path constraints\n" in document("approach_cone")
    assert "Eigenvalues with positive real parts, $2$ and $1$, make" in document("three_modes")
    assert "An eigenvalue with a positive real part, $3$, makes" in document("saddle")


def test_of_free_controls_no_bounds_are_spoken_of() -> None:
    assert "bound is active" in document("cart_pole")
    assert "bound is active" not in document("bryson_denham")


def test_the_boundary_value_problem_leads_to_every_step_of_an_active_constraint() -> None:
    derivation = shipped("approach_cone")
    collected = render(derivation).rpartition(r"\section{The boundary-value problem}")[2]
    for step in ("boundary_control", "constraint_multiplier", "constrained_costates", "junction_conditions"):
        assert step in derivation
        assert rf"\ref{{approach_cone:{step}}}" in collected


@pytest.mark.parametrize(
    ("name", "defined"), [("catalyst", "switching_function.u"), ("zermelo", "control_parts.cosine_of_heading")]
)
def test_the_boundary_value_problem_defines_what_its_law_is_stated_in(name: str, defined: str) -> None:
    collected = document(name).rpartition(r"\section{The boundary-value problem}")[2]
    assert rf"\tag{{\ref{{{name}:{defined}}}}}" in collected


def test_the_boundary_value_problem_has_the_points_on_the_way() -> None:
    collected = document("inspection").rpartition(r"\section{The boundary-value problem}")[2]
    for e in shipped("inspection").step("interior_conditions").equations:
        assert rf"\tag{{\ref{{inspection:interior_conditions.{e.name}}}}}" in collected
    assert "no path constraint is active" not in collected


@pytest.mark.slow
def test_bounds_among_constraints_are_called_so_and_change_no_costate_equation() -> None:
    text = document("shuttle_heating")
    costates = text.partition(r"\satsymstep{shuttle_heating:mixed_costates}")[2].partition(r"\satsymstep")[0]
    assert r"$\Gamma_{1}$" in costates
    assert r"$\Gamma_{2}$" not in costates
    assert r"$\Gamma_{2}$, $\Gamma_{3}$, $\Gamma_{4}$ and $\Gamma_{5}$ are the bounds of the controls" in text
    assert "mixed_costates" not in shipped("inspection")


def test_a_figure_is_referred_to_before_it_and_stands_before_the_quantities() -> None:
    text = document("polar_orbit")
    label = re.search(r"\\label\{([^}]*figure)\}", text)
    assert label
    assert text.index(rf"\ref{{{label[1]}}}") < text.index(r"\begin{figure}") < text.index(r"\begin{longtable}")


def test_works_cited_together_are_in_the_order_of_their_numbers() -> None:
    body, _ = cited(r"\cite{bryson} \cite{hartl,bryson}", "it", load("en"))
    assert body.endswith(r"\cite{it:bryson,it:hartl}")


def test_what_is_said_of_a_kind_leads_to_its_literature_where_there_is_one_of_that_kind() -> None:
    assert "primer vector is treated in" in document("transfer_fuel")
    assert "primer vector is treated in" not in document("brachistochrone")


def test_works_are_joined_by_words_of_the_language_and_so_are_parts_of_formulas() -> None:
    _, works = cited(r"\cite{kelley}", "it", load("id"))
    assert "R.~E. Kopp, dan H.~G. Moyer" in works
    assert "dalam G.~Leitmann" in works
    assert "<" not in works
    text = document("double_integrator_energy", "id")
    assert r"J_{\mathrm{diam}}" in text
    assert r"\mathrm{rest}" not in text


@pytest.mark.parametrize(
    ("entry", "one", "both"),
    [
        ("1", ROW_PLAIN, ROW_PLAIN),
        (r"\tfrac{1}{2}", ROW_SMALL_FRACTIONS, ROW_ONE_FRACTION),
        (r"\frac{1}{x}", ROW_ONE_FRACTION, ROW_FRACTIONS),
    ],
)
def test_rows_of_a_matrix_stand_apart_as_the_fractions_in_both_need(entry: str, one: str, both: str) -> None:
    rows = [["0", "0"], ["0", "0"], ["0", entry], [entry, "0"]]
    between = re.findall(r" \\\\ (?:\\noalign\{.*?\} )?", array(rows))
    assert between == [ROW_PLAIN, one, both]


def test_what_stands_below_a_fraction_line_is_a_product_where_that_is_shorter() -> None:
    text = document("shuttle")
    assert r"{(r_e + h)^{3}}" in text
    assert r"r_e^{3}" not in text
    assert r"r_e \cos \theta + h \cos \theta" not in text


def test_squares_of_sine_and_cosine_that_make_one_are_not_written() -> None:
    assert r"\sin^{2} \theta + \cos^{2} \theta" not in document("shuttle")
    x, a, b = sp.symbols("x a b", real=True)
    assert readable(a + b * sp.sin(x) ** 2 + b * sp.cos(x) ** 2) == a + b
    assert readable(a * sp.sin(x) ** 2 + b * sp.cos(x) ** 2).has(sp.sin)


def test_equations_of_motion_look_the_same_wherever_they_stand() -> None:
    derivation = shipped("cart_pole")
    assert derivation.rhs("state_equations") == derivation.rhs("first_order")


def test_what_controls_gain_stands_apart_in_the_minimised_hamiltonian() -> None:
    gain = r"\frac{(\ell \lambda_{v_1} - \lambda_{v_2} \cos q_2)^{2}}{4 \ell^{2} (m_1 + m_2 \sin^{2} q_2)^{2}}"
    assert gain in document("cart_pole")


def test_of_several_path_constraints_each_has_its_own_equations() -> None:
    text = document("approach_cone")
    steps = ("constraint_order", "boundary_control", "constraint_multiplier", "constrained_costates")
    for step in (*steps, "junction_conditions"):
        part = text.partition(rf"\satsymstep{{approach_cone:{step}}}")[2].partition(r"\satsymstep")[0]
        assert part.count(r"for~$\Gamma_{1}$") == part.count(r"for~$\Gamma_{2}$") == 1
    assert r"for~$\Gamma" not in document("beam")


def test_scaled_time_has_its_letter_in_formulas_and_sentences() -> None:
    text = re.sub(r"\\(?:label|ref|eqref|tag)\{[^}]*\}+", "", document("pitch_scaled_time"))
    assert r"\tau_0 \le \tau \le \tau_f" in text
    assert r"\int_{\tau_0}^{\tau_f} L \,d\tau" in text
    assert not re.search(r"(?<![a-z])t_[0f]", text)
    assert r"e^{A \tau} &=" in document("pitch_scaled").replace("e^{A \\tau} =", "e^{A \\tau} &=")


def test_laws_list_what_they_are_made_of_and_no_more() -> None:
    angle, thrust, parts = (document(name) for name in ("transfer_time", "transfer_fuel", "shuttle"))
    assert r"minimised by the direction of $(-H_{\cos\beta},$ $-H_{\sin\beta})$:" in angle
    assert "switching function" not in angle
    assert r"switching function $|\mathbf{p}| - w$" in thrust
    assert r"T^{\max}" in thrust
    assert r"u^{\max}" not in thrust
    assert "parts are named $q$" in parts


@pytest.mark.slow
def test_what_fills_pages_and_says_nothing_is_named_and_not_shown() -> None:
    text = document("reorientation")
    arcs = text.partition(r"\satsymstep{reorientation:singular_arcs}")[2].partition(r"\satsymstep")[0]
    assert r"$\sigma_{u_1}^{(3)}$, $\sigma_{u_2}^{(3)}$ and $\sigma_{u_3}^{(3)}$" in arcs.partition("are not shown")[2]
    assert r"\sigma_{u_1}^{(3)} &=" not in arcs
    assert all(
        rf"{{reorientation:singular_arcs.{e.name}}}" in arcs
        for e in shipped("reorientation").step("singular_arcs").equations
    )


@pytest.mark.slow
def test_ratios_of_polynomials_stand_by_falling_powers() -> None:
    text = document("pitch_classical")
    assert r"G_{\theta}(s) &= \frac{K_1 s + K_2}{I_y s^{2} + K_1 s + K_2}" in text
    assert r"\Delta(s) &= s^{2} + \frac{K_1 s}{I_y} + \frac{K_2}{I_y}" in text


def test_fixed_axes_are_not_said_to_turn() -> None:
    assert "The unit vectors are fixed" in document("two_body")
    assert "The unit vectors rotate" in document("polar_orbit")


@pytest.mark.slow
def test_a_fraction_that_all_terms_share_stands_before_the_parentheses() -> None:
    text = document("reorientation")
    assert r"\tfrac{1}{2} \lambda_{q_1} (q_2 \omega_3 - q_3 \omega_2 + q_4 \omega_1)" in text
    assert r"\bigl(\tfrac{1}{2} (" not in text


def test_bodies_in_space_are_named_in_the_language_of_the_document() -> None:
    text = document("gimballed_wheel", "id")
    assert r"\boldsymbol{\omega}^{\mathrm{roda}}" in text
    assert r"W^{\mathrm{roda}}" in text
    assert r"\mathrm{modus\ x}" in text
    assert not re.search(r"\\mathrm\{(?:body|wheel|mode)\b", text)


def test_a_matrix_of_one_row_is_a_list() -> None:
    assert array([["0", r"i \omega", "1"]]) == r"\left(0,\; i \omega,\; 1\right)"
    assert array([["a"]]) == "a"


@pytest.mark.parametrize("name", ["catalyst", "beam", "two_body"])
def test_no_fraction_parts_the_lines_of_a_sentence(name: str) -> None:
    for language in languages():
        text = re.sub(r"(?s)\\begin\{(align|equation)\*?\}.*?\\end\{\1", "", document(name, language))
        assert re.findall(r"[^$]*\$[^$]*\\frac[^$]*\$", text) == []


def test_of_a_long_equation_no_page_has_one_line_alone() -> None:
    term = plain("x" * 40)
    text = display([Row("long", plain("y"), term * 6)])
    lines = text.split(r"\\")
    assert [r"\displaybreak" in line for line in lines] == [False, True, True, True, False, False]


def test_equations_too_long_to_be_shown_may_be_the_first_ones() -> None:
    derivation, x = shipped("two_body"), sp.Symbol("x", real=True)
    lengthy = sp.Add(*(sp.sin(k * x) for k in range(1, 200)))
    names, sides = ("one", "two", "three"), (lengthy, lengthy, x)
    equations = tuple(Equation(name, sp.Symbol(name), e) for name, e in zip(names, sides, strict=True))
    step = Step("singular_arcs", "rule", equations, (), ())
    found = shown(Context(derivation, load("en"), Typesetter(derivation)), step)
    assert found.first == found.last == "two_body:singular_arcs.three"
    assert all(rf"\satsymalso{{0}}{{two_body:singular_arcs.{name}}}" in found.body for name in names[:2])


def test_the_components_of_a_vector_too_wide_for_a_line_are_counted_from_one() -> None:
    wide = plain("+".join(["x_{1}"] * 60))
    rows = _vector("f", (wide, wide))
    assert [row.left_tex for row in rows] == ["(f)_1", "(f)_2"]
    (row,) = _vector("f", (plain("x"), plain("y")))
    assert row.left_tex == "f"
