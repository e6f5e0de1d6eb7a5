"""Shooting from a cold start: choice of arcs and steps and, within bounds, of nodes at the corners of the control."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solution import Progress, Solution
from satsym.solvers.cold_start.origin import Start
from satsym.solvers.collocation.attempt import Reason
from satsym.solvers.collocation.continuation import NOTHING, corners, misplaced, stand_still, through
from satsym.solvers.collocation.curve import Path
from satsym.solvers.collocation.extremal import Extremal
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.extremal import solved
from satsym.solvers.iteration import Limits
from satsym.solvers.shooting.arcs import Arcs, sufficient
from satsym.solvers.shooting.newton import Outcome, doubled, newton
from satsym.solvers.shooting.runge_kutta import ORDER
from satsym.solvers.two_point import from_cold_start, inside, unfinished
from satsym.status import Status
from satsym.wording import counted

ACCURACY = 1e-11
"""Error of an arc during Newton's method, at first.

The solution uses twice as many steps, whose error is smaller by the factor 256.
"""

REFINEMENTS = 3
"""Number of times that all arcs are halved if Newton's method fails."""

FEWEST_ARCS = 10
"""Smallest number of arcs of a problem whose bounds are met."""

SETTLING = 12
"""Largest number of times that nodes are moved to the corners."""


def solve(instance: Instance, progress: Progress | None = None) -> Solution:
    """Solve an instance by multiple shooting.

    Parameters
    ----------
    instance
        The instance. Final states may be given, on the reference or free, and the final time given or free.
    progress
        Function that is called after each iteration of the cold start, and each phase.

    Returns
    -------
    Solution
        The status is ``converged`` if the estimated error is within the instance's tolerance. The error is usually near
        rounding, independent of the tolerance.

    Raises
    ------
    BadInput
        If the instance requests compiled kernels and numba is not installed.
    """
    if instance.solver.backend == "numba":
        instance = replace(instance, model=instance.model.compiled())
    return solved(instance, progress, "shooting", without_guess)


def without_guess(instance: Instance, limits: Limits) -> Extremal:
    """Return the extremal to which a cold start leads; see :func:`satsym.solvers.two_point.from_cold_start`."""
    return from_cold_start(instance, limits, _accurate)


def extremal(problem: TwoPoint, start: Path, limits: Limits) -> Extremal:
    """Return the extremal within bounds near a path of states and costates.

    Nodes are moved to the corners caused by bounds until these no longer change; then the error determines the number
    of steps.

    Parameters
    ----------
    problem
        The two-point problem.
    start
        Path of states and costates.
    limits
        Limits of time, with an observer that is told the cost of the result.
    """
    tolerance, accuracy = problem.instance.solver.tolerance, ACCURACY
    met, mesh, total = corners(problem, start), start.mesh, 0
    # with a remainder of an arc between neighbouring corners, no more arcs
    count = max(FEWEST_ARCS, len(mesh) - 2 - len(met))
    path, why = start, Reason.UNSETTLED.value
    for last in (*[False] * (SETTLING - 1), True):
        mesh = through(met, count) if len(met) else mesh
        outcome = _shot(problem, path, mesh, accuracy, limits)
        path, mesh, total = outcome.arcs, outcome.arcs.mesh, total + outcome.iterations
        if outcome.matching is None:
            why = f"Newton's method fails on {len(mesh) - 1} arcs"
            break
        before, met = met, corners(problem, path)
        if stand_still(before, met) or (last and misplaced(problem, path, met) < NOTHING):
            arcs, error = doubled(outcome.arcs, outcome.matching)
            limits.tell(arcs.cost() * problem.scale.cost, error)
            if error <= tolerance and not problem.instance.model.in_domain(arcs.course[1]):
                why = "the extremal leaves the domain"
                return Extremal(problem, arcs, float("inf"), Status.LEFT_DOMAIN, why, total, obeys=True)
            if error <= tolerance:
                return converged(arcs, error, total)
            accuracy /= 2**ORDER
            why = f"the estimated error stays at {error:.0e} on {_said(arcs)}"
    return unfinished(problem, start, why, total, limits)


def converged(arcs: Arcs, error: float, iterations: int) -> Extremal:
    """Return converged arcs, with their estimated error, as an extremal."""
    problem = arcs.problem
    message = f"estimated error {error:.0e} on {_said(arcs)}"
    return Extremal(problem, arcs, arcs.cost() * problem.scale.cost, Status.CONVERGED, message, iterations)


def _accurate(problem: TwoPoint, start: Start, limits: Limits) -> Extremal:
    """Return an accurate extremal within bounds from an extremal of low order without bounds."""
    bounded = inside(problem, start, start.found.curve, limits)
    steps = start.steps + bounded.iterations
    if bounded.reason is Reason.BLOCKED:
        return unfinished(problem, bounded.curve, bounded.message, steps, limits)
    found = extremal(problem, bounded.curve, limits)
    return replace(found, iterations=steps + found.iterations)


def _shot(problem: TwoPoint, start: Path, mesh: Array, accuracy: float, limits: Limits) -> Outcome:
    """Return the result of Newton's method from a path with nodes on a mesh, or on a finer mesh if it fails."""
    total = 0
    for _ in range(REFINEMENTS + 1):
        arcs = Arcs(problem, mesh, start(mesh), start.theta)
        stepped = sufficient(arcs, accuracy)
        outcome = newton(stepped, limits) if stepped else Outcome(arcs, None, 0)
        total += outcome.iterations
        if outcome.matching or limits.expired:
            break
        mesh = np.insert(mesh, np.arange(1, len(mesh)), (mesh[1:] + mesh[:-1]) / 2.0)
    return replace(outcome, iterations=total)


def _said(arcs: Arcs) -> str:
    return f"{counted(len(arcs.widths), 'arc')} of {counted(arcs.steps, 'step')}"
