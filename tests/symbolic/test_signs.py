"""Signs of polynomials with long coefficients are unknown at once; those of short ones are known as ever."""

from __future__ import annotations

import pytest
import sympy as sp

from satsym.symbolic.decimals import DIGITS

x = sp.Symbol("x", positive=True)


def decimal(text: str) -> sp.Expr:
    """As a derivation has it."""
    return sp.Float(text, DIGITS)


def asked(monkeypatch: pytest.MonkeyPatch) -> list[sp.Expr]:
    """The polynomials of which sympy takes the roots from now on."""
    found: list[sp.Expr] = []
    monkeypatch.setattr("sympy.polys.polytools.real_roots", lambda polynomial: found.append(polynomial) or [])
    return found


@pytest.mark.parametrize(
    "polynomial",
    [
        decimal("0.1764") * x**4 - decimal("1.4112") * x**3 + decimal("5.0736") * x**2 - decimal("9.0048") * x + 7,
        10**30 * x**4 - (3**60 + 1) * x**3 + sp.Rational(5**40, 7**50) * x - 1,
    ],
)
def test_no_roots_are_taken_of_polynomials_with_long_coefficients(
    polynomial: sp.Expr, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = asked(monkeypatch)
    assert polynomial.is_positive is None
    assert 0 * polynomial**-2 == 0
    assert not found


def test_signs_of_short_polynomials_are_known(monkeypatch: pytest.MonkeyPatch) -> None:
    assert (x**3 + x + 1).is_positive
    assert (decimal("0.5") * x**2 + decimal("0.1") * x + 1).is_positive
    found = asked(monkeypatch)
    assert (2 * x**3 - 3 * x**2 - 7).is_positive is None
    assert found
