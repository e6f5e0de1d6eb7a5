"""Newton's method on the conditions that arcs meet and the boundary is kept, damped by the natural monotonicity test.

The test compares simplified corrections, so it does not depend on how equations are scaled (Deuflhard, Newton
Methods for Nonlinear Problems, 3.3 and 7.1).
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
"""Size of the last correction."""

FLOOR = 1e-9
"""Corrections below this that no longer shrink are rounding."""

SURE = 1e-4
"""Corrections below this are taken whole."""

KEEP = 0.3
"""Share of a positive state, and of a free duration, that a correction must leave."""

SHORTEST = 1e-3
MOST_STEPS = 30


@dataclass(frozen=True, eq=False)
class Outcome:
    """Where Newton ended."""

    arcs: Arcs
    """The last ones."""
    matching: Matching | None
    """The last linear system, ``None`` where it failed."""
    iterations: int
    """Number of corrections."""


@dataclass(frozen=True, eq=False)
class Residual:
    """What is wrong with arcs that end there."""

    defects: Array
    """Where each arc ends, less where the next one begins, shape (N, 2n)."""
    start: Array
    finish: Array
    """Residuals at the boundary, shapes (n,) and (n + e,)."""


def residual(arcs: Arcs, ends: Array) -> Residual:
    """The residual of arcs with their ends, shape (2n, N)."""
    problem, nodes = arcs.problem, arcs.nodes
    start = nodes[: problem.states, 0] - problem.initial
    return Residual((ends - nodes[:, 1:]).T, start, problem.boundary(nodes[:, -1], arcs.theta))


def linearised(arcs: Arcs) -> tuple[Matching, Residual]:
    """The linear system of a correction, and the residual.

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
    """Newton from arcs with enough steps."""
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
    """Solved arcs with twice as many steps, corrected for these; and their error.

    It is estimated from that correction (Richardson), and from what is left to correct.
    """
    finer = arcs.with_steps(2 * arcs.steps)
    correction = _correction(matching, residual(finer, finer.ends()))
    corrected = finer.moved(*correction, 1.0)
    left = corrected.size(*_correction(matching, residual(corrected, corrected.ends())))
    return corrected, finer.size(*correction) / (2**ORDER - 1) + left


def _correction(matching: Matching, wrong: Residual) -> Correction:
    return matching.correction(wrong.defects, wrong.start, wrong.finish)


def _shortened(arcs: Arcs, correction: Correction, matching: Matching, size: float) -> Arcs | None:
    """The arcs after the longest part of a correction, halving it, that passes the test; ``None`` if none does."""
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
    """The longest part of a correction, at most all, that leaves positive states positive and the duration sane."""
    falls = [float((-nodes[:, i] / arcs.nodes[i]).max()) for i in arcs.problem.positive]
    if arcs.problem.free_time:
        falls.append(abs(float(theta[-1] / arcs.theta[-1])))
    return (1.0 - KEEP) / max(1.0 - KEEP, *falls, 0.0)
