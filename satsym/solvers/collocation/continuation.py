"""Control bounds by continuation: bounds are tightened until they hold, then nodes are placed at corners.

With the projected control law the canonical equations remain a single system; its solutions have corners where a bound
becomes active or inactive. Newton's method converges from a nearby start, so the bounds are tightened in steps that are
as large as possible.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array, distinct
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.curve import SMALL_COSTATE, Curve, Path
from satsym.solvers.collocation.newton import newton
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.system import System
from satsym.solvers.control.corners import BEYOND_ZERO, LAST_DIGITS, beyond, enclosed
from satsym.solvers.iteration import Limits

FIRST_FRACTION = 0.35
"""First step by which bounds are tightened, relative to the largest violation."""

FASTER = 1.7
QUICK = 6
"""``QUICK`` is the number of Newton corrections up to which the next step that tightens bounds is longer by the factor
``FASTER``."""

SHORTEST = 1e-4
"""Length of a step, relative to the largest violation, below which the continuation is given up."""

SAMPLES = 12
"""Number of points in each interval between which corners are searched for."""

ROUGHLY = 1e-6
"""Accuracy of intermediate solutions, and of the corners at which their nodes lie."""

STILL = 1e-11
SETTLING = 12
"""Maximum number of times that nodes are moved to the corners. Movement of corners, as a fraction of the duration,
below which they count as stationary."""

CLOSEST = 1e-7
"""Smallest distance, as a fraction of the duration, of two corners that get separate nodes."""

NOTHING = 1e-14
"""Error from corners between nodes that is accepted if corners do not become stationary because the crossing is nearly
tangential."""


def tighten(problem: TwoPoint, free: Curve, order: int, limits: Limits) -> Attempt:
    """Continue the extremal of a problem without control bounds to the extremal with its bounds.

    Parameters
    ----------
    problem
        Problem with its bounds.
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
    """Return the increasing times in (0, 1) at which the control law of a curve reaches or leaves a bound."""
    return distinct(np.concatenate([np.zeros(0), *by_bound(problem, curve, within)]))


def by_bound(problem: TwoPoint, curve: Path, within: float = LAST_DIGITS) -> list[Array]:
    """Return the times at which the control law meets each bound, in the order of ``ControlSet.excess``."""
    if not problem.control_set.bounded:
        return []

    def excess(at: Array) -> Array:
        return problem.control_set.excess(_unbounded(problem, curve, at))

    tau, values = _sampled(curve.mesh, excess)
    signs = np.where(np.isfinite(values).all(axis=1, keepdims=True), np.sign(values), 1.0)
    rows, at, after = _changes(signs)
    own = np.arange(len(rows))
    ends = tau[at], tau[after], values[rows, at], values[rows, after]
    met = enclosed(lambda times: excess(times)[rows, own], *ends, within)
    return [met[rows == row] for row in range(len(values))]


def _changes(signs: Array) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.intp]]:
    """Return row and positions before and after each change of sign, with zeros between them skipped."""
    row, at = np.nonzero(signs)
    found = signs[row, at]
    changed = np.flatnonzero((row[:-1] == row[1:]) & (found[:-1] != found[1:]))
    return row[changed], at[changed], at[changed + 1]


def kept(problem: TwoPoint, curve: Path) -> bool:
    """Return whether the control law without bounds satisfies the bounds."""
    return _violation(problem, curve) <= 0.0


def _violation(problem: TwoPoint, curve: Path) -> float:
    """Return the largest violation of the control set by the control law without bounds, at most 0 if there is none.

    Violations within rounding do not count. Brief violations at either end and between points are found as well.
    """
    within = problem.instance.control_set
    if not within.bounded:
        return -np.inf
    tau, _ = _sampled(curve.mesh, lambda at: within.excess(_unbounded(problem, curve, at)))
    law = _unbounded(problem, curve, tau)
    found = within.violation(law)
    return found if found > BEYOND_ZERO * float(np.abs(law).max()) else min(found, 0.0)


def _unbounded(problem: TwoPoint, curve: Path, tau: Array) -> Array:
    """Return the control law of a curve without bounds, shape (m, M)."""
    return problem.control(tau, curve(tau), curve.theta, bounded=False)


def _sampled(mesh: Array, excess: Callable[[Array], Array]) -> tuple[Array, Array]:
    """Return times in every interval, including those of brief bound violations between them, and the excess there.

    Parameters
    ----------
    excess
        Function from times (M,) to signed distances from each bound, shape (bounds, M).
    """
    inside = np.linspace(1e-9, 1.0 - 1e-9, SAMPLES)
    tau = distinct((mesh[:-1, None] + np.diff(mesh)[:, None] * inside).ravel())
    values, apart = excess(tau), np.append(True, np.diff(tau) > CLOSEST)
    momentary: list[float] = []
    for row, own in enumerate(values[:, apart]):
        momentary += beyond(lambda at, row=row: float(excess(np.array([at]))[row, 0]), tau[apart], own)  # type: ignore[misc]
    if not momentary:
        return tau, values
    tau = np.union1d(tau, momentary)
    return tau, excess(tau)


def misplaced(problem: TwoPoint, curve: Path, met: Array) -> float:
    """Return the error from corners between nodes, estimated from the rates on both sides of each corner.

    On the side on which no bound is active, the rates with and without bounds are equal.
    """
    if not len(met):
        return 0.0
    node = curve.mesh[np.abs(met[:, None] - curve.mesh).argmin(axis=1)]
    largest = 0.0
    for at in (node, np.clip(2.0 * met - node, 0.0, 1.0)):
        followed, free = (rates(at, curve(at), curve.theta) for rates in (problem.rates, problem.rates_beyond))
        largest = max(largest, apart(problem, curve, followed - free, met - node))
    return largest


def apart(problem: TwoPoint, curve: Path, rates: Array, late: Array) -> float:
    """Return the relative change of a curve if its rates differ by given amounts (2n, M) for short times (M,)."""
    size = np.abs(curve.nodes).reshape(2, -1).max(axis=1)
    jump = np.abs(rates).reshape(2, problem.states, -1).max(axis=1) / np.maximum(size, (1.0, SMALL_COSTATE))[:, None]
    return float((jump.max(axis=0) * np.abs(late)).max()) * problem.elapsed(curve.theta) / 2.0


def through(points: Array, count: int) -> Array:
    """Return a mesh of about ``count`` intervals with nodes at the given points, shape (N+1,)."""
    inner = points[(points > CLOSEST) & (points < 1.0 - CLOSEST)]
    ends = np.concatenate([[0.0], inner, [1.0]])
    ends = ends[np.concatenate([[True], np.diff(ends) > CLOSEST])]
    ends[-1] = 1.0
    parts = np.maximum(1, np.ceil(np.diff(ends) * count)).astype(int)
    pieces = [a + (b - a) * np.arange(k) / k for a, b, k in zip(ends[:-1], ends[1:], parts, strict=True)]
    return np.concatenate([*pieces, [1.0]])


def stand_still(before: Array, now: Array) -> bool:
    """Return whether corners have not moved."""
    return len(before) == len(now) and bool(np.abs(now - before).max(initial=0.0) < STILL)


def settled(problem: TwoPoint, curve: Curve, order: int, count: int, limits: Limits) -> Attempt:
    """Solve with control bounds, from a curve nearby, with nodes at the corners until these are stationary.

    Parameters
    ----------
    problem
        Problem with its bounds.
    order
        Number of stages; two more are used.
    count
        Approximate number of intervals.
    """
    before: Array | None = None
    now, total = corners(problem, curve), 0
    for _ in range(SETTLING):
        if before is not None and stand_still(before, now):
            return Attempt(curve, Reason.EXTREMAL, total)
        mesh = through(now, count)
        outcome = newton(System(problem, mesh, order + 2), curve.on(mesh, order + 2), most=15)
        if outcome is None or not outcome.solved:
            break
        limits.spend(outcome.iterations * (len(mesh) - 1) * (order + 2))
        total += outcome.iterations
        curve, before = outcome.curve, now
        now = corners(problem, curve)
    else:
        if misplaced(problem, curve, now) < NOTHING:
            return Attempt(curve, Reason.EXTREMAL, total)
    return Attempt(curve, Reason.UNSETTLED, total)
