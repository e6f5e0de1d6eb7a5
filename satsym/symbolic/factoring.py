"""Factorisation of expressions by FLINT.

The result is that of :func:`sympy.factor`. For polynomials in many symbols sympy takes up to a hundred times as long,
and for a few it takes minutes, depending on the random evaluation points of Wang's algorithm.
"""

from __future__ import annotations

import sympy as sp
from sympy.polys.rings import sring

from satsym.symbolic.decimals import with_letters

HIGHEST_DEGREE = 200
"""Degree of a polynomial in exponentials above which each exponential is treated as an independent variable.

To SymPy exp(-6.537 x) is the power 6537 of exp(-x/1000), and FLINT would search factors of that degree.
"""


def factored(expression: sp.Expr, fraction: sp.Expr | None = None) -> sp.Expr:
    """Write an expression as a quotient of products of irreducible polynomials with rational coefficients.

    Functions, roots and symbols count as independent. Letters stand for decimals. What has complex numbers is left to
    sympy.

    Parameters
    ----------
    fraction
        The expression as one fraction, where that is known.
    """
    expression = sp.sympify(expression)
    if expression.has(sp.Float):
        return with_letters(factored, expression)
    if expression.has(sp.I, sp.Order, sp.Derivative, sp.Integral):
        return sp.factor(expression)
    coefficient, factors = sp.Integer(1), []
    for part in sp.Mul.make_args(sp.together(expression) if fraction is None else fraction):
        base, exponent = part.args if part.is_Pow else (part, sp.Integer(1))
        if part.is_Number:
            coefficient *= part
        elif not (base.is_Add or base.has(sp.exp)):  # exponentials of sums have factors, too
            factors.append(part)
        elif exponent.is_Integer:
            content, found = factor_list(base)
            coefficient *= content**exponent
            factors += [factor ** (exponent * times) for factor, times in found]
        elif exponent.is_Rational:
            factors += _roots(base, exponent)
        else:
            return sp.factor(expression)
    number, product = sp.Mul(*factors).as_coeff_Mul()
    coefficient *= number
    # sympy would multiply each term of a sum by the number
    return (
        sp.Mul(coefficient, product, evaluate=False)
        if product.is_Add and abs(coefficient) != 1
        else coefficient * product
    )


def _roots(base: sp.Expr, exponent: sp.Rational) -> list[sp.Expr]:
    """Return the factors of a root of a polynomial: positive factors have roots of their own."""
    content, found = factor_list(base)
    alone = [factor ** (times * exponent) for factor, times in found if factor.is_positive]
    rest = [factor**times for factor, times in found if not factor.is_positive]
    (alone if content.is_positive else rest).append(content**exponent if content.is_positive else content)
    return [*alone, sp.Mul(*rest) ** exponent]


def factor_list(polynomial: sp.Expr) -> tuple[sp.Rational, list[tuple[sp.Expr, int]]]:
    """Return content and irreducible factors with multiplicities; leading coefficients are positive, as in sympy."""
    from flint import Ordering, fmpz_mpoly_ctx

    ring, poly = sring(polynomial)  # sparse: Poly has a place for each product of powers up to the highest ones
    if not ring.ngens:  # all but a number cancels
        return sp.expand(polynomial), []
    if max(poly.degrees()) > HIGHEST_DEGREE and (exponentials := sorted(polynomial.atoms(sp.exp), key=str)):
        letters = {e: sp.Symbol(f"exponential_{k}", positive=True) for k, e in enumerate(exponentials)}
        back = {letter: e for e, letter in letters.items()}
        content, found = factor_list(polynomial.xreplace(letters))
        return content, [(factor.xreplace(back), times) for factor, times in found]
    if not (ring.domain.is_ZZ or ring.domain.is_QQ):
        content, found = sp.factor_list(polynomial)
        return content, found
    denominator, whole = poly.clear_denoms()
    context = fmpz_mpoly_ctx.get([f"x{k}" for k in range(ring.ngens)], Ordering.lex)
    try:
        number, found = context.from_dict({powers: int(c) for powers, c in whole.items()}).factor()
    except OverflowError:  # python-flint sorts the factors by coefficients, of which it takes none beyond 64 bits
        content, found = sp.factor_list(polynomial)
        return content, found
    content, factors = sp.Rational(int(number), int(denominator)), []
    for factor, times in found:
        terms = factor.to_dict()
        sign = 1 if terms[max(terms)] > 0 else -1
        content *= sign**times
        own = {powers: sign * int(c) for powers, c in terms.items()}
        factors.append((ring.from_dict(own, orig_domain=sp.ZZ).as_expr(), times))
    return content, factors
