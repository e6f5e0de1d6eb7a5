"""Factors by FLINT are those of sympy, written alike."""

from __future__ import annotations

import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from satsym.symbolic.decimals import DIGITS
from satsym.symbolic.factoring import factored

x, y, z = sp.symbols("x y z", real=True)
k = sp.Symbol("k", positive=True)
NUMBERS = st.fractions(-9, 9, max_denominator=6).map(lambda q: sp.Rational(q.numerator, q.denominator))
ATOMS = st.sampled_from([x, y, z, k, sp.sqrt(k), sp.sin(x), sp.exp(-y), 1 / k])
TERMS = st.builds(lambda c, atoms: c * sp.Mul(*atoms), NUMBERS, st.lists(ATOMS, max_size=3))
SUMS = st.lists(TERMS, min_size=1, max_size=4).map(lambda terms: sp.Add(*terms))


@given(st.lists(SUMS, min_size=1, max_size=3), SUMS)
def test_a_product_that_was_multiplied_out_is_found_again_as_sympy_writes_it(factors: list[sp.Expr], beside: sp.Expr):
    for expression in (sp.expand(sp.Mul(*factors)), sp.Mul(*factors) + beside):
        assert str(factored(expression)) == str(sp.factor(expression))


@pytest.mark.parametrize(
    "expression",
    [
        -x * y**2 + z,
        x**2 / 2 + y**2 / 2,
        -x * y / 2 - z / 2,
        (2 * x * (x + 3 * y) + y * (y - 2 * x)) * sp.exp(-k * (z - 1)) / k**3,
        (x**2 - y**2) ** 2 / (x**2 + 2 * x * y + y**2),
        sp.sqrt(x**2 + 2 * x * y + y**2 + 1) * (x**2 - 1),
        sp.Integer(0),
        sp.Rational(2, 3),
        x * (x + 1) - x**2 - x,
        (x * (y + 1) - x * y - x + 2) * y / 3,
        (x**2 + 1) / (x + sp.I),
    ],
)
def test_forms_are_those_of_sympy(expression: sp.Expr):
    assert str(factored(expression)) == str(sp.factor(expression))
    assert factored(expression) == sp.factor(expression)


def test_the_factors_of_a_long_product_are_found():
    product = (x + 2 * y - z) * (x * y - k) ** 2 * (x**2 + y * z + 1) / (x - k)
    assert factored(sp.together(sp.expand(product))) == product


def test_high_powers_of_many_symbols_take_no_place_for_those_that_are_missing():
    a, b, c, d = sp.symbols("a b c d", real=True)
    factors = (a**150 + x, b**150 + y, c**150 + z, d**150 + k)
    assert set(factored(sp.expand(sp.Mul(*factors))).args) == set(factors)


def test_decimals_are_letters_in_what_is_factored(monkeypatch: pytest.MonkeyPatch):
    share = sp.Float("0.659605378721157", DIGITS) ** 2 / 11100
    asked, ask = [], sp.factor
    monkeypatch.setattr(sp, "factor", lambda e: asked.append(e) or ask(e))
    cases = [
        (share * x**2 - share * y**2, (x - y) * (x + y)),
        (3 * share * x * y - share / 2 * y, y * (6 * x - 1)),
        (1.5 * x**2 - 3 * x, x * (1.5 * x - 3)),
    ]
    for expression, factors in cases:
        for found in (factored(expression), factored(expression)):
            assert found.as_coeff_Mul()[1] == factors
            assert sp.expand(found) == expression
    assert not asked


def test_exponentials_of_decimal_exponents_are_no_polynomials_of_a_huge_degree() -> None:
    slow, fast = sp.exp(-sp.Rational(564783, 86400) * k), sp.exp(-2 * k)
    product = (slow + 3 * x) * (fast - y) * (x + 2)
    assert sp.expand(factored(sp.expand(product)) - product) == 0
    assert len(sp.Mul.make_args(factored(sp.expand(product)))) >= 3
