"""The quick way: Newton's method from the straight line between the ends, kept if it walks straight through.

No step may leave the domain, each must be less than half the one before, few may be needed; the mesh must still
resolve the motion and the second variation must be positive. Everything else is left to slower ways.
"""

from __future__ import annotations

import numpy as np

from satsym.solvers.collocation import mesh as meshes
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.curve import Curve
from satsym.solvers.collocation.linearised import linearise
from satsym.solvers.collocation.newton import within_domain
from satsym.solvers.collocation.second_variation import negative_directions
from satsym.solvers.collocation.system import System
from satsym.solvers.iteration import Limits

NEAR = 3e-2
"""Last correction from which the corrections of the refinement converge, with the linearisation at hand."""

FEW = 6
"""Corrections from the straight line that still count as straight through."""


def straight_through(start: Curve, system: System, limits: Limits) -> Attempt | None:
    """The minimum to which Newton's method leads at once.

    Parameters
    ----------
    start
        A guess, mostly without costates.
    system
        Collocation equations of a problem without bounds, on the guess's mesh and with its stages.
    """
    problem, curve = system.problem, start
    before, steps, cost = float("inf"), 0, 0.0
    while steps < FEW:
        steps += 1
        residual, jacobian = system.residual(curve), system.jacobian(curve)
        try:
            linearised = linearise(system, curve, residual, jacobian)
            step = linearised.step(residual)
            moved = curve.moved(step, 1.0)
            size = step.size(moved)
            if not size < before or within_domain(problem, curve, step) < 1.0:
                return None
            curve = moved
            if limits.watch or size < NEAR:
                cost = system.cost(curve)
                limits.tell(cost * problem.scale.cost, size)
            if size < NEAR:
                break
            before = size / 2.0
        except np.linalg.LinAlgError:
            return None
    else:
        return None
    try:
        minimum = negative_directions(problem, curve, linearised.matching) == 0
    except np.linalg.LinAlgError:
        return None
    if not minimum or system.largest_turn(curve, jacobian) > meshes.COARSEST:
        return None
    return Attempt(curve, Reason.MINIMUM, steps, cost, hard=False, linearised=linearised)
