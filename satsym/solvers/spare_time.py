"""How long a motion may last that costs less than a known one, and how quickly motions beside that swing."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.solution import Solution

PLACES = 41
"""At which modes are looked at."""

LONGER, SWINGS, FREELY = 12.0, 3.0, 4.0
"""Shares of a duration, or periods, up to which longer ones are looked at that can be paid for: what time alone would
cost is less than what was found. Where time need not cost anything, up to the last share."""


def longest(solution: Solution) -> float:
    """The longest duration in which something is looked for that may cost less: that which is given, if one is."""
    instance, lasting = solution.instance, float(solution.times[-1] - solution.times[0])
    if instance.tf is not None:
        return lasting
    idle = instance.control_set.project(np.zeros_like(solution.u))
    rate = float(np.min(instance.model.running_cost_batch(solution.times, solution.x, idle, instance.parameters)))
    paid = solution.objective / rate if rate > 0.0 else FREELY * lasting
    swings = SWINGS * 2.0 * np.pi / max(frequency(solution), 1e-300)
    return max(lasting, min(paid, max(LONGER * lasting, swings)))


def frequency(solution: Solution) -> float:
    """The angular frequency of the quickest oscillation of linearised motions along a solution."""
    slopes = rates_by_states(solution, max(1, len(solution.times) // PLACES))
    return float(np.abs(np.linalg.eigvals(slopes.transpose(2, 0, 1)).imag).max())


def rates_by_states(solution: Solution, step: int) -> Array:
    """The derivatives of rates by states, shape (n, n, M), at every so many times."""
    instance, n, times = solution.instance, len(solution.x), solution.times[::step]
    x, u = solution.x[:, ::step], solution.u[:, ::step]
    slopes = np.asarray(instance.model.jacobian_x_batch(times, x, u, instance.parameters))
    return np.broadcast_to(slopes, (n, n, len(times)))
