"""Long control laws as a chain of named parts with derivatives.

Substituted in one piece, such a law would occur many times in the functions that depend on it, and more often still in
their derivatives.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.chain import Assignment, Chain, along
from satsym.symbolic.derivation import Derivation
from satsym.symbolic.model import symbols_of, t
from satsym.symbolic.principle import product, set_laws

MOST_OPERATIONS = 250
"""Largest number of operations of laws that are substituted; longer ones become named parts. Thrust on equinoctial
elements has 600, and the Jacobian of its canonical equations in one piece a million."""


@dataclass(frozen=True)
class LawParts:
    """The chain of long laws, the symbols in it for the controls, and the derivatives of all its parts."""

    parts: tuple[Assignment, ...] = ()
    values: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    slopes: Mapping[sp.Symbol, Mapping[sp.Symbol, sp.Expr]] = field(default_factory=dict)

    def jacobian(self, column: sp.Matrix, by: tuple[sp.Symbol, ...]) -> sp.Matrix:
        """Return the derivatives of expressions in which long laws are represented by their symbols."""
        return sp.Matrix([[along(e, self.slopes.get(s, {s: sp.Integer(1)})) for s in by] for e in column])


def law_parts(derivation: Derivation) -> LawParts:
    """Return the chain of a derivation's control laws; empty where all laws are short enough to be substituted."""
    if product.STEP not in derivation or not (laws := _long_laws(derivation)):
        return LawParts()
    names = sp.utilities.numbered_symbols("law_part_", start=1, real=True)
    parts, reduced = sp.cse(list(laws.values()), symbols=names, order="canonical")
    chain = Chain(parts)
    values = {u: chain.named(f"law_of_{u.name}", law) for u, law in zip(laws, reduced, strict=True)}
    states = symbols_of(derivation.model.states)
    plain = Chain(chain.parts)
    slopes = {}
    for by in (*states, *map(n.costate_of, states), t):
        own = Chain(chain.parts)
        slopes[by] = own.derivatives(by)
        plain.parts += own.parts[len(chain.parts) :]
    return LawParts(tuple(plain.parts), values, slopes)


def _long_laws(derivation: Derivation) -> dict[sp.Symbol, sp.Expr]:
    """Return laws without a closed form, and those of other sets where these are long together."""
    without = {
        u: law
        for one in set_laws.found(derivation)
        if one.branch == "stationary"
        for u, law in zip(one.part.symbols, one.laws, strict=True)
    }
    every = set_laws.regularised_law(derivation)
    closed = {u: law for u, law in every.items() if u not in without}
    return without | closed if sum(map(sp.count_ops, closed.values())) > MOST_OPERATIONS else without
