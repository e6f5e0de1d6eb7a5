"""Accuracy: defect corrections on many points of each interval, and where these are not enough a finer mesh."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.arrays import Array, distinct
from satsym.solvers.collocation.accuracy.defect_correction import Corrected, correct_defects, left_out, resolved
from satsym.solvers.collocation.accuracy.jumping import found
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.continuation import apart, corners, misplaced
from satsym.solvers.collocation.curve import Curve
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.linearised import Linearised
from satsym.solvers.collocation.newton import newton
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.system import System
from satsym.solvers.control.breaks import find_breaks
from satsym.solvers.control.jumps import Jump

NEAR_CORRECTION = 1e-3
"""Last correction of Newton's method from which defect corrections converge quickly."""

AIM = 1e-3
"""Share of the tolerance that is aimed at: errors of the initial costates grow a thousandfold and more on the way."""

FINEST = 1e-13
"""What rounding allows."""

ROUNDS = 8
MOST_INTERVALS = 400
FEWEST, LARGEST_SPLIT = 0.6, 4.0
"""Bounds of the change in the density of the mesh in one round."""

ROOM = 0.25
"""Share of an interval by which a node may be moved to a corner; one that is farther from all nodes gets its own."""

ROUGH = 1e-6
"""What polynomials of low order may leave out for defect corrections to converge."""

SPARE = 0.1
"""Share of the error aimed at that the next mesh is laid for."""


def refine(
    problem: TwoPoint, curve: Curve, tolerance: float, keep_nodes: bool = False, known: Linearised | None = None
) -> Attempt:
    """Refine a solution until the error is far below a tolerance; below it is enough if that is all one can get.

    Parameters
    ----------
    curve
        A solution of collocation equations on some mesh.
    tolerance
        Largest error.
    keep_nodes
        Whether nodes lie on corners: intervals are only split, and nodes follow the corners as these become accurate.
    known
        The linearised equations at the curve or nearby, if it is a solution with :data:`STAGES` stages already.
    """
    total, best, aim = 0, Attempt(curve, Reason.INACCURATE, 0), max(AIM * tolerance, FINEST)
    _, scheduled = find_breaks(problem.instance)
    if len(scheduled):
        curve, known = curve.on(_followed(curve.mesh, scheduled), STAGES), None
    for _ in range(ROUNDS):
        if known is None:
            system = System(problem, curve.mesh, STAGES, found(problem, curve))
            outcome = newton(system, curve.on(curve.mesh, STAGES), tolerance=NEAR_CORRECTION)
            total += outcome.iterations if outcome else 0
            if outcome and outcome.solved:
                curve, known = outcome.curve, outcome.linearised
        corrected = (correct_defects(curve, known, aim) or resolved(problem, curve, ROUGH)) if known else None
        met = corners(problem, corrected.curve) if corrected and keep_nodes else np.zeros(0)
        jumps = found(problem, corrected.curve) if corrected else []
        error = _error(problem, corrected, met, jumps) if corrected else float("inf")
        better = error < 0.5 * best.error
        if corrected and error < best.error:
            reason = Reason.EXTREMAL if error < tolerance else Reason.INACCURATE
            best = Attempt(corrected.curve, reason, total, error=error)
        if best.error < aim or (best.solved and not better):
            break
        if corrected:
            density = _density(corrected.omitted, SPARE * aim, corrected.curve.order)
        elif known:
            density = _density(left_out(curve), ROUGH, STAGES)
        else:
            density = np.full(len(curve.mesh) - 1, 2.0)
        if density.sum() > MOST_INTERVALS:
            break
        curve = corrected.curve if corrected else curve
        places = distinct(np.concatenate([met, [jump.time for jump in jumps], scheduled]))
        followed = keep_nodes or len(places)
        mesh = _followed(_split(curve.mesh, density), places) if followed else _spread(curve.mesh, density)
        curve, known = curve.on(mesh, STAGES), None
    cost = System(problem, best.curve.mesh, best.curve.order).cost(best.curve)
    return replace(best, cost=cost, facts=(best.error, len(best.curve.mesh) - 1))


def _density(omitted: Array, aim: float, order: int) -> Array:
    """Wanted intervals for each present one, from what its polynomials leave out."""
    found: Array = np.clip((omitted / aim) ** (1.0 / order), FEWEST, LARGEST_SPLIT)
    return found


def _error(problem: TwoPoint, corrected: Corrected, met: Array, jumps: list[Jump]) -> float:
    """The estimated error, or what corners and jumps leave out that are off the nodes, if that is more."""
    curve = corrected.curve
    return max(corrected.error, misplaced(problem, curve, met), _jumping_off(problem, curve, jumps))


def _jumping_off(problem: TwoPoint, curve: Curve, jumps: list[Jump]) -> float:
    """The error that jumps between the nodes cause: the change of the rates times the time to the nearest node."""
    if not jumps:
        return 0.0
    met = np.array([jump.time for jump in jumps])
    node = curve.mesh[np.abs(met[:, None] - curve.mesh).argmin(axis=1)]
    leaps = [problem.saltation(one.time, z, curve.theta, one).leap for one, z in zip(jumps, curve(met).T, strict=True)]
    return apart(problem, curve, np.array(leaps).T, met - node)


def _followed(mesh: Array, met: Array) -> Array:
    """A mesh whose nodes have followed the corners, the others in proportion; far from all nodes they get their own."""
    before, after, own = [0.0], [0.0], []
    for corner in met:
        k = int(np.abs(mesh - corner).argmin())
        room = ROOM * np.diff(mesh)[max(k - 1, 0) : k + 1].min()
        if 0 < k < len(mesh) - 1 and abs(mesh[k] - corner) < room and mesh[k] > before[-1]:
            before.append(float(mesh[k]))
            after.append(float(corner))
        elif abs(mesh[k] - corner) >= room:
            own.append(float(corner))
    moved = np.interp(mesh, [*before, 1.0], [*after, 1.0])
    return distinct(np.concatenate([moved, own]))


def _split(mesh: Array, density: Array) -> Array:
    """Every interval in equal parts."""
    parts = np.ceil(density - 0.05).astype(int)
    inner = [a + (b - a) * np.arange(k) / k for a, b, k in zip(mesh[:-1], mesh[1:], parts, strict=True)]
    return np.concatenate([*inner, mesh[-1:]])


def _spread(mesh: Array, density: Array) -> Array:
    """The errors equally distributed over a new mesh."""
    count = max(int(np.ceil(density.sum())), len(density) + 1)
    cumulated = np.concatenate([[0.0], np.cumsum(density)]) / density.sum()
    spread = np.interp(np.linspace(0.0, 1.0, count + 1), cumulated, mesh)
    spread[0], spread[-1] = mesh[0], mesh[-1]
    return spread
