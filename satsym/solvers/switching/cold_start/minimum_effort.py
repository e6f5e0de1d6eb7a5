"""Motions of least effort where the final time is free: where to look for structures and from where to start.

Without bounds the least effort in a given time is found at once. In about the least time its signs are often those of
the bang-bang control; within the bounds, from a long duration towards the least, they become so.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from satsym.instance import Instance
from satsym.solvers.cold_start.durations import time_scale
from satsym.solvers.cold_start.paths import curve as as_curve
from satsym.solvers.cold_start.paths import first
from satsym.solvers.cold_start.straight_through import straight_through
from satsym.solvers.collocation.curve import Curve
from satsym.solvers.collocation.following import follow
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.scaling import two_point
from satsym.solvers.control.regularised import regularised
from satsym.solvers.iteration import Limits

NEAR_FULL = (1.15, 2.2)
"""Largest controls without bounds, relative to these, of durations near the least one: 1.5 from rest to rest."""

WITHIN = (0.6, 0.95)
"""The same of durations so long that bounds do not bind."""

DRIFTING = 10.0
"""Times one over the largest slope of the motion that a first duration is, where its eigenvalues give no scale."""

DURATIONS = 8
"""Durations tried until the control is so large."""

OTHERS = (1.4, 2.0)
"""Durations that are tried besides, relative to that."""

SHORTER, SMALLEST_SHORTENING = 0.12, 0.002
"""By this share durations are shortened, and by no less."""


@dataclass(frozen=True, eq=False)
class Smoothed:
    """A smoothed extremal."""

    problem: TwoPoint
    curve: Curve
    """The regularised problem, and its solution."""
    scaled: float = 1.0
    """Factor of the costates by which those of the regularised problem are those of the problem."""


def quick(instance: Instance, limits: Limits) -> Iterator[Smoothed]:
    """Motions of least effort in about the least time: their signs are often those of the problem.

    For free final times; as many as there are where the straight line leads there at once.
    """
    found = of_size(instance, NEAR_FULL, limits)
    if found is None:
        return
    yield found
    for factor in OTHERS:
        other = _least_effort(instance, factor * found.problem.duration, limits)
        if other is not None:
            yield other


def beside(instance: Instance, duration: float, fractions: Sequence[float], limits: Limits) -> Iterator[Smoothed]:
    """Motions of least effort in shares of a duration: reachable durations need not be an interval."""
    for fraction in fractions:
        found = _least_effort(instance, fraction * duration, limits)
        if found is not None:
            yield found


def of_size(instance: Instance, wanted: tuple[float, float], limits: Limits) -> Smoothed | None:
    """The least effort in a duration for which the largest control is about that large, relative to its bounds."""
    duration = first_duration(instance)
    goal = (wanted[0] * wanted[1]) ** 0.5
    for _ in range(DURATIONS):
        found = _least_effort(instance, duration, limits)
        if found is None or not 0.0 < (full := _largest_share(instance, found)) < float("inf"):
            return None
        if wanted[0] <= full <= wanted[1]:
            return found
        duration *= min(max((full / goal) ** 0.6, 0.1), 10.0)
    return None


def first_duration(instance: Instance) -> float:
    """The guess; or the time scale of the motion, unless that is long only because its modes drift slowly apart."""
    if instance.tf_guess is not None:
        return instance.tf_guess - instance.t0
    scale, n = time_scale(regularised(instance, 1.0, 0.0)), len(instance.initial)
    idle = instance.control_set.rest
    slopes = np.array(instance.model.jacobian_x(instance.t0, instance.initial, idle, instance.parameters))
    quickest = float(np.linalg.norm(slopes.reshape(n, n), 2))
    return DRIFTING / quickest if quickest * scale > DRIFTING**2 else scale


def _least_effort(instance: Instance, duration: float, limits: Limits) -> Smoothed | None:
    """The least effort in a given time without bounds, if the straight line leads there at once."""
    if limits.expired:
        return None
    fixed = replace(regularised(instance, 1.0, 0.0), tf=instance.t0 + duration, tf_guess=None)
    problem = two_point(fixed, duration).relaxed(float("inf"))
    line = as_curve(problem, first(problem))
    found = straight_through(problem, line, limits)
    return None if found is None else Smoothed(problem, found.curve, _normalised(problem, found.curve))


def _largest_share(instance: Instance, found: Smoothed) -> float:
    """The largest control, relative to its bound on that side."""
    tau = np.linspace(0.0, 1.0, 33)
    u = found.problem.control(tau, found.curve(tau), found.curve.theta)
    low, high = instance.control_set.box
    return float(np.max(np.where(u > 0.0, u / high, np.where(u < 0.0, u / low, 0.0))))


def shortening(instance: Instance, limits: Limits) -> Iterator[Smoothed]:
    """Motions of least effort within the bounds, from a long duration towards the least.

    For free final times; there the control is on its bounds almost all the time.
    """
    found = of_size(instance, WITHIN, limits)
    if found is None:
        return
    longest = found.problem.relaxed(0.0)
    curve, duration, ratio = found.curve, longest.duration, SHORTER

    def lasting(duration: float) -> TwoPoint:
        return replace(
            longest, duration=duration, instance=replace(longest.instance, tf=instance.t0 + duration, tf_guess=None)
        )

    while ratio > SMALLEST_SHORTENING and not limits.expired:
        start, end = duration, duration / (1.0 + ratio)

        def between(fraction: float, start: float = start, end: float = end) -> TwoPoint:
            return lasting(start + fraction * (end - start))

        curve, reached = follow(between, curve, limits, shortest=0.25)
        duration = start + reached * (end - start)
        if reached < 1.0:
            ratio /= 4.0
        if reached > 0.0:
            problem = lasting(duration)
            yield Smoothed(problem, curve, _normalised(problem, curve))


def _normalised(problem: TwoPoint, curve: Curve) -> float:
    """The factor that makes the Hamiltonian vanish, the control being on its bounds: in the mean over time."""
    instance, n = problem.instance, problem.states
    tau = np.linspace(0.0, 1.0, 17)
    z, t, p = curve(tau) * problem.scale.both, instance.t0 + problem.duration * tau, instance.parameters
    sigma = instance.model.switching_function_batch(t, z[:n], z[n:], p)
    u = np.where(sigma > 0.0, *instance.control_set.box)
    growth = (z[n:] * instance.model.dynamics_batch(t, z[:n], u, p)).sum(axis=0)
    cost = np.broadcast_to(instance.model.running_cost_batch(t, z[:n], u, p), growth.shape)
    factor = -float(cost.mean() / growth.mean()) if growth.any() else 1.0
    return factor if 0.0 < factor < float("inf") else 1.0
