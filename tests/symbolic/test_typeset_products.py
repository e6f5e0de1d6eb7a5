"""Numbers of a product as they are written before and below its fraction line."""

from __future__ import annotations

import pytest
import sympy as sp

from satsym.symbolic.latex.products import take_apart

x, y = sp.symbols("x y", real=True)


@pytest.mark.parametrize(
    ("expression", "number", "below"),
    [
        (sp.Float("0.3") * x * (x / 100 + y / 100), "0.003", 1),
        (x * (x / 100 + y / 100), "0.01", 1),
        (sp.Float("0.3") * x * (x / 7 + y / 7), "0.3", 7),
        (x * (x / 7 + y / 7), "1", 7),
    ],
)
def test_a_decimal_times_hundredths_is_one_decimal(expression: sp.Expr, number: str, below: int) -> None:
    parts = take_apart(expression)
    assert abs(parts.number - sp.Rational(number)) < 1e-15
    assert parts.number_below == below
