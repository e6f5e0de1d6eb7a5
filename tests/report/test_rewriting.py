"""Expressions in shorter words mean the same, and are the ones that people write."""

from __future__ import annotations

import pytest
import sympy as sp

from satsym.symbolic.latex.printer import Kind, Printer
from satsym.symbolic.latex.rewriting import readable

a, b, x, y = sp.symbols("a b x y", real=True)
p, q = sp.symbols("p q", positive=True)
NAMES = "abxypq"
PRINTER = Printer({n: n for n in NAMES}, {n: (Kind.MOTION, k) for k, n in enumerate(NAMES)})


@pytest.mark.parametrize(
    ("expression", "short"),
    [
        (a * x**2 - 2 * a * x * y + a * y**2 + b, r"a (x - y)^{2}"),
        (p**2 + q**2 - 2 * p * x + x**2, "(x - p)^{2}"),
        (b * (sp.cos(x) - sp.sin(x)) * (sp.cos(x) + sp.sin(x)) / a, r"\\cos (2 x)"),
        (sp.exp(a) * sp.exp(-a * x) * b, "e^{"),
        (sp.exp(-x) * (1 + 2 * sp.exp(x)), "2 + e^{- x}"),
        (2 / p - 2 * sp.cos(x) / p, "1 - cos"),
        (a * x / p + b * y / p, "a x + b y"),
    ],
)
def test_shorter_words_mean_the_same(expression: sp.Expr, short: str) -> None:
    found = readable(expression)
    assert sp.count_ops(found) < sp.count_ops(expression)
    numbers = {a: 0.3, b: -1.7, x: 0.8, y: 2.1, p: 1.3, q: 0.4}
    assert abs(sp.N((found - expression).subs(numbers))) < 1e-12


def test_fractions_that_share_more_than_what_is_below_stay_apart() -> None:
    total = a * x / p + a * y / p
    assert readable(total) == total


def test_numbers_stay_before_sums_in_what_is_not_rewritten() -> None:
    total = -(p**2 + q**2) / 2 + a * x + b * y
    unsummed = sp.Add(sp.Mul(-sp.Rational(1, 2), p**2 + q**2, evaluate=False), a * x, b * y)
    assert readable(unsummed) == unsummed
    assert sp.expand(unsummed - total) == 0


@pytest.mark.parametrize(
    ("expression", "printed"),
    [
        (1 / (x - 1), r"-\frac{1}{1 - x}"),
        (p / (b - a), r"-\frac{p}{a - b}"),
        ((b - a) ** 2, "(a - b)^{2}"),
        (sp.sqrt(p) * x / sp.sqrt(q), r"x \sqrt{p/q}"),
        (sp.sqrt(2) * sp.sqrt(p), r"\sqrt{2 p}"),
        (p ** sp.Rational(307, 100) / q ** sp.Rational(307, 100), r"\Bigl(\frac{p}{q}\Bigr)^{3.07}"),
        (sp.Rational(307, 100) * x, "3.07 x"),
        (sp.Abs(p * x - 1), r"\left|{1 - x p}\right|"),
        (a * sp.Max(0, x) / b, r"\frac{a}{b} \max"),
    ],
)
def test_powers_and_fractions_are_written_as_people_do(expression: sp.Expr, printed: str) -> None:
    assert PRINTER.doprint(PRINTER.normalised(readable(expression))).startswith(printed)


@pytest.mark.parametrize(
    ("expression", "printed"),
    [
        (-x * (b - a) / p, r"\frac{x}{p} (a - b)"),
        (sp.Mul(-1, b - a, x**2), "x^{2} (a - b)"),
        ((b - a) * (y**2 - a * x - b * x), "(a - b) (a x + b x - y^{2})"),
        (sp.Mul(-1, 1 - a, 1 - x), "(1 - a) (x - 1)"),
        (sp.Mul(-1, 1 - a, b - x), "(1 - a) (x - b)"),
        (-x * (a - b) / p, r"-\frac{x}{p} (a - b)"),
        (-p * (x**2 - a), "-p (x^{2} - a)"),
        (y - x * (b - a), "y - x (b - a)"),
        ((b - a) / p, r"\frac{b - a}{p}"),
    ],
)
def test_no_product_begins_with_a_minus_before_a_sum_that_is_turned_round(expression: sp.Expr, printed: str) -> None:
    assert " ".join(t.signed(first=k == 0) for k, t in enumerate(PRINTER.terms(expression))) == printed
    assert PRINTER.doprint(expression) == printed
