"""Given ends: collocation from a cold start, refined until the error estimate is small enough, within bounds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from satsym.instance import Instance
from satsym.solution import Progress, Solution
from satsym.solvers.cold_start import paths
from satsym.solvers.cold_start.by_newton import from_guess
from satsym.solvers.cold_start.durations import free_duration
from satsym.solvers.cold_start.first_minimum import cold_start
from satsym.solvers.cold_start.origin import Origin, Start
from satsym.solvers.cold_start.soft_bounds import TRIED, within_bounds, within_found
from satsym.solvers.cold_start.swept import from_control, loose, swept
from satsym.solvers.collocation.accuracy.refinement import refine
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.continuation import settled, tighten
from satsym.solvers.collocation.curve import Curve, Path
from satsym.solvers.collocation.extremal import Extremal
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.scaling import two_point
from satsym.solvers.collocation.system import System
from satsym.solvers.drawn_motions import motions
from satsym.solvers.extremal import nothing, solved
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits
from satsym.solvers.nearest_end import Nearest, nearest
from satsym.status import Status

ROUNDING = 1e-12
"""An estimated error below this can hardly be made smaller."""

FEWEST_INTERVALS = 10
"""Intervals of a mesh on which a guess is followed."""

GUESSED = 1e-2
"""Softness of the bounds with which a guess or a path that is drawn is followed first."""

DRAWN, AMPLITUDES = 4, (0.2, 0.5)
"""Paths that are drawn where the bounds cannot be brought in, and how far they leave the straight line. Motions under
controls that are drawn follow where these lead nowhere."""

PATIENT = 300
"""Steps of the minimisation from these: among many swings those cost nearly the same that differ by a push."""

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

    def method(one: Instance, limits: Limits, effort: bool) -> Extremal:
        return from_cold_start(one, limits, effort, accurate)

    return solved(instance, progress, "collocation", method)


def from_cold_start(instance: Instance, limits: Limits, effort: bool, accurate: Accurate) -> Extremal:
    """Find an extremal of low order without bounds, its duration where that is free, and make it accurate.

    Parameters
    ----------
    limits
        When to stop, and the observer of the cost of what was found.
    effort
        Whether free durations are looked for with great effort.
    """
    spec = instance.model.spec
    if spec.stationary or spec.directional:
        led = from_guess(instance)
        if led is None:
            message = (
                "no extremal is known near which the law says something of the controls: guess states and costates"
            )
            return nothing(instance, Status.NOT_CONVERGED, message)
        (problem, start), duration = led, ""
    elif instance.tf is not None:
        problem = two_point(instance, instance.tf - instance.t0)
        start, duration = guessed(problem, limits) or cold_start(problem, limits), ""
        if not start.found.minimum:
            start = drawn_within(problem, limits) or start
        if start.saddle is not None:
            start = replace(start, found=start.saddle)
        elif not start.found.minimum:
            message = f"no extremal found: {start.found.message}"
            return unfinished(problem, start.found.curve, message, start.steps, limits)
    else:
        chosen = free_duration(instance, limits, effort)
        if isinstance(chosen, Extremal):
            return replace(chosen, problem=chosen.problem.relaxed(0.0))
        problem, start, duration = chosen.problem.relaxed(0.0), chosen.start, f", {chosen.message}"
    found = accurate(problem, start, limits)
    if not found.status.answered:
        return found
    return replace(found, message=f"{found.message}, from the {start.named}{duration}")


def unfinished(problem: TwoPoint, path: Path, message: str, steps: int, limits: Limits) -> Extremal:
    """No extremal, and why: for want of time where that is up."""
    if limits.expired:
        return Extremal(problem, path, float("inf"), Status.TIME_LIMIT, f"time was up: {message}", steps)
    return Extremal(problem, path, float("inf"), Status.NOT_CONVERGED, message, steps)


def guessed(problem: TwoPoint, limits: Limits) -> Start | None:
    """The extremal within the bounds to which a guess leads; ``None`` without one, or where bounds are none or free.

    Without costates that are guessed the bounds are soft at first, but harder than where the guess would be led away.
    """
    guess = problem.instance.guess
    if not guess or not problem.control_set.bounded or problem.free_time:
        return None
    begun, curve = paths.start(problem), None
    if guess.control and loose(problem):
        curve = from_control(problem, guess.control, limits)
    elif guess.costate:
        bounded = settled(problem, begun, STAGES, max(len(begun.mesh) - 1, FEWEST_INTERVALS), limits)
        curve = bounded.curve if bounded.solved else None
    if curve is None:
        softened = within_bounds(problem, paths.first(problem), limits, GUESSED)
        curve = softened.curve if softened.solved else None
    if curve is None or not curve.in_domain(problem.positive):
        return None
    cost = System(problem, curve.mesh, curve.order).cost(curve)
    return Start(Attempt(curve, Reason.MINIMUM, 1, cost), Origin.GUESS, 1, bounded=True)


def inside(problem: TwoPoint, start: Start, free: Curve, limits: Limits) -> Attempt:
    """The extremal within the bounds, from one without.

    The bounds are brought in from where they do not bind. Where that ends too early they are made harder and harder,
    from that extremal and then from paths that are drawn: a structure that exists only within bounds is found so.

    Parameters
    ----------
    problem
        With its bounds.
    start
        How the extremal was found.
    free
        The extremal, perhaps more accurate.
    """
    if start.bounded:
        return replace(start.found, iterations=1)
    bounded = tighten(problem, free, STAGES, limits)
    if bounded.solved or problem.free_time or _separated(problem, limits) is not None:
        return bounded
    first = within_found(problem, start.found, limits)
    drawn = None if first.solved else drawn_within(problem, limits)
    steps = bounded.iterations + first.iterations + (drawn.steps if drawn else 0)
    found = drawn.found if drawn else first
    return replace(found if found.solved else bounded, iterations=steps)


def drawn_within(problem: TwoPoint, limits: Limits) -> Start | None:
    """The cheapest extremal within the bounds to which paths that are drawn lead, or corners of the box, if any."""
    rng, steps = np.random.default_rng(DRAWN), 0
    found: list[tuple[float, Curve]] = []
    bent = [paths.bent(problem, rng, AMPLITUDES[k % len(AMPLITUDES)]) for k in range(DRAWN)]
    meeting = partial(motions, problem, rng, cheapest=True)
    for drawn, most in ((lambda: bent, TRIED), (lambda: [motion.path for motion in tried(meeting) or []], PATIENT)):
        for path in () if found else drawn():
            one = within_bounds(problem, path, limits, GUESSED, most)
            steps += one.iterations
            if one.solved:
                found.append((System(problem, one.curve.mesh, one.curve.order).cost(one.curve), one.curve))
            if limits.expired:
                break
    corners = (curve for curve in swept(problem, limits) if curve is not None)
    found += [(System(problem, curve.mesh, curve.order).cost(curve), curve) for curve in corners]
    if not found:
        return None
    cost, curve = min(found, key=lambda one: one[0])
    return Start(Attempt(curve, Reason.MINIMUM, steps, cost), Origin.DRAWN, steps, bounded=True)


def explained(found: Extremal, limits: Limits) -> Extremal:
    """What was found; where bounds are in the way of an answer, whether the end can be reached at all."""
    problem = found.problem
    if found.status is not Status.NOT_CONVERGED or not problem.control_set.bounded:
        return found
    separated = _separated(problem, limits)
    if separated is not None:
        return replace(found, status=Status.INFEASIBLE, message=separated)
    near = nearest(problem, found.path, limits)
    if near is None or limits.expired:
        return found
    if near.arrives:
        arrived = _from_arrival(problem, near, limits)
        known = (
            f"{found.message}; controls within the bounds miss the end by {near.distance:.1g} of the sizes of states, "
            f"which bounds a little wider, or more time, may close"
        )
        return arrived if arrived.status.answered else replace(found, message=known)
    if near.undecided:
        return replace(found, message=f"{found.message}; {near.message}, but others may arrive")
    return replace(found, status=Status.INFEASIBLE, message=f"{near.message}; {found.message}")


def _from_arrival(problem: TwoPoint, near: Nearest, limits: Limits) -> Extremal:
    """The extremal within the bounds to which a motion leads that arrives."""
    found = within_bounds(problem, near.path, limits, GUESSED, PATIENT)
    if not found.solved:
        return unfinished(problem, found.curve, found.message, found.iterations, limits)
    cost = System(problem, found.curve.mesh, found.curve.order).cost(found.curve)
    attempt = Attempt(found.curve, Reason.MINIMUM, found.iterations, cost)
    return within(problem, Start(attempt, Origin.DRAWN, found.iterations, bounded=True), limits)


def _separated(problem: TwoPoint, limits: Limits) -> str | None:
    """Why no admissible control reaches the end of a linear motion; few instances need the rooms that know."""
    from satsym.solvers.switching.linear.by_reach import unreachable

    return unreachable(problem.instance, limits)


def accurate(problem: TwoPoint, start: Start, limits: Limits) -> Extremal:
    """From an extremal of low order without bounds to an accurate one within them, by collocation."""
    return explained(within(problem, start, limits), limits)


def within(problem: TwoPoint, start: Start, limits: Limits) -> Extremal:
    """The same, without asking why where there is none."""
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
            message += ", which rounding leaves: raise [solver] tolerance"
        return replace(unfinished(problem, refined.curve, message, steps, limits), obeys=True)
    message = f"estimated error {refined.error:.0e} on {len(refined.curve.mesh) - 1} intervals"
    return Extremal(problem, refined.curve, refined.cost * problem.scale.cost, Status.CONVERGED, message, steps)
