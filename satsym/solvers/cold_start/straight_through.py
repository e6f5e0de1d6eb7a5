"""Quick start: Newton's method from the straight line between the boundary states, accepted only if it goes smoothly.

No correction may leave the domain, each on the same mesh must be smaller than the one before or be rounding, and only
a few are allowed. On a mesh that resolves the motion, which is recomputed if necessary, the second variation must be
positive. All other cases are left to slower methods.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.solvers.collocation import mesh as meshes
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.curve import Curve
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.linearised import linearise
from satsym.solvers.collocation.newton import FLOOR, within_domain
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.second_variation import negative_directions
from satsym.solvers.collocation.system import System, costs
from satsym.solvers.iteration import Limits

NEAR_CORRECTION = 3e-2
"""Size of the last correction below which the refinement converges with the linearisation at hand."""

FEW_CORRECTIONS = 6
"""Largest number of corrections from the straight line."""

ROUGH, FEWER = 2, 3
"""Number of first corrections with fewer stages, and the number of these stages."""

SHORTER = 0.8
"""Factor by which each correction must be smaller than the one before.

The first correction raises the costates from zero to their magnitude, so that the second one is not much smaller.
"""


def straight_through(problem: TwoPoint, start: Curve, limits: Limits) -> Attempt | None:
    """Return the minimum to which Newton's method converges at once; ``None`` if it does not.

    Parameters
    ----------
    problem
        The problem without bounds.
    start
        Initial guess, usually with zero costates.
    limits
        Limits of time, with an observer that is told the cost of each curve.
    """
    passed: list[tuple[System, Curve, float]] = []
    found = _followed(problem, start, passed)
    cost_of_each = costs([(system, curve) for system, curve, _ in passed]) if found or limits.watch else []
    for cost, (_, _, size) in zip(cost_of_each, passed, strict=False):
        limits.tell(cost * problem.scale.cost, size)
    return replace(found, cost=cost_of_each[-1]) if found else None


def _followed(problem: TwoPoint, start: Curve, passed: list[tuple[System, Curve, float]]) -> Attempt | None:
    """Return the attempt without its cost.

    Each curve on the way is appended to `passed`, with the size of its correction.
    """
    curve, before = start.with_stages(FEWER), float("inf")
    system = System(problem, start.mesh, FEWER)
    for steps in range(1, FEW_CORRECTIONS + 1):
        if steps == ROUGH + 1:
            curve, system, before = curve.with_stages(STAGES), System(problem, curve.mesh, STAGES), float("inf")
        residual, jacobian = system.residual(curve), system.jacobian(curve)
        try:
            linearised = linearise(system, curve, residual, jacobian)
            step = linearised.step(residual)
            moved = curve.moved(step, 1.0)
            size = step.size(moved)
            if not (size < before or size < FLOOR) or within_domain(problem, curve, step) < 1.0:
                return None
            curve, before = moved, SHORTER * size
            passed.append((system, curve, size))
            if not size < NEAR_CORRECTION or steps <= ROUGH:
                continue
            if system.largest_turn(curve, jacobian) > meshes.COARSEST:
                curve = curve.on(meshes.laid(problem, curve), STAGES)
                system, before = System(problem, curve.mesh, STAGES), float("inf")
            elif negative_directions(problem, curve, linearised.matching):
                return None
            else:
                return Attempt(curve, Reason.MINIMUM, steps, hard=False, linearised=linearised)
        except np.linalg.LinAlgError:
            return None
    return None
