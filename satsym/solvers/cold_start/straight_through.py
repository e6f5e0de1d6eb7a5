"""The quick way: Newton's method from the straight line between the ends, kept if it walks straight through.

No step may leave the domain, each must be shorter than the one before, few may be needed; on a mesh that resolves the
motion, which is laid anew where it does not, the second variation must be positive. Everything else is left to slower
ways.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.solvers.collocation import mesh as meshes
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.curve import Curve
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.linearised import linearise
from satsym.solvers.collocation.newton import within_domain
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.second_variation import negative_directions
from satsym.solvers.collocation.system import System, costs
from satsym.solvers.iteration import Limits

NEAR_CORRECTION = 3e-2
"""Last correction from which the corrections of the refinement converge, with the linearisation at hand."""

FEW_CORRECTIONS = 6
"""Corrections from the straight line that still count as straight through."""

ROUGH, FEWER = 2, 3
"""First corrections, which are far off whatever the stages, and the stages that they are given."""

SHORTER = 0.8
"""Share of the correction before that the next one may have. The first raises the costates from zero to their size,
whatever that is, so that the second is not to be compared with it closely."""


def straight_through(problem: TwoPoint, start: Curve, limits: Limits) -> Attempt | None:
    """The minimum to which Newton's method leads at once.

    Parameters
    ----------
    problem
        Without bounds.
    start
        A guess, mostly without costates.
    """
    passed: list[tuple[System, Curve, float]] = []
    found = _followed(problem, start, passed)
    cost_of_each = costs([(system, curve) for system, curve, _ in passed]) if found or limits.watch else []
    for cost, (_, _, size) in zip(cost_of_each, passed, strict=False):
        limits.tell(cost * problem.scale.cost, size)
    return replace(found, cost=cost_of_each[-1]) if found else None


def _followed(problem: TwoPoint, start: Curve, passed: list[tuple[System, Curve, float]]) -> Attempt | None:
    """The attempt without its cost; curves on the way, and the corrections that led to them, are put into a list."""
    curve, before = start.with_stages(FEWER), float("inf")
    system = System(problem, start.mesh, FEWER)
    for steps in range(1, FEW_CORRECTIONS + 1):
        if steps == ROUGH + 1:
            curve, system = curve.with_stages(STAGES), System(problem, curve.mesh, STAGES)
        residual, jacobian = system.residual(curve), system.jacobian(curve)
        try:
            linearised = linearise(system, curve, residual, jacobian)
            step = linearised.step(residual)
            moved = curve.moved(step, 1.0)
            size = step.size(moved)
            if not size < before or within_domain(problem, curve, step) < 1.0:
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
