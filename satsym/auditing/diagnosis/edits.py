"""All edits of one place of a printed formula, ordered by size: the typical slips in signs, indices, factors etc.

The size of an edit depends on its kind: a sign counts less than an index, an index less than a number, and so on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from enum import IntEnum
from fractions import Fraction
from functools import partial
from itertools import combinations

from satsym.auditing.ledger.scopes import Scope
from satsym.formula.tree import (
    ONE,
    Add,
    Call,
    Div,
    Mul,
    Neg,
    Node,
    Num,
    Path,
    Pow,
    Sym,
    children,
    constant,
    number,
    replaced,
    walk,
)


class Change(IntEnum):
    """Kinds of edits of a formula, in order of increasing size."""

    SIGN = 1
    INDEX = 2
    FACTOR = 3
    EXPONENT = 4
    FUNCTION = 5
    SYMBOL = 6
    DROPPED_FACTOR = 7
    DROPPED_TERM = 8
    BRACKET = 9
    INVERTED = 10
    MISSING_FACTOR = 11
    MISSING_TERM = 12
    TERM = 13
    MEAN = 14
    ENTRY = 15


@dataclass(frozen=True)
class Edit:
    """A change of one part of a formula."""

    change: Change
    """Kind of the edit."""
    path: Path
    """Path to the part in the tree of the formula."""
    old: Node
    new: Node
    """The part before and after the edit."""
    result: Node
    """The whole formula after the edit."""
    times: int = 1
    """Number of places with the same edit."""


_EXACT = tuple(
    Fraction(n, d) for n, d in ((2, 1), (1, 2), (3, 1), (1, 3), (4, 1), (1, 4), (3, 2), (2, 3), (6, 1), (1, 6))
)
"""Numeric factors that authors forget or insert by mistake."""
_FEW_PLACES = 6
"""Number of places up to which all subsets of places are tried."""
_STEPS = (1, -1, 2, -2)
_FUNCTIONS = {"sin": ("cos",), "cos": ("sin",), "min": ("max",), "max": ("min",), "sinh": ("cosh",), "cosh": ("sinh",)}


def single_edits(formula: Node, letters: Scope, usable: Callable[[str], bool] = lambda _: True) -> list[Edit]:
    """Return all edits of one place that use only usable symbols, ordered by size and then by place."""
    found: list[Edit] = []
    for path, node in walk(formula):
        if not in_exponent(formula, path):
            for change, new in _changes(formula, path, node, letters, usable):
                found.append(Edit(change, path, node, new, replaced(formula, path, new)))
    return sorted(found, key=lambda edit: edit.change)


def repeated_edits(formula: Node, letters: Scope, usable: Callable[[str], bool] = lambda _: True) -> Iterator[Edit]:
    """Yield edits that repeat one slip at several places: a wrong symbol, or a superfluous factor.

    If there are few places, all subsets of at least two places are tried. Otherwise only all places, and all but one.
    """
    for name in _names_in(formula):
        places = [path for path, node in walk(formula) if node == Sym(name) and not in_exponent(formula, path)]
        for other in letters.family(name):
            if usable(other) and letters.is_slip(name, other):
                for chosen in _choices(places):
                    yield _everywhere(Change.INDEX, formula, chosen, Sym(name), lambda _: Sym(other))  # noqa: B023
    factors = {factor: None for _, node in walk(formula) if isinstance(node, Mul) for factor in node.factors}
    for factor in factors:
        places = [path for path, node in walk(formula) if isinstance(node, Mul) and factor in node.factors]
        for chosen in _choices(places):
            yield _everywhere(Change.DROPPED_FACTOR, formula, chosen, factor, lambda node: without_factor(node, factor))  # noqa: B023


def mean_edits(formula: Node) -> Iterator[Edit]:
    """Yield edits that replace each mean of two symbols by the first, or by the second symbol."""
    places = [path for path, node in walk(formula) if _ends(node)]
    for end in (0, 1) if places else ():
        old = at(formula, places[-1])
        yield _everywhere(Change.MEAN, formula, places, old, lambda node: _without_mean(node, end))  # noqa: B023


def _ends(node: Node) -> tuple[Node, ...]:
    """Return the two symbols of a product that contains half their sum; empty for any other tree."""
    if not isinstance(node, Mul) or Num(Fraction(1, 2)) not in node.factors:
        return ()
    sums = (f.terms for f in node.factors if isinstance(f, Add))
    return next((t for t in sums if len(t) == 2 and all(isinstance(end, Sym) for end in t)), ())


def _without_mean(node: Node, end: int) -> Node:
    assert isinstance(node, Mul)
    ends = _ends(node)
    kept = tuple(ends[end] if factor == Add(ends) else factor for factor in node.factors)
    return without_factor(Mul(kept), Num(Fraction(1, 2)))


def _everywhere(change: Change, formula: Node, places: Sequence[Path], old: Node, rule: Callable[[Node], Node]) -> Edit:
    result = formula
    for path in sorted(places, key=lambda path: (len(path), path), reverse=True):  # the inner places first
        result = replaced(result, path, rule(at(result, path)))
    return Edit(change, (), old, ONE if change is Change.DROPPED_FACTOR else rule(old), result, len(places))


def _choices(places: Sequence[Path]) -> Iterator[tuple[Path, ...]]:
    sizes = range(len(places), 1, -1) if len(places) <= _FEW_PLACES else (len(places), len(places) - 1)
    for size in sizes:
        yield from combinations(places, size)


def spine(formula: Node, path: Path) -> list[Node]:
    """Return the nested parts of a formula on the path to a place, from the whole formula to the part at the place."""
    found = [formula]
    for step in path:
        found.append(children(found[-1])[step])
    return found


def at(formula: Node, path: Path) -> Node:
    """Return the part of a formula at a place."""
    return spine(formula, path)[-1]


def in_exponent(formula: Node, path: Path) -> bool:
    """Return whether a place is inside an exponent; exponents are edited only as a whole."""
    return any(isinstance(node, Pow) and step == 1 for node, step in zip(spine(formula, path), path, strict=False))


def _changes(
    formula: Node, path: Path, node: Node, letters: Scope, usable: Callable[[str], bool]
) -> Iterator[tuple[Change, Node]]:
    *above, _ = spine(formula, path)
    direct = above[-1] if above else None
    parent = next((owner for owner in reversed(above) if not isinstance(owner, Neg)), None)  # a minus is of its term
    is_term = not isinstance(node, Neg) and (parent is None or isinstance(parent, Add | Call))
    if not isinstance(direct, Neg) and (
        parent is None or isinstance(parent, Add | Call) or (isinstance(parent, Pow) and isinstance(node, Add))
    ):
        yield Change.SIGN, node.operand if isinstance(node, Neg) else Neg(node)
    if is_term:
        for factor in _EXACT:
            yield Change.FACTOR, times(node, factor)
    if isinstance(node, Sym):
        for other in letters.family(node.name):
            if usable(other):
                yield (Change.INDEX if letters.is_slip(node.name, other) else Change.SYMBOL), Sym(other)
    if isinstance(node, Num):
        for value in _near(node.value):
            yield Change.FACTOR, number(value)
    yield from _powers(node, direct)
    if isinstance(node, Call):
        for other in _FUNCTIONS.get(node.function, ()):
            yield Change.FUNCTION, Call(other, node.arguments, node.named)
    for is_term_gone, new in shortened(node):
        yield (Change.DROPPED_TERM if is_term_gone else Change.DROPPED_FACTOR), new
    yield from ((Change.BRACKET, new) for new in regrouped(node))
    if isinstance(node, Div):
        yield Change.INVERTED, Div(node.denominator, node.numerator)
    if is_term:
        for name in _names(letters, formula):
            if usable(name):
                yield Change.MISSING_FACTOR, times_symbol(node, Sym(name))
                yield Change.MISSING_FACTOR, over_symbol(node, Sym(name))


def _powers(node: Node, parent: Node | None) -> Iterator[tuple[Change, Node]]:
    if isinstance(node, Pow):
        exponent = constant(node.exponent) or Fraction(0)
        for other in dict.fromkeys([*(exponent + step for step in _STEPS), -exponent]):
            if other == 1:
                yield Change.EXPONENT, node.base
            elif other:
                yield Change.EXPONENT, Pow(node.base, number(other))
    elif isinstance(node, Sym | Call | Add) and not isinstance(parent, Pow):
        for power in (2, 3, -1):
            yield Change.EXPONENT, Pow(node, number(power))


def _near(value: Fraction) -> list[Fraction]:
    steps = [value + step for step in (1, -1, 2, -2)] if value.denominator == 1 else []
    return [other for other in dict.fromkeys([*(value * f for f in _EXACT), *steps]) if other > 0]


def _names(letters: Scope, formula: Node) -> list[str]:
    """Return symbols that may be missing as a factor: first those of the formula, then others of the notation."""
    inside = _names_in(formula)
    others = letters.family(inside[0]) if inside else letters.family("")
    return [*inside, *(name for name in others if name not in inside)]


def _names_in(formula: Node) -> list[str]:
    """Return the symbols of a formula in the order in which they are printed."""
    return list(dict.fromkeys(node.name for _, node in walk(formula) if isinstance(node, Sym)))


def regrouped(node: Node) -> Iterator[Node]:
    """Yield formulas with a bracket moved, so that a factor or denominator applies to fewer or more terms."""
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
    """Yield sums in which a factor or denominator of a bracket applies only to its first, or only to its last terms."""
    for k in range(1, len(bracket.terms)):
        head, tail = bracket.terms[:k], bracket.terms[k:]
        yield Add((*head, around(combined(Add, tail))))
        yield Add((around(combined(Add, head)), *tail))


def combined(kind: type[Add] | type[Mul], parts: tuple[Node, ...]) -> Node:
    """Return the sum or product of parts, or the part itself if there is only one."""
    return parts[0] if len(parts) == 1 else kind(parts)


def shortened(node: Node) -> Iterator[tuple[bool, Node]]:
    """Yield a product without one of its factors, or a sum without one of its terms, and whether a term was dropped."""
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
    """Return a product without one of its factors."""
    assert isinstance(node, Mul)
    return combined(Mul, _but(node.factors, node.factors.index(factor)))


def times(node: Node, factor: Fraction) -> Node:
    """Return a term times a number, in the usual form of writing."""
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
    """Return a term multiplied by a symbol."""
    if isinstance(node, Neg):
        return Neg(times_symbol(node.operand, symbol))
    if isinstance(node, Div):
        return Div(times_symbol(node.numerator, symbol), node.denominator)
    if isinstance(node, Num):
        return symbol if node.value == 1 else Mul((node, symbol))
    return Mul((*node.factors, symbol)) if isinstance(node, Mul) else Mul((node, symbol))


def over_symbol(node: Node, symbol: Sym) -> Node:
    """Return a term divided by a symbol."""
    if isinstance(node, Neg):
        return Neg(over_symbol(node.operand, symbol))
    if isinstance(node, Div):
        return Div(node.numerator, times_symbol(node.denominator, symbol))
    return Div(node, symbol)
