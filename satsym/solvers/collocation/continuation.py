"""Bounds on the control: tightened from where they do not bind, then mesh nodes put on the corners they cause.

With the projected control law the canonical equations stay one system; its solutions have corners where a bound
is met or left. Newton converges if it starts near, so the bounds move in as far as they can at a time.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array, distinct
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.curve import Curve, Path, stage_times
from satsym.solvers.collocation.newton import newton
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.system import System
from satsym.solvers.control.corners import LAST_DIGITS, enclosed
from satsym.solvers.iteration import Limits

FIRST_FRACTION = 0.35
"""Of the largest violation, by which the bounds move in first."""

FASTER = 1.7
QUICK = 6
"""Newton corrections up to which the next move is longer."""

SHORTEST = 1e-4
"""Share of the largest violation below which a move is given up."""

SAMPLES = 12
"""Points in each interval between which a corner is looked for."""

ROUGHLY = 1e-6
"""Accuracy of solutions on the way, and of the corners at which their nodes lie."""

STILL = 1e-11
SETTLING = 12
"""Times that nodes are moved to the corners, and the share of the horizon by which these may then still move."""

CLOSEST = 1e-7
"""Smallest distance of two corners that get nodes of their own, as a share of the horizon."""


def tighten(problem: TwoPoint, free: Curve, order: int, limits: Limits) -> Attempt:
    """From the extremal without bounds to the one with them.

    Parameters
    ----------
    problem
        With its bounds.
    """
    worst = _violation(problem, free)
    if worst <= 0.0:
        return Attempt(free, Reason.EXTREMAL, 0)
    count = max(10, len(free.mesh) - 1)
    curve, width, move, total = free, worst, FIRST_FRACTION * worst, 0
    while width > 0.0:
        narrower = max(width - move, 0.0)
        narrower = 0.0 if narrower < 1e-3 * worst else narrower
        step = problem.relaxed(narrower)
        mesh = through(corners(step, curve, ROUGHLY), count)
        outcome = newton(System(step, mesh, order), curve.on(mesh, order), tolerance=ROUGHLY, most=15)
        limits.spend((outcome.iterations if outcome else 1) * (len(mesh) - 1) * order)
        if outcome is None or not outcome.solved:
            move /= 2.0
            if move < SHORTEST * worst or limits.expired:
                return Attempt(curve, Reason.BLOCKED, total, facts=(1.0 - width / worst,))
            continue
        total += outcome.iterations
        curve, width = outcome.curve, narrower
        if limits.watch:
            limits.watch(System(step, mesh, order).cost(curve) * step.scale.cost, width / worst)
        move *= FASTER if outcome.iterations <= QUICK else 1.0
    found = settled(problem, curve, order, count, limits)
    return replace(found, iterations=total + found.iterations)


def corners(problem: TwoPoint, curve: Path, within: float = LAST_DIGITS) -> Array:
    """Times in (0, 1) at which the control law of a curve meets or leaves a bound, increasing."""
    return distinct(np.concatenate([np.zeros(0), *by_bound(problem, curve, within)]))


def by_bound(problem: TwoPoint, curve: Path, within: float = LAST_DIGITS) -> list[Array]:
    """The same, bound by bound, in the order of :func:`satsym.control_set.ControlSet.excess`."""
    if not problem.control_set.bounded:
        return []
    inside = np.linspace(1e-9, 1.0 - 1e-9, SAMPLES)
    tau = distinct((curve.mesh[:-1, None] + np.diff(curve.mesh)[:, None] * inside).ravel())

    def excess(at: Array) -> Array:
        law = problem.control(at, curve(at), curve.theta, bounded=False)
        return problem.control_set.excess(law)

    values = excess(tau)
    signs = np.where(np.isfinite(values).all(axis=1, keepdims=True), np.sign(values), 1.0)
    rows, at, after = _changes(signs)
    own = np.arange(len(rows))
    ends = tau[at], tau[after], values[rows, at], values[rows, after]
    met = enclosed(lambda times: excess(times)[rows, own], *ends, within)
    return [met[rows == row] for row in range(len(values))]


def _changes(signs: Array) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.intp]]:
    """Rows and places before and after each change of sign; zeros between, as right at a node on a corner, are none."""
    row, at = np.nonzero(signs)
    found = signs[row, at]
    changed = np.flatnonzero((row[:-1] == row[1:]) & (found[:-1] != found[1:]))
    return row[changed], at[changed], at[changed + 1]


def kept(problem: TwoPoint, curve: Curve) -> bool:
    """Whether the control law without bounds keeps them."""
    return _violation(problem, curve) <= 0.0


def _violation(problem: TwoPoint, curve: Curve) -> float:
    """By how much the control law without bounds leaves the control set; negative where there are none."""
    if not problem.instance.control_set.bounded:
        return -np.inf
    tau = stage_times(curve.mesh, curve.order).ravel()
    law = problem.control(tau, curve.flat, curve.theta, bounded=False)
    return problem.instance.control_set.violation(law)


def through(points: Array, count: int) -> Array:
    """A mesh of about ``count`` intervals with nodes on the given points, shape (N+1,)."""
    inner = points[(points > CLOSEST) & (points < 1.0 - CLOSEST)]
    ends = np.concatenate([[0.0], inner, [1.0]])
    ends = ends[np.concatenate([[True], np.diff(ends) > CLOSEST])]
    ends[-1] = 1.0
    parts = np.maximum(1, np.ceil(np.diff(ends) * count)).astype(int)
    pieces = [a + (b - a) * np.arange(k) / k for a, b, k in zip(ends[:-1], ends[1:], parts, strict=True)]
    return np.concatenate([*pieces, [1.0]])


def settled(problem: TwoPoint, curve: Curve, order: int, count: int, limits: Limits) -> Attempt:
    """Solve within the bounds, from a curve nearby, with nodes on the corners until these stand still.

    Parameters
    ----------
    problem
        With its bounds.
    order
        Stages; two more are taken.
    count
        Intervals, about.
    """
    before: Array | None = None
    now, total = corners(problem, curve), 0
    for _ in range(SETTLING):
        if before is not None and len(before) == len(now) and np.abs(now - before).max(initial=0.0) < STILL:
            return Attempt(curve, Reason.EXTREMAL, total)
        mesh = through(now, count)
        outcome = newton(System(problem, mesh, order + 2), curve.on(mesh, order + 2), most=15)
        if outcome is None or not outcome.solved:
            break
        limits.spend(outcome.iterations * (len(mesh) - 1) * (order + 2))
        total += outcome.iterations
        curve, before = outcome.curve, now
        now = corners(problem, curve)
    return Attempt(curve, Reason.UNSETTLED, total)
