"""Given ends: collocation from a line or a guess, refined until the error estimate is small enough, within bounds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from satsym.instance import Instance
from satsym.solution import Progress, Solution
from satsym.solvers.cold_start import paths
from satsym.solvers.cold_start.by_newton import from_guess
from satsym.solvers.cold_start.origin import Origin, Start
from satsym.solvers.cold_start.straight_through import straight_through
from satsym.solvers.collocation.accuracy.refinement import refine
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.continuation import tighten
from satsym.solvers.collocation.curve import Curve, Path
from satsym.solvers.collocation.extremal import Extremal
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.newton import newton
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.scaling import two_point
from satsym.solvers.collocation.system import System
from satsym.solvers.extremal import nothing, solved
from satsym.solvers.iteration import Limits
from satsym.status import Status

ROUNDING = 1e-12
"""An estimated error below this can hardly be made smaller."""

CORRECTIONS = 15
"""Corrections of Newton's method from the straight line, where the problem is linear and has one extremal at most."""

Accurate = Callable[[TwoPoint, Start, Limits], Extremal]
"""From an extremal of low order without bounds to an accurate one within them."""


def solve(instance: Instance, progress: Progress | None = None) -> Solution:
    """Solve an instance by collocation.

    Parameters
    ----------
    instance
        With final states given, on the reference or free, and a final time that is given or free.
    progress
        Called after each step of the minimisation, and each phase.

    Returns
    -------
    Solution
        With status ``converged`` when the estimated error is within the instance's tolerance.
    """

    def method(one: Instance, limits: Limits) -> Extremal:
        return from_cold_start(one, limits, accurate)

    return solved(instance, progress, "collocation", method)


def from_cold_start(instance: Instance, limits: Limits, accurate: Accurate) -> Extremal:
    """Find an extremal of low order, from a guess or without bounds from a straight line, and make it accurate.

    Controls of which vanishing costates say nothing need a guess of all states and costates.

    Parameters
    ----------
    limits
        When to stop, and the observer of the cost of what was found.
    """
    spec, led = instance.model.spec, from_guess(instance, limits)
    if led is None and (spec.stationary or spec.directional):
        message = "Newton's method has no initial guess: give states and costates in [guess]"
        return nothing(instance, Status.NOT_CONVERGED, message)
    if led is not None:
        problem, start = led
    elif instance.tf is None:
        message = "the final time is free, and Newton's method begins at a guess of states and costates alone"
        return nothing(instance, Status.NOT_CONVERGED, message)
    else:
        problem = two_point(instance, instance.tf - instance.t0)
        begun = cold_start(problem, limits)
        if begun is None:
            status = Status.TIME_LIMIT if limits.expired else Status.NOT_CONVERGED
            message = "no extremal found: Newton's method does not lead from the straight line to a minimum"
            return nothing(instance, status, message)
        start = begun
    found = accurate(problem, start, limits)
    if not found.status.answered:
        return found
    return replace(found, message=f"{found.message}, starting from the {start.named}")


def unfinished(problem: TwoPoint, path: Path, message: str, steps: int, limits: Limits) -> Extremal:
    """No extremal, and why: for want of time where that is up."""
    if limits.expired:
        return Extremal(problem, path, float("inf"), Status.TIME_LIMIT, f"time limit reached: {message}", steps)
    return Extremal(problem, path, float("inf"), Status.NOT_CONVERGED, message, steps)


def inside(problem: TwoPoint, start: Start, free: Curve, limits: Limits) -> Attempt:
    """The extremal within the bounds, from one without: the bounds are brought in from where they do not bind.

    Parameters
    ----------
    problem
        With its bounds.
    start
        How the extremal was found.
    free
        The extremal, perhaps more accurate.
    """
    return replace(start.found, iterations=1) if start.bounded else tighten(problem, free, STAGES, limits)


def accurate(problem: TwoPoint, start: Start, limits: Limits) -> Extremal:
    """Make an extremal of low order an accurate one within the bounds."""
    tolerance = problem.instance.solver.tolerance
    free, steps = problem.relaxed(float("inf")), start.steps
    refined = start.found
    if not start.bounded:
        refined = refine(free, start.found.curve, tolerance, known=start.found.linearised)
        limits.tell(refined.cost * problem.scale.cost, refined.error)
        steps += refined.iterations
    bounded = inside(problem, start, refined.curve, limits)
    if bounded.iterations:
        steps += bounded.iterations
        if not bounded.solved:
            return unfinished(problem, refined.curve, bounded.message, steps, limits)
        refined = refine(problem, bounded.curve, tolerance, keep_nodes=problem.control_set.bounded)
        steps += refined.iterations
        limits.tell(refined.cost * problem.scale.cost, refined.error)
    if not refined.solved:
        message = refined.message
        if refined.error < ROUNDING:
            message += ", which is due to rounding; raise [solver] tolerance"
        return replace(unfinished(problem, refined.curve, message, steps, limits), obeys=True)
    message = f"estimated error {refined.error:.0e} on {len(refined.curve.mesh) - 1} intervals"
    return Extremal(problem, refined.curve, refined.cost * problem.scale.cost, Status.CONVERGED, message, steps)


def cold_start(problem: TwoPoint, limits: Limits) -> Start | None:
    """The minimum of a problem without bounds to which Newton's method leads at once, if it does.

    It begins from a straight line in the state space: that between the ends or, where nothing is asked of the end, the
    uncontrolled motion; or else from what is guessed. What this does not solve is left to the direct search; but where
    a problem is linear its only extremal is found here, be it a minimum or not.

    Parameters
    ----------
    problem
        Bounds are ignored.
    """
    free, spec = problem.relaxed(float("inf")), problem.instance.model.spec
    line = paths.start(free, paths.first(free))
    with np.errstate(all="ignore"):
        found = straight_through(free, line, limits)
        if found is None and spec.linear_quadratic and not problem.control_set.bounded and not limits.expired:
            found = _extremal(free, line)
    if found is None:
        return None
    return Start(found, Origin.GUESS if problem.instance.guess else Origin.STRAIGHT_LINE, found.iterations)


def _extremal(problem: TwoPoint, start: Curve) -> Attempt | None:
    """What Newton's method finds from a curve, whether a minimum or not."""
    system = System(problem, start.mesh, STAGES)
    outcome = newton(system, start, most=CORRECTIONS)
    if outcome is None or not outcome.solved or not outcome.curve.in_domain(problem.positive):
        return None
    return Attempt(outcome.curve, Reason.EXTREMAL, outcome.iterations, system.cost(outcome.curve))
