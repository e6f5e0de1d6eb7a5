"""What is simplified without asking sympy is what sympy would say; roots are counted whatever their multiplicity."""

from __future__ import annotations

from collections.abc import Callable

import mpmath as mp
import pytest
import sympy as sp
from sympy import cos, sin, sqrt

from satsym.symbolic import FirstOrder, Problem, Variable
from satsym.symbolic.algebra import (
    COMMON,
    PROVABLE,
    depends,
    shortened,
    simplified,
    simplify,
    terms_of,
    terms_over,
    tidy,
    vanishes,
)
from satsym.symbolic.checks import identity, numeric, points
from satsym.symbolic.decimals import CERTAIN, DIGITS, as_decimals, as_fractions, lengthened
from satsym.symbolic.linear.matrices import right_half_plane
from tests.support.distance import deviation

x, y = sp.symbols("x y", positive=True)
q = sp.Symbol("q", real=True)


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        (x * cos(q) ** 2 + x * sin(q) ** 2, x),
        (x * cos(q) ** 4 - x * sin(q) ** 4 + 2 * x * sin(q) ** 2, x),
        ((cos(q) ** 2 - 1) / x + sin(q) ** 2 / x, sp.Integer(0)),
        (x**2 / sqrt(x**2 + y**2) + y**2 / sqrt(x**2 + y**2), sqrt(x**2 + y**2)),
        (cos(q) ** -2 - sin(q) ** 2 / cos(q) ** 2, sp.Integer(1)),
        (cos(q + x) ** 2 + sin(q + x) ** 2 + cos(q) ** 3 / cos(q) ** 3, sp.Integer(2)),
        (y / x * (x**2 - y**2) / (x - y), y * (x + y) / x),
    ],
)
def test_what_cancels_is_simplified_away(expression: sp.Expr, expected: sp.Expr) -> None:
    assert tidy(simplified(expression)) == tidy(sp.simplify(expression)) == tidy(expected)


def test_what_vanishes_is_told_from_what_does_not() -> None:
    assert vanishes(x / (x + y) + y / (x + y) - 1)
    assert vanishes(cos(q) ** 2 + sin(q) ** 2 - 1)
    assert not vanishes(x / (x + y) + y / (x + y) - 2)
    assert not vanishes(cos(q) ** 2 - sin(q) ** 2 - 1)


@pytest.mark.parametrize(
    ("roots", "expected"),
    [
        ([0, 0, 1j, -1j, 1j, -1j], (0, 6)),
        ([2, 2, 2, -1], (3, 0)),
        ([1e-9, -1e-9, 3j, -3j], (1, 2)),
        ([0], (0, 1)),
        ([2], (1, 0)),
        ([-2], (0, 0)),
        ([-1e6, 1e-6], (1, 0)),
    ],
)
def test_roots_are_counted_by_the_side_they_lie_on(roots: list[complex], expected: tuple[int, int]) -> None:
    with mp.workdps(30):
        coefficients = [mp.mpf(1)]
        for root in roots:
            longer = [*coefficients, mp.mpf(0)]
            coefficients = [a - mp.mpmathify(root) * b for a, b in zip(longer, [0, *coefficients], strict=True)]
        assert right_half_plane([mp.mpf(7) * mp.re(c) for c in coefficients]) == expected


@pytest.mark.parametrize("factor", [sp.Integer(1), sp.Symbol("q", real=True), sin(sp.Symbol("q", real=True))])
def test_decimals_that_cancel_but_for_rounding_vanish_in_products_too(factor: sp.Expr) -> None:
    z = sp.Symbol("z", real=True)
    tenth, rest = (sp.Float(text, DIGITS) for text in ("0.1", "0.001"))
    cancels = (z + tenth) ** 3 - z**3 - 3 * tenth * z**2 - 3 * tenth**2 * z - rest
    for off, right in ((0, True), (sp.Float("1e-13", DIGITS) * z, False)):
        assert identity("decimals", [factor * (cancels + off)]).passed == right


def test_what_an_expression_depends_on_is_seen_although_it_is_written_with_more() -> None:
    expression = x * (cos(q) ** 2 + sin(q) ** 2) + y
    assert not depends(expression, [q])
    assert depends(expression, [q, x])
    assert not depends(sp.Integer(3), [x])


def test_terms_are_counted_before_they_are_multiplied_out() -> None:
    for expression in ((x + y + q) ** 4, (x + 1) * (y + 2) * (q + 3) + x**7, x * y / (x + y) ** 3, x):
        numerator, denominator = sp.fraction(expression)
        expected = len(sp.Add.make_args(sp.expand(numerator))) * len(sp.Add.make_args(sp.expand(denominator)))
        assert terms_of(expression) == expected
    assert terms_of(x * sin((x + y) ** 3)) == 4


def test_terms_over_a_common_denominator_are_counted_before_they_are_multiplied_out() -> None:
    for expression in (x / (x + y) + y / (x + q), (x + y) / (1 + x) ** 3 - 2 / (1 + x), q / x + x / q, x + y):
        assert terms_over(expression) >= len(sp.Add.make_args(sp.numer(sp.cancel(expression))))
    assert terms_over(1 / (x + y) + 1 / (x + y) ** 2) == 3
    assert terms_over(1 / sqrt(1 + x) ** 5 + sin(q)) == 1 + 4


@pytest.mark.parametrize("function", [sp.Symbol("w"), sp.tanh(q), cos(y)])
def test_long_fractions_are_cancelled_and_sympy_is_not_asked(
    function: sp.Expr, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sp, "simplify", lambda expression: pytest.fail(f"asked for {expression}"))
    below = {k: k * x + function**2 + y + 1 for k in range(1, 5)}
    long = sp.Add(*(k * y * (x + k * function**2) / of for k, of in below.items()))
    same = sp.Add(*(k * y - k * y * (of - x - k * function**2) / of for k, of in below.items()))
    assert terms_over(long) > COMMON
    assert shortened(long).count_ops() <= long.count_ops()
    assert shortened(long - same) == 0
    assert vanishes(long - same)
    assert not vanishes(long - same * (1 + x / 10**9))


@pytest.mark.slow
def test_what_would_grow_when_multiplied_out_is_parted_by_what_it_is_linear_in_and_no_more() -> None:
    lam = sp.symbols("lambda_1:3", real=True)
    long = (1 + x + y + q + x * q) ** 8
    expression = lam[0] * long * (lam[1] + 2) + lam[1] * sin(long) + 1 / (1 + long)
    found = tidy(expression, lam)
    assert found.count_ops() < 2 * expression.count_ops()
    assert {term for term in sp.Add.make_args(found) if term.has(lam[0])} == {
        term for term in sp.Add.make_args(found) if term.coeff(lam[0]) != 0
    }
    sides = numeric([found, expression])
    with mp.workdps(30):
        assert all(deviation(*([value] for value in sides(p))) < 1e-25 for p in points({x, y, q, *lam}, "parted"))


def test_sympy_is_not_asked_to_rewrite_many_sines_at_length_unless_they_may_cancel(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked = []
    monkeypatch.setattr(sp, "simplify", lambda expression: asked.append(expression) or sp.Integer(0))
    waves = sp.Add(*(sin(k * q) * cos(x + k * y) / (x + k) ** 2 for k in range(1, 9)))
    assert shortened(waves) == waves
    assert not asked
    doubled = 2 * sin(q) * cos(q) - sin(2 * q)
    assert shortened(waves * doubled) == 0
    assert asked


@pytest.mark.parametrize(("off", "right"), [(0, True), (sp.Rational(1, 10**9), False)])
def test_identities_too_long_to_be_multiplied_out_are_decided_by_numbers(off: sp.Expr, right: bool) -> None:
    one, other = (1 + x + y) ** 60, (1 + q + x * q) ** 2
    expression = one * other * (1 + off * x) - one * (1 + 2 * q * (1 + x) + q**2 * (1 + x) ** 2)
    assert terms_of(expression) > PROVABLE
    assert identity("long", [expression]).passed == right


def test_decimals_are_fractions_and_back() -> None:
    a, b, c = (sp.Float(text, DIGITS) for text in ("20.967", "0.47", "6.265"))
    expression = sqrt(x) * (a * x * y + b * c * y) ** 2 + sp.exp(-b * q)
    fractions = as_fractions(sp.expand(expression))
    assert not fractions.has(sp.Float)
    assert sp.factor(fractions.coeff(sp.exp(-sp.Rational(47, 100) * q))) == 1
    assert sp.simplify(fractions - as_fractions(expression)) == 0
    again = as_decimals(fractions)
    assert {r.q for r in again.atoms(sp.Rational)} == {1, 2}  # exponents that are roots stay so
    sides = numeric([again, expression])
    with mp.workdps(30):
        assert all(deviation(*([value] for value in sides(p))) < 1e-25 for p in points({x, y, q}, "decimals"))


def test_a_decimal_that_was_divided_is_the_fraction_that_it_is() -> None:
    a, b = (sp.Float(text, DIGITS) for text in ("0.3", "8.494359976797647"))
    exact = sp.Rational("8.494359976797647")
    assert as_fractions(a / 6500 * x) == sp.Rational(3, 65000) * x
    assert as_fractions(b**3 / 6500**4 * sp.Rational(89, 7)) == exact**3 / 6500**4 * sp.Rational(89, 7)
    assert as_fractions(sp.Float("1.5e-250", DIGITS)) == sp.Rational("1.5e-250")
    assert abs(as_fractions(sqrt(a)) ** 2 / sp.Rational(3, 10) - 1) < sp.Rational(1, 10**CERTAIN)


@pytest.mark.parametrize("make", [tidy, simplified, shortened])
def test_an_exponential_with_a_decimal_in_it_is_no_high_power_of_another(make: Callable[[sp.Expr], sp.Expr]) -> None:
    """With fractions for decimals sympy takes exp(2.34121812381485 q) for the power 46824362476297 of a root of exp."""
    steep = sp.exp(-sp.Rational("2.34121812381485") * q**2)
    assert make((steep * x + steep**3 / y) / steep - x - steep**2 / y).xreplace({q: sp.Rational(3, 7)}).evalf() == 0
    assert make(steep**2 - sp.exp(-sp.Rational("4.6824362476297") * q**2)) == 0
    assert simplified((1 + steep) ** 2 - 1 - 2 * steep - steep**2) == 0
    assert simplified((steep - 2 * steep**2) / (1 - 2 * steep)) == steep


def test_a_hyperbolic_function_next_to_exponentials_is_a_letter_to_sympy() -> None:
    """Sympy takes minutes for the factors of what has both, in complex numbers."""
    h, faded = sp.tanh(q / 80), sp.exp(-0.010000000000000002 * q)
    k2, k4, v, l1, l2 = sp.symbols("k2 k4 v l1 l2", real=True)
    slope = 30000.0 * k2 * v**2 + 20000.0 * k2 * v + 30000.0 * v**2 + 20000.0 * v
    rate = (v + 1) * (-10000.0 * k2 * v**2 - 10000.0 * v**2) + sp.Rational(15525180, 97) * h + faded * 66 / 97
    u = sp.Rational(3286969, 1000000) / k4
    drift = sp.Rational(776259, 388) * (1 - h**2) - sp.Float("0.0068041237113402", DIGITS) * faded
    given = v * drift - slope * (rate - u * l2) - u * (slope * l2 - l1)
    at = {q: sp.Rational(1, 3), v: sp.Rational(1, 7), k2: sp.Rational(2, 5), k4: 3, l1: 5, l2: 7}
    assert abs((simplified(given) / given).subs(at).evalf() - 1) < 1e-12


def test_one_hyperbolic_function_is_a_letter_to_sympy() -> None:
    """Its search for identities takes minutes where there are none."""
    h = sp.tanh(q)
    long = sum(k * y * (x + h**2) / (k * h**2 * x + h**2 + y + 1) ** (k % 2 + 1) for k in range(1, 6))
    assert vanishes((1 + h**2) / (1 + h) - (1 + h**2) ** 2 / (1 + h + h**2 + h**3))
    assert shortened(long).has(h)
    assert vanishes(sp.cosh(q) ** 2 - sp.sinh(q) ** 2 - 1)
    assert vanishes(sp.sinh(q) - h * sp.cosh(q))
    assert vanishes(sp.cosh(q) - (sp.exp(q) + sp.exp(-q)) / 2)


def test_a_cosine_of_what_no_other_has_is_a_letter_to_sympy(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of products with others it would make sums, and of these products again."""
    z, w = sp.symbols("z w", real=True)
    asked, ask = [], sp.simplify
    monkeypatch.setattr(sp, "simplify", lambda e: asked.append(e) or ask(e))
    quotient = z**2 / 6 - 2 * z / 3 + sp.Rational(5, 3)
    expression = x * sp.exp(sin(q)) * sin(w / 3) + (5 * cos(y + z / quotient - 2 / quotient) + q**2) * cos(q)
    found = shortened(expression)
    assert not asked[-1].atoms(sp.Symbol) & {w, z}
    assert vanishes(found - expression)
    assert shortened(sin(q) * cos(z) + cos(q) * sin(z)) == sin(q + z)


def test_an_exponential_of_a_sine_is_a_letter_to_sympy_unless_it_may_cancel(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its search for identities of what stands in the exponent and beside it may not end."""
    asked, ask = [], sp.simplify
    monkeypatch.setattr(sp, "simplify", lambda e: asked.append(e) or ask(e))
    angle = (y - q / 3) / (1 + y**2)
    steep = sp.exp(sin(angle))
    expression = (
        (x * (1 + y**2) * steep - cos(angle) * steep - 2 * cos(angle)) / steep / (1 + y**2) ** sp.Rational(5, 2)
    )
    found = shortened(expression)
    assert not any(e.args[0].has(sin) for each in asked for e in each.atoms(sp.exp))
    sides = numeric([found, expression])
    with mp.workdps(30):
        assert all(deviation(*([value] for value in sides(p))) < 1e-25 for p in points({x, y, q}, "letters"))
    assert shortened(steep**2 / steep - steep) == 0
    assert shortened(sp.exp(sin(q) ** 2) * sp.exp(cos(q) ** 2) - sp.E) == 0


def test_an_exponential_that_divides_by_a_sum_is_a_letter_to_sympy(monkeypatch: pytest.MonkeyPatch) -> None:
    """Multiplied by the denominators in its exponent it would be a power of ten thousands."""
    asked, ask = [], sp.simplify
    monkeypatch.setattr(sp, "simplify", lambda e: asked.append(e) or ask(e))
    bell, again = sp.exp(-(y**2) / (y**2 + sp.Rational(612359, 86400))), sp.exp(-86400 * y**2 / (86400 * y**2 + 612359))
    expression = x * (q + 1) * (q + 3 * y) * cos(q) * again / sin(q) + 24 * (q + 1) * bell / 10
    found = shortened(expression)
    assert not any(each.has(sp.exp) for each in asked)
    sides = numeric([found, expression])
    with mp.workdps(30):
        assert all(deviation(*([value] for value in sides(p))) < 1e-25 for p in points({x, y, q}, "letters"))
    assert shortened(x * bell - x * again) == 0


def test_sines_of_which_none_multiplies_another_are_letters_to_sympy(monkeypatch: pytest.MonkeyPatch) -> None:
    """It would seek angles of sums in vain, and factors of all that comes of it."""
    asked, ask = [], sp.simplify
    monkeypatch.setattr(sp, "simplify", lambda e: asked.append(e) or ask(e))
    expression = y * sin(q) + x * sin(1 / (q**2 + y**2)) * q / (q**4 + y) + q / sqrt(1 + q**2)
    found = shortened(expression)
    assert not asked[-1].has(sin)
    assert vanishes(found - expression)
    assert shortened(sin(q) ** 2 + y * cos(q) + cos(q) ** 2) == 1 + y * cos(q)
    assert shortened(2 * sin(q + x) - 2 * sin(x + q)) == 0


def test_sympy_simplifies_letters_in_place_of_decimals(monkeypatch: pytest.MonkeyPatch) -> None:
    third, other = sp.Float("0.659605378721157", DIGITS) ** 2 / 11100, sp.Float("5.205", DIGITS)
    expression = third * x / (1 + sin(q) ** 2) + third / 2 * x * cos(q) ** 2 + third / 2 * x * sin(q) ** 2
    asked, ask = [], sp.simplify
    monkeypatch.setattr(sp, "simplify", lambda e: asked.append(e) or ask(e))
    found = simplify(expression - other * y)
    assert not asked[0].atoms(sp.Float)
    assert len(asked[0].free_symbols) == len({x, y, q}) + 2  # a half is no other letter
    assert not found.has(cos)
    sides = numeric([found, expression - other * y])
    with mp.workdps(30):
        assert all(deviation(*([value] for value in sides(p))) < 1e-25 for p in points({x, y, q}, "letters"))


def test_matrices_with_decimals_are_simplified_entry_by_entry() -> None:
    third = sp.Float("0.3", DIGITS)
    found = simplify(sp.Matrix([[third * x * cos(q) ** 2 + third * x * sin(q) ** 2, x - x], [y, third * x / x]]))
    assert found == sp.Matrix([[third * x, 0], [y, third]])


@pytest.mark.parametrize("difference", ["0.3", "0.30000000000000001"])
def test_decimals_that_cancel_are_not_taken_apart(difference: str) -> None:
    one, two, three = (sp.Float(text, DIGITS) for text in ("0.1", "0.2", difference))
    expression = x * (one + two * cos(q) ** 2) + two * x * sin(q) ** 2 - three * x
    assert vanishes(as_fractions(expression)) == (difference == "0.3")
    assert (abs(simplify(expression).xreplace({x: sp.Integer(1)})) < 1e-30) == (difference == "0.3")


def test_a_decimal_alone_is_what_is_written() -> None:
    """Were it a float of Python, six times of it would be rounded where sixths of steps are taken."""
    model = FirstOrder(name="m", title="", states=(Variable("x", "x"),), controls=(), parameters=(), rates={q: 0.1})
    stated = Problem(name="p", title="", model=model, running_cost=0.1, terminal_cost=q + 0.25)
    found = lengthened(stated)
    assert found.running_cost == found.model.rates[q] == sp.Float("0.1", DIGITS)
    assert 6 * found.running_cost == sp.Float("0.6", DIGITS)
