"""Arcs on and beside the boundaries of path constraints.

Constraints on states are of order one or two and linear in the states. On their boundary the controls keep the first or
the second rate of the constraint at zero, and the rates of the costates have a multiple of its gradient in addition;
where a boundary of order two is entered, left or touched the costates jump by such a multiple (direct adjoining). In a
convex problem, non-negative multiples make the extremal a global minimum.

A mixed constraint is one on states and one control together, which limits the control by the states. On its boundary
the control follows from the boundary, and the rates of the costates have a multiple of its gradient as well. As the
multiplier vanishes where the arc begins or ends, H as minimised over the admissible controls is differentiable once,
and the field of extremals is as for bounds of the controls.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from functools import partial
from itertools import pairwise

import numpy as np
from flint import arb_series, ctx

from satsym.proof.balls.arithmetic import Ball, BeyondProof, Key, NotProved, Series, constant, value
from satsym.proof.balls.jets import OPAQUE, gradients
from satsym.proof.balls.kernel import BallKernel
from satsym.proof.balls.taylor import Step
from satsym.proof.laws import Law, Regular
from satsym.proof.shooting import Junction
from satsym.proof.statement import Statement
from satsym.solution import Solution


def wall(which: int) -> Key:
    """Return the key of the condition that a constraint is satisfied."""
    return ("path_constraints", which)


def levels(law: Law, z: Sequence[Series]) -> list[Series]:
    """Return the values of the constraints, which must not be positive."""
    t, x, _ = law.parts(z)
    return list(law.kernel.path_constraints(t, x, law.control(z), law.p, ()))


def gradient_of(law: Law, which: int) -> list[Ball]:
    """Return the derivatives of a constraint by the states, which do not depend on the states.

    Raises
    ------
    BeyondProof
        If they do.
    """
    n, m = law.n, len(law.kernel.spec.controls)
    ctx.cap = 1
    try:
        found = law.kernel.path_gradient(OPAQUE, [OPAQUE] * n, [OPAQUE] * m, law.p)
    except TypeError:
        raise BeyondProof("path constraints that are not linear in the states") from None
    return [value(v) for v in found[n * which : n * which + n]]


class BesideWalls(Regular):
    """An arc on which no path constraint is active."""

    def conditions(self, z: Sequence[Series]) -> list[tuple[Key, Series]]:
        kept = [(wall(k), -v) for k, v in enumerate(levels(self, z))]
        return [*super().conditions(z), *kept]


class Pushed(Law):
    """An arc on the boundary of a constraint, whose gradient enters the rates of the costates.

    Parameters
    ----------
    which
        The place of the constraint among all.
    """

    def __init__(self, kernel: BallKernel, parameters: Sequence[Series], which: int) -> None:
        super().__init__(kernel, parameters)
        self.which = which

    @abstractmethod
    def gradient(self, z: Sequence[Series]) -> list[Series]:
        """Return the gradient of the constraint by the states."""

    def multiplier(self, z: Sequence[Series]) -> Series:
        """Return the factor of the constraint's gradient in the rates of the costates."""
        t, x, lam = self.parts(z)
        return self.kernel.path_multiplier(t, x, self.control(z), lam, self.p, ())[self.which] + constant(0)

    def _rates(self, z: Sequence[Series]) -> Sequence[Series]:
        t, x, lam = self.parts(z)
        u, push = self.control(z), self.multiplier(z)
        costates = self.kernel.costate_rate(t, x, u, lam, self.p)
        pushed = [v - push * s for v, s in zip(costates, self.gradient(z), strict=True)]
        return [*(v + constant(0) for v in self.kernel.dynamics(t, x, u, self.p)), *pushed]

    def _jacobian(self, z: Sequence[Series]) -> Sequence[Series]:
        return gradients(self._rates, z)


class OnBoundary(Pushed):
    """An arc on the boundary of a constraint on the states."""

    def __init__(self, kernel: BallKernel, parameters: Sequence[Series], which: int) -> None:
        super().__init__(kernel, parameters, which)
        self.order = kernel.spec.path_constraints[which].order
        self.slope = [constant(v) for v in gradient_of(self, which)]

    def control(self, z: Sequence[Series]) -> Sequence[Series]:
        t, x, lam = self.parts(z)
        m = len(self.kernel.spec.controls)
        found = self.kernel.boundary_control(t, x, lam, self.p, ())
        return list(found[m * self.which : m * self.which + m])

    def gradient(self, z: Sequence[Series]) -> list[Series]:
        return self.slope

    def vanishing(self, z: Sequence[Series], law: Law | None = None) -> list[Series]:
        """Return what is zero on the arc: the constraint, its rate, H_u along the boundary, and the rate of H_u.

        For a constraint of order one, its rate is zero by the control, and only H_u is left of the others.
        """
        t, x, lam = self.parts(z)
        u, k = (law or self).control(z), self.which
        level = self.kernel.path_constraints(t, x, u, self.p, ())[k]
        rates = self.kernel.path_rates(t, x, u, self.p)[2 * k : 2 * k + self.order - 1]
        others = self.kernel.path_vanishing(t, x, u, lam, self.p, ())[2 * k : 2 * k + self.order]
        return [v + constant(0) for v in (level, *rates, *others)]

    def conditions(self, z: Sequence[Series]) -> list[tuple[Key, Series]]:
        return [(wall(k), -v) for k, v in enumerate(levels(self, z)) if k != self.which]

    def leaving(self, other: Law) -> Key:
        return wall(self.which)


class BesideMixed(BesideWalls):
    """An arc on which no mixed constraint is active, next to arcs on which one is."""

    def leaving(self, other: Law) -> Key:
        return wall(other.which) if isinstance(other, OnMixed) else super().leaving(other)


class OnMixed(Pushed):
    """An arc on the boundary of a mixed constraint."""

    def control(self, z: Sequence[Series]) -> Sequence[Series]:
        t, x, lam = self.parts(z)
        return [self.kernel.boundary_control(t, x, lam, self.p, ())[self.which] + constant(0)]

    def gradient(self, z: Sequence[Series]) -> list[Series]:
        t, x, _ = self.parts(z)
        found = self.kernel.path_gradient(t, x, self.control(z), self.p)
        return [v + constant(0) for v in found[self.n * self.which : self.n * (self.which + 1)]]

    def conditions(self, z: Sequence[Series]) -> list[tuple[Key, Series]]:
        others = [(wall(k), -v) for k, v in enumerate(levels(self, z)) if k != self.which]
        return [(("path_multiplier", self.which), self.multiplier(z)), *others]

    def leaving(self, other: Law) -> Key:
        return ("path_multiplier", self.which)


def structured(statement: Statement, found: Solution) -> tuple[list[Law], list[Junction], list[float], list[float]]:
    """Return laws, junctions, times and jumps of the costates of an answer with constraints on states."""
    kernel, p = statement.kernel, statement.p
    names = [one.name for one in statement.spec.path_constraints]
    laws: list[Law] = [BesideWalls(kernel, p, ())]
    junctions, times, jumps = [], [float(found.times[0])], []
    for event in found.events:
        which = names.index(event.name)
        entered = event.kind == "entry"
        if event.kind not in ("entry", "exit", "touch") or isinstance(laws[-1], OnBoundary) is not (
            event.kind == "exit"
        ):
            raise BeyondProof("a structure of boundary arcs that is not recognised")
        boundary = OnBoundary(kernel, p, which)
        first = boundary.order == 1
        if first and event.kind == "touch":
            raise BeyondProof("a path constraint of order one with a touch point")
        laws.append(boundary if entered else BesideWalls(kernel, p, ()))
        order = 2 if first or event.kind == "touch" else 3
        asked = {"entry": 2 * boundary.order, "touch": 2, "exit": 0}[event.kind]
        slope = () if first else tuple(gradient_of(boundary, which))
        vanishing = partial(_first, boundary, laws[-1], asked)
        junctions.append(Junction(wall(which), wall(which), order, vanishing, slope))
        times.append(event.t)
        jumps += [] if first else [_jump(found, event.t, slope)]
    return laws, junctions, [*times, float(found.times[-1])], jumps


def structured_mixed(statement: Statement, found: Solution) -> tuple[list[Law], list[Junction], list[float]]:
    """Return laws, junctions and times of an answer with mixed constraints whose events are known.

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


def _first(boundary: OnBoundary, law: Law, count: int, z: Sequence[Series]) -> list[Series]:
    """Return the first vanishing quantities on a boundary, under the law of the arc that begins there."""
    return boundary.vanishing(z, law)[:count]


def _jump(found: Solution, t: float, slope: Sequence[Ball]) -> float:
    """Return by how many times the gradient the costates fall at a time, where an answer has that time twice."""
    k = int(np.argmin(np.abs(found.times[:-1] - t) + 1e9 * (np.diff(found.times) > 0.0)))
    fall, along = found.lam[:, k] - found.lam[:, k + 1], np.array([float(v.mid()) for v in slope])
    return float(fall @ along / (along @ along))


def require_push(law: OnBoundary, steps: Sequence[Step]) -> None:
    """Show that the multiplier of a boundary is not negative.

    Raises
    ------
    NotProved
        If its multiplier may be negative.
    """
    for step in steps:
        ctx.cap = 1
        push = value(law.multiplier([arb_series([v]) for v in step.range]))
        if not push >= 0:
            raise NotProved("the multiplier of a path constraint on its boundary could not be shown to be nonnegative")
