"""Newton's method for continuity of arcs and boundary conditions, damped by the natural monotonicity test.

The test compares simplified corrections and therefore does not depend on the scaling of the equations (Deuflhard,
Newton Methods for Nonlinear Problems, 3.3 and 7.1).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.solvers.collocation.elimination import Matching
from satsym.solvers.iteration import Limits
from satsym.solvers.shooting.arcs import Arcs
from satsym.solvers.shooting.runge_kutta import ORDER

Correction = tuple[Array, Array]

TOLERANCE = 1e-12
"""Size of the last correction at which Newton's method has converged."""

FLOOR = 1e-9
"""Size below which a correction that no longer shrinks is attributed to rounding."""

SURE = 1e-4
"""Size below which corrections are applied without damping."""

KEEP = 0.3
"""Fraction of a positive state, and of a free duration, that a correction must leave."""

SHORTEST = 1e-3
MOST_STEPS = 30


@dataclass(frozen=True, eq=False)
class Outcome:
    """Result of Newton's method."""

    arcs: Arcs
    """The arcs after the last correction."""
    matching: Matching | None
    """The last linear system; ``None`` if the method failed."""
    iterations: int
    """Number of Newton corrections."""


@dataclass(frozen=True, eq=False)
class Residual:
    """Residual of the shooting equations."""

    defects: Array
    """End of each arc minus the next node, shape (N, 2n)."""
    start: Array
    finish: Array
    """Residuals of the initial and final conditions, shapes (n,) and (n + e,)."""


def residual(arcs: Arcs, ends: Array) -> Residual:
    """Return the residual of arcs with given ends, shape (2n, N)."""
    problem, nodes = arcs.problem, arcs.nodes
    start = nodes[: problem.states, 0] - problem.initial
    return Residual((ends - nodes[:, 1:]).T, start, problem.boundary(nodes[:, -1], arcs.theta))


def linearised(arcs: Arcs) -> tuple[Matching, Residual]:
    """Return the linear system of a correction, and the residual.

    Raises
    ------
    numpy.linalg.LinAlgError
        If the system is singular.
    """
    ends, transition = arcs.variations()
    wrong = residual(arcs, ends)
    by_theta = arcs.by_theta(ends, transition)
    of_end = arcs.problem.boundary_slopes(arcs.nodes[:, -1], arcs.theta)
    return Matching(transition, by_theta, *of_end, mixed=arcs.problem.homogeneous), wrong


def newton(arcs: Arcs, limits: Limits) -> Outcome:
    """Return the result of Newton's method from arcs with a sufficient number of steps."""
    before = float("inf")
    for iteration in range(1, MOST_STEPS + 1):
        try:
            matching, wrong = linearised(arcs)
            correction = _correction(matching, wrong)
        except np.linalg.LinAlgError:
            break
        size = arcs.size(*correction)
        if not np.isfinite(size) or limits.expired:
            break
        moved = _shortened(arcs, correction, matching, size)
        if moved is None:
            break
        arcs = moved
        if size < TOLERANCE or (size < FLOOR and size > 0.2 * before):
            return Outcome(arcs, matching, iteration)
        before = size
    return Outcome(arcs, None, iteration)


def doubled(arcs: Arcs, matching: Matching) -> tuple[Arcs, float]:
    """Return converged arcs with twice as many steps, corrected for these, and their error.

    The error is estimated from that correction (Richardson) and from the remaining correction.
    """
    finer = arcs.with_steps(2 * arcs.steps)
    correction = _correction(matching, residual(finer, finer.ends()))
    corrected = finer.moved(*correction, 1.0)
    left = corrected.size(*_correction(matching, residual(corrected, corrected.ends())))
    return corrected, finer.size(*correction) / (2**ORDER - 1) + left


def _correction(matching: Matching, wrong: Residual) -> Correction:
    return matching.correction(wrong.defects, wrong.start, wrong.finish)


def _shortened(arcs: Arcs, correction: Correction, matching: Matching, size: float) -> Arcs | None:
    """Return the arcs after the longest part of a correction that passes the monotonicity test; ``None`` if none does.

    The part is halved until it passes.
    """
    length = within_domain(arcs, *correction)
    while length > SHORTEST:
        trial = arcs.moved(*correction, length)
        if size < SURE:
            return trial
        if trial.size(*_correction(matching, residual(trial, trial.ends()))) <= (1.0 - length / 4.0) * size:
            return trial
        length /= 2.0
    return None


def within_domain(arcs: Arcs, nodes: Array, theta: Array) -> float:
    """Return the largest fraction (at most one) of a correction that keeps positive states and the duration valid."""
    falls = [float((-nodes[:, i] / arcs.nodes[i]).max()) for i in arcs.problem.positive]
    if arcs.problem.free_time:
        falls.append(abs(float(theta[-1] / arcs.theta[-1])))
    return (1.0 - KEEP) / max(1.0 - KEEP, *falls, 0.0)
