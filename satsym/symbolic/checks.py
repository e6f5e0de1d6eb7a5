"""Numeric confirmation of symbolic results, at random points and with 30 digits."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from functools import lru_cache
from types import MappingProxyType
from typing import Any, TypeAlias

import mpmath as mp
import sympy as sp

from satsym.spec import Variable
from satsym.symbolic.algebra import LARGEST, PROVABLE, terms_of, vanishes
from satsym.symbolic.derivation import Check, DerivationError
from satsym.symbolic.minimisers import MPMATH_FUNCTIONS
from satsym.symbolic.roots import Root

DIGITS = 30
LIMIT = 1e-15
"""Allowed relative deviation: far above what 30 digits and numeric differentiation leave, far below a mistake."""
FAINT = 1e-10
"""What is smaller is compared as if it were that large: it may be what numbers of size one leave when they cancel."""
POINTS = 5
TRIES = 60
"""Random points at most, of which those are looked at where functions have numbers of a moderate size."""
HUGE = 1e12
"""Where numbers are larger, what is lost by cancellation may exceed :data:`LIMIT`."""

_TYPICAL: ContextVar[Mapping[str, tuple[float, float]]] = ContextVar("typical", default=MappingProxyType({}))

Point: TypeAlias = dict[sp.Symbol, Any]


@contextmanager
def drawn_from(variables: Iterable[Variable]) -> Iterator[None]:
    """Draw random points in here from where these variables typically lie.

    As soon as one of them says so, those with a default are drawn about that: what they enter must fit together.
    """
    declared = list(variables)
    ranges = {v.symbol: v.typical for v in declared if v.typical}
    if ranges:
        for v in declared:
            if v.default and not v.typical:
                ranges[v.symbol] = (0.5 * v.default, 1.5 * v.default)
    token = _TYPICAL.set(ranges)
    try:
        yield
    finally:
        _TYPICAL.reset(token)


def random_number(symbol: sp.Symbol, rng: random.Random) -> float:
    """From where the symbol typically lies; else of size one, positive where the symbol is, and away from zero."""
    size = rng.uniform(0.5, 1.5)
    if symbol.name in (typical := _TYPICAL.get()):
        low, high = typical[symbol.name]
        return low + (size - 0.5) * (high - low)
    return size if symbol.is_positive or rng.random() < 0.5 else -size


def random_point(symbols: Iterable[sp.Symbol], rng: random.Random) -> Point:
    """A generic point, a number for each symbol."""
    return {symbol: mp.mpf(random_number(symbol, rng)) for symbol in sorted(symbols, key=lambda s: s.name)}


def points(symbols: Iterable[sp.Symbol], seed: str, count: int = POINTS) -> Iterator[Point]:
    """Reproducible random points, drawn anew for every seed text."""
    chosen = list(symbols)
    rng = random.Random(seed)
    for _ in range(count):
        yield random_point(chosen, rng)


def numeric(expressions: Sequence[sp.Expr]) -> Callable[[Mapping[sp.Symbol, Any]], list[Any]]:
    """A function that evaluates the expressions at a point, in the working precision of mpmath."""
    symbols, function = _compiled(tuple(expressions))
    return lambda point: function(*(point[s] for s in symbols))


@lru_cache(maxsize=1024)  # checks ask at every point anew
def _compiled(expressions: tuple[sp.Expr, ...]) -> tuple[list[sp.Symbol], Callable[..., list[Any]]]:
    symbols = sorted(set().union(*(sp.sympify(e).free_symbols for e in expressions)), key=lambda s: s.name)
    return symbols, sp.lambdify(symbols, list(expressions), modules=[MPMATH_FUNCTIONS, "mpmath"])


def numeric_along(
    chain: Iterable[tuple[sp.Symbol, sp.Expr]], expressions: Iterable[sp.Expr]
) -> tuple[Callable[[Mapping[sp.Symbol, Any]], list[Any]], list[sp.Symbol]]:
    """The same for expressions in named parts, each of which may use those before it; and the symbols it needs."""
    parts, values = list(chain), list(expressions)
    free = set().union(*(e.free_symbols for _, e in parts), *(e.free_symbols for e in values)) - {s for s, _ in parts}
    symbols = sorted(free, key=lambda s: s.name)
    roots = set().union(*(sp.sympify(e).atoms(Root) for _, e in parts))
    modules = [{**MPMATH_FUNCTIONS, **{root.func.__name__: root.func._imp_ for root in roots}}, "mpmath"]
    function = sp.lambdify(symbols, values, modules=modules, cse=lambda _: (parts, values))
    return lambda point: function(*(point[s] for s in symbols)), symbols


def deviation(found: Iterable[Any], expected: Iterable[Any]) -> float:
    """Largest difference, relative to the size of what was expected and of the largest of it, but one at most.

    NaN if any of them is.
    """
    pairs = list(zip(found, expected, strict=True))
    unit = max(FAINT, min(1.0, _largest(abs(b) for _, b in pairs)))
    return _largest(abs(a - b) / (unit + abs(b)) for a, b in pairs)


def compare(
    claim: str,
    symbols: Iterable[sp.Symbol],
    sides: Callable[[Point], tuple[Iterable[Any], Iterable[Any]]],
    limit: float = LIMIT,
) -> Check:
    """Check two routes to the same numbers at random points.

    Points where the other route has no moderate numbers are passed over; the error is NaN where too few have them.

    Parameters
    ----------
    claim
        Key of the sentence that says what is compared; also the seed of the points.
    symbols
        What the points give values to.
    sides
        Point -> (numbers by the derived expressions, the same numbers by the other route).
    """
    errors: list[float] = []
    with mp.workdps(DIGITS):
        for point in points(symbols, claim, TRIES):
            found, expected = map(list, sides(point))
            if not moderate(expected):
                continue  # outside the domain, or where rounding hides what is to be compared
            errors.append(deviation(found, expected))
            if len(errors) == POINTS:
                break
    return Check(claim, _largest(errors) if len(errors) == POINTS else math.nan, limit)


def moderate(values: Iterable[Any]) -> bool:
    """Whether all of these are numbers of which 30 digits tell something."""
    return all(abs(value) <= HUGE for value in values)


def first_order_at_zero(
    claim: str, exact: Sequence[sp.Expr], linear: Sequence[sp.Expr], moving: Sequence[sp.Symbol]
) -> Check:
    """Check linear expressions by the exact ones along a ray through zero, differentiated there."""
    function, found = numeric(exact), numeric(linear)

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        def along(scale: Any) -> list[Any]:
            return function({**point, **{s: point[s] * scale for s in moving}})

        return found(point), [mp.diff(lambda scale, k=k: along(scale)[k], 0) for k in range(len(exact))]

    return compare(claim, {*moving}.union(*(f.free_symbols for f in exact)), sides)


def never_below(
    claim: str, symbols: Iterable[sp.Symbol], margins: Callable[[Point, random.Random], Iterable[Any]]
) -> Check:
    """Check that margins which must not be negative are not, at random points.

    Raises
    ------
    DerivationError
        If a margin is not a real number, as where the root of a negative state is taken.
    """
    rng = random.Random(claim)
    try:
        with mp.workdps(DIGITS):
            deficits = [max(-m, mp.mpf(0)) if m == m else m for p in points(symbols, claim) for m in margins(p, rng)]
    except TypeError as error:  # mpmath does not order complex numbers
        raise DerivationError(
            f"the check {claim!r} met values without an order, such as complex ones; declare what must be positive so, "
            "or say where the variables lie: Variable(..., typical=(low, high))"
        ) from error
    return Check(claim, _largest(deficits), LIMIT)


def positive(claim: str, symbols: Iterable[sp.Symbol], expressions: Sequence[sp.Expr]) -> Check:
    """Check that expressions are positive at random points."""
    values = numeric(expressions)
    return never_below(claim, symbols, lambda point, _: [v if v != v or v > 0 else mp.mpf(-1) for v in values(point)])


def _largest(values: Iterable[Any]) -> float:
    """The largest of some non-negative numbers; NaN if any of them is, which ``max`` alone may pass over."""
    found = list(values)
    return float(max(found, default=0.0)) if all(v == v for v in found) else math.nan


def identity(claim: str, expressions: Iterable[sp.Expr]) -> Check:
    """Check that expressions are identically zero, by simplification where multiplying out does not show it.

    Decimals are rounded when they are multiplied out: what has some is held against the size of its terms at random
    points, and so is what has too many terms.
    """

    def zero(e: sp.Expr) -> bool:
        terms = terms_of(e)
        if terms <= PROVABLE and sp.expand(e) == 0:
            return True
        return _rounds_to_zero(claim, e) if terms > LARGEST or e.has(sp.Float) else vanishes(e)

    remainders = [e for e in expressions if not zero(e)]
    return Check(claim, float(len(remainders)), 0.0)


def _rounds_to_zero(claim: str, expression: sp.Expr) -> bool:
    """Whether an expression with decimals is no larger at random points than the rounding of its terms."""
    value = numeric([expression, _in_all(expression)])

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        found, size = value(point)
        return [1 + found / size if size else 1], [1]

    return compare(claim, expression.free_symbols, sides).passed


def _in_all(expression: sp.Expr) -> sp.Expr:
    """What the terms of an expression add up to by magnitude, multiplied out, before any cancel."""
    if expression.is_Add or expression.is_Mul:
        return expression.func(*map(_in_all, expression.args))
    if expression.is_Pow and expression.exp.is_Integer and expression.exp.is_positive:
        return _in_all(expression.base) ** expression.exp
    return sp.Abs(expression)


def partial(function: Callable[[Mapping[sp.Symbol, Any]], list[Any]], point: Point, symbol: sp.Symbol) -> list[Any]:
    """Numeric partial derivatives of a vector function by central differences in high precision."""
    return slopes(lambda h: function({**point, symbol: point[symbol] + h}))


def slopes(function: Callable[[Any], Sequence[Any]]) -> list[Any]:
    """Numeric derivatives at zero of a vector function of one number, by central differences in high precision.

    NaN where the function is so large that rounding hides how it changes.
    """
    digits = mp.mp.dps
    with mp.workdps(3 * digits):
        h = mp.mpf(10) ** (-digits)
        above, below = function(h), function(-h)
        readable = h * mp.mpf(10) ** (2 * digits + digits // 3)
        return [(a - b) / (2 * h) if abs(a) < readable else mp.nan for a, b in zip(above, below, strict=True)]
