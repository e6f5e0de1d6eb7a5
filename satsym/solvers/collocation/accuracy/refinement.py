"""Accuracy of collocation: defect corrections on many points of each interval and, if necessary, finer meshes."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from satsym.arrays import Array, distinct
from satsym.solvers.collocation.accuracy.jumping import found
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.continuation import apart, corners, misplaced
from satsym.solvers.collocation.curve import SMALL_COSTATE, Curve, Step
from satsym.solvers.collocation.gauss import STAGES, interpolation, scheme
from satsym.solvers.collocation.linearised import Linearised
from satsym.solvers.collocation.newton import newton
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.system import System
from satsym.solvers.control.breaks import find_breaks
from satsym.solvers.control.jumps import Jump

NEAR_CORRECTION = 1e-3
"""Size of the last Newton correction below which defect corrections converge quickly."""

AIM = 1e-3
"""Error aimed at, relative to the tolerance: errors of the initial costates may grow more than a thousandfold."""

FINEST = 1e-13
"""Smallest error that rounding allows."""

ROUNDS, MOST_INTERVALS, FEWEST, LARGEST_SPLIT = 8, 400, 0.6, 4.0
"""Maximum number of meshes, maximum number of intervals of a mesh, and bounds of the factor by which the density of a
mesh changes."""

ROOM = 0.25
"""Largest distance, relative to an interval, by which a node is moved to a corner; a corner farther away gets its own
node."""

ROUGH = 1e-6
"""Largest truncation error of low-order polynomials for which defect corrections converge."""

SPARE = 0.1
"""Error for which the next mesh is designed, relative to the error aimed at."""

POINTS, MORE = 16, 24
"""Number of points of each interval at first, and number if the truncation error is slightly too large for the
first."""

MOST_CORRECTIONS = 6
"""Maximum number of defect corrections of one solution."""

CONTRACTION = 0.1
"""Ratio of successive corrections above which no further correction is made."""

ROUNDING = 3e-15
"""Size of corrections and residuals that consist of rounding."""

ROUNDED_ERROR = 1e-14
"""Error estimate of a solution whose Newton corrections have reached rounding."""

FAINT_COSTATE = 1e-5
"""Effect of costates on the states, relative to the states, below which rounding makes costates less accurate."""

LITTLE = 1e-2
"""Magnitude of scaled costates above which all are equally accurate."""

FAINTEST = 1e-6
"""Magnitude of scaled costates above which it is not tested whether they have any effect."""


def refine(
    problem: TwoPoint, curve: Curve, tolerance: float, keep_nodes: bool = False, known: Linearised | None = None
) -> Attempt:
    """Refine a solution until the error is well below a tolerance, or at least below it if no more is possible.

    Parameters
    ----------
    curve
        A solution of collocation equations on a mesh.
    tolerance
        Largest admissible error.
    keep_nodes
        Whether nodes lie at corners: intervals are then only divided, and nodes follow the corners as accuracy grows.
    known
        The linearised equations at or near the curve, if it is a solution with :data:`STAGES` stages; otherwise
        ``None``.
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
        corrected = (_correct_defects(curve, known, aim) or _resolved(problem, curve, ROUGH)) if known else None
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
            density = _density(_left_out(curve), ROUGH, STAGES)
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
    """Return the number of new intervals for each interval, from its truncation error."""
    found: Array = np.clip((omitted / aim) ** (1.0 / order), FEWEST, LARGEST_SPLIT)
    return found


def _error(problem: TwoPoint, corrected: _Corrected, met: Array, jumps: list[Jump]) -> float:
    """Return the estimated error, or the error from corners and jumps between nodes if that is larger."""
    curve = corrected.curve
    return max(corrected.error, misplaced(problem, curve, met), _jumping_off(problem, curve, jumps))


def _jumping_off(problem: TwoPoint, curve: Curve, jumps: list[Jump]) -> float:
    """Return the error caused by jumps between nodes: the change of rates times the time to the nearest node."""
    if not jumps:
        return 0.0
    met = np.array([jump.time for jump in jumps])
    node = curve.mesh[np.abs(met[:, None] - curve.mesh).argmin(axis=1)]
    leaps = [problem.saltation(one.time, z, curve.theta, one).leap for one, z in zip(jumps, curve(met).T, strict=True)]
    return apart(problem, curve, np.array(leaps).T, met - node)


def _followed(mesh: Array, met: Array) -> Array:
    """Return a mesh whose nodes are moved to nearby corners, with new nodes at corners far from all nodes."""
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
    """Return a mesh with every interval divided into equal parts."""
    parts = np.ceil(density - 0.05).astype(int)
    inner = [a + (b - a) * np.arange(k) / k for a, b, k in zip(mesh[:-1], mesh[1:], parts, strict=True)]
    return np.concatenate([*inner, mesh[-1:]])


def _spread(mesh: Array, density: Array) -> Array:
    """Return a new mesh over which the errors are equally distributed."""
    count = max(int(np.ceil(density.sum())), len(density) + 1)
    cumulated = np.concatenate([[0.0], np.cumsum(density)]) / density.sum()
    spread = np.interp(np.linspace(0.0, 1.0, count + 1), cumulated, mesh)
    spread[0], spread[-1] = mesh[0], mesh[-1]
    return spread


@dataclass(frozen=True, eq=False)
class _Corrected:
    """A curve after its defect corrections."""

    curve: Curve
    """Curve on the same mesh, with more stages."""
    error: float
    """Estimated error, relative as in :meth:`Step.size`: the last correction or the truncation error, if that is
    larger."""
    omitted: Array
    """Truncation error of each interval, shape (N,)."""


def _correct_defects(curve: Curve, linearised: Linearised, tolerance: float, points: int = POINTS) -> _Corrected | None:
    """Correct a solution of collocation equations until its error is below a tolerance, as far as possible.

    Gauss collocation with s stages has order 2s at the nodes, but between them its polynomials have only order s + 1.
    On more points of each interval the defect shows their error; its propagation to the end of the interval and to all
    other nodes follows from the linearisation, whose symplectic fundamental matrices X(tau) are inverted without
    solving a system.

    Parameters
    ----------
    linearised
        Linearised equations at or near the solution, on the same mesh with the same stages.
    tolerance
        Largest admissible error.
    points
        Number of points of each interval.

    Returns
    -------
    _Corrected or None
        ``None`` if corrections are not finite or do not decrease.
    """
    system = System(linearised.system.problem, curve.mesh, points, linearised.system.jumps)
    onto = interpolation(linearised.system.order, points)
    fundamental = linearised.fundamental(onto)
    inverse = _inverted(fundamental)
    fine, before = curve.with_stages(points), float("inf")
    small = _faint(linearised) if np.abs(curve.nodes[len(curve.nodes) // 2 :]).max() < LITTLE else SMALL_COSTATE
    for _ in range(MOST_CORRECTIONS):
        step = _correction(system, fine, linearised, onto, fundamental, inverse)
        size = step.size(fine, small)
        if not size < before:
            # Near rounding corrections no longer shrink.
            if before > tolerance:
                return None
            size = before
            break
        fine, contraction = fine.moved(step, 1.0), size / before
        if contraction > CONTRACTION:
            break
        # Corrections keep shrinking by the same factor: from the second on, each foretells the next.
        before, size = size, size * contraction if np.isfinite(before) else size
        if size < max(CONTRACTION * tolerance, ROUNDING):
            break
    omitted = _left_out(fine, small)
    found = _Corrected(_without_rounding(system, fine), max(size, float(omitted.max())), omitted)
    # What is left out falls by the same factor with every point.
    if points < MORE and found.error > tolerance > found.error ** (MORE / points):
        return _correct_defects(fine, linearised, tolerance, MORE) or found
    return found


def _resolved(problem: TwoPoint, curve: Curve, rough: float) -> _Corrected | None:
    """Correct a curve by Newton's method on all points, if low-order polynomials already represent it well.

    On intervals that are long compared with the decay of neighbouring extremals, a low-order linearisation is useless
    even if the truncation error is small: corrections from it do not converge, but more points resolve the decay.
    """
    if not _left_out(curve).max() < rough:
        return None
    system = System(problem, curve.mesh, POINTS, found(problem, curve))
    outcome = newton(system, curve.with_stages(POINTS))
    if outcome is None or not outcome.solved:
        return None
    omitted = _left_out(outcome.curve)
    return _Corrected(_without_rounding(system, outcome.curve), max(ROUNDED_ERROR, float(omitted.max())), omitted)


def _faint(linearised: Linearised) -> float:
    """Return the minimum scale of small costates: it moves the states by :data:`FAINT_COSTATE` of their scale.

    The costates that the end conditions require, and the effect of rounding of the states on costates, follow from the
    same response.
    """
    problem = linearised.system.problem
    n, e = problem.states, problem.unknowns
    met = np.zeros((linearised.system.intervals, linearised.system.rows))
    starts = [(unit, np.zeros(n + e)) for unit in np.eye(n)]
    ends = [(np.zeros(n), unit) for unit in np.eye(n, n + e)[problem.fixed]]
    asked = [linearised.matching.correction(met, start, end)[0][:, n:] for start, end in starts + ends]
    largest = float(np.abs(asked).max())
    return max(SMALL_COSTATE, FAINT_COSTATE * largest) if np.isfinite(largest) else SMALL_COSTATE


def _without_rounding(system: System, curve: Curve) -> Curve:
    """Return the curve with costates without effect set to zero: if no control is needed, they are rounding noise.

    They have no effect if the residual of the equations is the same without them, up to rounding.
    """
    n = len(curve.nodes) // 2
    if max(np.abs(curve.nodes[n:]).max(), np.abs(curve.stages[n:]).max()) >= FAINTEST:
        return curve
    nodes, stages = curve.nodes.copy(), curve.stages.copy()
    nodes[n:], stages[n:] = 0.0, 0.0
    without = replace(curve, nodes=nodes, stages=stages)
    left, kept, size = system.residual(without), system.residual(curve), max(1.0, float(np.abs(nodes).max()))
    parts = ((left.stages, kept.stages), (left.ends, kept.ends), (left.start, kept.start), (left.finish, kept.finish))
    done = max(float(np.abs(a - b).max()) for a, b in parts)
    return without if done <= ROUNDING * size else curve


def _correction(
    system: System, fine: Curve, linearised: Linearised, onto: Array, fundamental: Array, inverse: Array
) -> Step:
    """Return the correction that the defect at the fine points implies, as a step."""
    residual, own = system.residual(fine), system.scheme
    defect = (residual.stages @ own.inverse.T).transpose(1, 2, 0)
    carried = (inverse @ defect[..., None])[..., 0]
    local = -(fundamental @ (own.matrix @ carried)[..., None])[..., 0]
    arrived = -(linearised.matching.transition @ (own.weights @ carried)[..., None])[..., 0]
    # The polynomial through the fine points ends elsewhere than where the next interval begins.
    nodes, theta = linearised.matching.correction(arrived - residual.ends.T, residual.start, residual.finish)
    stages = local + linearised.spread(nodes, theta, onto)
    return Step(nodes.T, stages.transpose(2, 0, 1), theta)


def _inverted(matrices: Array) -> Array:
    """Return the inverses of symplectic matrices [[A, B], [C, D]]: [[D', -B'], [-C', A']]."""
    n = matrices.shape[-1] // 2
    transposed = matrices.swapaxes(-1, -2)
    found = np.empty_like(matrices)
    found[..., :n, :n], found[..., n:, n:] = transposed[..., n:, n:], transposed[..., :n, :n]
    found[..., :n, n:], found[..., n:, :n] = -transposed[..., n:, :n], -transposed[..., :n, n:]
    return found


def _left_out(curve: Curve, small: float = SMALL_COSTATE) -> Array:
    """Return the relative truncation error of each interval, shape (N,), from the last two Legendre coefficients."""
    n = len(curve.nodes) // 2
    known = np.concatenate([curve.nodes[:, :-1, None], curve.stages], axis=2)
    last = np.abs(known @ scheme(curve.order).coefficients[-2:].T).max(axis=2)
    size = np.abs(known).reshape(2 * n, -1).max(axis=1)
    scale = np.repeat([max(1.0, size[:n].max()), max(size[n:].max(), small)], n)
    found: Array = (last / scale[:, None]).max(axis=0)
    return found
