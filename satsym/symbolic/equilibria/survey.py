"""All that is found of the equilibria of one attitude in orbit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp

from satsym.symbolic.derivation import Derivation, DerivationError
from satsym.symbolic.equilibria.attitude import Equilibrium, all_of
from satsym.symbolic.equilibria.continuum import Continuum, continuum
from satsym.symbolic.equilibria.momenta import Followed, follow

REACH_FACTOR = 2.0
"""Equilibria are followed up to so many times the parameter at which it outweighs every other torque."""


@dataclass(frozen=True, eq=False)
class Attitudes:
    """All equilibria of one attitude in orbit.

    Attributes
    ----------
    parameter
        The name of that over which they are followed.
    count, complex
        Exact numbers of real and of complex ones, where they are finitely many.
    equilibria
        All of them, or one of each circle.
    continuum
        Where they are not finitely many.
    followed
        Over the parameter; ``None`` where they are not finitely many at any value.
    """

    parameter: str
    count: int | None
    complex: int | None
    equilibria: tuple[Equilibrium, ...]
    continuum: Continuum | None
    followed: Followed | None


def survey(derivation: Derivation, numbers: Mapping[str, float]) -> Attitudes:
    """Find and follow all equilibria, the parameters being taken for the decimal numbers that they are written as.

    Raises
    ------
    DerivationError
        If the derivation is not that of one attitude in orbit.
    """
    rest = derivation.model.rest(derivation)
    if rest is None or rest.varied is None:
        raise DerivationError(f"{derivation.name}: its equilibria are not those of one attitude in orbit")
    letters = (rest.inertia.free_symbols | rest.torque.free_symbols) - {*rest.cosines, *rest.turns}
    known = {s: sp.Rational(repr(numbers[s.name])) for s in letters | {rest.varied}}
    here = rest.at(known)
    found, equilibria = all_of(here)
    whole = continuum(here, found.dimension) if found.dimension > 0 else None
    return Attitudes(
        parameter=rest.varied.name,
        count=found.real,
        complex=found.complex,
        equilibria=(whole.circles or ()) if whole else equilibria,
        continuum=whole,
        followed=follow(rest, {s: v for s, v in known.items() if s != rest.varied}, REACH_FACTOR),
    )
