"""Symbolic operations that several steps of a derivation share: derivatives, simplification, forms of expressions."""

from __future__ import annotations

import math
import random
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache, reduce
from typing import TypeVar

import sympy as sp
from sympy.functions.elementary.hyperbolic import HyperbolicFunction
from sympy.functions.elementary.trigonometric import TrigonometricFunction

from satsym.symbolic.decimals import with_letters
from satsym.symbolic.factoring import factored
from satsym.symbolic.model import Model, symbols_of, t

Simplified = TypeVar("Simplified", sp.Expr, sp.Matrix)

MOST_TERMS_SIMPLIFIED = 400
"""Number of terms after expansion up to which an expression is simplified; larger expressions stay unchanged."""

LENGTHY = 1000
"""Number of operations up to which an expression is simplified; longer expressions stay unchanged."""

COMMON = 300
"""Number of terms over a common denominator above which FLINT is used instead of SymPy, which would be slow."""

TURNING = 300
"""Product of the numbers of operations and of sines and cosines, up to which trigonometric terms are rewritten."""

PROVABLE = 4000
"""Number of terms up to which a sum is multiplied out to decide whether it is zero."""

MOST_OPERATIONS = 150
GROWTH = 2
"""Factor by which the number of operations may grow when an expression is multiplied out.

It is also the largest number of terms that such an expression may have.
"""

FACTORED = 40
"""Number of terms up to which a factorisation of a sum is tried; longer sums rarely have a short one."""

MINUTE = 1e-30
"""Magnitude below which a computed number is taken to be possibly zero."""

ONE_POINT = 20
"""Seed of the random point at which expressions are evaluated first."""

LARGEST_EXPONENT = 20
"""Largest exponent of a power that is multiplied out."""


def total_derivative(expression: sp.Expr | sp.Matrix, rates: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr | sp.Matrix:
    """Return the time derivative of an expression or a matrix along a motion with given rates.

    It is taken by the chain rule, entry by entry of a matrix.
    """
    along = (sp.diff(expression, symbol) * rate for symbol, rate in rates.items())
    return sum(along, sp.diff(expression, t))


def definitions_of(model: Model) -> dict[sp.Symbol, sp.Expr]:
    """Return the named constants of a model with their values, for substitution into expressions."""
    return {symbols_of((d.variable,))[0]: d.value for d in model.definitions}


def constants_of(model: Model) -> set[sp.Symbol]:
    """Return the symbols of a model that do not move: time, parameters and named constants."""
    return {t, *symbols_of(model.parameters), *definitions_of(model)}


def gradient(expression: sp.Expr, symbols: Iterable[sp.Symbol]) -> list[sp.Expr]:
    """Return the partial derivatives of an expression by the given symbols, in their order."""
    return [sp.diff(expression, s) for s in symbols]


def simplified(expression: sp.Expr) -> sp.Expr:
    """Simplify an expression; sympy is asked only where the expression is no polynomial.

    Sums of products of symbols and their powers are multiplied out, for which there is only one form; squares of
    cosines are first replaced by sines.
    """
    named, steep = _steep_named(expression)
    return _simplified(named).xreplace(steep)


@lru_cache(maxsize=4096)  # problems of one model ask alike
def _simplified(expression: sp.Expr) -> sp.Expr:
    if terms_of(expression) > PROVABLE:
        return expression
    expanded = _expand(expression)
    squares = {
        p: (1 - sp.sin(p.base.args[0]) ** 2) ** (p.exp // 2) * p.base ** (p.exp % 2)
        for p in expanded.atoms(sp.Pow)
        if isinstance(p.base, sp.cos) and p.exp.is_Integer and p.exp > 1
    }
    plain = _expand(expanded.xreplace(squares))
    unique = not plain.atoms(sp.Function) and all(p.base.is_Symbol and p.exp.is_Integer for p in plain.atoms(sp.Pow))
    return plain if unique else shortened(expression)


def simplify(expression: Simplified) -> Simplified:
    """Simplify an expression or each entry of a matrix by sympy, with letters in place of decimal numbers.

    Sympy turns decimals into fractions of long whole numbers, whose factors it may seek for hours. Decimals stay where
    the expression that has them may vanish.
    """
    if isinstance(expression, sp.MatrixBase):
        return expression.applyfunc(simplify)
    if not expression.has(sp.Float) or not differs_from_zero(expression):
        return sp.simplify(expression)
    return with_letters(sp.simplify, expression)


def shortened(expression: sp.Expr) -> sp.Expr:
    """Simplify an expression by sympy without merging its logarithms.

    When logarithms are merged, their factors become exponents, and these have no units.
    """
    operations, turned = expression.count_ops(), len(expression.atoms(TrigonometricFunction))
    if terms_of(expression) > MOST_TERMS_SIMPLIFIED or operations > LENGTHY:
        return expression
    if operations * turned > TURNING and differs_from_zero(expression):
        return expression
    if (over := terms_over(expression)) > COMMON:
        if over > PROVABLE and differs_from_zero(expression):
            return expression
        form = factored(expression) if over <= PROVABLE else expression
        if form == 0 or differs_from_zero(expression):
            return shortest(expression, form)
    named, steep = _steep_named(expression)
    inside, meant = _of_functions_named(named)
    if meant and not differs_from_zero(expression):
        if simplify(inside) == 0:
            return sp.Integer(0)
    else:
        named, steep = inside, steep | {symbol: e.xreplace(steep) for symbol, e in meant.items()}
    alone = _alone(named)
    named, steep = named.xreplace(alone), steep | {dummy: f.xreplace(steep) for f, dummy in alone.items()}
    logarithms = {e: sp.Dummy(real=True) for e in named.atoms(sp.log)}
    if not logarithms:
        return simplify(named).xreplace(steep)
    if not differs_from_zero(expression) and simplify(named) == 0:
        return sp.Integer(0)
    simple = simplify(named.xreplace(logarithms)).xreplace({dummy: e for e, dummy in logarithms.items()})
    return simple.xreplace(steep)


def _alone(expression: sp.Expr) -> dict[sp.Expr, sp.Symbol]:
    """Replace functions that sympy cannot relate to others by letters: sympy would search for minutes.

    A sine or cosine is replaced where no power of it occurs, and all of them are where none multiplies another.
    Hyperbolic functions are replaced next to exponentials, unless the expression may be zero.
    """
    hyperbolic, turning = expression.atoms(HyperbolicFunction), expression.atoms(TrigonometricFunction)
    nonzero = bool(hyperbolic or turning) and differs_from_zero(expression)
    related = hyperbolic if nonzero else hyperbolic | expression.atoms(sp.exp)
    found = [f for f in hyperbolic if not _meets(f, related - {f})]
    if nonzero and _degree(expression, turning) <= 1:
        found += turning
    else:
        raised = {p.base for p in expression.atoms(sp.Pow)}
        found += [f for f in turning - raised if not _meets(f, turning - {f})]
    return {f: sp.Dummy(real=True) for f in sorted(found, key=sp.default_sort_key)}


def _degree(expression: sp.Expr, functions: set[sp.Expr]) -> float:
    """Bound the degree of an expression as a polynomial in these functions; infinite where it is none."""
    if expression in functions:
        return 1
    degrees = [_degree(e, functions) for e in expression.args]
    if expression.is_Add or not any(degrees):
        return max(degrees, default=0)
    if expression.is_Mul:
        return sum(degrees)
    if expression.is_Pow and expression.exp.is_Integer and expression.exp.is_positive:
        return degrees[0] * int(expression.exp)
    return math.inf


def _meets(function: sp.Expr, others: Iterable[sp.Expr]) -> bool:
    return any(other.free_symbols & function.free_symbols for other in others)


def shortest(*forms: sp.Expr) -> sp.Expr:
    """Return the one of several equal expressions that has the fewest operations, the first of several such."""
    return min(forms, key=sp.count_ops)


def vanishes(expression: sp.Expr) -> bool:
    """Tell whether an expression is identically zero, as far as simplification shows.

    A number other than zero at a random point shows that the expression is not zero.
    """
    return expression == 0 or (not differs_from_zero(expression) and bool(simplified(expression) == 0))


def divisors_in_time(model: Model, expressions: Iterable[sp.Expr]) -> list[sp.Expr]:
    """Return divisors that depend on time and constants alone, and so must never be zero."""
    powers = {p for e in expressions for p in e.atoms(sp.Pow) if p.exp.is_negative and p.base.has(t)}
    moving = {*symbols_of(model.states), *symbols_of(model.controls)}
    return sorted({p.base for p in powers if not p.base.free_symbols & moving}, key=sp.default_sort_key)


def depends(expression: sp.Expr, symbols: Iterable[sp.Symbol]) -> bool:
    """Tell whether an expression changes with any of the given symbols, as far as simplification shows."""
    return any(not vanishes(sp.diff(expression, s)) for s in expression.free_symbols & set(symbols))


@lru_cache(maxsize=4096)
def differs_from_zero(expression: sp.Expr) -> bool:
    """Tell whether an expression is certainly not zero: its value at one point, to 15 digits, is not."""
    rng = random.Random(ONE_POINT)
    point = {symbol: sp.Rational(rng.randrange(500, 1500), 1000) for symbol in sorted(expression.free_symbols, key=str)}
    value = expression.xreplace(point).evalf()
    return bool(value.is_number and value.is_finite and abs(value) > MINUTE)


def terms_of(expression: sp.Expr) -> int:
    """Count the terms of an expression that is multiplied out, or of what is inside its functions, if none cancel."""
    if expression.is_Add:
        return sum(terms_of(e) for e in expression.args)
    if expression.is_Mul:
        return math.prod(terms_of(e) for e in expression.args)
    if expression.is_Pow and expression.exp.is_Integer:
        return _power(terms_of(expression.base), abs(int(expression.exp)))
    return max((terms_of(e) for e in expression.args if isinstance(e, sp.Expr)), default=1)


def terms_over(expression: sp.Expr) -> int:
    """Count the terms of the numerator of an expression over a common denominator, multiplied out, if none cancel."""
    return _over(expression)[0]


def _over(expression: sp.Expr) -> tuple[int, dict[sp.Expr, int]]:
    """Return the number of terms of the numerator, and the sums in the denominator with their powers."""
    if expression.is_Add:
        parts = [_over(e) for e in expression.args]
        common = {base: max(below.get(base, 0) for _, below in parts) for _, below in parts for base in below}
        missing = ({base: power - below.get(base, 0) for base, power in common.items()} for _, below in parts)
        return sum(terms * _product(lacks) for (terms, _), lacks in zip(parts, missing, strict=True)), common
    if expression.is_Mul:
        factors = [_over(e) for e in expression.args]
        return math.prod(terms for terms, _ in factors), dict(sum((Counter(below) for _, below in factors), Counter()))
    if expression.is_Pow and expression.exp.is_Rational:
        terms, below = _over(expression.base)
        power = math.ceil(abs(expression.exp))
        whole = {base: times * power for base, times in below.items()}
        if expression.exp.is_positive:
            return _power(terms, power), whole
        return _product(whole), {expression.base: power} if terms > 1 else {}
    return max((terms_over(e) for e in expression.args if isinstance(e, sp.Expr)), default=1), {}


def _product(powers: Mapping[sp.Expr, int]) -> int:
    return math.prod(_power(terms_over(base), power) for base, power in powers.items())


def _power(terms: int, power: int) -> int:
    """Return the number of terms of a power of a sum with so many terms."""
    return math.comb(terms + power - 1, power)


def tidy(expression: sp.Expr, by: Sequence[sp.Symbol] = ()) -> sp.Expr:
    """Write an expression as a sum over the symbols in which it is linear, each with its shortest coefficient.

    An expression that would be too long when multiplied out is only split into such terms, and its coefficients stay as
    they are.
    """
    named, steep = _steep_named(sp.sympify(expression))
    expanded = _multiplied_out(named)
    if expanded is None:
        return _parted(named, tuple(by)).xreplace(steep)
    collected = sp.collect(expanded, list(by), evaluate=False) if by else {sp.Integer(1): expanded}
    parts = [factor * _shortest(coefficient) for factor, coefficient in collected.items()]
    return sp.Add(*parts).xreplace(steep)


def _multiplied_out(expression: sp.Expr) -> sp.Expr | None:
    """Expand an expression, unless the result is long and much longer than the expression."""
    if terms_of(expression) > PROVABLE:
        return None
    expanded = _expand(expression)
    long = terms_of(expanded) > MOST_OPERATIONS
    return None if long and expanded.count_ops() > GROWTH * expression.count_ops() else expanded


def _parted(expression: sp.Expr, by: tuple[sp.Symbol, ...]) -> sp.Expr:
    """Split an expression into a sum over the symbols in which it is linear, with its derivatives as coefficients."""
    for k, symbol in enumerate(by):
        slope = sp.diff(expression, symbol)
        if slope != 0 and not slope.has(symbol):
            rest = _parted(expression.xreplace({symbol: sp.Integer(0)}), by[k + 1 :])
            return symbol * tidy(slope, by[k + 1 :]) + rest
    return expression if _multiplied_out(expression) is None else tidy(expression)


def _steep_named(expression: sp.Expr) -> tuple[sp.Expr, dict[sp.Symbol, sp.Expr]]:
    """Replace exponentials with large exponents by symbols; return the expression and what they stand for.

    Sympy treats e^(500 h) as the 500th power of e^h and e^(2.34 h) as the 117th power of e^(h/50).

    Exponentials whose exponents are small multiples of a common one become powers of one symbol. Exponentials that
    scale a difference, such as e^(-k (h - 1)), or contain a number in it, such as e^(-(x - 5/2)^2), are replaced as
    well, because their factors have no moderate numbers of their own. Those that divide by a sum, such as
    e^(-x^2/(x^2 + 0.7)), are steep as soon as sympy multiplies by the denominator.
    """
    scaled = [e for e in expression.atoms(sp.exp) if not e.args[0].is_number]
    steep = {e for e in scaled if any(map(_is_steep, e.args[0].as_coefficients_dict().values()))}
    return _named(expression, [e for e in scaled if e in steep or _divides_by_a_sum(e) or _scales_a_difference(e)])


def _of_functions_named(expression: sp.Expr) -> tuple[sp.Expr, dict[sp.Symbol, sp.Expr]]:
    """Replace exponentials of functions, such as e^(sin x), by symbols; return the expression and the symbols.

    No identity relates them to sines elsewhere in the expression, but sympy may search for one for hours.
    """
    exponentials = expression.atoms(sp.exp)
    inner = set().union(*(e.args[0].atoms(sp.exp) for e in exponentials))
    return _named(expression, [e for e in exponentials - inner if e.args[0].atoms(sp.Function)])


def _named(expression: sp.Expr, exponentials: Iterable[sp.Expr]) -> tuple[sp.Expr, dict[sp.Symbol, sp.Expr]]:
    """Replace exponentials by symbols, as powers of one symbol where exponents are small multiples of each other.

    Returns
    -------
    The expression, and what the symbols stand for.
    """
    families: dict[sp.Expr, dict[sp.Expr, sp.Expr]] = {}
    for e in sorted(exponentials, key=sp.default_sort_key):
        factor, exponent = (sp.cancel if _divides_by_a_sum(e) else sp.expand)(e.args[0]).primitive()
        side = -1 if exponent.could_extract_minus_sign() else 1
        families.setdefault(side * exponent, {})[e] = side * factor
    named: dict[sp.Expr, sp.Expr] = {}
    meant: dict[sp.Symbol, sp.Expr] = {}
    for exponent, factors in families.items():
        common = reduce(sp.gcd, factors.values())
        least = min(factors, key=lambda e: abs(factors[e]))
        if max(abs(f) for f in factors.values()) > LARGEST_EXPONENT * common:
            powers = [({e: sp.Integer(1)}, e) for e in factors]
        elif abs(factors[least]) == common:  # written as it is
            powers = [({e: factor / factors[least] for e, factor in factors.items()}, least)]
        else:
            powers = [({e: factor / common for e, factor in factors.items()}, sp.exp(common * exponent))]
        for exponents, base in powers:
            symbol = sp.Dummy(f"e{len(meant)}", positive=True)
            meant[symbol] = base
            named |= {e: symbol**n for e, n in exponents.items()}
    return expression.xreplace(named), meant


def _divides_by_a_sum(exponential: sp.exp) -> bool:
    powers = exponential.args[0].atoms(sp.Pow)
    return any(p.base.is_Add and p.base.free_symbols and p.exp.is_negative for p in powers)


def _is_steep(coefficient: sp.Expr) -> bool:
    """Tell whether a coefficient in an exponent makes a high power, or one that sympy does not recognise."""
    return abs(coefficient.p if coefficient.is_Rational else coefficient) > LARGEST_EXPONENT


def _scales_a_difference(exponential: sp.exp) -> bool:
    terms = sp.Add.make_args(sp.expand(exponential.args[0]))
    common = set.intersection(*(term.free_symbols for term in terms))
    return len(terms) > 1 and (bool(common) or any(term.is_number for term in terms))


@lru_cache(maxsize=4096)  # problems of one model ask alike
def _shortest(expression: sp.Expr) -> sp.Expr:
    expanded = _expand(expression)
    # A sum with decimals is hardly ever a product of others, and to look for them takes sympy up to a minute.
    long = len(sp.Add.make_args(expanded)) > FACTORED or terms_over(expression) > PROVABLE
    plain = long or expression.has(sp.Float)
    fraction = sp.together(expression)
    products = sp.gcd_terms(expanded) if plain else factored(expression, fraction)
    return min((expanded, products, fraction), key=sp.count_ops)


def _expand(expression: sp.Expr) -> sp.Expr:
    """Multiply out products and powers, but leave roots of sums and logarithms in one piece.

    Roots of sums are easier to simplify whole, and the parts of a logarithm may have units.
    """
    powers = {p for p in expression.atoms(sp.Pow) if p.base.is_Add and p.exp.is_Rational and not p.exp.is_Integer}
    whole = {sp.Pow(p.base, sp.Rational(1, p.exp.q)): sp.Dummy(positive=True) for p in powers}
    hidden = {p: whole[sp.Pow(p.base, sp.Rational(1, p.exp.q))] ** p.exp.p for p in powers}
    expanded = sp.expand(expression.xreplace(hidden), log=False)
    return expanded.xreplace({dummy: root for root, dummy in whole.items()})
