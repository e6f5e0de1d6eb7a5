"""Extremals with jumps of the control law: mesh nodes follow the jumps until nodes and jumps coincide."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.arrays import distinct
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.continuation import corners, through
from satsym.solvers.collocation.curve import Curve, Path
from satsym.solvers.collocation.linearised import linearise
from satsym.solvers.collocation.newton import newton, within_domain
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.system import System
from satsym.solvers.control.jumps import Jump, jumps

SAMPLES, CLEAR_JUMP = 12, 1e-3
"""Number of points in each interval between which jumps are searched for, and the change of a control, relative to the
largest control, that counts as a jump."""

STILL, MOST_MOVES = 1e-12, 25
"""Movement of jumps, as a fraction of the duration, below which they count as stationary. Maximum number of times that
nodes are moved to the jumps."""

ROUGHLY = 1e-4
"""Relative size of a step below which Newton's method completes the iteration."""

LARGEST_CHANGE = 0.5
"""Largest relative change of a curve in one step."""

CLOSE_JUMPS = 1e-6
"""Distance of two jumps, as a fraction of the duration, below which they are merged."""


def found(problem: TwoPoint, curve: Path) -> list[Jump]:
    """Return the jumps of a curve's control law in order; none if H has a single minimiser for every control."""
    if not problem.instance.model.spec.stationary:
        return []
    inside = np.linspace(1e-9, 1.0 - 1e-9, SAMPLES)
    tau = distinct((curve.mesh[:-1, None] + np.diff(curve.mesh)[:, None] * inside).ravel())

    def joins(jump: Jump) -> bool:  # and not only because the curve itself is torn at a node
        apart = problem.between(jump.time, curve(np.array([jump.time]))[:, 0], curve.theta, jump)
        return apart > CLEAR_JUMP * max(float(np.abs(jump.before).max()), float(np.abs(jump.after).max()))

    return [one for one in jumps(lambda at: problem.control(at, curve(at), curve.theta), tau, CLEAR_JUMP) if joins(one)]


def located(problem: TwoPoint, curve: Curve, order: int, count: int) -> Attempt | None:
    """Return the extremal near a curve, with nodes at its jumps and bound crossings; ``None`` if none is found.

    Nodes move after each Newton step: with fixed nodes, the method would account for the movement of jumps twice.

    Parameters
    ----------
    order
        Number of stages.
    count
        Approximate number of intervals.
    """
    met, before, size = found(problem, curve), np.zeros(0), float("inf")
    for _ in range(MOST_MOVES):
        met = _merged(met)
        times = np.array([jump.time for jump in met])
        mesh = through(np.union1d(corners(problem, curve), times), count)
        system, curve = System(problem, mesh, order, met), curve.on(mesh, order)
        if size < ROUGHLY:
            outcome = newton(system, curve)
            if outcome is None or not outcome.solved:
                return None
            if len(before) == len(times) and np.abs(times - before).max(initial=0.0) < STILL:
                return outcome
            curve = outcome.curve
        else:
            stepped = _stepped(system, curve)
            if stepped is None:
                return None
            curve, size = stepped
        before, met = times, found(problem, curve)
    return Attempt(curve, Reason.UNSETTLED, MOST_MOVES)


def _merged(met: list[Jump]) -> list[Jump]:
    """Return the jumps with coinciding ones merged; a gap of a curve at a node may make its law jump back and forth."""
    left: list[Jump] = []
    for jump in met:
        if left and jump.time - left[-1].time < CLOSE_JUMPS:
            last = left.pop()
            apart = float(np.abs(jump.after - last.before).max())
            if apart > CLEAR_JUMP * max(float(np.abs(jump.after).max()), float(np.abs(last.before).max())):
                left.append(replace(last, after=jump.after))
        else:
            left.append(jump)
    return left


def _stepped(system: System, curve: Curve) -> tuple[Curve, float] | None:
    """Return the curve after a Newton step, and the relative size of the step; ``None`` if the step fails."""
    residual = system.residual(curve)
    try:
        step = linearise(system, curve, residual, system.jacobian(curve)).step(residual)
    except np.linalg.LinAlgError:
        return None
    size = step.size(curve)
    if not np.isfinite(size):
        return None
    return curve.moved(
        step, min(within_domain(system.problem, curve, step), LARGEST_CHANGE / max(size, LARGEST_CHANGE))
    ), size
