"""Random points lie where functions have numbers, and where they are declared to; wrong steps fail there as well."""

from __future__ import annotations

import random
from dataclasses import replace

import mpmath as mp
import pytest
import sympy as sp

from satsym.agreement import DIGITS
from satsym.report.artefacts import generated
from satsym.spec import Variable
from satsym.symbolic import DerivationError, FirstOrder, Problem, derive, symbols_of
from satsym.symbolic.checks import compare, drawn_from, numeric, partial, random_point

STATES = (Variable("h", "h", "1", "height", positive=True), Variable("v", "v", "1", "speed"))
CONTROLS = (Variable("u", "u", "1", "thrust"),)
h, v = symbols_of(STATES)
(u,) = symbols_of(CONTROLS)


def climb(drag: sp.Expr, states: tuple[Variable, ...] = STATES) -> Problem:
    model = FirstOrder(
        name="climb", title="A climb", states=states, controls=CONTROLS, parameters=(), rates={h: v, v: u - drag}
    )
    return Problem(name="climbing", title="Climbing", model=model, running_cost=u**2 / 2, control_set="box")


@pytest.mark.parametrize("steepness", [5, 500, 5000])
def test_steep_atmospheres_are_derived_and_generated(steepness: int) -> None:
    derivation = derive(climb(310 * v**2 * sp.exp(-steepness * (h - 1))))
    slope = next(e.rhs for e in derivation.step("linearisation").equations if e.name == "A_v_h")
    assert sp.simplify(slope / sp.exp(-steepness * (h - 1)) - 310 * steepness * v**2) == 0
    generated(derivation, "climb.py")


def test_a_root_far_away_needs_a_typical_range() -> None:
    with pytest.raises(
        DerivationError, match=r"give the ranges of the variables: Variable\(\.\.\., typical=\(low, high\)\)"
    ):
        derive(climb(sp.sqrt(h - 100)))
    near = derive(climb(sp.sqrt(h - 100), (replace(STATES[0], typical=(101.0, 120.0)), STATES[1])))
    generated(near, "climb.py")


def test_typical_ranges_are_where_points_lie_and_defaults_go_with_them() -> None:
    declared = (replace(STATES[0], typical=(6500.0, 7000.0)), Variable("k", "k", default=-2.0), STATES[1])
    symbols, rng = symbols_of(declared), random.Random(1)
    with drawn_from(declared):
        for _ in range(100):
            height, factor, speed = random_point(symbols, rng).values()
            assert 6500 <= height <= 7000
            assert -3 <= factor <= -1
            assert 0.5 <= abs(speed) <= 1.5
    assert abs(random_point(symbols, rng)[symbols[0]]) <= 1.5  # and only as long as that is asked for


@pytest.mark.parametrize("typical", [(2.0, 1.0), (1.0, 1.0), (0.0, 1.0), (-1.0, 1.0), (1.0, float("inf"))])
def test_ranges_that_are_none_are_refused(typical: tuple[float, float]) -> None:
    with pytest.raises(ValueError, match=r"variable 'h': got the typical range .*; give two numbers, 0 < low < high"):
        replace(STATES[0], typical=typical)


@pytest.mark.parametrize("default", ["1", float("nan"), (1.0,)])
def test_defaults_that_are_no_numbers_are_refused(default: object) -> None:
    with pytest.raises(ValueError, match=r"variable 'h': got the default .*; give a finite number"):
        replace(STATES[0], default=default)  # type: ignore[arg-type]


@pytest.mark.parametrize("value", [sp.zoo, sp.nan, sp.oo, -sp.oo])
def test_what_is_not_finite_is_refused_where_it_is_stated(value: sp.Expr) -> None:
    with pytest.raises(DerivationError, match="the rate of v is not finite, because of a division by zero"):
        derive(climb(v * h - sp.sin(v) * value))
    with pytest.raises(DerivationError, match="the running cost is not finite"):
        derive(replace(climb(v), running_cost=u**2 + value))


@pytest.mark.parametrize("name", ["", "Climb", "a b", "9", "class "])
def test_names_that_no_file_can_have_are_refused(name: str) -> None:
    with pytest.raises(DerivationError, match="the name of a model must be a lower-case letter, followed by"):
        derive(replace(climb(v), name=name))


@pytest.mark.parametrize("size", [1e-9, 1.0, 1e6])
def test_a_wrong_derivative_is_noticed_whatever_the_size_of_the_numbers(size: float) -> None:
    x, y = symbols_of(declared := (Variable("x", "x", typical=(size, 2 * size)), Variable("y", "y")))
    function = numeric([x**2 * y])

    def error(derived: sp.Expr) -> float:
        found = numeric([derived])
        with drawn_from(declared):
            return compare("slope", {x, y}, lambda point: (found(point), partial(function, point, x))).error

    assert error(2 * x * y) < 1e-15
    assert error(2.001 * x * y) > 1e-4
    assert error(-2 * x * y) > 0.5


@pytest.mark.parametrize(("term", "right"), [(u, True), (u * (1 + sp.Rational(1, 10**12)), False)])
def test_slopes_beside_terms_of_any_size_are_told_right_from_wrong(term: sp.Expr, right: bool) -> None:
    function, slope = numeric([sp.exp(40 * h) + u**2 / 2]), numeric([term])
    found = compare("steep", {h, u}, lambda point: (slope(point), partial(function, point, u)))
    assert found.passed == right


def test_slopes_beside_numbers_of_any_size_are_numbers() -> None:
    with mp.workdps(DIGITS):
        for size in (10, 1000, 5000):
            slope = partial(numeric([sp.exp(size * h) + u]), {h: mp.mpf(1), u: mp.mpf(1)}, u)[0]
            assert slope == pytest.approx(1.0, abs=1e-20)
        assert mp.isnan(partial(numeric([sp.exp(10**5 * h) + u]), {h: mp.mpf(1), u: mp.mpf(1)}, u)[0])
