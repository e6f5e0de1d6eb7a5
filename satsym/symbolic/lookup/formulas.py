"""Conversion between formula trees and sympy, and tests whether an expression is zero."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from typing import Any

import mpmath as mp
import sympy as sp
from sympy.functions.elementary.hyperbolic import HyperbolicFunction
from sympy.functions.elementary.trigonometric import TrigonometricFunction

from satsym.formula.budget import charge
from satsym.formula.tree import Add, Call, Div, Mul, Neg, Node, Num, Pow, Sym, constant, number
from satsym.symbolic.checks import POINTS, points
from satsym.symbolic.factoring import factored
from satsym.symbolic.functions.minimisers import Clip, Shorten, Shrink, Switch, by_signs

_FUNCTIONS: dict[str, Callable[..., sp.Expr]] = {
    "sin": sp.sin,
    "cos": sp.cos,
    "tan": sp.tan,
    "sqrt": sp.sqrt,
    "exp": sp.exp,
    "log": sp.log,
    "abs": sp.Abs,
    "sign": sp.sign,
    "asin": sp.asin,
    "acos": sp.acos,
    "atan": sp.atan,
    "sinh": sp.sinh,
    "cosh": sp.cosh,
    "tanh": sp.tanh,
    "atan2": sp.atan2,
    "min": sp.Min,
    "max": sp.Max,
}
_NAMES = {function: name for name, function in _FUNCTIONS.items() if name != "sqrt"}
_DIGITS = 40
_OF_CASES = 100
"""Number of random points at which an expression with case distinctions is evaluated."""
_NOT_ZERO = 1e-12
_MOST_COEFFICIENTS = 200_000
"""Largest number of coefficients of a dense polynomial that is factored only to shorten its print."""
_PER_COEFFICIENT = 20
"""Number of calls that are counted against the limit of work for each coefficient of a dense polynomial."""


class NotAFormula(Exception):
    """An expression has parts that printed formulas do not have; the message names them."""


def function(name: str, arguments: list[sp.Expr]) -> sp.Expr:
    """Apply an elementary function to expressions."""
    if name not in _FUNCTIONS:
        raise NotAFormula(f"{name}(...) is not an elementary function")
    return _FUNCTIONS[name](*arguments)


def from_tree(tree: Node, symbols: Callable[[str], sp.Expr]) -> sp.Expr:
    """Convert a tree to an expression of sympy."""
    if isinstance(tree, Num):
        return sp.Rational(tree.value.numerator, tree.value.denominator)
    if isinstance(tree, Sym):
        return symbols(tree.name)
    if isinstance(tree, Neg):
        return -from_tree(tree.operand, symbols)
    if isinstance(tree, Add):
        return sp.Add(*(from_tree(term, symbols) for term in tree.terms))
    if isinstance(tree, Mul):
        return sp.Mul(*(from_tree(factor, symbols) for factor in tree.factors))
    if isinstance(tree, Div):
        return from_tree(tree.numerator, symbols) / from_tree(tree.denominator, symbols)
    if isinstance(tree, Pow):
        return sp.Pow(from_tree(tree.base, symbols), rational(constant(tree.exponent) or Fraction(0)))
    if isinstance(tree, Call):
        return function(tree.function, [from_tree(argument, symbols) for argument in tree.arguments])
    raise NotAFormula(f"{type(tree).__name__} is not a formula")


def to_tree(expression: Any) -> Node:
    """Convert an expression of sympy to a tree in usual form: one quotient, minus signs in front.

    Raises
    ------
    NotAFormula
        If it has a part that printed formulas do not have.
    """
    e = sp.sympify(expression)
    if e.is_Rational:
        return number(Fraction(int(e.p), int(e.q)))
    if e.is_Float:  # a decimal, as it was stated
        return number(Fraction(str(e)))
    if e is sp.I or e is sp.pi:
        return Sym("I" if e is sp.I else "pi")
    if e is sp.E:
        return Call("exp", (Num(Fraction(1)),))
    if e.is_Symbol:
        return Sym(e.name)
    if e.is_Add:
        terms = [to_tree(term) for term in e.as_ordered_terms()]
        return Add(tuple(sorted(terms, key=lambda term: isinstance(term, Neg))))
    if e.is_Mul or (e.is_Pow and e.exp.is_Rational and e.exp.is_negative):
        return _quotient(e)
    if e.is_Pow and e.exp.is_Rational:
        if e.exp == sp.Rational(1, 2):
            return Call("sqrt", (to_tree(e.base),))
        return Pow(to_tree(e.base), number(Fraction(int(e.exp.p), int(e.exp.q))))
    if isinstance(e, sp.exp):
        return Call("exp", (to_tree(e.args[0]),))
    if isinstance(e, Clip):
        value, lower, upper = map(to_tree, e.args)
        return Call("min", (upper, Call("max", (lower, value))))
    if isinstance(e, Shorten):
        norm_squared, limit = map(to_tree, e.args)
        return Call("min", (Num(Fraction(1)), Div(limit, Call("sqrt", (norm_squared,)))))
    if isinstance(e, Switch | Shrink):
        return to_tree(by_signs(e))
    if isinstance(e, sp.Min | sp.Max):
        first, *rest = map(to_tree, sorted(e.args, key=lambda argument: not argument.is_number))
        for other in rest:
            first = Call("min" if isinstance(e, sp.Min) else "max", (first, other))
        return first
    name = _NAMES.get(e.func)
    if name is None:
        raise NotAFormula(f"{e.func} has no counterpart in printed formulas")
    return Call(name, tuple(map(to_tree, e.args)))


def _quotient(e: sp.Expr) -> Node:
    if e.could_extract_minus_sign():
        return Neg(to_tree(-e))
    above, below = sp.fraction(e)
    if below == 1:
        factors = tuple(to_tree(factor) for factor in above.as_ordered_factors())
        return factors[0] if len(factors) == 1 else Mul(factors)
    return Div(to_tree(above), to_tree(below))


def rational(value: Fraction) -> sp.Rational:
    """Return a fraction as a number of sympy."""
    return sp.Rational(value.numerator, value.denominator)


def plain(expression: sp.Expr) -> sp.Expr:
    """Write functions of control sets by minima, as they are printed."""
    return (
        by_signs(expression)
        .replace(Clip, lambda value, lower, upper: sp.Min(upper, sp.Max(lower, value)))
        .replace(Shorten, lambda square, limit: sp.Min(1, limit / sp.sqrt(square)))
    )


def is_zero(expression: sp.Expr) -> bool:
    """Tell whether an expression is identically zero, by rewriting it.

    A rational function is multiplied out; sines and cosines of sums are expanded and reduced by ``sin^2 + cos^2 = 1``;
    roots are taken as symbols with a known power. Only what is left is simplified by sympy.
    """
    e = sp.sympify(expression)
    if e == 0:
        return True
    if e.is_number:
        return bool(sp.expand(e) == 0 or sp.simplify(e) == 0)
    numerator = sp.expand(sp.fraction(sp.together(sp.expand(e, power_base=True)))[0])
    if numerator == 0:
        return True
    if numerator.is_polynomial(*numerator.free_symbols):
        return False
    charge(calls=_multiple(numerator) ** 2)
    taken_apart = sp.expand(
        numerator.rewrite(sp.exp) if numerator.has(sp.sinh, sp.cosh, sp.tanh) else numerator, trig=True
    )
    taken_apart = sp.expand(taken_apart.replace(sp.sin, lambda x: sp.sin(x)).subs(_squares(taken_apart)))
    if taken_apart == 0:
        return True
    charge(calls=_PER_COEFFICIENT * _box(numerator))
    return bool(sp.simplify(numerator) == 0)


def _box(expression: sp.Expr) -> int:
    """Count the coefficients of an expression as a dense polynomial in all bases of powers, zeros included.

    Sympy makes so many lists of the expression, and to find a common divisor evaluates it at a number with so many
    digits.
    """
    return math.prod(1 + degree for degree in _degrees(expression).values())


def _degrees(e: sp.Expr) -> dict[sp.Expr, int]:
    """Return the degree of an expanded expression in each base of powers; exp(5*x) is the fifth power of exp(x)."""
    found: dict[sp.Expr, int] = {}
    if e.is_number:
        return found
    if isinstance(e, sp.Pow) and e.exp.is_Rational:
        return {base: degree * abs(int(e.exp.p)) for base, degree in _degrees(e.base).items()}
    if isinstance(e, sp.exp | TrigonometricFunction | HyperbolicFunction):
        for factor, rest in (term.as_coeff_Mul() for term in sp.Add.make_args(e.args[0])):
            size = max(abs(int(factor.p)), int(factor.q)) if factor.is_Rational else 1
            found[e.func(rest)] = max(found.get(e.func(rest), 0), size)
        return found
    if not isinstance(e, sp.Add | sp.Mul):
        return {e: 1}
    for part in e.args:
        for base, degree in _degrees(part).items():
            before = found.get(base, 0)
            found[base] = max(before, degree) if isinstance(e, sp.Add) else before + degree
    return found


def _multiple(expression: sp.Expr) -> int:
    """Return the largest whole multiple in an argument of a sine or cosine: the degree of its polynomial."""
    arguments = [call.args[0] for call in expression.atoms(TrigonometricFunction, HyperbolicFunction)]
    factors = [abs(term.as_coeff_Mul()[0]) for a in arguments for term in sp.Add.make_args(sp.expand(a))]
    return max((int(factor) for factor in factors if factor.is_Integer), default=0)


def _squares(expression: sp.Expr) -> dict[sp.Expr, sp.Expr]:
    """Replace even powers of sines by cosines, so that sines occur to the first power only."""
    found = {}
    for power in expression.atoms(sp.Pow):
        if isinstance(power.base, sp.sin) and power.exp.is_Integer and power.exp >= 2:
            half, odd = divmod(int(power.exp), 2)
            found[power] = (1 - sp.cos(power.base.args[0]) ** 2) ** half * power.base**odd
    return found


def differs_somewhere(expression: sp.Expr) -> bool:
    """Tell whether an expression differs from zero at a random point, computed with 40 digits.

    An expression with cases is evaluated at many points of many sizes: two bounds differ only beyond the smaller one.
    """
    symbols = sorted(expression.free_symbols, key=lambda s: s.name)
    shown = plain(expression)
    function_ = sp.lambdify(symbols, shown, modules="mpmath")
    rng, cases = random.Random(str(expression)), shown.has(sp.Min, sp.Max, sp.Abs, sp.sign, sp.Piecewise)
    with mp.workdps(_DIGITS):
        for point in points(symbols, str(expression), _OF_CASES if cases else POINTS):
            sizes = [mp.mpf(10) ** rng.uniform(-2.0, 2.0) if cases else 1 for _ in symbols]
            try:
                if abs(function_(*(point[s] * size for s, size in zip(symbols, sizes, strict=True)))) > _NOT_ZERO:
                    return True
            except (ArithmeticError, ValueError, TypeError, AttributeError):  # mpmath orders no complex numbers
                continue
    return False


ZERO = sp.Integer(0)


def symbol(name: str) -> sp.Symbol:
    """Return the real symbol with this name."""
    return sp.Symbol(name, real=True)


def product(factors: Iterable[sp.Expr]) -> sp.Expr:
    """Return the product of some factors."""
    return sp.Mul(*factors)


def roots(polynomial: sp.Expr, by: sp.Symbol) -> list[sp.Expr]:
    """Return the roots of a polynomial with multiplicity, in sympy's order; empty where they have no closed form."""
    found = sp.roots(sp.Poly(sp.expand(polynomial), by))
    ordered = sorted(found, key=sp.default_sort_key)
    return [root for root in ordered for _ in range(found[root])] if sum(found.values()) else []


def nonvanishing_quotient(one: sp.Expr, other: sp.Expr) -> sp.Expr | None:
    """Return the quotient of two expressions if its symbols are positive and it has one sign.

    A sum of squares of other symbols has one sign, too, but equations that differ by such a factor differ for complex
    numbers.
    """
    if is_zero(other) or is_zero(one):
        return None
    quotient = factored(sp.cancel(sp.together(one / other)))
    if not all(symbol.is_positive for symbol in quotient.free_symbols):
        return None
    return quotient if quotient.is_positive or quotient.is_negative else None


def as_number(expression: sp.Expr) -> Fraction | None:
    """Return the value of an expression that is a rational number."""
    value = sp.nsimplify(sp.simplify(expression)) if expression.is_number else expression
    return Fraction(int(value.p), int(value.q)) if value.is_Rational else None


def text(expression: sp.Expr) -> str:
    """Return an expression as sympy writes it, for messages."""
    return str(expression)


def short(expression: sp.Expr) -> sp.Expr:
    """Return the shortest of several ways to write an expression."""
    expanded = sp.expand(expression)
    ways = [expanded, sp.together(expanded)]
    if max(map(_box, sp.fraction(ways[-1]))) <= _MOST_COEFFICIENTS:
        ways.insert(1, factored(expanded))
    return min(ways, key=sp.count_ops)


def has_a_value(expression: sp.Expr) -> bool:
    """Tell whether an expression is free of infinities, as a division by zero has them."""
    return not expression.has(sp.zoo, sp.nan, sp.oo, -sp.oo)


def nullspace(rows: Sequence[Sequence[sp.Expr]]) -> list[list[sp.Expr]]:
    """Return columns that span the null space of a matrix."""
    return [list(column) for column in sp.Matrix(rows).nullspace(simplify=True)]


def exact_matrix(rows: Sequence[Sequence[str]]) -> sp.ImmutableMatrix:
    """Return a matrix of rational numbers, each given as a text such as ``"-1/2"``."""
    return sp.ImmutableMatrix([[sp.Rational(entry) for entry in row] for row in rows])


def exact(value: Any) -> Any:
    """Convert a number to sympy's exact number; leave an expression or a matrix unchanged."""
    return sp.sympify(value)


def solutions(expression: sp.Expr, symbol: sp.Symbol) -> list[sp.Expr]:
    """Return the values of a symbol, possibly real, for which an expression is zero."""
    return [found for found in sp.solve(expression, symbol) if found.is_real is not False]


def compiled(expressions: Sequence[sp.Expr], symbols: Sequence[sp.Symbol]) -> Callable[..., list[float]]:
    """Compile expressions to a function of plain numbers."""
    found: Callable[..., list[float]] = sp.lambdify(list(symbols), list(expressions), modules="math")
    return found


def matrix_of(rows: Sequence[Sequence[sp.Expr]]) -> sp.ImmutableMatrix:
    """Return a matrix of sympy from rows of expressions."""
    return sp.ImmutableMatrix([list(row) for row in rows])
