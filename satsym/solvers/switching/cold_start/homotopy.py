"""Continuation from a motion of the direct search to extremals of regularised problems with decreasing smoothing.

It begins with the strongest smoothing for which Newton's method finds an extremal from the motion; each step then
starts from the previous solution.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from satsym.instance import Instance
from satsym.solvers.cold_start.swept import on_mesh
from satsym.solvers.collocation import mesh as meshes
from satsym.solvers.collocation.accuracy.refinement import refine
from satsym.solvers.collocation.continuation import corners, through
from satsym.solvers.collocation.curve import Curve
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.newton import newton
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.scaling import two_point
from satsym.solvers.collocation.system import System
from satsym.solvers.control.regularised import regularised
from satsym.solvers.control.slopes import cost_rate
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.structure import Course
from satsym.status import Status

MOST_SMOOTHED = 4.0**6
"""First smoothing parameter, as a multiple of that for which the quadratic cost equals all other costs; controls then
hardly reach their bounds."""

LEVELS, TIGHTER = 12, 4.0
"""Number of levels of smoothing, and the factor between the smoothing parameters of successive levels."""

FINER = 1e-6
"""Error of a more accurate solution, from which the next level is tried again after a failure."""

BACK = 2
"""Number of earlier levels from which the next level is tried again after a failure."""

SPLIT = 2, 4
"""Numbers of parts into which intervals are divided, one after the other, if more accuracy does not help."""

MOST_SPLIT = 500
"""Maximum number of intervals of a divided mesh."""

FOLLOWED = 5
"""Typical number of corrections in a step of the continuation, by which its work is counted."""

ROUGHLY = 1e-5
"""Accuracy of intermediate solutions."""

SHORTEST = 1.0 / 256.0
"""Smallest step of the continuation, as a fraction of the path."""

MOST_INTERVALS = 60
"""Approximate maximum number of intervals of the mesh during the continuation."""


@dataclass(frozen=True, eq=False)
class Smoothed:
    """An extremal of a regularised problem."""

    problem: TwoPoint
    curve: Curve
    """The regularised problem, and its solution."""


@dataclass(frozen=True)
class Stopped(Exception):
    """Raised if the continuation from a motion to the original problem cannot be completed."""

    status: Status
    message: str
    """Status and message of the result."""
    chattering: tuple[Smoothed, ...] = ()
    """All regularised problems that were solved, the least smoothed last, if they show infinitely many switches."""


def path(instance: Instance, course: Course, limits: Limits, most: int = LEVELS) -> Iterator[Smoothed]:
    """Yield extremals of regularised problems near a motion, with decreasing smoothing.

    Parameters
    ----------
    course
        States and costates of a motion of nearly minimum cost.

    Raises
    ------
    Stopped
        If no extremal is found, or smoothing cannot be reduced further.
    """
    yield from less_and_less(instance, _near(instance, course, limits), limits, most)


def _near(instance: Instance, course: Course, limits: Limits) -> Smoothed:
    """Return the extremal with the strongest smoothing that Newton's method finds from a motion."""
    lasting = float(np.ptp(course.times))
    tau, smoothing = (course.times - course.times[0]) / lasting, MOST_SMOOTHED * first_smoothing(instance, course)
    for _ in range(LEVELS):
        problem = two_point(regularised(instance, smoothing, 1.0), lasting)
        z = course.z / problem.scale.both
        curve = on_mesh(problem, tau, z, meshes.along(problem, tau, z[: problem.states], problem.theta))
        found, reached = _follow(partial(_itself, problem), curve, limits, shortest=1.0)
        if reached:
            return Smoothed(problem, found)
        if limits.expired:
            break
        smoothing /= TIGHTER
    raise Stopped(Status.NOT_CONVERGED, "no smoothed extremal was found near the motion that the search found")


def _itself(problem: TwoPoint, _: float) -> TwoPoint:
    return problem


def less_and_less(instance: Instance, first: Smoothed, limits: Limits, most: int = LEVELS) -> Iterator[Smoothed]:
    """Yield a smoothed extremal, and then a given number of extremals with decreasing smoothing.

    Raises
    ------
    Stopped
        If smoothing cannot be reduced further.
    """
    passed = [first]
    yield first
    for _ in range(most):
        last = passed[-1]
        wanted = last.problem.control_set.smoothing / TIGHTER
        near = _sharper(instance, last, wanted, limits)
        for earlier in passed[: -2 - BACK : -1] if near is None else ():
            finer = (_sharper(instance, one, wanted, limits, MOST_SPLIT) for one in _finer(earlier))
            near = next((one for one in finer if one is not None and _less(one, last)), None)
            if near is not None or limits.expired:
                break
        if near is None:
            message = f"a regularisation below {last.problem.control_set.smoothing:.1e} was not reached"
            raise Stopped(Status.NOT_CONVERGED, message)
        passed.append(near)
        yield near


def _less(one: Smoothed, than: Smoothed) -> bool:
    return one.problem.control_set.smoothing < than.problem.control_set.smoothing


def _sharper(
    instance: Instance, near: Smoothed, wanted: float, limits: Limits, most: int = MOST_INTERVALS
) -> Smoothed | None:
    """Return an extremal with less smoothing, as close to the desired value as possible; ``None`` on failure."""
    begun = near.problem.control_set.smoothing

    def sharper(fraction: float) -> TwoPoint:
        return replace(near.problem, instance=regularised(instance, begun * (wanted / begun) ** fraction, 1.0))

    curve, reached = _follow(sharper, near.curve, limits, most=most)
    return Smoothed(sharper(reached), curve) if reached > 0.0 else None


def _finer(near: Smoothed) -> Iterator[Smoothed]:
    """Yield more accurate versions of an extremal: with less smoothing, rates change faster at the ends of bound arcs.

    Neighbouring corners may be too close for the intervals of a mesh, so that finer meshes are tried as well.
    """
    problem, curve = near.problem, near.curve
    found = refine(problem, curve, FINER, keep_nodes=True)
    if found.solved:
        yield Smoothed(problem, found.curve)
    for times in SPLIT:
        mesh = through(corners(problem, curve, ROUGHLY), min(times * (len(curve.mesh) - 1), MOST_SPLIT))
        outcome = newton(System(problem, mesh, STAGES), curve.on(mesh, STAGES), tolerance=ROUGHLY, most=15)
        if outcome is not None and outcome.solved:
            yield Smoothed(problem, outcome.curve)


def first_smoothing(instance: Instance, course: Course) -> float:
    """Return the smoothing at which the largest control costs about as much again as all other terms together."""
    m = len(instance.lower)
    largest = [max(abs(low), abs(high)) for low, high in zip(instance.lower, instance.upper, strict=True)]
    cost = max(abs(cost_rate(instance, np.array(u))) for u in (instance.lower, instance.upper, (0.0,) * m))
    effort = sum(value * value for value in largest)
    known = cost if 0.0 < cost < float("inf") else _mean_cost(instance, course)
    return 2.0 * (known or 1.0) / effort if effort > 0.0 else 1.0


def _mean_cost(instance: Instance, course: Course) -> float:
    """Return the mean running cost of a motion with controls at rest, for problems without a cost at the start."""
    n, count = len(instance.initial), len(course.times)
    idle = np.repeat(np.array(instance.control_set.rest)[:, None], count, axis=1)
    running = instance.model.running_cost_batch(course.times, course.z[:n], idle, instance.parameters)
    found = abs(float(np.mean(np.broadcast_to(running, count))))
    return found if np.isfinite(found) else 0.0


def _follow(
    problem: Callable[[float], TwoPoint],
    curve: Curve,
    limits: Limits,
    shortest: float = SHORTEST,
    most: int = MOST_INTERVALS,
) -> tuple[Curve, float]:
    """Follow the solutions of a family of problems from its start as far as possible.

    Each solution is the initial guess of the next; steps are halved where Newton's method fails.

    Parameters
    ----------
    problem
        Function that returns the problem at a fraction of the path.
    curve
        Solution at the start of the path.
    shortest
        Step, as a fraction of the path, below which the continuation ends.
    most
        Approximate maximum number of mesh intervals.

    Returns
    -------
    curve, reached
        The last solution, and the fraction of the path that was reached.
    """
    at, move, count = 0.0, 1.0, max(8, min(len(curve.mesh) - 1, most))
    while at < 1.0 and move >= shortest and not limits.expired:
        there = problem(min(at + move, 1.0))
        mesh = through(corners(there, curve, ROUGHLY), count)
        limits.spend(FOLLOWED * STAGES * len(mesh))
        outcome = newton(System(there, mesh, STAGES), curve.on(mesh, STAGES), tolerance=ROUGHLY, most=10)
        if outcome is None or not outcome.solved or not outcome.curve.in_domain(there.positive):
            move /= 2.0
            continue
        at, curve = min(at + move, 1.0), outcome.curve
        move *= 2.0
        if limits.watch:
            limits.watch(System(there, mesh, STAGES).cost(curve) * there.scale.cost, max(1.0 - at, ROUGHLY))
    return curve, at
