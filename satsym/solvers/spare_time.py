"""The longest duration of a motion that may cost less than a known one, and the frequency of nearby oscillations."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.solution import Solution

PLACES = 41
"""Number of points at which modes are computed."""

LONGER, SWINGS, FREELY = 12.0, 3.0, 4.0
"""Limits of the durations that are searched: multiples of the known duration and of the oscillation period, as far as
the cost of time alone stays below the known cost; and a multiple of the known duration if time has no cost."""


def longest(solution: Solution) -> float:
    """Return the longest duration in which a cheaper motion is searched for; the given duration if there is one."""
    instance, lasting = solution.instance, float(solution.times[-1] - solution.times[0])
    if instance.tf is not None:
        return lasting
    idle = instance.control_set.project(np.zeros_like(solution.u))
    rate = float(np.min(instance.model.running_cost_batch(solution.times, solution.x, idle, instance.parameters)))
    paid = solution.objective / rate if rate > 0.0 else FREELY * lasting
    swings = SWINGS * 2.0 * np.pi / max(frequency(solution), 1e-300)
    return max(lasting, min(paid, max(LONGER * lasting, swings)))


def frequency(solution: Solution) -> float:
    """Return the angular frequency of the fastest oscillation of the linearised motion along a solution."""
    slopes = rates_by_states(solution, max(1, len(solution.times) // PLACES))
    return float(np.abs(np.linalg.eigvals(slopes.transpose(2, 0, 1)).imag).max())


def rates_by_states(solution: Solution, step: int) -> Array:
    """Return derivatives of the rates by states, shape (n, n, M), at every ``step``-th time."""
    instance, n, times = solution.instance, len(solution.x), solution.times[::step]
    x, u = solution.x[:, ::step], solution.u[:, ::step]
    slopes = np.asarray(instance.model.jacobian_x_batch(times, x, u, instance.parameters))
    return np.broadcast_to(slopes, (n, n, len(times)))
