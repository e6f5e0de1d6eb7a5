"""Problems with given ends: collocation from a straight line or an initial guess, refined to the required accuracy."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solution import Progress, Solution
from satsym.solvers.cold_start import paths
from satsym.solvers.cold_start.by_newton import from_guess
from satsym.solvers.cold_start.origin import Origin, Start
from satsym.solvers.cold_start.straight_through import straight_through
from satsym.solvers.cold_start.swept import from_control, loose
from satsym.solvers.collocation import mesh as meshes
from satsym.solvers.collocation.accuracy.refinement import refine
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.continuation import tighten
from satsym.solvers.collocation.curve import Curve, Path
from satsym.solvers.collocation.extremal import Extremal
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.newton import newton
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.scaling import two_point
from satsym.solvers.collocation.sqp import minimise
from satsym.solvers.collocation.system import System
from satsym.solvers.extremal import nothing, solved
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits
from satsym.status import Status

ROUNDING = 1e-12
"""Error estimate below which rounding prevents a further reduction."""

STRAIGHT_THROUGH = 15
"""Maximum number of steps from the straight line to a minimum. If more steps are needed, other starts are tried."""

ROUGHLY, TOLERANCE = 3e-2, 1e-7
"""Sizes of the last step of the two stages of the minimisation: after the first stage a new mesh is used if the
iteration was irregular; the second stage ends it."""

Accurate = Callable[[TwoPoint, Start, Limits], Extremal]
"""Function from an extremal of low order without control bounds to an accurate one with bounds."""


def solve(instance: Instance, progress: Progress | None = None) -> Solution:
    """Solve an instance by collocation.

    Parameters
    ----------
    instance
        Instance with final states given, on the reference or free, and a given or free final time.
    progress
        Function that is called after each step of the minimisation, and each phase.

    Returns
    -------
    Solution
        Solution with the status ``converged`` if the estimated error is within the instance's tolerance.
    """

    def method(one: Instance, limits: Limits) -> Extremal:
        return from_cold_start(one, limits, accurate)

    return solved(instance, progress, "collocation", method)


def from_cold_start(instance: Instance, limits: Limits, accurate: Accurate) -> Extremal:
    """Find an extremal of low order, from a guess or a straight line, and make it accurate.

    From a straight line bounds are ignored at first. Controls that vanishing costates do not determine need an initial
    guess of all states and costates.

    Parameters
    ----------
    limits
        Limits of the computation, and the observer of costs.
    """
    spec, led = instance.model.spec, from_guess(instance, limits)
    if led is None and (spec.stationary or spec.directional):
        message = "Newton's method has no initial guess: give states and costates in [guess]"
        return nothing(instance, Status.NOT_CONVERGED, message)
    if led is not None:
        problem, start = led
    elif instance.tf is None:
        message = "the final time is free, but Newton's method starts from a guess of states and costates only"
        return nothing(instance, Status.NOT_CONVERGED, message)
    else:
        problem = two_point(instance, instance.tf - instance.t0)
        start = under_guess(problem, limits) or cold_start(problem, limits)
        if start.saddle is not None and not problem.control_set.bounded:  # within bounds there may be a minimum
            start = replace(start, found=start.saddle)
        elif not start.found.minimum:
            message = f"no extremal found: {start.found.message}"
            return unfinished(problem, start.found.curve, message, start.steps, limits)
    found = accurate(problem, start, limits)
    if not found.status.answered:
        return found
    return replace(found, message=f"{found.message}, starting from the {start.named}")


def unfinished(problem: TwoPoint, path: Path, message: str, steps: int, limits: Limits) -> Extremal:
    """Return no extremal, and why; the status is the time limit if that is reached."""
    if limits.expired:
        return Extremal(problem, path, float("inf"), Status.TIME_LIMIT, f"time limit reached: {message}", steps)
    return Extremal(problem, path, float("inf"), Status.NOT_CONVERGED, message, steps)


def under_guess(problem: TwoPoint, limits: Limits) -> Start | None:
    """Return the extremal with bounds to which sweeps lead from an initial guess of the control, otherwise ``None``."""
    control = problem.instance.guess.control
    if not control or not problem.control_set.bounded or not loose(problem):
        return None
    curve = from_control(problem, control, limits)
    if curve is None:
        return None
    cost = System(problem, curve.mesh, curve.order).cost(curve)
    return Start(Attempt(curve, Reason.MINIMUM, 1, cost), Origin.GUESS, 1, bounded=True)


def inside(problem: TwoPoint, start: Start, free: Curve, limits: Limits) -> Attempt:
    """Return the extremal with bounds from one without, by tightening bounds that are inactive at first.

    Parameters
    ----------
    problem
        Problem with its bounds.
    start
        How the extremal was found.
    free
        The extremal without bounds, possibly refined.
    """
    return replace(start.found, iterations=1) if start.bounded else tighten(problem, free, STAGES, limits)


def accurate(problem: TwoPoint, start: Start, limits: Limits) -> Extremal:
    """Make an extremal of low order accurate, with the bounds of the control."""
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


def cold_start(problem: TwoPoint, limits: Limits) -> Start:
    """Find a minimum of a problem without bounds, or an extremal that is no minimum.

    Newton's method begins from a straight line in the state space between the ends, from the uncontrolled motion if
    nothing is required of the end, or from an initial guess. If it fails, a minimisation follows. Problems that this
    does not solve are left to the direct search.

    Parameters
    ----------
    problem
        Problem whose bounds are ignored.

    Raises
    ------
    ArithmeticError
        If the equations at the start are singular.
    """
    free = problem.relaxed(float("inf"))
    path = paths.first(free)
    line = paths.start(free, path)
    with np.errstate(all="ignore"):
        found = tried(partial(_minimum, free, line, limits))
    if found is None:
        raise ArithmeticError("the equations of the cold start are singular")
    if found.minimum and found.curve.in_domain(free.positive):
        origin = Origin.GUESS if problem.instance.guess else Origin.STRAIGHT_LINE
        return Start(found, origin, found.iterations)
    saddle = None if limits.expired else _extremal(free, line)
    if found.minimum:
        found = replace(found, reason=Reason.OUT_OF_DOMAIN)
    return Start(found, Origin.NO_MINIMUM, found.iterations, saddle=saddle)


def _minimum(problem: TwoPoint, line: Curve, limits: Limits) -> Attempt:
    """Return the minimum to which the straight line leads as an initial guess, or why it leads to none."""
    return straight_through(problem, line, limits) or from_path(problem, paths.first(problem), limits, STRAIGHT_THROUGH)


def _extremal(problem: TwoPoint, start: Curve) -> Attempt | None:
    """Return the extremal that Newton's method finds from a curve, which need not be a minimum; otherwise ``None``."""
    system = System(problem, start.mesh, STAGES)
    outcome = newton(system, start, most=STRAIGHT_THROUGH)
    if outcome is None or not outcome.solved or not outcome.curve.in_domain(problem.positive):
        return None
    return Attempt(outcome.curve, Reason.SADDLE, outcome.iterations, system.cost(outcome.curve))


def from_path(problem: TwoPoint, path: Callable[[Array], Array], limits: Limits, most: int) -> Attempt:
    """Minimise from a path of states, with new meshes as the curve takes shape.

    Parameters
    ----------
    path
        Function from M times to states, shape (n, M).
    most
        Maximum number of steps of the minimisation.
    """
    curve = paths.curve(problem, path)
    steps, hard, tolerance = 0, False, ROUGHLY
    while True:
        found = minimise(System(problem, curve.mesh, STAGES), curve, limits, tolerance, max(most - steps, 1))
        steps, hard = steps + found.iterations, hard or found.hard
        found = replace(found, iterations=steps, hard=hard)
        extremal = found.reason in (Reason.MINIMUM, Reason.SADDLE)
        if not (extremal or found.reason is Reason.OUTGROWN) or not found.curve.in_domain(problem.positive):
            return found
        if extremal and tolerance == TOLERANCE:
            return found
        if steps >= most or limits.expired:
            return replace(found, reason=Reason.NO_CONVERGENCE, facts=(steps,))
        tolerance = TOLERANCE if extremal else ROUGHLY
        curve = found.curve if extremal and not hard else found.curve.on(meshes.laid(problem, found.curve), STAGES)
