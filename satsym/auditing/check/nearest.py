"""Similarity of equations: a printed equation is meant to be the derived one with which it shares most terms."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from functools import lru_cache
from itertools import product
from typing import Any

from satsym.formula.angles import Complex, Monomial, TooManyTerms, over, terms_of
from satsym.formula.tree import Node

_MOST_SHIFTS = 24


@lru_cache(maxsize=20_000)
def terms(tree: Node) -> Mapping[Monomial, Complex]:
    """Return a formula as a sum of products, by monomial; empty if the sum has too many terms."""
    try:
        found = terms_of(tree).coefficients
    except (TooManyTerms, RecursionError):
        return {}
    # whole exponents as integers: these are added and compared many times quicker
    whole: Any = {key: tuple((n, p if p.denominator != 1 else p.numerator) for n, p in key) for key in found}
    return {whole[key]: value for key, value in found.items()}


def likeness(printed: Node, target: Node, least: float = 0.0) -> float:
    """Return the similarity of two residuals up to a common factor: about one if they agree, zero if nothing is shared.

    Zero is also returned if the numbers of terms and the letters show that the similarity is below `least`.
    """
    one, other = terms(printed), terms(target)
    if not one or not other:
        return 0.0
    mine, theirs = _letters(printed), _letters(target)
    letters = 0.2 * len(mine & theirs) / max(1, len(mine | theirs))
    if min(len(one), len(other)) / max(len(one), len(other)) + letters < least:
        return 0.0
    best = 0.0
    shifts: dict[tuple[Monomial, Fraction], None] = {}
    for a, b in product((a for a, (real, imaginary) in one.items() if real and not imaginary), other):
        shifts[over(a, b), other[b][0] / one[a][0]] = None
        if len(shifts) == _MOST_SHIFTS:
            break
    for shift, scale in shifts:
        shared = 0.0
        for a, (real, imaginary) in one.items():
            there = other.get(over(a, shift))
            if there is not None:
                same = there == (real * scale, imaginary * scale)
                shared += 1.0 if same else 0.6
        best = max(best, shared / max(len(one), len(other)))
    return best + letters


@lru_cache(maxsize=20_000)
def _letters(tree: Node) -> frozenset[str]:
    return frozenset(name for key in terms(tree) for name, _ in key)
