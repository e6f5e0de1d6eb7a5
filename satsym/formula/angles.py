"""Arguments of exponentials and angles, expanded to sums of rational multiples of products of symbols."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import TypeAlias

from satsym.formula.tree import Add, Div, Mul, Neg, Node, Num, Pow, Sym, constant
from satsym.formula.writing import written


class TooManyTerms(Exception):
    """An angle, or an exponent, has too many terms to be expanded."""


Complex: TypeAlias = tuple[Fraction, Fraction]
Monomial: TypeAlias = tuple[tuple[str, Fraction], ...]
"""The factors of a product, as names or texts with exponents, sorted."""

HALF_TURNS: Monomial = (("pi", Fraction(1)),)
PARTS = 12
"""Largest denominator of a coefficient of an angle."""
_ONE: Complex = (Fraction(1), Fraction(0))
_MOST_TERMS = 200


@dataclass(frozen=True)
class Terms:
    """A sum that maps products of symbols to complex rational coefficients, none of them zero."""

    coefficients: Mapping[Monomial, Complex]

    def plus(self, other: Terms) -> Terms:
        """Return the sum of two sums."""
        total = dict(self.coefficients)
        for key, coefficient in other.coefficients.items():
            _enter(total, key, coefficient)
        return Terms(total)

    def times_i(self) -> Terms:
        """Return the sum times the imaginary unit."""
        return Terms({key: (-imaginary, real) for key, (real, imaginary) in self.coefficients.items()})


def terms_of(node: Node) -> Terms:
    """Write a formula as a sum of products; any other part counts as one symbol."""
    return Terms(_expanded(node))


def _expanded(node: Node) -> dict[Monomial, Complex]:
    if isinstance(node, Num):
        return {(): (node.value, Fraction(0))} if node.value else {}
    if isinstance(node, Sym):
        return {(): (Fraction(0), Fraction(1))} if node.name == "I" else {((node.name, Fraction(1)),): _ONE}
    if isinstance(node, Neg):
        return _times({(): (Fraction(-1), Fraction(0))}, _expanded(node.operand))
    if isinstance(node, Add):
        total: dict[Monomial, Complex] = {}
        for term in node.terms:
            for key, coefficient in _expanded(term).items():
                _enter(total, key, coefficient)
        return total
    if isinstance(node, Mul):
        product: dict[Monomial, Complex] = {(): _ONE}
        for factor in node.factors:
            product = _times(product, _expanded(factor))
        return product
    if isinstance(node, Div):
        return _times(_expanded(node.numerator), _power(node.denominator, Fraction(-1)))
    exponent = constant(node.exponent) if isinstance(node, Pow) else None
    return _power(node.base, exponent) if isinstance(node, Pow) and exponent is not None else _atom(node, Fraction(1))


def _power(base: Node, exponent: Fraction) -> dict[Monomial, Complex]:
    terms = _expanded(base)
    if exponent.denominator == 1 and 0 <= exponent <= 4:
        product: dict[Monomial, Complex] = {(): _ONE}
        for _ in range(int(exponent)):
            product = _times(product, terms)
        return product
    if len(terms) == 1:
        ((key, (real, imaginary)),) = terms.items()
        if not imaginary and (exponent.denominator == 1 or real == 1):
            return {
                tuple((name, power * exponent) for name, power in key): (
                    real ** int(exponent) if real != 1 else real,
                    Fraction(0),
                )
            }
    return _atom(base, exponent)


def _atom(node: Node, exponent: Fraction) -> dict[Monomial, Complex]:
    return {((written(node), exponent),): _ONE}


def _times(one: Mapping[Monomial, Complex], other: Mapping[Monomial, Complex]) -> dict[Monomial, Complex]:
    total: dict[Monomial, Complex] = {}
    if len(one) * len(other) > _MOST_TERMS:
        raise TooManyTerms("an angle has too many terms")
    for left, (a, b) in one.items():
        for right, (c, d) in other.items():
            _enter(total, _joined(left, right), (a * c - b * d, a * d + b * c))
    return total


def _joined(one: Monomial, other: Monomial) -> Monomial:
    powers = dict(one)
    for name, power in other:
        powers[name] = powers[name] + power if name in powers else power
    return tuple(sorted((name, power) for name, power in powers.items() if power))


@lru_cache(maxsize=100_000)
def over(one: Monomial, other: Monomial) -> Monomial:
    """Return the quotient of two products."""
    return _joined(one, tuple((name, -power) for name, power in other))


def _enter(total: dict[Monomial, Complex], key: Monomial, coefficient: Complex) -> None:
    real, imaginary = total.get(key, (Fraction(0), Fraction(0)))
    real, imaginary = real + coefficient[0], imaginary + coefficient[1]
    if real or imaginary:
        total[key] = (real, imaginary)
    else:
        total.pop(key, None)
