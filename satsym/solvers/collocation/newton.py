"""Newton's method for the collocation equations from a good initial curve, damped by the natural monotonicity test.

With exact Jacobians it converges quadratically, also with active bounds, where the equations are only semismooth. The
test compares simplified corrections, so that it does not depend on the scaling of the equations (Deuflhard, Newton
Methods for Nonlinear Problems, 3.3).
"""

from __future__ import annotations

import numpy as np

from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.curve import Curve, Step
from satsym.solvers.collocation.linearised import linearise
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.system import Residual, System

KEEP = 0.3
"""Fraction of a positive state that has to remain after a step."""

SURE = 1e-4
"""Size of corrections below which full steps are taken without a test."""

SHORTEST = 1e-3
ABOUT = 1e-3
"""Largest residual of the equations of motion and end conditions, relative to the states, of a curve that counts as a
solution."""

FLOOR = 1e-9
"""Size below which corrections that no longer decrease count as rounding."""


def newton(system: System, start: Curve, tolerance: float = 1e-12, most: int = 12) -> Attempt | None:
    """Solve the equations by Newton's method from a curve on the system's mesh.

    Returns ``None`` if the equations are singular or not finite.
    """
    problem, curve = system.problem, start
    residual = system.residual(curve)
    before = float("inf")
    for iteration in range(1, most + 1):
        try:
            linearised = linearise(system, curve, residual, system.jacobian(curve))
            step = linearised.step(residual)
        except np.linalg.LinAlgError:
            return None
        size = step.size(curve)
        if not np.isfinite(size):
            return None
        length = within_domain(problem, curve, step)
        while True:
            trial = curve.moved(step, length)
            residual = system.residual(trial)
            if size < SURE or linearised.step(residual).size(trial) <= (1.0 - length / 4.0) * size:
                break
            length /= 2.0
            if length < SHORTEST:
                return Attempt(curve, Reason.NO_CONVERGENCE, iteration, linearised=linearised, facts=(iteration,))
        curve = trial
        # Corrections shrink faster and faster: where the next one is small enough it is not made.
        ahead = size * min(size / before, 1.0) if np.isfinite(before) and length == 1.0 else size
        if ahead < tolerance or (size < FLOOR and size > 0.2 * before):
            if not _moves(system, curve, residual):
                return Attempt(curve, Reason.NO_CONVERGENCE, iteration, linearised=linearised, facts=(iteration,))
            return Attempt(curve, Reason.EXTREMAL, iteration, linearised=linearised)
        before = size
    return Attempt(curve, Reason.NO_CONVERGENCE, most, linearised=linearised, facts=(most,))


def _moves(system: System, curve: Curve, residual: Residual) -> bool:
    """Return whether states roughly satisfy their equations; with very large costates every correction seems small."""
    n = system.problem.states
    size = max(1.0, float(np.abs(curve.nodes[:n]).max()))
    return float(system.infeasibility(residual)[:n].max()) <= ABOUT * size


def within_domain(problem: TwoPoint, curve: Curve, step: Step) -> float:
    """Return the largest fraction of a step that keeps positive states positive and the duration reasonable."""
    length = 1.0
    for i in problem.positive:
        fall = max((-step.stages[i] / curve.stages[i]).max(), (-step.nodes[i] / curve.nodes[i]).max())
        length = min(length, (1.0 - KEEP) / max(1.0 - KEEP, fall))
    if problem.free_time:
        length = min(length, 0.5 * curve.theta[-1] / max(abs(step.theta[-1]), 1e-300))
    return length
