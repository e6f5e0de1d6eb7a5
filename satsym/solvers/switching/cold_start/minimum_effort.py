"""Motions of least effort where the final time is free: durations in which bounds bind, or hardly do.

Without bounds the least effort in a given time is found at once.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from satsym.instance import Instance
from satsym.solvers.cold_start.durations import time_scale
from satsym.solvers.cold_start.paths import curve as as_curve
from satsym.solvers.cold_start.paths import first
from satsym.solvers.cold_start.straight_through import straight_through
from satsym.solvers.collocation.curve import Curve
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


@dataclass(frozen=True, eq=False)
class Smoothed:
    """A smoothed extremal."""

    problem: TwoPoint
    curve: Curve
    """The regularised problem, and its solution."""


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
    return None if found is None else Smoothed(problem, found.curve)


def _largest_share(instance: Instance, found: Smoothed) -> float:
    """The largest control, relative to its bound on that side."""
    tau = np.linspace(0.0, 1.0, 33)
    u = found.problem.control(tau, found.curve(tau), found.curve.theta)
    low, high = instance.control_set.box
    return float(np.max(np.where(u > 0.0, u / high, np.where(u < 0.0, u / low, 0.0))))
