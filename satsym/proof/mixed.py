"""Arcs on the boundary of a constraint on states and one control together, which limits the control by the states.

On such an arc the control follows from the boundary, and the rates of the costates have a multiple of the constraint's
gradient in addition. As the multiplier vanishes where the arc begins or ends, H as minimised over the admissible
controls is differentiable once, and the field of extremals is as for bounds of the controls.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from satsym.proof.balls.arithmetic import BeyondProof, Key, Series, constant
from satsym.proof.laws import Law
from satsym.proof.shooting import Junction
from satsym.proof.statement import Statement
from satsym.proof.walls import BesideWalls, Pushed, levels, wall
from satsym.solution import Solution


class BesideMixed(BesideWalls):
    """An arc on which no constraint is active, next to arcs on which one is."""

    def leaving(self, other: Law) -> Key:
        return wall(other.which) if isinstance(other, OnMixed) else super().leaving(other)


class OnMixed(Pushed):
    """An arc on the boundary of a constraint that contains the control."""

    def control(self, z: Sequence[Series]) -> Sequence[Series]:
        t, x, lam = self.parts(z)
        return [self.kernel.boundary_control(t, x, lam, self.p, ())[self.which] + constant(0)]

    def gradient(self, z: Sequence[Series]) -> list[Series]:
        """Return the gradient of the constraint by the states."""
        t, x, _ = self.parts(z)
        found = self.kernel.path_gradient(t, x, self.control(z), self.p)
        return [v + constant(0) for v in found[self.n * self.which : self.n * (self.which + 1)]]

    def conditions(self, z: Sequence[Series]) -> list[tuple[Key, Series]]:
        others = [(wall(k), -v) for k, v in enumerate(levels(self, z)) if k != self.which]
        return [(("path_multiplier", self.which), self.multiplier(z)), *others]

    def leaving(self, other: Law) -> Key:
        return ("path_multiplier", self.which)


def structured(statement: Statement, found: Solution) -> tuple[list[Law], list[Junction], list[float]]:
    """Return laws, junctions and times of an answer whose events are known.

    Raises
    ------
    BeyondProof
        If these are other than beginnings and ends of arcs on boundaries.
    """
    kernel, p = statement.kernel, statement.p
    names = [one.name for one in statement.spec.path_constraints]
    laws: list[Law] = [BesideMixed(kernel, p, ())]
    times = [float(found.times[0])]
    for event in found.events:
        entered = event.kind == "entry"
        if event.kind not in ("entry", "exit") or isinstance(laws[-1], OnMixed) is entered:
            raise BeyondProof("a structure of boundary arcs that is not recognised")
        following = OnMixed(kernel, p, names.index(event.name)) if entered else BesideMixed(kernel, p, ())
        if event.t <= times[0]:
            laws = [following]
        elif event.t < found.times[-1]:
            laws.append(following)
            times.append(event.t)
    junctions = [Junction.between(a, b) for a, b in pairwise(laws)]
    return laws, junctions, [*times, float(found.times[-1])]
