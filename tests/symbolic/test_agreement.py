"""Rounding is never taken for a mistake, nor a mistake for rounding, whatever the size of coefficients and terms."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import mpmath as mp
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

import satsym
from satsym.agreement import DIGITS, LIMIT, disagreement, equal
from satsym.report.artefacts import generated
from satsym.spec import Variable
from satsym.symbolic import FirstOrder, Problem, derive, symbols_of
from satsym.symbolic.checks import compare, identity, never_below, numeric, partial

x, y, z = sp.symbols("x y z", real=True)
FACTORS = (x, y, x * y, sp.sin(x * z), sp.cos(x + y), sp.exp(x), 1 / (3 + x), x**3 * z, sp.sqrt(x**2 + y**2), z)


def with_digits(side: Callable[[], list[Any]]) -> Callable[[int], tuple[list[Any], list[Any]]]:
    """A list of numbers beside zeros, in the working precision."""

    def at(digits: int) -> tuple[list[Any], list[Any]]:
        with mp.workdps(digits):
            found = side()
        return found, [0] * len(found)

    return at


@pytest.mark.parametrize("size", [0, 10, 25, 60, 100])
def test_what_cancels_vanishes_and_what_is_left_does_not_whatever_cancelled(size: int) -> None:
    third = sp.Rational(1, 3)
    left = mp.mpf(10) ** -15

    def remainder() -> Any:
        return mp.mpf(10) ** size * (mp.mpf(third.p) / third.q * 3 - 1 + mp.sin(1) ** 2 + mp.cos(1) ** 2 - 1)

    assert equal(with_digits(lambda: [remainder(), 0]))
    assert not equal(with_digits(lambda: [remainder() + left, 1]))
    assert not equal(with_digits(lambda: [1, remainder() + left]))


def test_numbers_are_compared_one_by_one_however_small_beside_others() -> None:
    assert disagreement(lambda _: ([1e30, 1e-20], [1e30, 1e-20])) == 0.0
    with mp.workdps(DIGITS):
        one, other = [mp.mpf(10) ** 25, mp.mpf(1)], [mp.mpf(10) ** 25, 1 + mp.mpf(10) ** -18]
    assert disagreement(lambda _: (one, other)) > LIMIT


def test_rounding_that_was_small_by_chance_is_no_mistake() -> None:
    rounding = {60: 1.3e-55, 120: -1.6e-55, 240: 1e-205}
    assert equal(lambda digits: ([mp.mpf(rounding[digits]), 1], [0, 1]))
    assert equal(lambda digits: ([0, 1], [mp.mpf(rounding[digits]), 1]))
    assert not equal(lambda digits: ([mp.mpf(rounding[digits]) + 1e-50, 1], [0, 1]))


def test_what_never_settles_is_no_agreement() -> None:
    assert not equal(lambda digits: ([1 + (digits // DIGITS) % 7], [0]))


def test_what_is_no_number_is_no_agreement() -> None:
    assert math.isnan(disagreement(lambda _: ([mp.nan, 1], [1, 1])))
    assert math.isnan(disagreement(lambda _: ([mp.inf], [1])))


def test_routes_that_gain_half_the_digits_lead_to_the_same_numbers() -> None:
    def double_root() -> list[Any]:
        noise = mp.eps * mp.sqrt(2)
        return [mp.sqrt(noise)]

    assert equal(with_digits(double_root))


@settings(max_examples=40, deadline=None)
@given(
    st.lists(
        st.tuples(st.floats(-5, 5), st.sampled_from(FACTORS), st.sampled_from(FACTORS), st.booleans()),
        min_size=1,
        max_size=6,
    ),
    st.data(),
)
def test_derivatives_with_coefficients_over_ten_decades_are_told_right_from_wrong(
    drawn: list[tuple[float, sp.Expr, sp.Expr, bool]], data: st.DataObject
) -> None:
    coefficients = [
        sp.Rational(round(10 ** (power % 1 + 4)), 10000) * sp.Integer(10) ** int(power) for power, *_ in drawn
    ]
    terms = [(1 if up else -1) * c * f * g for c, (_, f, g, up) in zip(coefficients, drawn, strict=True)]
    function = numeric([sp.Add(*terms)])
    slopes = [s for term in terms for s in sp.Add.make_args(sp.diff(term, x)) if s != 0]
    point = {x: mp.mpf(0.7), y: mp.mpf(-1.2), z: mp.mpf(1.1)}
    sizes = [abs(v) for v in numeric(slopes)(point)]

    def found(*parts: sp.Expr) -> bool:
        derived = numeric([sp.Add(*parts)])
        return compare("slope", {x, y, z}, lambda at: (derived(at), partial(function, at, x))).passed

    assert found(*slopes)
    counted = [k for k, size in enumerate(sizes) if size >= 1e-9 * sum(sizes) > 0]
    if counted and sp.expand(sp.Add(*slopes)) != 0:
        k = data.draw(st.sampled_from(counted))
        wrong = slopes[k] * (1 + sp.Rational(1, 10**6))
        assert not found(*slopes[:k], wrong, *slopes[k + 1 :])


@pytest.mark.parametrize("size", [sp.Rational(1, 10**6), sp.Integer(1), sp.Integer(10) ** 6, sp.Float("1e6", 60)])
def test_a_minimum_is_one_whatever_the_size_of_its_cost(size: sp.Expr) -> None:
    value = numeric([size * (x - y / 3) ** 2 + size * y**2 / 7])

    def margins(law: sp.Expr) -> Callable[..., list[Any]]:
        chosen = numeric([law])
        return lambda point, rng: [
            value({**point, x: other})[0] - value({**point, x: chosen(point)[0]})[0]
            for other in (point[x], *([chosen(point)[0]] * 2), chosen(point)[0] * (1 - mp.mpf(10) ** -8))
        ]

    assert never_below("least", {x, y}, margins(y / 3)).passed
    assert not never_below("least", {x, y}, margins(y / 3 * (1 + sp.Rational(1, 10**8)))).passed


def test_what_has_no_symbols_is_looked_at_once() -> None:
    seen = []

    def sides(point: Any) -> tuple[list[Any], list[Any]]:
        seen.append(mp.mp.dps)
        return [mp.mpf(10) ** 20 * mp.sqrt(2) ** 2, mp.mpf(10) ** -20], [2 * mp.mpf(10) ** 20, mp.mpf(10) ** -20]

    assert compare("numbers", (), sides).passed
    assert seen == [DIGITS]
    assert identity("numbers", [sp.sqrt(2) ** 2 - 2, sp.Float("0.1", 480) * 3 - sp.Float("0.3", 480)]).passed
    assert not identity("numbers", [sp.Float("0.1", 480) * 3 - sp.Float("0.3", 480) + sp.Float("1e-15", 480)]).passed


def crane(factor: sp.Expr | float) -> Problem:
    variables = [Variable(name, name, "1") for name in ("l", "a", "w", "v", "u1", "u2")]
    length, angle, rate, speed, u1, u2 = symbols_of(tuple(variables))
    rates = {length: speed, angle: rate, speed: u2, rate: -(u1 + factor * angle + 2 * speed * rate) / length}
    model = FirstOrder(
        name="crane",
        title="A load",
        states=tuple(variables[:4]),
        controls=tuple(variables[4:]),
        parameters=(),
        rates=rates,
    )
    return Problem(name="swing", title="To rest", model=model, running_cost=(angle**2 + rate**2) / 2, control_set="box")


@pytest.mark.parametrize("factor", [3, 27, 1e-4, pytest.param(sp.Integer(10) ** 9, marks=pytest.mark.slow)])
def test_singular_arcs_vanish_whatever_the_coefficients(factor: sp.Expr | float) -> None:
    assert "singular_arcs" in derive(crane(factor))


def test_four_thrusters_of_a_linear_cost_derive_and_generate() -> None:
    states = (Variable("r", "r", positive=True), Variable("u", "u"), Variable("v", "v"))
    controls = tuple(Variable(name, name) for name in ("ur1", "ur2", "ut1", "ut2"))
    (r, u, v), (ur1, ur2, ut1, ut2) = symbols_of(states), symbols_of(controls)
    rates = {r: u, u: v**2 / r - 1 / r**2 + ur1 - ur2, v: -u * v / r + ut1 - ut2}
    model = FirstOrder(name="thrust", title="Thrust", states=states, controls=controls, parameters=(), rates=rates)
    problem = Problem(
        name="four", title="Four thrusters", model=model, running_cost=ur1 + ur2 + ut1 + ut2, control_set="box"
    )
    _, found = generated(derive(problem), "four.py")
    assert found.dynamics(0.0, (2.0, 0.5, 1.0), (0.3, 0.1, 0.7, 0.2), ()) == pytest.approx((0.5, 0.45, 0.25))


def linear(*rows: str, inputs: str) -> FirstOrder:
    """A model with a matrix and one input, as text."""
    states = tuple(Variable(f"x{k}", f"x_{k}") for k in range(len(rows)))
    (u,) = symbols_of(controls := (Variable("u", "u"),))
    names = symbols_of(states)
    rates = {
        s: sum((sp.Rational(a) * other for a, other in zip(row.split(), names, strict=True)), sp.Rational(b) * u)
        for s, row, b in zip(names, rows, inputs.split(), strict=True)
    }
    return FirstOrder(name="matrix", title="A matrix", states=states, controls=controls, parameters=(), rates=rates)


@pytest.mark.parametrize(
    ("model", "verdict"),
    [
        (linear("-0.71707317 0 0", "0 0 1", "15.77 0 0", inputs="0 0 1"), "unstable"),
        (linear("0 0", "0 0", inputs="0 0"), "marginally stable"),
        (linear("0 1", "-4 0", inputs="0 0"), "marginally stable"),
        (linear("0 1 0", "-4 0 0", "0 0 0", inputs="0 0 1"), "marginally stable"),
    ],
)
def test_matrices_of_numbers_are_analysed(model: FirstOrder, verdict: str) -> None:
    assert verdict in str(satsym.analyse(model))
