"""Bounds made hard by and by: minima within them that are not reached from the minimum without bounds.

Where exceeding a bound costs as its square, the problem has no bounds and can be minimised from any path; as that is
weighed more and more its minima tend to those within the bounds, or, where none of the paths nearby can keep them,
their cost grows without end (a quadratic penalty: Nocedal and Wright, Numerical Optimization, 17.1).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from satsym.arrays import Array
from satsym.solvers.cold_start.from_path import finished, from_path
from satsym.solvers.collocation import mesh as meshes
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.continuation import kept, settled
from satsym.solvers.collocation.curve import Curve
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.sqp import minimise
from satsym.solvers.collocation.system import System
from satsym.solvers.iteration import Limits

HARDER = 0.1
"""Softness of each problem, as a share of that of the one before."""

HARDEST, HARD = 1e-6, 1e-2
"""Softness at which this ends, and from which on the bounds themselves are tried."""

TOLERANCE, MOST, TRIED = 1e-5, 40, 20
"""Size of the last step of each minimisation; steps of one, and of the first."""

BLOCKED = 5.0
"""Growth of the cost from one softness to the next, tenfold where bounds cannot be kept, that shows it."""


def within_bounds(
    problem: TwoPoint,
    path: Callable[[Array], Array],
    limits: Limits,
    softness: float = 1.0,
    most: int = TRIED,
    arrived: Callable[[Curve], bool] | None = None,
) -> Attempt:
    """The extremal within the bounds to which a path of states leads, its mesh with nodes where these are met.

    Parameters
    ----------
    problem
        With its bounds, and a given duration.
    path
        Scaled states, shape (n, M), at M times tau.
    softness
        Of the first problem: one for that without bounds.
    most
        Steps of its minimisation.
    arrived
        Whether a curve leads to an extremal that is known, which then ends the search.
    """
    softened = problem.softened(softness)
    first = finished(softened, from_path(softened, path, limits, most, arrived), limits)
    if not first.minimum:
        return first
    if not first.curve.in_domain(problem.positive):
        return replace(first, reason=Reason.OUT_OF_DOMAIN)
    return within_found(problem, first, limits, softness)


def within_found(problem: TwoPoint, first: Attempt, limits: Limits, softness: float = 1.0) -> Attempt:
    """The extremal within the bounds to which a minimum leads that was found with soft ones, or without any."""
    if kept(problem, first.curve):
        return first
    curve, cost, steps, grown = first.curve, first.cost, first.iterations, 0
    while softness > HARDEST and not limits.expired:
        softness *= HARDER
        found = _softer(problem.softened(softness), curve, limits)
        steps += found.iterations
        if not found.minimum or not found.curve.in_domain(problem.positive):
            break
        grown = grown + 1 if found.cost > BLOCKED * abs(cost) else 0
        curve, cost = found.curve, found.cost
        if softness <= HARD and grown < 2:
            bounded = settled(problem, curve, STAGES, max(10, len(curve.mesh) - 1), limits)
            steps += bounded.iterations
            if bounded.solved and bounded.curve.in_domain(problem.positive):
                return replace(bounded, iterations=steps)
    return Attempt(curve, Reason.COSTLY if grown >= 2 else Reason.UNSETTLED, steps, cost)


def _softer(problem: TwoPoint, curve: Curve, limits: Limits) -> Attempt:
    """The minimum of the next problem, on a mesh that is laid anew where the curve outgrows it."""
    found = minimise(System(problem, curve.mesh, curve.order), curve, limits, TOLERANCE, MOST, meshes.COARSEST)
    if found.reason is not Reason.OUTGROWN:
        return found
    curve = found.curve.on(meshes.laid(problem, found.curve), STAGES)
    return minimise(System(problem, curve.mesh, curve.order), curve, limits, TOLERANCE, MOST, meshes.COARSEST)
