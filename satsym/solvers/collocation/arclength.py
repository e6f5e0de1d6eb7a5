"""Extremals followed along a path of problems by arc length, also past points where the path turns back.

Each step follows the tangent and is corrected by Newton's method at right angles to it, so that a fold, where two
extremals meet and none exists beyond, is passed like any other point (Allgower and Georg, Numerical Continuation
Methods, chapters 2 and 10).
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
"""Function from a fraction of the path to the problem there: only given end values change; at 1 it is the problem
itself."""

FIRST, SHORTEST = 0.02, 1e-5
"""First length of a step, and the length below which the path is given up. A step that changes the path fraction only
has the length of this change."""

CORRECTIONS, TRUSTED, SMALLEST_CORRECTION = 7, 0.3, 1e-4
"""Maximum number of Newton corrections of a step, largest size of a correction, and size below which corrections
end."""

FEW_CORRECTIONS, MANY_CORRECTIONS = 3, 5
"""Number of corrections up to which the next step is longer, and from which it is shorter."""

AHEAD = 1e-4
"""Difference of path fractions in the finite difference of the residual."""

GROWN = 0.1
"""Relative change of the required number of intervals above which a new mesh is used."""


@dataclass(frozen=True, eq=False)
class Direction:
    """A change of a curve and of the fraction of the path at which it is a solution."""

    step: Step
    fraction: float

    def times(self, factor: float) -> Direction:
        """Return this direction multiplied by a factor."""
        return Direction(_combined(self.step, factor, self.step, 0.0), factor * self.fraction)


def extremals(at: Problems, start: Curve) -> Iterator[Point]:
    """Yield extremals along a path of problems, close to each other, as long as the path can be followed.

    Parameters
    ----------
    at
        The path. Where its fraction passes 1, the extremal there is computed for exactly 1.
    start
        Extremal at the beginning of the path; the first one yielded is the next.
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
    """A curve at a fraction of the path: an extremal there, or an approximation of one."""

    at: Problems
    """Function from a fraction of the path to the problem there."""
    fraction: float
    curve: Curve
    """Fraction of the path, and the curve there."""
    known: Linearised | None = None
    """Linearised equations near the point, ``None`` if they are not known."""

    @cached_property
    def problem(self) -> TwoPoint:
        """Return the two-point problem at the fraction of the path that the point has."""
        return self.at(self.fraction)

    @cached_property
    def system(self) -> System:
        """Return the collocation equations of the problem."""
        return System(self.problem, self.curve.mesh, STAGES)

    @cached_property
    def residual(self) -> Residual:
        """Return the residual of the equations at the point."""
        return self.system.residual(self.curve)

    @cached_property
    def linearised(self) -> Linearised:
        """Return the equations linearised at the point; raises LinAlgError if they are singular."""
        return self.known or linearise(self.system, self.curve, self.residual, self.system.jacobian(self.curve))

    @property
    def minimum(self) -> bool:
        """Return whether the extremal is a minimum."""
        try:
            return negative_directions(self.problem, self.curve, self.linearised.matching) == 0
        except np.linalg.LinAlgError:
            return False

    def response(self) -> Step:
        """Return the derivative of the extremal with respect to the fraction of the path."""
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
        """Return the inner product of two directions: of their path fractions plus the nodal mean of scaled changes."""
        n = self.problem.states
        largest = np.abs(self.curve.nodes).reshape(2, -1).max(axis=1)
        sizes = np.repeat(np.maximum(largest, (1.0, SMALL_COSTATE)), n)[:, None]
        return float((a.step.nodes * b.step.nodes / sizes**2).mean()) + a.fraction * b.fraction

    def tangent(self, before: Direction | None) -> Direction:
        """Return the unit tangent of the path, oriented like the previous tangent."""
        along = Direction(self.response(), 1.0)
        back = before is not None and self.product(before, along) < 0.0
        return along.times((-1.0 if back else 1.0) / self.product(along, along) ** 0.5)

    def moved(self, direction: Direction, fraction: float | None = None) -> Point:
        """Return the point that a change of curve and path fraction leads to."""
        there = self.fraction + direction.fraction if fraction is None else fraction
        return Point(self.at, there, self.curve.moved(direction.step, 1.0))


def _next(here: Point, tangent: Direction, length: float) -> tuple[Point | None, float]:
    """Return the next extremal, or ``None``, and the length of the following step."""
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
    """Return the corrected extremal after a step, and the number of corrections.

    Corrections are at right angles to the tangent or, if the step ends the path, at the fraction 1.
    """
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
    """Return a point and its tangent on a mesh that fits the motion."""
    curve, step = point.curve, tangent.step
    mesh = meshes.laid(point.problem, curve)
    if abs(len(mesh) - len(curve.mesh)) <= GROWN * len(curve.mesh):
        return point, tangent
    change = Curve(curve.mesh, step.nodes, step.stages, step.theta).on(mesh, STAGES)
    moved = Step(change.nodes, change.stages, change.theta)
    return Point(point.at, point.fraction, curve.on(mesh, STAGES)), Direction(moved, tangent.fraction)


def _combined(a: Step, by: float, b: Step, other: float) -> Step:
    """Return a linear combination of two steps."""
    return Step(by * a.nodes + other * b.nodes, by * a.stages + other * b.stages, by * a.theta + other * b.theta)
