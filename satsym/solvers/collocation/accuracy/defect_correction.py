"""A solution made accurate between its nodes as well: defect corrections on more points, at no new linearisation.

Gauss collocation with s stages is right to order 2s at the nodes, but between them its polynomials are right to
order s + 1 only. On more points of each interval the defect shows what they miss; how it travels to the end of
the interval, and on to all other nodes, is known from the linearisation at hand, whose fundamental matrices
X(tau) are inverted without a solve, being symplectic.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from satsym.arrays import Array
from satsym.solvers.collocation.accuracy.jumping import found
from satsym.solvers.collocation.curve import SMALL_COSTATE, Curve, Step
from satsym.solvers.collocation.gauss import interpolation, scheme
from satsym.solvers.collocation.linearised import Linearised
from satsym.solvers.collocation.newton import newton
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.system import System

POINTS, MORE = 16, 24
"""Points of each interval, at first and where polynomials through so many leave out too little for a finer mesh."""

MOST_CORRECTIONS = 6
CONTRACTION = 0.1
"""Corrections that shrink less are not worth another."""

ROUNDING = 3e-15
"""Corrections of this size show nothing any more, and residuals of this size are none."""

ROUNDED_ERROR = 1e-14
"""What is said of the error where Newton's method has brought its corrections down to rounding."""

FAINT_COSTATE = 1e-5
"""Share of the size of the states: costates that move them by less are rounded too much to be known as well as others.
"""

LITTLE = 1e-2
"""Scaled costates above this are known as well as any others."""

FAINTEST = 1e-6
"""Scaled costates from which nobody need ask whether they do anything."""


@dataclass(frozen=True, eq=False)
class Corrected:
    """A curve after its defect corrections."""

    curve: Curve
    """On the same mesh, with more stages."""
    error: float
    """Estimate of its error, relative as in :meth:`Step.size`: the last correction, or what its polynomials leave
    out."""
    omitted: Array
    """The latter interval by interval, shape (N,)."""


def correct_defects(curve: Curve, linearised: Linearised, tolerance: float, points: int = POINTS) -> Corrected | None:
    """Correct a solution of collocation equations until its error is below a tolerance, as far as that goes.

    Parameters
    ----------
    linearised
        The linearised equations there or nearby, on the same mesh with the same stages.
    tolerance
        Largest error.
    points
        Of each interval.

    Returns
    -------
    Corrected or None
        ``None`` where corrections are not finite or do not shrink.
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
    omitted = left_out(fine, small)
    found = Corrected(_without_rounding(system, fine), max(size, float(omitted.max())), omitted)
    # What is left out falls by the same factor with every point.
    if points < MORE and found.error > tolerance > found.error ** (MORE / points):
        return correct_defects(fine, linearised, tolerance, MORE) or found
    return found


def resolved(problem: TwoPoint, curve: Curve, rough: float) -> Corrected | None:
    """By Newton's method on all points, where polynomials of low order already leave out little.

    On intervals that are long beside the decay of neighbouring extremals a linearisation of low order is worthless even
    where hardly anything is left of these: it leads corrections nowhere, and more points still follow them.
    """
    if not left_out(curve).max() < rough:
        return None
    system = System(problem, curve.mesh, POINTS, found(problem, curve))
    outcome = newton(system, curve.with_stages(POINTS))
    if outcome is None or not outcome.solved:
        return None
    omitted = left_out(outcome.curve)
    return Corrected(_without_rounding(system, outcome.curve), max(ROUNDED_ERROR, float(omitted.max())), omitted)


def _faint(linearised: Linearised) -> float:
    """The size at which smaller scaled costates count: it moves the states by :data:`FAINT_COSTATE` of theirs.

    What the ends of the states ask of the costates, and how the rounding of states shows in these, is the same
    response.
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
    """The curve with costates that do nothing set to zero: where no control is needed they are noise of both signs.

    They do nothing if the residual of the equations is the same without them, but for rounding.
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
    """What the defect on the fine points says, as a step."""
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
    """Inverses of symplectic matrices [[A, B], [C, D]]: [[D', -B'], [-C', A']]."""
    n = matrices.shape[-1] // 2
    transposed = matrices.swapaxes(-1, -2)
    found = np.empty_like(matrices)
    found[..., :n, :n], found[..., n:, n:] = transposed[..., n:, n:], transposed[..., :n, :n]
    found[..., :n, n:], found[..., n:, :n] = -transposed[..., n:, :n], -transposed[..., :n, n:]
    return found


def left_out(curve: Curve, small: float = SMALL_COSTATE) -> Array:
    """What polynomials of this degree leave out, judged by their last two coefficients, relative, shape (N,)."""
    n = len(curve.nodes) // 2
    known = np.concatenate([curve.nodes[:, :-1, None], curve.stages], axis=2)
    last = np.abs(known @ scheme(curve.order).coefficients[-2:].T).max(axis=2)
    size = np.abs(known).reshape(2 * n, -1).max(axis=1)
    scale = np.repeat([max(1.0, size[:n].max()), max(size[n:].max(), small)], n)
    found: Array = (last / scale[:, None]).max(axis=0)
    return found
