"""Dimensions of expressions as exact exponents of base dimensions, and the rules for sums, products and functions."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from itertools import pairwise
from typing import Any, TypeAlias

import sympy as sp

from satsym.symbolic.functions import minimisers, pieces, roots

Dimension: TypeAlias = Mapping[str, sp.Expr]
"""Exact exponents of base dimensions, without zeros; empty for plain numbers."""

Known: TypeAlias = Mapping[str, Dimension | None]
"""Name of a symbol -> its dimension; ``None`` for zero, which has every dimension."""

PLAIN: Dimension = {}
_TOLD = {
    "unknown": "uses {0}, whose dimension is unknown",
    "unequal": "adds or compares {0}, of dimension {1}, and {2}, of dimension {3}",
    "plain": "applies {2} to {0}, of dimension {1}, but the argument must be dimensionless",
    "exponent": "has {0}, of dimension {1}, as an exponent, but exponents must be dimensionless",
}


class Disagreement(Exception):
    """An expression combines different dimensions; the message continues "the expression ..."."""

    def __init__(self, kind: str, *parts: str) -> None:
        super().__init__(_TOLD[kind].format(*parts))
        self.kind, self.parts = kind, parts


def dimension_of(expression: Any, known: Known) -> Dimension | None:
    """Return the dimension of an expression.

    Parameters
    ----------
    expression
        Anything but a matrix.
    known
        Dimensions of its symbols.

    Returns
    -------
    Dimension or None
        ``None`` for zero.

    Raises
    ------
    Disagreement
        If it is not homogeneous.
    """
    e = sp.sympify(expression)
    if e.is_Symbol:
        if e.name not in known:
            raise Disagreement("unknown", e.name)
        return known[e.name]
    if e.is_number:
        return None if e == 0 else PLAIN
    for kinds, rule in _RULES:
        if isinstance(e, kinds):
            return rule(e, known)
    for argument in e.args:
        _plain(argument, known, e.func.__name__)
    return PLAIN


def written(dimension: Dimension | None) -> str:
    """Write a dimension for people, such as ``[length]/[time]^2``; ``1`` for a plain number."""
    above: list[str] = []
    below: list[str] = []
    for base, exponent in (dimension or PLAIN).items():
        side, size = (below, -exponent) if exponent.could_extract_minus_sign() else (above, exponent)
        side.append(base if size == 1 else f"{base}^{size if size.is_Integer else f'({size})'}")
    return "/".join(["*".join(above) or "1", *below])


def _plain(expression: sp.Expr, known: Known, function: str = "") -> None:
    found = dimension_of(expression, known)
    if found:
        raise Disagreement("plain" if function else "exponent", str(expression), written(found), function)


def _common(expressions: Iterable[sp.Expr], known: Known) -> Dimension | None:
    """Return the dimension that all of some expressions have."""
    first, found = None, None
    for expression in expressions:
        dimension = dimension_of(expression, known)
        if dimension is None:
            continue
        if found is None:
            first, found = expression, dimension
        elif dimension != found:
            raise Disagreement("unequal", str(first), written(found), str(expression), written(dimension))
    return found


def product(dimensions: Iterable[Dimension | None]) -> Dimension | None:
    """Return the dimension of a product."""
    total: dict[str, sp.Expr] = {}
    for dimension in dimensions:
        if dimension is None:
            return None
        for base, exponent in dimension.items():
            total[base] = sp.expand(total.get(base, 0) + exponent)
    return {base: total[base] for base in sorted(total) if total[base] != 0}


def power_of(dimension: Dimension | None, exponent: sp.Expr) -> Dimension | None:
    """Return the dimension of a power."""
    if dimension is None:
        return None
    exact = sp.nsimplify(exponent, rational=True)
    return {base: sp.expand(power * exact) for base, power in dimension.items()}


def over(dimension: Dimension | None, other: Dimension | None) -> Dimension | None:
    """Return the dimension of a quotient."""
    return product((dimension, power_of(other, sp.Integer(-1))))


def _of_power(e: sp.Pow, known: Known) -> Dimension | None:
    _plain(e.exp, known)
    return power_of(dimension_of(e.base, known), e.exp)


def _of_signed_clip(e: sp.Expr, known: Known) -> Dimension | None:
    slope, weight, smoothing, *limits = e.args
    return _common((slope / smoothing, weight / smoothing, *limits), known)


def _of_switch(e: sp.Expr, known: Known) -> Dimension | None:
    slope, weight, *limits = e.args
    _common((slope, weight), known)
    return _common(limits, known)


def _of_until(e: sp.Expr, known: Known) -> Dimension | None:
    dimension_of(e.args[0], known)
    return _common(e.args[1:], known)


def _of_argmin(e: sp.Expr, known: Known) -> Dimension | None:
    ratios = [a / b for a, b in pairwise(e.args[2:]) if b != 0 and a != 0]
    return _common((*_ends(e), *ratios), known)


def _ends(e: sp.Expr) -> list[sp.Expr]:
    """Return the finite ends of an interval, which are the first two arguments of a minimiser over it."""
    return [end for end in e.args[:2] if not end.is_infinite]


def _of_piecewise(e: sp.Piecewise, known: Known) -> Dimension | None:
    for comparison in e.atoms(sp.core.relational.Relational):
        _common(comparison.args, known)
    return _common([branch for branch, _ in e.args], known)


def _of_stretch(e: sp.Expr, known: Known) -> Dimension | None:
    norm_squared, _, length = (dimension_of(a, known) for a in e.args)
    return over(length, power_of(norm_squared, sp.Rational(1, 2)))


def _of_share(e: sp.Expr, known: Known) -> Dimension | None:
    """Check the arguments of a factor that shortens a vector to a norm, and return that it is a plain number."""
    norm_squared, *limits = e.args
    _common((norm_squared, *(limit**2 for limit in limits)), known)
    return PLAIN


def _of_angle(e: sp.Expr, known: Known) -> Dimension | None:
    _common(e.args, known)
    return PLAIN


_RULES: tuple[tuple[tuple[type, ...], Callable[[Any, Known], Dimension | None]], ...] = (
    ((sp.Add, sp.Max, sp.Min, minimisers.Clip, minimisers.Shrink), lambda e, known: _common(e.args, known)),
    ((sp.Mul,), lambda e, known: product(dimension_of(a, known) for a in e.args)),
    ((sp.Pow,), _of_power),
    ((sp.Abs, roots.Convex), lambda e, known: dimension_of(e.args[0], known)),
    ((minimisers.SignedClip,), _of_signed_clip),
    ((minimisers.Switch, minimisers.SignedSwitch), _of_switch),
    ((pieces.Until,), _of_until),
    ((roots.Choice,), lambda e, known: _common(e.args[1:], known)),
    ((roots.Vertex,), lambda e, known: _common((e.args[1] / e.args[0], *e.args[2:]), known)),
    ((roots.Argmin,), _of_argmin),
    ((roots.Root,), lambda e, known: _common(_ends(e), known)),  # nothing tells where it has no ends
    ((sp.Piecewise,), _of_piecewise),
    ((minimisers.Stretch,), _of_stretch),
    ((minimisers.Shorten, minimisers.Within), _of_share),
    ((sp.atan2, roots.Bearing), _of_angle),
    ((sp.sign,), lambda _, __: PLAIN),
)
"""Classes of expressions with the rule for each; any other function takes and returns plain numbers."""
