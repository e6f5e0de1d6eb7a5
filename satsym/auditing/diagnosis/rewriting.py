"""Formulas written a little differently: another factor, one part less, brackets in another place."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import partial

from satsym.formula.tree import ONE, Add, Div, Mul, Neg, Node, Num, Sym, constant, number, replaced


def regrouped(node: Node) -> Iterator[Node]:
    """A factor, or a denominator, that belongs to part of a bracket only; or to a longer one."""
    if isinstance(node, Div) and isinstance(node.numerator, Add):
        yield from _split(node.numerator, lambda part: Div(part, node.denominator))
    if isinstance(node, Mul):
        for i, factor in enumerate(node.factors):
            if isinstance(factor, Add):
                yield from _split(factor, partial(replaced, node, (i,)))
    if isinstance(node, Add):
        *before, last = node.terms
        negative, inner = isinstance(last, Neg), last.operand if isinstance(last, Neg) else last
        if isinstance(inner, Div):
            yield Div(Add((*before, Neg(inner.numerator) if negative else inner.numerator)), inner.denominator)
        if isinstance(inner, Mul):
            first, *others = inner.factors
            yield Mul((Add((*before, Neg(first) if negative else first)), *others))


def _but(parts: tuple[Node, ...], index: int) -> tuple[Node, ...]:
    return (*parts[:index], *parts[index + 1 :])


def _split(bracket: Add, around: Callable[[Node], Node]) -> Iterator[Node]:
    """A sum of which only the last terms, or only the first ones, are in the bracket."""
    for k in range(1, len(bracket.terms)):
        head, tail = bracket.terms[:k], bracket.terms[k:]
        yield Add((*head, around(combined(Add, tail))))
        yield Add((around(combined(Add, head)), *tail))


def combined(kind: type[Add] | type[Mul], parts: tuple[Node, ...]) -> Node:
    """A sum or a product, or the only part there is."""
    return parts[0] if len(parts) == 1 else kind(parts)


def shortened(node: Node) -> Iterator[tuple[bool, Node]]:
    """A product without a factor, a sum without a term; and whether it is a term that is gone."""
    if isinstance(node, Mul):
        for i in range(len(node.factors)):
            yield False, combined(Mul, _but(node.factors, i))
    if isinstance(node, Div):
        yield False, node.numerator
        yield False, Div(ONE, node.denominator)
    if isinstance(node, Add):
        for i in range(len(node.terms)):
            yield True, combined(Add, _but(node.terms, i))


def without_factor(node: Node, factor: Node) -> Node:
    """A product without a factor it has."""
    assert isinstance(node, Mul)
    return combined(Mul, _but(node.factors, node.factors.index(factor)))


def times(node: Node, factor: Fraction) -> Node:
    """A term with another numeric factor, written as people write it."""
    if isinstance(node, Neg):
        return Neg(times(node.operand, factor))
    if isinstance(node, Num):
        return number(node.value * factor)
    if isinstance(node, Div):
        above, below = times(node.numerator, Fraction(factor.numerator)), factor.denominator
        return Div(above, node.denominator if below == 1 else times(node.denominator, Fraction(below)))
    if isinstance(node, Mul) and (value := constant(node.factors[0])) is not None:
        rest, scaled = node.factors[1:], value * factor
        return combined(Mul, rest if scaled == 1 else (number(scaled), *rest))
    if factor.numerator == 1 and factor.denominator != 1:
        return Div(node, number(factor.denominator))
    if factor == 1:
        return node
    return Mul((number(factor), *node.factors)) if isinstance(node, Mul) else Mul((number(factor), node))


def times_symbol(node: Node, symbol: Sym) -> Node:
    """A term with one more factor."""
    if isinstance(node, Neg):
        return Neg(times_symbol(node.operand, symbol))
    if isinstance(node, Div):
        return Div(times_symbol(node.numerator, symbol), node.denominator)
    if isinstance(node, Num):
        return symbol if node.value == 1 else Mul((node, symbol))
    return Mul((*node.factors, symbol)) if isinstance(node, Mul) else Mul((node, symbol))


def over_symbol(node: Node, symbol: Sym) -> Node:
    """A term divided by one more factor."""
    if isinstance(node, Neg):
        return Neg(over_symbol(node.operand, symbol))
    if isinstance(node, Div):
        return Div(node.numerator, times_symbol(node.denominator, symbol))
    return Div(node, symbol)
