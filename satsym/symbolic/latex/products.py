"""Products split for print into numerator and denominator, and sums into signed terms."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import sympy as sp

from satsym.symbolic.factoring import factored

HUNDREDTHS = (100, 1000, 10000)
"""Denominators of fractions that are printed as decimal numbers."""
MOST_TERMS = 12
"""Number of terms up to which a factorisation of a sum in a denominator is tried."""


@dataclass(frozen=True)
class Product:
    """A product as sign * number * top / (number_below * bottom), with coprime positive numbers."""

    negative: bool
    number: sp.Expr
    top: tuple[sp.Expr, ...]
    number_below: sp.Integer
    bottom: tuple[sp.Expr, ...]


def decimal(number: sp.Expr) -> sp.Expr:
    """Write a fraction over a power of ten, such as hundredths, as a decimal number."""
    if isinstance(number, sp.Rational) and number.q in HUNDREDTHS:
        return sp.Float(str(number.p / number.q))
    return number


def sides(excess: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Return the two sides of a difference; for any other expression, the expression and zero."""
    below = [term for term in excess.args if is_negative(term)] if excess.is_Add else []
    if len(below) != 1 or len(excess.args) != 2:
        return excess, sp.Integer(0)
    return excess - below[0], -below[0]


def take_apart(expression: sp.Expr) -> Product:
    """Write any expression as a product, with minus signs and whole numbers taken out of its sums."""
    number, below = sp.Integer(1), sp.Integer(1)
    top: list[sp.Expr] = []
    bottom: list[sp.Expr] = []
    for factor in _factors(expression):
        if factor.is_Rational:
            number, below = number * factor.p, below * factor.q
        elif factor.is_Float:
            number *= factor
        elif factor.is_Pow and factor.exp.is_Rational and factor.exp.is_negative:
            bottom.append(sp.Pow(factor.base, -factor.exp))
        elif factor.is_Add and expression.is_Mul:
            content, primitive = factor.primitive()
            if not content.is_Integer and not all(abs(term.as_coeff_Mul()[0]) == 1 for term in primitive.args):
                content, primitive = sp.Integer(1), factor
            flip = all(map(is_negative, primitive.args))
            number, below = number * (-content.p if flip else content.p), below * content.q
            top.append(-primitive if flip else primitive)
        else:
            top.append(factor)
    negative = bool(number.is_negative)
    if negative and expression.is_Mul and sum(bool(f.is_Add) for f in top) > 1:
        turned = [k for k, f in enumerate(top) if _turns_well(f)]
        turned += [k for k, f in enumerate(top) if f.is_Add and any(map(is_negative, f.args))][::-1]
        if turned:  # -(1 - a)(b - c) is better read as (1 - a)(c - b)
            negative, top[turned[0]] = False, -top[turned[0]]
    if not number.is_Float:
        number, below = sp.fraction(number / below)
    if below in HUNDREDTHS and (top or bottom):
        number = number / below if number.is_Float else sp.Float(str(number.p / below.p))
        below = sp.Integer(1)
    return Product(negative, abs(number), *_with_roots(top, bottom, below))


def _with_roots(
    top: Sequence[sp.Expr], bottom: Sequence[sp.Expr], below: sp.Integer
) -> tuple[tuple[sp.Expr, ...], sp.Integer, tuple[sp.Expr, ...]]:
    """Write products and quotients of roots of the same degree as one root, where their contents are positive."""
    powers = {f.exp for f in (*top, *bottom) if _is_root(f)}
    above, under = list(top), list(bottom)
    for power in sorted(powers, key=sp.default_sort_key):
        over = [f for f in top if _is_root(f) and f.exp == power]
        low = [f for f in bottom if _is_root(f) and f.exp == power]
        if len(over) + len(low) < 2 or not over:
            continue
        whole = sp.Mul(*(f.base for f in over), *(1 / f.base for f in low))
        above = [*(f for f in above if f not in over), sp.Pow(whole, power, evaluate=False)]
        under = [f for f in under if f not in low]
    return tuple(above), below, tuple(under)


def _is_root(factor: sp.Expr) -> bool:
    """Tell whether a factor is a fractional power of a positive number or symbol."""
    return bool(
        factor.is_Pow
        and factor.exp.is_Rational
        and not factor.exp.is_Integer
        and (factor.base.is_Symbol or factor.base.is_Number)
        and factor.base.is_positive
    )


def turned_round(parts: Product, backwards: Sequence[int]) -> Product:
    """Reverse sums in the numerator where that saves minus signs, or moves one from the front.

    Parameters
    ----------
    parts
        A product.
    backwards
        Places of these sums, of which the last stays as it is where else a minus would come before the product.
    """
    turned = backwards[: len(backwards) - (len(backwards) + parts.negative) % 2]
    top = tuple(-f if k in turned else f for k, f in enumerate(parts.top))
    more = _minuses(top) >= _minuses(parts.top) + (2 if parts.negative else 0)
    return replace(parts, negative=False, top=top) if turned and not more else parts


def _minuses(factors: Iterable[sp.Expr]) -> int:
    return sum(is_negative(term) for f in factors if f.is_Add for term in f.args)


def spread(summand: sp.Expr) -> sp.Expr:
    """Divide a sum in the numerator of a summand term by term, where the result is shorter."""
    parts = take_apart(summand)
    sums = [f for f in parts.top if f.is_Add]
    if len(sums) != 1 or not parts.bottom:
        return summand
    below = sp.Mul(parts.number_below, *parts.bottom)
    divided = sp.Add(*(a / below for a in sums[0].args))
    if sp.count_ops(divided) >= sp.count_ops(sums[0] / below):
        return summand
    number = -parts.number if parts.negative else parts.number
    return sp.Mul(number, *(f for f in parts.top if f is not sums[0])) * divided


def _turns_well(factor: sp.Expr) -> bool:
    """Tell whether a factor is a sum with minus signs in which no number gets a minus when it is reversed."""
    minuses = [is_negative(a) for a in factor.args] if factor.is_Add else []
    return any(minuses) and not any(a.is_number and not minus for a, minus in zip(factor.args, minuses, strict=False))


def is_negative(summand: sp.Expr) -> bool:
    """Tell whether an expression is printed with a minus sign in front."""
    return take_apart(summand).negative


def is_power_of_sum(expression: sp.Expr) -> bool:
    """Tell whether an expression contains a power of a sum whose sign may be reversed."""
    if not (expression.is_Pow and expression.base.is_Add and expression.exp.is_Integer):
        return False
    return bool(expression.exp.is_negative or expression.exp.is_even)


def with_plus_first(summands: Sequence[sp.Expr]) -> list[sp.Expr]:
    """Reorder summands whose first has a minus: numbers last, or else the first with a plus in front."""
    first, *rest = summands
    plus = next((s for s in rest if not is_negative(s)), None)
    if plus is None or not is_negative(first):
        return list(summands)
    return [*with_plus_first(rest), first] if first.is_number else [plus, *(s for s in summands if s is not plus)]


def base(factor: sp.Expr) -> sp.Expr:
    """Return the base of a power; any other factor is its own base."""
    return factor.base if factor.is_Pow else factor


def exponent(factor: sp.Expr) -> sp.Expr:
    """Return the rational exponent of a power; one for any other factor."""
    return factor.exp if factor.is_Pow and factor.exp.is_Rational else sp.Integer(1)


@lru_cache(maxsize=4096)
def _as_product(total: sp.Expr) -> sp.Expr:
    """Write a sum in a denominator as a product, if that is shorter."""
    if len(total.args) > MOST_TERMS or total.has(sp.Float):
        return total
    return min(total, factored(total), key=sp.count_ops)


def _factors(expression: sp.Expr) -> Iterator[sp.Expr]:
    for factor in sp.Mul.make_args(expression):
        if factor.is_Mul:
            yield from _factors(factor)
        elif factor.is_Pow and factor.base.is_Add and factor.exp.is_Integer and factor.exp.is_negative:
            yield from sp.Mul.make_args(sp.Pow(_as_product(factor.base), factor.exp))
        else:
            yield factor


@dataclass(frozen=True)
class Piece:
    """A piece of a line that may be broken before it, with its depth of parentheses."""

    tex: str
    depth: int = 0


@dataclass(frozen=True)
class Term:
    """One signed term of a sum."""

    negative: bool
    """Whether the term has a minus sign."""
    tex: str
    """The term without its sign."""
    pieces: tuple[Piece, ...]
    """The pieces of a term without its sign, between which a long line may be broken."""

    def signed(self, *, first: bool) -> str:
        """Print the term with its sign, as the first term of a sum or a later one."""
        return _signed(self.negative, self.tex, first)

    def signed_pieces(self, *, first: bool) -> tuple[Piece, ...]:
        """Return the term with its sign as pieces between which a line may be broken."""
        head, *rest = self.pieces
        return (Piece(_signed(self.negative, head.tex, first), head.depth), *rest)


def whole_term(negative: bool, tex: str) -> Term:
    """Return a term that is never broken across lines."""
    return Term(negative, tex, (Piece(tex),))


def plain(tex: str) -> tuple[Term, ...]:
    """Return a sum that consists of one term and is never broken across lines."""
    return (whole_term(False, tex),)


def joined(terms: Sequence[Term]) -> str:
    """Print a sum on one line."""
    return " ".join(t.signed(first=k == 0) for k, t in enumerate(terms))


def _signed(negative: bool, tex: str, first: bool) -> str:
    if first:
        return f"-{tex}" if negative else tex
    return f"- {tex}" if negative else f"+ {tex}"
