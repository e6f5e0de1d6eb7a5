"""Expressions rewritten as people write them: known sums of squares by name, one exponential, one root."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import combinations

import sympy as sp

from satsym.symbolic.factoring import factored


def readable(expression: sp.Expr) -> sp.Expr:
    """Simplify an expression for print: a sin^2 + a cos^2 as a, complete squares, and exponentials multiplied out."""
    if expression.has(sp.cos):
        expression = rewritten(expression, lambda e: e.is_Add and e.has(sp.cos), _united)
        expression = rewritten(expression, lambda e: e.is_Mul and e.has(sp.cos), _doubled)
    if expression.has(sp.exp):
        expression = rewritten(expression, lambda e: e.is_Mul and e.has(sp.exp), _one_exponential)
    expression = rewritten(expression, lambda e: e.is_Add and len(e.args) > 2, _squared)
    return rewritten(expression, lambda e: e.is_Add and len(e.args) == 2, _over_one)


def rewritten(expression: sp.Expr, matches: Callable[[sp.Expr], bool], change: Callable[[sp.Expr], sp.Expr]) -> sp.Expr:
    """Change the matching parts of an expression; sympy's own replacement is slow where nothing changes."""
    seen, left = {expression}, [expression]
    while left:
        part = left.pop()
        if matches(part) and change(part) != part:
            return expression.replace(matches, change)
        new = [e for e in part.args if e not in seen]
        seen.update(new)
        left += new
    return expression


def _united(total: sp.Expr) -> sp.Expr:
    """Replace every a sin^2 + a cos^2 in a sum by a."""
    terms = list(total.args)
    for term in total.args:
        for square in (p for p in sp.Mul.make_args(term) if p.is_Pow and p.exp == 2 and isinstance(p.base, sp.cos)):
            partner = term / square * sp.sin(square.base.args[0]) ** 2
            if term in terms and partner in terms:
                terms = [t for t in terms if t not in (term, partner)] + [term / square]
    return _sum(total, terms)


def _doubled(product: sp.Expr) -> sp.Expr:
    """Replace every (cos a - sin a) (cos a + sin a) in a product by cos 2 a."""
    for angle in sorted({c.args[0] for c in product.atoms(sp.cos)}, key=sp.default_sort_key):
        factors, both = list(product.args), sp.cos(angle) + sp.sin(angle)
        for sign in (1, -1):
            difference = sign * (sp.cos(angle) - sp.sin(angle))
            if both in factors and difference in factors:
                rest = [f for f in factors if f not in (both, difference)]
                return sp.Mul(sign, *rest, sp.cos(2 * angle))
    return product


def _one_exponential(product: sp.Expr) -> sp.Expr:
    """Merge the exponentials of a product, into a sum that has exponentials itself if that is shorter."""
    powers = [f for f in product.args if isinstance(f, sp.exp)]
    rest = [f for f in product.args if not isinstance(f, sp.exp)]
    if len(powers) > 1:
        product = sp.Mul(*rest, sp.exp(factored(sp.Add(*(p.args[0] for p in powers)))))
    sums = [f for f in rest if f.is_Add and any(t.has(sp.exp) for t in f.args)]
    if not powers or len(sums) != 1:
        return product
    terms = sp.Add(*(_one_exponential(sp.Mul(*powers, t)) for t in sums[0].args))
    within = sp.Mul(*(f for f in rest if f is not sums[0]), terms, evaluate=False)
    return within if sp.count_ops(within) < sp.count_ops(product) else product


def _squared(total: sp.Expr) -> sp.Expr:
    """Replace every a x^2 + 2 a x y + a y^2 in a sum by a (x + y)^2."""
    terms = dict.fromkeys(total.args)  # in order, and found by their hash
    for term, one, other in [(t, *pair) for t in total.args for pair in _pairs(t)]:
        for sign in (1, -1):
            a = sign * term / (2 * one * other)
            united = term, a * one**2, a * other**2
            if all(t in terms for t in united):
                terms = dict.fromkeys([t for t in terms if t not in united] + [a * (one + sign * other) ** 2])
    return _sum(total, list(terms))


def _sum(total: sp.Expr, terms: Sequence[sp.Expr]) -> sp.Expr:
    """Return the sum of terms, or ``total`` itself if its terms are these: sympy would expand sums within it."""
    return total if len(terms) == len(total.args) else sp.Add(*terms, evaluate=len(terms) == 1)


def _over_one(total: sp.Expr) -> sp.Expr:
    """Write two fractions with the same denominator as one, if that is shorter and they share nothing else."""
    (one, below), (other, also) = map(sp.fraction, total.args)
    if below != also or below.is_number or one.free_symbols & other.free_symbols:
        return total
    content, primitive = sp.Add(one, other).primitive()
    united = sp.Mul(content, primitive, 1 / below, evaluate=False)
    return united if sp.count_ops(united) < sp.count_ops(total) else total


def _pairs(term: sp.Expr) -> Iterator[tuple[sp.Expr, sp.Expr]]:
    yield from combinations([f for f in sp.Mul.make_args(term) if f.is_Symbol], 2)
