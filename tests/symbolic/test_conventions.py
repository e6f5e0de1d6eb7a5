"""Minimum and maximum convention: printed differently, the same controls, the same kernels."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import get_args

import pytest
import sympy as sp

from satsym.codegen import module
from satsym.report import artefacts
from satsym.report.latex import document as latex
from satsym.symbolic import Derivation, DerivationError, Problem, derive, loader
from satsym.symbolic.checks import numeric, points
from satsym.symbolic.model import Convention
from satsym.symbolic.switching import functions as steps
from tests.support import derived as shared
from tests.support.distance import deviation
from tests.support.switching_models import (
    CATALYST,
    FULLER,
    LEAST_FUEL,
    MINIMUM_TIME,
    OSCILLATOR,
    REGULATOR,
    ROCKET,
    TWO_ENGINES,
    WORST,
    derived,
    switching,
    u1,
    x1,
    x2,
)

LAMBDA = sp.symbols("lambda_x1:4", real=True)
l1, l2, l3 = LAMBDA
PROBLEMS = {
    "time": MINIMUM_TIME,
    "fuel": LEAST_FUEL,
    "Fuller": FULLER,
    "regulator": REGULATOR,
    "oscillator": OSCILLATOR,
    "rocket": ROCKET,
    "two engines": TWO_ENGINES,
}


@pytest.mark.parametrize("name", PROBLEMS)
def test_both_conventions_give_the_same_control(name: str) -> None:
    """At costates of the other sign: the same laws, the same state equations, and costate rates of the other sign."""
    problem = PROBLEMS[name]
    least, greatest = derived(problem), derived(problem, "maximum")
    controls = [v.symbol for v in problem.model.controls]

    def everything(found: Derivation) -> list[sp.Expr]:
        laws = [found.equation(f"{step}.{u}").rhs for step in ("control_law", "smoothed_law") for u in controls]
        return [*steps.written_out(found, laws), *found.rhs("state_equations"), *found.rhs("costate_equations")]

    one, other = everything(least), everything(greatest)
    symbols = set().union(*(e.free_symbols for e in one))
    lam = LAMBDA[: len(problem.model.states)]
    assert set(lam) <= symbols
    for point in points(symbols, name, 40):
        here = numeric(one)(point)
        there = numeric(other)({**point, **{c: -point[c] for c in lam}})
        n = len(here) - len(lam)
        assert deviation([*there[:n], *(-rate for rate in there[n:])], here) < 1e-14


def test_transversality_changes_its_sign_with_the_convention() -> None:
    least, greatest = derived(CATALYST), derived(CATALYST, "maximum")
    assert [least.equation(f"boundary_conditions.{c}").rhs for c in (l1, l2)] == [1, 1]
    assert [greatest.equation(f"boundary_conditions.{c}").rhs for c in (l1, l2)] == [-1, -1]


def test_a_regular_problem_can_be_maximised_as_well() -> None:
    effort = switching({x1: x2, x2: u1}, u1**2 / 2 + x1**2)
    least, greatest = derive(effort), derive(replace(effort, convention="maximum"))
    assert least.equation("stationarity.u1_hat").rhs == -l2
    assert greatest.equation("stationarity.u1_hat").rhs == l2
    assert greatest.equation("second_derivative.u1_u1").rhs == -1
    assert greatest.equation("maximised_hamiltonian.H_star").rhs == l1 * x2 + l2**2 / 2 - x1**2
    with pytest.raises(DerivationError, match="H_uu is not negative definite, so H has no maximum"):
        derive(replace(switching({x1: u1}, -(u1**2)), convention="maximum", control_set="free"))


def test_kernels_are_those_of_the_minimum_form(tmp_path: Path) -> None:
    """Text and all: the convention is one of the printed derivation."""
    text = (Path(__file__).parents[2] / "derivations" / "small_systems.py").read_text(encoding="utf-8")
    chosen = re.sub(r"PROBLEMS = .*", "PROBLEMS = (van_der_pol,)", text)
    assert chosen.count('control_set="box",') == 2
    turned = chosen.replace('control_set="box",', 'control_set="box",\n    convention="maximum",')
    rendered = []
    for name, content in (("a", chosen), ("b", turned)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "mine.py").write_text(content, encoding="utf-8")
        rendered.append(artefacts.render([tmp_path / name / "mine.py"], tmp_path))
    least, greatest = rendered
    alike = [re.sub(r"^(Source|Digest): .*", r"\1", each["van_der_pol.py"], flags=re.M) for each in rendered]
    assert alike[0] == alike[1]
    assert least["van_der_pol.tex"] != greatest["van_der_pol.tex"]
    with pytest.raises(ValueError, match="generated from the minimum form"):
        module.render(derived(MINIMUM_TIME, "maximum"), "mine.py")


@pytest.mark.parametrize("convention", ["minimum", "maximum"])
@pytest.mark.parametrize("language", ["en", "id"])
@pytest.mark.parametrize("problem", [MINIMUM_TIME, LEAST_FUEL, OSCILLATOR, ROCKET, WORST, CATALYST])
def test_every_step_has_its_texts(problem: Problem, language: str, convention: Convention) -> None:
    text = latex.render(derived(problem, convention), language)
    assert r"\begin{cases}" in text
    assert ("- L$" in text) == (convention == "maximum")


STATED = {p.name: p for path in loader.shipped() for p in loader.load(path) if isinstance(p, Problem)}
LONG = {"shuttle", "shuttle_heating", "reorientation"}
"""Problems that take more than ten seconds to derive: studies, drawn or not."""


@pytest.mark.slow
@pytest.mark.parametrize("name", [case for case in shared.each(left=LONG) if case.values[0] in STATED])
def test_every_shipped_problem_can_be_told_in_the_other_convention(name: str) -> None:
    (other,) = set(get_args(Convention)) - {STATED[name].convention}
    assert latex.render(shared.derived(replace(STATED[name], convention=other)))
