"""What is simplified without asking sympy is what sympy would say; roots are counted whatever their multiplicity."""

from __future__ import annotations

import mpmath as mp
import pytest
import sympy as sp
from sympy import cos, sin, sqrt

from satsym.symbolic.algebra import simplified, tidy, vanishes
from satsym.symbolic.checks import identity
from satsym.symbolic.linear.matrices import right_half_plane

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
    tenth, rest = (sp.Float(text, 60) for text in ("0.1", "0.001"))
    cancels = (z + tenth) ** 3 - z**3 - 3 * tenth * z**2 - 3 * tenth**2 * z - rest
    for off, right in ((0, True), (sp.Float("1e-13", 60) * z, False)):
        assert identity("decimals", [factor * (cancels + off)]).passed == right
