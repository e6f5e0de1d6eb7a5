"""Decimal numbers of an author, kept exact so that rounding never decides a comparison.

Sympy keeps 15 digits of a float; multiplied out, and in exponentials and roots, they differ by more than checks allow.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import fields, is_dataclass, replace
from fractions import Fraction
from functools import lru_cache
from typing import Any, TypeVar

import sympy as sp

from satsym.agreement import MOST_DIGITS
from satsym.spec import Variable
from satsym.symbolic.model import Model

T = TypeVar("T")

DIGITS = 2 * MOST_DIGITS
"""Digits of a decimal: twice the largest number of digits in checks."""

CERTAIN = 400
"""Number of digits of a long decimal that are still correct after a few multiplications."""

LARGEST_RATIO_NUMBER = 20
"""Largest numerator and denominator of the ratio of two decimals that share a symbol."""


def lengthened(stated: T) -> T:
    """Return a problem or model with its decimals replaced by exact values; itself where it has none."""

    def exact(e: Any) -> Any:
        if isinstance(e, float):
            return sp.Float(repr(e), DIGITS)
        decimals = {number: sp.Float(repr(float(number)), DIGITS) for number in e.atoms(sp.Float)}
        return e.xreplace(decimals) if decimals else e

    return everywhere(stated, exact)


def as_fractions(expression: sp.Expr) -> sp.Expr:
    """Replace decimals by fractions: sums of decimals hardly ever cancel, and polynomials in them have no factors."""
    return expression.xreplace({decimal: _fraction(decimal) for decimal in expression.atoms(sp.Float)})


@lru_cache(maxsize=1024)
def _fraction(decimal: sp.Float) -> sp.Rational:
    """Return the fraction with the smallest denominator that has these decimal digits.

    A third of 0.1 becomes 1/30, and no number of 400 digits. Where there is no such fraction, as for a root, the digits
    are taken.
    """
    exact = Fraction(*map(int, sp.Rational(decimal).as_numer_denom()))
    near = exact.limit_denominator(10 ** (CERTAIN // 3))
    if abs(exact - near) <= abs(exact) / 10**CERTAIN:
        return sp.Rational(near.numerator, near.denominator)
    return sp.Rational(str(sp.Float(decimal, CERTAIN)))


def as_decimals(expression: sp.Expr) -> sp.Expr:
    """Replace the fractions of an expression by decimals, except in exponents, where they are roots."""
    if expression.is_Rational and not expression.is_Integer:
        return sp.Float(expression, DIGITS)
    if not expression.args:
        return expression
    if expression.is_Pow:
        return sp.Pow(as_decimals(expression.base), expression.exp)
    return expression.func(*map(as_decimals, expression.args))


def with_letters(function: Callable[[sp.Expr], sp.Expr], expression: sp.Expr) -> sp.Expr:
    """Apply a function of sympy to an expression whose decimals were replaced by letters.

    Sympy turns polynomials with decimals into ones with long whole numbers, whose factors it may seek for hours.
    """
    letters, decimals = _lettered(expression.atoms(sp.Float))
    return function(expression.xreplace(letters)).xreplace(decimals)


def _lettered(decimals: Iterable[sp.Float]) -> tuple[dict[sp.Float, sp.Expr], dict[sp.Symbol, sp.Float]]:
    """Map decimals to positive symbols: return the symbol of each decimal, and the value of each symbol.

    Decimals whose ratio is a fraction of small numbers share a symbol.
    """
    letters: dict[sp.Float, sp.Expr] = {}
    meant: dict[sp.Symbol, sp.Float] = {}
    for decimal in sorted(decimals, key=lambda d: (abs(d), d)):
        multiples = ((letter, _small_ratio(decimal / of)) for letter, of in meant.items())
        found = next((letter * ratio for letter, ratio in multiples if ratio is not None), None)
        if found is None:
            letter = sp.Dummy(f"d{len(meant)}", positive=True)
            meant[letter] = abs(decimal)
            found = letter if decimal > 0 else -letter
        letters[decimal] = found
    return letters, meant


def _small_ratio(quotient: sp.Float) -> sp.Rational | None:
    """Return the fraction of small whole numbers that a quotient of decimals equals, except for rounding."""
    exact = Fraction(*map(int, sp.Rational(quotient).as_numer_denom()))
    near = exact.limit_denominator(LARGEST_RATIO_NUMBER)
    close = 0 < abs(near.numerator) <= LARGEST_RATIO_NUMBER and abs(exact - near) <= abs(exact) / 10**CERTAIN
    return sp.Rational(near.numerator, near.denominator) if close else None


def everywhere(stated: T, changing: Callable[[Any], Any]) -> T:
    """Apply a change to all expressions and matrices of a problem or model; return itself where none changes.

    Parameters
    ----------
    changing
        Gives back the very expression that it does not change.
    """
    found: T = _everywhere(stated, changing)
    return found


def _everywhere(stated: Any, changing: Callable[[Any], Any]) -> Any:
    if isinstance(stated, sp.Basic | sp.MatrixBase | float):
        return changing(stated)
    parts = _parts(stated)
    changed = {key: new for key, part in parts.items() if (new := _everywhere(part, changing)) is not part}
    if not changed:
        return stated
    if isinstance(stated, Mapping):
        return {**stated, **changed}
    if isinstance(stated, tuple):
        return tuple({**parts, **changed}.values())
    return replace(stated, **changed)


def _parts(stated: Any) -> dict[Any, Any]:
    """Return the parts of something declared; the model that another one is derived from is not one of them."""
    if isinstance(stated, Mapping):
        return dict(stated)
    if isinstance(stated, tuple):
        return dict(enumerate(stated))
    if is_dataclass(stated) and not isinstance(stated, Variable | type):
        found = {field.name: getattr(stated, field.name) for field in fields(stated) if field.init}
        return {k: v for k, v in found.items() if not (isinstance(stated, Model) and isinstance(v, Model))}
    return {}
