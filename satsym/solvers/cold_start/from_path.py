"""From a path of states to a minimum: the mesh is laid anew as the curve takes shape."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from satsym.arrays import Array
from satsym.solvers.cold_start import paths
from satsym.solvers.collocation import mesh as meshes
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.sqp import minimise
from satsym.solvers.collocation.system import System
from satsym.solvers.iteration import Limits

STRAIGHT_THROUGH = 15
"""Steps within which the straight line leads to a minimum if it does so easily."""

ROUGHLY, TOLERANCE = 3e-2, 1e-7
"""Sizes of the last step: after the first the mesh is laid anew if the way was hard, the other ends the minimisation.
"""


def from_path(
    problem: TwoPoint, path: Callable[[Array], Array], limits: Limits, most: int = STRAIGHT_THROUGH
) -> Attempt:
    """Minimise from a path of states, shape (n, M) for M times; the mesh is laid anew as the curve takes shape."""
    curve = paths.curve(problem, path)
    steps, hard, tolerance = 0, False, ROUGHLY
    while True:
        system = System(problem, curve.mesh, STAGES)
        found = minimise(system, curve, limits, tolerance, max(most - steps, 1), meshes.COARSEST)
        steps, hard = steps + found.iterations, hard or found.hard
        found = replace(found, iterations=steps, hard=hard)
        extremal = found.reason in (Reason.MINIMUM, Reason.SADDLE)
        if not (extremal or found.reason is Reason.OUTGROWN) or not found.curve.in_domain(problem.positive):
            return found
        if extremal and tolerance == TOLERANCE:
            return found
        if steps >= most or limits.expired:
            return replace(found, reason=Reason.NO_CONVERGENCE, facts=(steps,))
        tolerance = TOLERANCE if extremal else ROUGHLY
        curve = found.curve if extremal and not hard else found.curve.on(meshes.laid(problem, found.curve), STAGES)
