"""Which equation of a derivation a printed one is meant to be: the one that it shares most terms with."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from functools import lru_cache

from satsym.formula.angles import Complex, Monomial, TooManyTerms, terms_of
from satsym.formula.tree import Node

_MOST_SHIFTS = 24


@lru_cache(maxsize=4000)
def terms(tree: Node) -> Mapping[Monomial, Complex]:
    """A formula as a sum of products; none of what has too many."""
    try:
        return terms_of(tree).coefficients
    except (TooManyTerms, RecursionError):
        return {}


def likeness(printed: Node, target: Node) -> float:
    """How much of two residuals is the same, up to a common factor: one for the same, at most zero for nothing."""
    one, other = terms(printed), terms(target)
    if not one or not other:
        return 0.0
    best = 0.0
    shifts: dict[tuple[Monomial, Fraction], None] = {}
    for a in one:
        for b in other:
            if len(shifts) < _MOST_SHIFTS and one[a][0] and not one[a][1]:
                shifts[_over(a, b), other[b][0] / one[a][0]] = None
    for shift, scale in shifts:
        shared = 0.0
        for a, (real, imaginary) in one.items():
            there = other.get(_over(a, shift))
            if there is not None:
                same = there == (real * scale, imaginary * scale)
                shared += 1.0 if same else 0.6
        best = max(best, shared / max(len(one), len(other)))
    return best + 0.2 * _letters_shared(one, other)


def _letters_shared(one: Mapping[Monomial, Complex], other: Mapping[Monomial, Complex]) -> float:
    mine, theirs = ({name for key in terms_ for name, _ in key} for terms_ in (one, other))
    return len(mine & theirs) / max(1, len(mine | theirs))


def _over(one: Monomial, other: Monomial) -> Monomial:
    powers = dict(one)
    for name, power in other:
        powers[name] = powers.get(name, Fraction(0)) - power
    return tuple(sorted((name, power) for name, power in powers.items() if power))
