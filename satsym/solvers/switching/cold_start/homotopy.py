"""From a motion that the search finds to smoothed extremals, less and less smoothed.

The most smoothed one that Newton's method finds from the motion is the first; then the smoothing is taken away, each
step starting from the last solution.
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
"""Multiple of the smoothing that costs as much as all else, with which it begins: controls then hardly meet bounds."""

LEVELS, TIGHTER = 12, 4.0
"""Levels of smoothing, and the factor by which less is smoothed at each of them."""

FINER = 1e-6
"""Error that is left where the next level is not reached from what is solved roughly."""

BACK = 2
"""Levels before the last one from which it is tried again where that does not lead on."""

SPLIT = 2, 4
"""Into so many parts intervals are split where more accuracy does not lead on."""

MOST_SPLIT = 500
"""Most intervals of such a mesh."""

FOLLOWED = 5
"""Corrections that a step of the continuation usually takes, as its work is counted."""

ROUGHLY = 1e-5
"""Accuracy of solutions on the way."""

SHORTEST = 1.0 / 256.0
"""Shortest step of the continuation, as a share of the way."""

MOST_INTERVALS = 60
"""Intervals of the mesh on the way, about."""


@dataclass(frozen=True, eq=False)
class Smoothed:
    """A smoothed extremal."""

    problem: TwoPoint
    curve: Curve
    """The regularised problem, and its solution."""


@dataclass(frozen=True)
class Stopped(Exception):
    """The path from a motion to the problem ends early."""

    status: Status
    message: str
    """What came of it."""
    chattering: tuple[Smoothed, ...] = ()
    """All regularised problems that were solved, the least smoothed last, where that shows infinitely many switches."""


def path(instance: Instance, course: Course, limits: Limits, most: int = LEVELS) -> Iterator[Smoothed]:
    """Smoothed extremals near a motion, less and less smoothed, that many times.

    Parameters
    ----------
    course
        States and costates of a motion that is nearly the cheapest.

    Raises
    ------
    Stopped
        Where there is none, or the way to less smoothing is blocked.
    """
    yield from less_and_less(instance, _near(instance, course, limits), limits, most)


def _near(instance: Instance, course: Course, limits: Limits) -> Smoothed:
    """The most smoothed extremal that Newton's method finds from a motion."""
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
    """A smoothed extremal, and then so many others, less and less smoothed.

    Raises
    ------
    Stopped
        Where that does not go on.
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
    """A less smoothed extremal, as far towards what is wanted as one leads there; ``None`` where that fails."""
    begun = near.problem.control_set.smoothing

    def sharper(fraction: float) -> TwoPoint:
        return replace(near.problem, instance=regularised(instance, begun * (wanted / begun) ** fraction, 1.0))

    curve, reached = _follow(sharper, near.curve, limits, most=most)
    return Smoothed(sharper(reached), curve) if reached > 0.0 else None


def _finer(near: Smoothed) -> Iterator[Smoothed]:
    """The extremal more accurately: what is smoothed less changes ever more quickly where bounds end.

    Corners that are near each other may lie too close for the intervals of a mesh; so meshes with more are tried.
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
    """The smoothing at which the largest control costs about as much again as time, state, |u| and the end do."""
    m = len(instance.lower)
    largest = [max(abs(low), abs(high)) for low, high in zip(instance.lower, instance.upper, strict=True)]
    cost = max(abs(cost_rate(instance, np.array(u))) for u in (instance.lower, instance.upper, (0.0,) * m))
    effort = sum(value * value for value in largest)
    known = cost if 0.0 < cost < float("inf") else _mean_cost(instance, course)
    return 2.0 * (known or 1.0) / effort if effort > 0.0 else 1.0


def _mean_cost(instance: Instance, course: Course) -> float:
    """What time and state cost in the mean along a motion under no control, where they cost nothing at first."""
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
    """Follow the solutions of a family of problems from its start to its end, as far as that goes.

    Each solution is the guess of the next; steps are halved where Newton's method fails.

    Parameters
    ----------
    problem
        The one at a share of the way.
    curve
        A solution at the start.
    shortest
        Step below which it is given up, as a share of the way.
    most
        Intervals of the mesh, about.

    Returns
    -------
    curve, reached
        The last one, and the share of the way at which it is.
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
