"""A limit on sympy's search for the sign of a sum, which may take hours.

Wherever zero times something is written, sympy asks whether that is finite, thus whether a divisor may vanish. For a
polynomial in one symbol of known sign it then finds all roots of the derivative, by way of the prime factors of the
coefficients. Coefficients that were decimals have hundreds of digits.
"""

from __future__ import annotations

import sympy as sp
from sympy.core import exprtools

LARGEST_COEFFICIENT = 2**64
"""Largest integer coefficient of a polynomial whose roots SymPy may compute in order to find its sign."""

_sign = exprtools._monotonic_sign


def keep_short() -> None:
    """Make sympy answer that it does not know the signs of polynomials with long coefficients.

    Sympy gives this answer for most sums, and nothing may rely on more.
    """
    exprtools._monotonic_sign = _sign_or_none


def _sign_or_none(expression: sp.Expr) -> sp.Expr | None:
    return None if _has_long_coefficients(expression) else _sign(expression)


def _has_long_coefficients(expression: sp.Expr) -> bool:
    """Tell whether an expression is a polynomial in one symbol, of degree at least three, with long coefficients."""
    free = expression.free_symbols
    if not expression.is_Add or len(free) != 1 or not expression.is_polynomial(*free):
        return False
    polynomial = sp.Poly(expression, *free)
    if polynomial.degree() < 3 or expression.has(sp.Float):
        return polynomial.degree() >= 3
    exact = polynomial.domain.is_ZZ or polynomial.domain.is_QQ
    return exact and polynomial.clear_denoms(convert=True)[1].max_norm() > LARGEST_COEFFICIENT
