"""Numeric checks of symbolic results at random points; :mod:`satsym.agreement` decides when numbers are equal."""

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

from satsym.agreement import DIGITS, LIMIT, Sides, disagreement, finite, slopes
from satsym.spec import Variable
from satsym.symbolic.algebra import PROVABLE, terms_of
from satsym.symbolic.derivation import Check, DerivationError
from satsym.symbolic.functions.minimisers import MPMATH_FUNCTIONS
from satsym.symbolic.functions.roots import Root

POINTS = 5
TRIES = 60
"""Largest number of random points that are tried in order to find points at which functions have values."""

_TYPICAL: ContextVar[Mapping[str, tuple[float, float]]] = ContextVar("typical", default=MappingProxyType({}))

Point: TypeAlias = dict[sp.Symbol, Any]


@contextmanager
def drawn_from(variables: Iterable[Variable]) -> Iterator[None]:
    """Draw random points inside this context from the typical ranges of the given variables.

    If any variable states such a range, variables with a default are drawn near that default, so that the values fit
    together.
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
    """Draw a number from a symbol's typical range, or else of size one, away from zero and positive where declared."""
    size = rng.uniform(0.5, 1.5)
    if symbol.name in (typical := _TYPICAL.get()):
        low, high = typical[symbol.name]
        return low + (size - 0.5) * (high - low)
    return size if symbol.is_positive or rng.random() < 0.5 else -size


def random_point(symbols: Iterable[sp.Symbol], rng: random.Random) -> Point:
    """Draw a generic point: a number for each symbol."""
    return {symbol: mp.mpf(random_number(symbol, rng)) for symbol in sorted(symbols, key=lambda s: s.name)}


def points(symbols: Iterable[sp.Symbol], seed: str, count: int = POINTS) -> Iterator[Point]:
    """Return reproducible random points; each seed text gives others."""
    chosen = list(symbols)
    rng = random.Random(seed)
    for _ in range(count):
        yield random_point(chosen, rng)


def numeric(expressions: Sequence[sp.Expr]) -> Callable[[Mapping[sp.Symbol, Any]], list[Any]]:
    """Compile expressions to a function of a point that works in mpmath's precision."""
    symbols, function = _compiled(tuple(expressions))
    return lambda point: function(*(point[s] for s in symbols))


@lru_cache(maxsize=1024)  # checks ask at every point anew
def _compiled(expressions: tuple[sp.Expr, ...]) -> tuple[list[sp.Symbol], Callable[..., list[Any]]]:
    symbols = sorted(set().union(*(sp.sympify(e).free_symbols for e in expressions)), key=lambda s: s.name)
    return symbols, sp.lambdify(symbols, list(expressions), modules=[MPMATH_FUNCTIONS, "mpmath"])


def numeric_along(
    chain: Iterable[tuple[sp.Symbol, sp.Expr]], expressions: Iterable[sp.Expr]
) -> tuple[Callable[[Mapping[sp.Symbol, Any]], list[Any]], list[sp.Symbol]]:
    """Compile expressions in named parts, each of which may use those before; also return the symbols needed."""
    parts, values = list(chain), list(expressions)
    free = set().union(*(e.free_symbols for _, e in parts), *(e.free_symbols for e in values)) - {s for s, _ in parts}
    symbols = sorted(free, key=lambda s: s.name)
    roots = set().union(*(sp.sympify(e).atoms(Root) for _, e in parts))
    modules = [{**MPMATH_FUNCTIONS, **{root.func.__name__: root.func._imp_ for root in roots}}, "mpmath"]
    function = sp.lambdify(symbols, values, modules=modules, cse=lambda _: (parts, values))
    return lambda point: function(*(point[s] for s in symbols)), symbols


def compare(
    claim: str,
    symbols: Iterable[sp.Symbol],
    sides: Callable[[Point], tuple[Iterable[Any], Iterable[Any]]],
) -> Check:
    """Check that two routes lead to the same numbers at random points, or at one point without symbols.

    Points where the other route has no numbers are passed over; the error is NaN where too few are left.

    Parameters
    ----------
    claim
        Key of the sentence that says what is compared; also the seed of the points.
    symbols
        What the points give values to.
    sides
        Point -> (numbers by the derived expressions, the same numbers by the other route), in the working precision of
        mpmath. It must be a function of the point alone: what it draws at random it draws anew from the same seed.
    """
    chosen = list(symbols)
    wanted, errors = POINTS if chosen else 1, list[float]()
    for point in points(chosen, claim, TRIES if chosen else 1):
        error = _where_finite(with_digits(sides, point))
        if error is not None:
            errors.append(error)
        if len(errors) == wanted:
            return Check(claim, _largest(errors), LIMIT)
    return Check(claim, math.nan, LIMIT)


def _where_finite(at: Callable[[int], Sides]) -> float | None:
    """Return the disagreement of both sides at a point; ``None`` where the other route has no numbers."""
    first = at(DIGITS)
    return disagreement(lambda digits: first if digits == DIGITS else at(digits)) if finite(first[1]) else None


def with_digits(sides: Callable[[Point], tuple[Iterable[Any], Iterable[Any]]], point: Point) -> Callable[[int], Sides]:
    """Return both sides at a point as a function of the number of digits; NaN where either divides by zero."""

    def at(digits: int) -> Sides:
        with mp.workdps(digits):
            try:
                found, expected = sides(point)
            except ZeroDivisionError:
                return [mp.nan], [mp.nan]
            return list(found), list(expected)

    return at


def first_order_at_zero(
    claim: str, exact: Sequence[sp.Expr], linear: Sequence[sp.Expr], moving: Sequence[sp.Symbol]
) -> Check:
    """Check linear expressions by the exact ones, differentiated at zero along a ray."""
    function, found = numeric(exact), numeric(linear)

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        def along(scale: Any) -> list[Any]:
            return function({**point, **{s: point[s] * scale for s in moving}})

        return found(point), [mp.diff(lambda scale, k=k: along(scale)[k], 0) for k in range(len(exact))]

    return compare(claim, {*moving}.union(*(f.free_symbols for f in exact)), sides)


def never_below(
    claim: str, symbols: Iterable[sp.Symbol], margins: Callable[[Point, random.Random], Iterable[Any]]
) -> Check:
    """Check at random points that margins are nowhere negative.

    Raises
    ------
    DerivationError
        If a margin is not a real number, as where the root of a negative state is taken.
    """

    def below(point: Point) -> tuple[list[Any], list[Any]]:
        rng = random.Random(f"{claim} {sorted((s.name, float(v)) for s, v in point.items())}")
        found = [m if not m >= 0 else mp.mpf(0) for m in margins(point, rng)]
        return found, [0] * len(found)

    try:
        errors = [disagreement(with_digits(below, point)) for point in points(symbols, claim)]
    except TypeError as error:  # mpmath does not order complex numbers
        raise DerivationError(
            f"the check {claim!r} encountered values that cannot be ordered, such as complex numbers; declare positive "
            "variables as positive, or give the ranges of the variables: Variable(..., typical=(low, high))"
        ) from error
    return Check(claim, _largest(errors), LIMIT)


def positive(claim: str, symbols: Iterable[sp.Symbol], expressions: Sequence[sp.Expr]) -> Check:
    """Check that expressions are positive at random points."""
    values = numeric(expressions)
    return never_below(claim, symbols, lambda point, _: [v if v != v or v > 0 else mp.mpf(-1) for v in values(point)])


def _largest(values: Iterable[Any]) -> float:
    """Return the largest of some non-negative numbers; NaN if any of them is, which ``max`` may miss."""
    found = list(values)
    return float(max(found, default=0.0)) if all(v == v for v in found) else math.nan


def identity(claim: str, expressions: Iterable[sp.Expr]) -> Check:
    """Check that expressions are identically zero."""
    remainders = [e for e in expressions if not vanishes(claim, e)]
    return Check(claim, float(len(remainders)), 0.0)


def vanishes(claim: str, expression: sp.Expr) -> bool:
    """Tell whether an expression is identically zero: by expansion where that is short, by numbers otherwise.

    Numbers decide as well as simplification does, for which sympy may need minutes.
    """
    if terms_of(expression) <= PROVABLE and sp.expand(expression) == 0:
        return True
    value = numeric([expression])
    return agree(claim, expression.free_symbols, lambda point: (value(point), [0]))


def agree(
    seed: str, symbols: Iterable[sp.Symbol], sides: Callable[[Point], tuple[Iterable[Any], Iterable[Any]]]
) -> bool:
    """Tell whether two routes lead to the same numbers at random points; no step claims the answer.

    Parameters
    ----------
    seed
        Of the points.
    symbols, sides
        As of :func:`compare`.
    """
    return compare(seed, symbols, sides).passed


def partial(function: Callable[[Mapping[sp.Symbol, Any]], list[Any]], point: Point, symbol: sp.Symbol) -> list[Any]:
    """Differentiate a vector function numerically by central differences in high precision."""
    return slopes(lambda h: function({**point, symbol: point[symbol] + h}))
