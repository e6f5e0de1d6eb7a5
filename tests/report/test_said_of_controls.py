"""What a typeset derivation says of controls, constraints and costs holds for the model at hand."""

from __future__ import annotations

import re

import pytest
import sympy as sp

from satsym.report.latex import tex
from satsym.report.texts import languages
from satsym.symbolic import Problem
from satsym.symbolic import notation as n
from satsym.symbolic.checks import positive
from satsym.symbolic.principle import effort as pn
from tests.support.derived import document, shipped, stated


def step_of(name: str, step: str, language: str = "en") -> str:
    """The part of a document that a step takes."""
    return document(name, language).partition(rf"\satsymstep{{{name}:{step}}}")[2].partition(r"\satsymstep")[0]


def collected(name: str, language: str = "en") -> str:
    return document(name, language).rpartition(r":section.boundary_value}")[2]


def test_the_law_of_a_thrust_is_that_of_the_problem_and_the_regularised_one_stands_apart() -> None:
    """The reason for the first: what regularises is introduced by the step after it."""
    for part in (step_of("transfer_fuel", "control_law"), collected("transfer_fuel")):
        assert not re.search(r"\\varepsilon|\\kappa", part)
    assert r"\sqrt{p_{T_r}^{2} + p_{T_\theta}^{2}} > w_{T_r}" in step_of("transfer_fuel", "control_law")
    derivation = shipped("transfer_fuel")
    h = derivation.equation("smoothed_law.H").rhs
    norm = sp.sqrt(sum(s**2 for s in sp.symbols("T_r T_t", real=True)))
    (share,) = (s for s in h.free_symbols if s.name == "norm_factor")
    (weight,) = (s for s in h.free_symbols if s.name.startswith("norm_weight"))
    assert sp.simplify(sp.diff(h, share) - weight * norm) == 0  # so that |T| has the weight kappa w in it


@pytest.mark.slow
def test_sets_of_which_h_has_products_are_not_said_to_be_minimised_over_one_by_one() -> None:
    assert "where products occur" in step_of("shuttle", "control_parts")
    assert "product of sets" not in step_of("zermelo", "control_parts")
    assert "therefore minimised over each set" not in step_of("shuttle", "control_parts") + document("zermelo")
    assert "The norm of the control is bounded" in document("transfer_fuel")


def test_an_angle_has_its_own_letter() -> None:
    said = step_of("brachistochrone", "control_parts") + step_of("brachistochrone", "control_law")
    assert r"H_{\cos\theta}" in said
    assert r"\beta" not in said


@pytest.mark.parametrize("name", ["chain", "shuttle"])
def test_where_h_is_neither_linear_nor_quadratic_no_parts_are_said_to_add_up(name: str) -> None:
    assert [c.claim for c in shipped(name).step("control_parts").checks][:1] == ["numeric derivative"]


def test_what_is_examined_is_what_is_announced() -> None:
    assert "examines stability and controllability." in document("pitch_scaled")
    assert "examines stability, controllability and observability." in document("clohessy_wiltshire")
    text = document("saddle")
    assert r"\section{Stability}" in text
    assert "number of states" not in text
    assert "derives the equations of motion" not in text


def test_without_controls_none_is_spoken_of() -> None:
    assert r"\mathbf{u}" not in document("saddle")
    assert r"\mathbf{u}" in step_of("explicit_time", "linearisation")


@pytest.mark.parametrize("language", languages())
def test_formulas_have_the_decimal_sign_of_the_language(language: str) -> None:
    text = step_of("rayleigh", "first_order", language)
    assert ("1.4" in text, "1{,}4" in text) == (language == "en", language == "id")


def test_a_control_that_a_constraint_contains_is_not_called_free() -> None:
    text = document("rayleigh_mixed")
    assert "The control is not bounded" not in text
    assert r"step~\ref{rayleigh_mixed:mixed_constraints} gives" in step_of("rayleigh_mixed", "control_law")
    assert r"marked $\mathrm{b}$" in step_of("rayleigh_mixed", "mixed_constraints")
    assert "The control is not bounded" in document("rayleigh")


def test_a_closed_form_that_leaves_a_constraint_out_says_so() -> None:
    assert "no path constraint is active" in step_of("beam", "least_effort")
    assert "no path constraint is active" not in step_of("double_integrator_energy", "least_effort")


def test_the_control_from_rest_has_a_name_of_its_own_in_the_time_of_the_document() -> None:
    assert r"{U}_{\mathrm{rest}}(\tau)" in step_of("pitch_scaled_energy", "least_effort")
    assert "U(t)" not in document("pitch_scaled_energy")


@pytest.mark.parametrize(("name", "arcs"), [("singular_regulator", True), ("double_integrator_time", False)])
def test_singular_arcs_are_in_the_boundary_value_problem_where_there_may_be_some(name: str, arcs: bool) -> None:
    assert (rf"\ref{{{name}:singular_arcs}}" in collected(name)) == arcs
    assert (r"marked $\mathrm{s}$" in step_of(name, "singular_arcs")) == arcs


def test_orders_of_constraints_are_spoken_of_as_they_are() -> None:
    for name, meeting in (("beam", r"where $\Gamma$ and $\dot\Gamma$ vanish"), ("goddard_pressure", "$ vanishes and")):
        text = step_of(name, "junction_conditions")
        assert meeting in text
        assert "$p" not in text
    assert r"\Gamma_{1}" not in document("goddard_pressure")


def test_without_a_reference_no_end_on_it_is_spoken_of() -> None:
    assert r"\iota^{\mathrm{r}}" not in document("beam")
    assert r"\iota^{\mathrm{r}}" in document("polar_orbit")
    residual = shipped("beam").equation("boundary_residual.x").rhs
    assert n.on_reference(sp.Symbol("x")) in residual.free_symbols  # kernels have it all the same


def test_one_thing_has_one_symbol_and_two_have_two() -> None:
    assert r"$\mathbf{x}_f$" not in document("beam")
    for name, letter in (("shuttle", "q"), ("shuttle_heating", "k")):  # whose heating has the letter q
        problem = stated(name)
        assert isinstance(problem, Problem)
        assert pn.letter_of_parts(problem) == letter
    assert r"\dot{\mathbf{e}}_{x} &= \mathbf{0}" in step_of("two_body", "unit_vectors")


def test_the_second_derivative_by_one_control_is_a_number() -> None:
    assert r"\frac{\partial^2 H}{\partial {u}^2} = " in step_of("beam", "second_derivative")
    assert r"H_{\mathbf{uu}}" in step_of("polar_orbit", "second_derivative")


def test_one_body_is_no_plural() -> None:
    assert "A rigid body rotates" in document("gyrostat")
    assert "Rigid bodies rotate" in document("gimballed_wheel")


def test_minors_are_positive_and_not_merely_not_negative() -> None:
    x = sp.Symbol("x", real=True)
    assert positive("positive minors", {x}, [x**2]).passed
    assert not positive("positive minors", {x}, [x**2, x - x]).passed


def test_a_large_number_is_written_by_its_powers_of_ten() -> None:
    assert tex.number(1.4076539e16, "{,}") == r"$1{,}4076539 \times 10^{16}$"
    assert tex.number(1 / 3) == "$1/3$"


def test_shorter_rates_of_coordinates_are_the_same() -> None:
    assert r"\omega_0 \cos \psi}{\cos \phi}" in step_of("gyrostat", "first_order")
    claims = {c.claim for c in shipped("gyrostat").step("first_order").checks}
    assert "solved by elimination in numbers" in claims


def test_what_is_divided_by_is_not_zero() -> None:
    for name, assumed in (
        ("explicit_time", r"$t \ne 0$"),
        ("transfer_time", r" \ne 0$"),
        ("pitch_minimum_energy", "$I_y - I_{wy} > 0$"),
    ):
        assert assumed in document(name).partition(r"\section{The motion}")[0]
    assert r"\ne 0" not in document("saddle")
    stated_conditions = document("gimballed_wheel").partition("Throughout, ")[2].partition("\n")[0]
    assert r"$I_{wy} \ge 0$" not in stated_conditions  # as it is positive


def test_entries_that_are_named_are_those_of_a_matrix() -> None:
    assert "The longer entry of $A$ is\n" in document("goddard")
    assert "The longer entries of $A$ are\n" in document("gyrostat")


def test_a_scaled_quantity_is_defined() -> None:
    assert "  p &= " in step_of("pitch_scaled_energy", "scales")


def test_where_a_length_is_at_its_threshold_the_law_says_that_it_says_nothing() -> None:
    keys = [c.key for c in shipped("transfer_fuel").step("control_law").conclusions]
    assert "no length at the threshold" in keys
    assert "no length at the threshold" not in [c.key for c in shipped("transfer_time").step("control_law").conclusions]
