"""A long way down: minimisation after minimisation, each on a mesh laid for where the last one came to."""

from __future__ import annotations

from dataclasses import replace

from satsym.solvers.collocation import mesh as meshes
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.curve import Curve
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.sqp import minimise
from satsym.solvers.collocation.system import System
from satsym.solvers.iteration import Limits

ROUNDS, STEPS = 6, 60
"""Minimisations, and steps of each."""


def descended(problem: TwoPoint, curve: Curve, stages: int, tolerance: float, limits: Limits) -> Attempt:
    """Minimise from a neighbour's minimum. Where there is none nearby the way may be long, and need other meshes."""
    steps = 0
    for _ in range(ROUNDS):
        curve = curve.on(meshes.laid(problem, curve), stages)
        found = minimise(System(problem, curve.mesh, stages), curve, limits, tolerance, STEPS, meshes.COARSEST)
        steps, curve = steps + found.iterations, found.curve
        if limits.expired or found.reason not in (Reason.OUTGROWN, Reason.NO_CONVERGENCE):
            break
    return replace(found, iterations=steps)
