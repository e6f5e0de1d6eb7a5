"""Extremals followed along a path of problems by its arc length, which goes on where the path turns back.

Each step goes along the tangent and is corrected by Newton's method at right angles to it, so a fold, where
two extremals meet and none is near in the direction of the path, is passed like any other point
(Allgower and Georg, Numerical Continuation Methods, chapters 2 and 10).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from satsym.solvers.collocation import mesh as meshes
from satsym.solvers.collocation.curve import SMALL_COSTATE, Curve, Step
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.linearised import Linearised, linearise
from satsym.solvers.collocation.newton import within_domain
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.second_variation import negative_directions
from satsym.solvers.collocation.system import Residual, System

Problems = Callable[[float], TwoPoint]
"""The problem at a share of the way: given values at the ends change, all else stays; at one, the problem itself."""

FIRST, SHORTEST = 0.02, 1e-5
"""Lengths of a step, in shares of the way where only these change: the first one, and where it is given up."""

CORRECTIONS, TRUSTED, SMALLEST_CORRECTION = 7, 0.3, 1e-4
"""Newton corrections of a step, the largest size of one, and the size at which they end."""

FEW_CORRECTIONS, MANY_CORRECTIONS = 3, 5
"""Corrections up to which the next step is longer, and from which it is shorter."""

AHEAD = 1e-4
"""Difference of shares with which the slope of the residual is measured."""

GROWN = 0.1
"""Relative change of the number of intervals from which the mesh is laid anew."""


@dataclass(frozen=True, eq=False)
class Direction:
    """A change of a curve and of the share of the way."""

    step: Step
    fraction: float

    def times(self, factor: float) -> Direction:
        """This direction, longer or shorter."""
        return Direction(_combined(self.step, factor, self.step, 0.0), factor * self.fraction)


def extremals(at: Problems, start: Curve) -> Iterator[Point]:
    """Extremals along a path of problems, near enough to each other, for as long as they can be followed.

    Parameters
    ----------
    at
        The path. Where it is crossed at one, there is an extremal at exactly one.
    start
        An extremal at its beginning; the first that comes is the next one.
    """
    here, tangent, length = Point(at, 0.0, start.on(meshes.laid(at(0.0), start), STAGES)), None, FIRST
    while length >= SHORTEST:
        try:
            tangent = here.tangent(tangent)
        except np.linalg.LinAlgError:
            return
        there, length = _next(here, tangent, length)
        if there is None:
            return
        yield there
        here, tangent = _resolved(there, tangent)


@dataclass(frozen=True, eq=False)
class Point:
    """A curve at a share of the way: an extremal there, or near one."""

    at: Problems
    """The path."""
    fraction: float
    curve: Curve
    """Where on it, and the curve."""
    known: Linearised | None = None
    """The equations next to it, if they are at hand."""

    @cached_property
    def problem(self) -> TwoPoint:
        """The problem here."""
        return self.at(self.fraction)

    @cached_property
    def system(self) -> System:
        """Its equations."""
        return System(self.problem, self.curve.mesh, STAGES)

    @cached_property
    def residual(self) -> Residual:
        """By how much they fail."""
        return self.system.residual(self.curve)

    @cached_property
    def linearised(self) -> Linearised:
        """The equations here, linearised; LinAlgError where they are singular."""
        return self.known or linearise(self.system, self.curve, self.residual, self.system.jacobian(self.curve))

    @property
    def minimum(self) -> bool:
        """Whether the extremal is one."""
        try:
            return negative_directions(self.problem, self.curve, self.linearised.matching) == 0
        except np.linalg.LinAlgError:
            return False

    def response(self) -> Step:
        """The change of the extremal by the share of the way."""
        there = System(self.at(self.fraction + AHEAD), self.curve.mesh, STAGES).residual(self.curve)
        here = self.residual
        slope = replace(
            here,
            stages=(there.stages - here.stages) / AHEAD,
            ends=np.zeros_like(here.ends),
            start=(there.start - here.start) / AHEAD,
            finish=(there.finish - here.finish) / AHEAD,
        )
        return self.linearised.step(slope)

    def product(self, a: Direction, b: Direction) -> float:
        """The inner product of directions: the share, and the mean over the nodes by the sizes of the curve."""
        n = self.problem.states
        largest = np.abs(self.curve.nodes).reshape(2, -1).max(axis=1)
        sizes = np.repeat(np.maximum(largest, (1.0, SMALL_COSTATE)), n)[:, None]
        return float((a.step.nodes * b.step.nodes / sizes**2).mean()) + a.fraction * b.fraction

    def tangent(self, before: Direction | None) -> Direction:
        """The direction of the path, of length one, on from the direction before."""
        along = Direction(self.response(), 1.0)
        back = before is not None and self.product(before, along) < 0.0
        return along.times((-1.0 if back else 1.0) / self.product(along, along) ** 0.5)

    def moved(self, direction: Direction, fraction: float | None = None) -> Point:
        """The point after a change."""
        there = self.fraction + direction.fraction if fraction is None else fraction
        return Point(self.at, there, self.curve.moved(direction.step, 1.0))


def _next(here: Point, tangent: Direction, length: float) -> tuple[Point | None, float]:
    """The next extremal, and the length of the step after it."""
    while length >= SHORTEST:
        step = tangent.times(length)
        arrives = here.fraction != 1.0 and (here.fraction - 1.0) * (here.fraction + step.fraction - 1.0) <= 0.0
        if arrives:
            step = tangent.times((1.0 - here.fraction) / tangent.fraction)
        try:
            there, needed = _corrected(here, tangent, step, arrives)
        except np.linalg.LinAlgError:
            there, needed = None, CORRECTIONS
        if there is not None:
            return there, length * (1.7 if needed <= FEW_CORRECTIONS else 0.7 if needed >= MANY_CORRECTIONS else 1.0)
        length /= 2.0
    return None, length


def _corrected(here: Point, tangent: Direction, step: Direction, arrives: bool) -> tuple[Point | None, int]:
    """The extremal after a step, across the tangent or, where it arrives, at share one; the corrections it took."""
    if within_domain(here.problem, here.curve, step.step) < 1.0:
        return None, 0
    there, before = here.moved(step, 1.0 if arrives else None), float("inf")
    for needed in range(1, CORRECTIONS + 1):
        correction = Direction(there.linearised.step(there.residual), 0.0)
        if not arrives:
            along = Direction(there.response(), 1.0)
            fraction = -here.product(tangent, correction) / here.product(tangent, along)
            correction = Direction(_combined(correction.step, 1.0, along.step, fraction), fraction)
        size = max(correction.step.size(there.curve), abs(correction.fraction))
        if not size < min(TRUSTED, before / 2.0) or within_domain(there.problem, there.curve, correction.step) < 1.0:
            return None, needed
        there, before = there.moved(correction), size
        if size < SMALLEST_CORRECTION:
            return there, needed
    return None, CORRECTIONS


def _resolved(point: Point, tangent: Direction) -> tuple[Point, Direction]:
    """A point and its tangent on a mesh that follows the motion."""
    curve, step = point.curve, tangent.step
    mesh = meshes.laid(point.problem, curve)
    if abs(len(mesh) - len(curve.mesh)) <= GROWN * len(curve.mesh):
        return point, tangent
    change = Curve(curve.mesh, step.nodes, step.stages, step.theta).on(mesh, STAGES)
    moved = Step(change.nodes, change.stages, change.theta)
    return Point(point.at, point.fraction, curve.on(mesh, STAGES)), Direction(moved, tangent.fraction)


def _combined(a: Step, by: float, b: Step, other: float) -> Step:
    """The sum of multiples of two steps."""
    return Step(by * a.nodes + other * b.nodes, by * a.stages + other * b.stages, by * a.theta + other * b.theta)
