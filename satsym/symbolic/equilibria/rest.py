"""Torques on a body at rest relative to its orbit, as polynomials in direction cosines."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import sympy as sp


@dataclass(frozen=True, eq=False)
class Rest:
    """The torques on a body that is at rest relative to its orbit.

    Attributes
    ----------
    inertia
        The mass matrix, in letters.
    torque
        Torques along the body's axes, in the angular velocity, direction cosines and letters.
    turns
        The angular velocity, and what it is at rest, in direction cosines.
    cosines
        Symbols, the orbital axes in rows.
    varied
        The parameter over which equilibria are followed.
    """

    inertia: sp.Matrix
    torque: sp.Matrix
    turns: Mapping[sp.Symbol, sp.Expr]
    cosines: sp.Matrix
    varied: sp.Symbol | None

    def at(self, numbers: Mapping[sp.Symbol, sp.Rational]) -> Rest:
        """Return the equations of rest with numbers in place of letters."""
        known = dict(numbers)
        return replace(
            self,
            inertia=self.inertia.xreplace(known),
            torque=self.torque.xreplace(known),
            turns={w: e.xreplace(known) for w, e in self.turns.items()},
        )

    @cached_property
    def equations(self) -> list[sp.Expr]:
        """Return the torques at rest, which are polynomials in direction cosines."""
        return [sp.expand(e.xreplace(dict(self.turns))) for e in self.torque]

    @cached_property
    def axes(self) -> list[int]:
        """Return the orbital axes that occur in the torques."""
        used = set().union(*(e.free_symbols for e in self.equations))
        return [k for k in range(3) if used & set(self.cosines.row(k))]
