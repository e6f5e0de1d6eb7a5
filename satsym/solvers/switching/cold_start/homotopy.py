"""From a cold start to smoothed extremals, less and less smoothed.

Without bounds the regularised problem is one of least effort, which collocation solves from a cold start. Its bounds
are then brought in, the weight of |u| is, and the smoothing is taken away, each step starting from the last solution.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from satsym.instance import Instance
from satsym.solvers.cold_start.durations import free_duration
from satsym.solvers.cold_start.first_minimum import cold_start
from satsym.solvers.collocation.accuracy.refinement import refine
from satsym.solvers.collocation.attempt import Reason
from satsym.solvers.collocation.continuation import corners, through
from satsym.solvers.collocation.curve import Curve, Path
from satsym.solvers.collocation.extremal import Extremal
from satsym.solvers.collocation.following import ROUGHLY, follow
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.newton import newton
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.scaling import two_point
from satsym.solvers.collocation.system import System
from satsym.solvers.control.regularised import regularised
from satsym.solvers.control.slopes import cost_rate
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.cold_start.minimum_effort import (
    NEAR_FULL,
    WITHIN,
    Smoothed,
    first_duration,
    of_size,
)
from satsym.solvers.switching.magnitudes import resting
from satsym.status import Status

STEPS = 200
"""RK4 steps of a motion under a constant control."""

LEVELS = 12
TIGHTER = 4.0
"""By so much less is smoothed at each level."""

FINER = 1e-6
"""Error that is left where the next level is not reached from what is solved roughly."""

MOST_INTERVALS = 240
"""Of a mesh, there."""

SPLIT = 2, 4
"""Into so many parts intervals are split where their errors cannot be corrected."""

MOST_SPLIT = 500
"""Intervals of such a mesh."""


@dataclass(frozen=True)
class Stopped(Exception):
    """The path from a cold start to the problem ends early."""

    status: Status
    message: str
    """What came of it."""
    problem: TwoPoint | None = None
    curve: Path | None = None
    """The last regularised problem that was solved, if any."""
    chattering: tuple[Smoothed, ...] = ()
    """All regularised problems that were solved, the least smoothed last, where that shows infinitely many switches."""


def path(
    instance: Instance, limits: Limits, most: int = LEVELS, begun: tuple[TwoPoint, Curve] | None = None
) -> Iterator[Smoothed]:
    """Smoothed extremals, less and less smoothed, that many times.

    Parameters
    ----------
    begun
        The first without the weight of |u|, if it is known.

    Raises
    ------
    Stopped
        Where there is none, or the way to the bounds is blocked.
    """
    first = _weighed(instance, limits, begun)
    yield from less_and_less(instance, first, limits, most)


def _weighed(instance: Instance, limits: Limits, begun: tuple[TwoPoint, Curve] | None) -> Smoothed:
    """Well smoothed within the bounds, with the weight of |u|."""
    problem, curve = begun or (instance.tf is None and _long(instance, limits)) or _bounded(instance, limits)
    smoothing = problem.control_set.smoothing

    def weighed(fraction: float) -> TwoPoint:
        return replace(problem, instance=regularised(instance, smoothing, fraction))

    curve, reached = follow(weighed, curve, limits)
    if reached < 1.0:
        raise Stopped(Status.NOT_CONVERGED, f"the weight of |u| could be brought in only {reached:.0%}", problem, curve)
    return Smoothed(weighed(1.0), curve)


def less_and_less(instance: Instance, first: Smoothed, limits: Limits, most: int = LEVELS) -> Iterator[Smoothed]:
    """A smoothed extremal, and then so many others, less and less smoothed.

    Raises
    ------
    Stopped
        Where that does not go on.
    """
    problem, curve = first.problem, first.curve
    smoothing = problem.control_set.smoothing
    yield first
    for _ in range(most):
        before = smoothing

        def sharper(fraction: float, before: float = before, problem: TwoPoint = problem) -> TwoPoint:
            return replace(problem, instance=regularised(instance, before * TIGHTER**-fraction, 1.0))

        curve, reached = follow(sharper, curve, limits)
        if reached == 0.0:
            curve, reached = follow(sharper, _finer(problem, curve), limits, most=MOST_INTERVALS)
        if reached == 0.0:
            raise Stopped(
                Status.NOT_CONVERGED, f"a regularisation below {smoothing:.1e} was not reached", problem, curve
            )
        smoothing *= TIGHTER**-reached
        problem = replace(problem, instance=regularised(instance, smoothing, 1.0))
        yield Smoothed(problem, curve)


def _finer(problem: TwoPoint, curve: Curve) -> Curve:
    """The same more accurately, if that is found: what is smoothed less changes ever more quickly where bounds end.

    Corners that are near each other may lie too close for the intervals of a mesh; then one with more is tried.
    """
    found = refine(problem, curve, FINER, keep_nodes=True)
    for times in () if found.solved else SPLIT:
        mesh = through(corners(problem, curve, ROUGHLY), min(times * (len(curve.mesh) - 1), MOST_SPLIT))
        outcome = newton(System(problem, mesh, STAGES), curve.on(mesh, STAGES), tolerance=ROUGHLY, most=15)
        if outcome is not None and outcome.solved:
            found = refine(problem, outcome.curve, FINER, keep_nodes=True)
            return found.curve if found.solved else outcome.curve
    return found.curve if found.solved else curve


def _long(instance: Instance, limits: Limits) -> tuple[TwoPoint, Curve] | None:
    """A free duration so long that bounds do not bind, and the smoothing for which it is the best.

    Where |u| costs, it may be far too little smoothing to bring that in.
    """
    if any(resting(instance)):
        return None
    found = of_size(instance, WITHIN, limits)
    if found is None:
        return None
    problem, curve = found.problem, found.curve
    z = (curve.nodes[:, -1] * problem.scale.both[:, 0]).tolist()
    n, t, p = problem.states, instance.t0 + problem.duration, instance.parameters
    u = tuple(problem.control(np.ones(1), curve.nodes[:, -1:], curve.theta)[:, 0].tolist())
    effort = sum(v * v for v in u) / 2.0
    growth = effort + sum(a * b for a, b in zip(z[n:], instance.model.dynamics(t, z[:n], u, p), strict=True))
    idle = instance.control_set.rest
    smoothing = -instance.model.running_cost(t, z[:n], idle, p) / growth if growth else 0.0
    if not 0.0 < smoothing < float("inf"):
        return None
    eased = two_point(regularised(instance, smoothing, 0.0), problem.duration)
    ratio = np.ones((2 * n, 1))
    ratio[n:] = smoothing * problem.scale.both[n:] / eased.scale.both[n:]
    ratio[:n] = problem.scale.both[:n] / eased.scale.both[:n]
    curve = Curve(
        curve.mesh, curve.nodes * ratio, curve.stages * ratio[:, :, None], np.append(curve.theta, problem.duration)
    )
    outcome = newton(System(eased, curve.mesh, curve.order), curve, tolerance=1e-5)
    return (eased, outcome.curve) if outcome is not None and outcome.solved else None


def _bounded(instance: Instance, limits: Limits) -> tuple[TwoPoint, Curve]:
    """From no bounds to the bounds, well smoothed."""
    problem, curve = _unbounded(regularised(instance, first_smoothing(instance), 0.0), limits)
    worst = max(_violation(problem, curve), 0.0)

    def bounded(fraction: float) -> TwoPoint:
        return problem.relaxed((1.0 - fraction) * worst)

    if worst > 0.0:
        curve, reached = follow(bounded, curve, limits)
        if reached < 1.0:
            message = Reason.BLOCKED.value.format(min(reached, 0.99))
            raise Stopped(Status.NOT_CONVERGED, message, problem, curve)
    return problem.relaxed(0.0), curve


def first_smoothing(instance: Instance) -> float:
    """The smoothing at which the largest control costs about as much again as time, state, |u| and the end do."""
    m = len(instance.lower)
    largest = [max(abs(low), abs(high)) for low, high in zip(instance.lower, instance.upper, strict=True)]
    cost = max(abs(cost_rate(instance, np.array(u))) for u in (instance.lower, instance.upper, (0.0,) * m))
    effort = sum(value * value for value in largest)
    known = cost if 0.0 < cost < float("inf") else _later(instance)
    return 2.0 * (known or 1.0) / effort if effort > 0.0 else 1.0


def _later(instance: Instance) -> float:
    """What time and state cost in the mean where they cost nothing at first: the least among constant controls."""
    duration = first_duration(instance) if instance.tf is None else instance.tf - instance.t0
    times, p, found = instance.t0 + np.linspace(0.0, duration, STEPS + 1), instance.parameters, [0.0]
    for held in (instance.lower, instance.upper, instance.control_set.rest):
        u = np.repeat(np.array(held)[:, None], STEPS + 1, axis=1)
        x = instance.model.forward(times, instance.initial, u, u[:, 1:], p)[0]
        found.append(abs(float(np.mean(instance.model.running_cost_batch(times, x, u, p)))))
    return min((cost for cost in found if 0.0 < cost < float("inf")), default=0.0)


def _unbounded(instance: Instance, limits: Limits) -> tuple[TwoPoint, Curve]:
    """The regularised problem without bounds, solved."""
    if instance.tf is None:
        near = of_size(instance, NEAR_FULL, limits) if instance.tf_guess is None else None
        duration = first_duration(instance) if near is None else near.problem.duration
        chosen = free_duration(replace(instance, tf_guess=instance.t0 + duration), limits)
        if isinstance(chosen, Extremal):
            raise Stopped(chosen.status, chosen.message, chosen.problem, chosen.path)
        return chosen.problem, chosen.start.found.curve
    problem = two_point(instance, instance.tf - instance.t0)
    start = cold_start(problem, limits)
    if not start.found.minimum:
        raise Stopped(Status.NOT_CONVERGED, f"no extremal found: {start.found.message}", problem, start.found.curve)
    return problem, start.found.curve


def _violation(problem: TwoPoint, curve: Curve) -> float:
    tau = np.linspace(0.0, 1.0, 201)
    return problem.instance.control_set.violation(problem.control(tau, curve(tau), curve.theta, bounded=False))
