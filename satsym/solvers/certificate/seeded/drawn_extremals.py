"""Competitors from extremals that are drawn, where a motion is likely to have several minima that few starts show.

So it is where starts disagree or lead nowhere, where a motion is far from linear, and where a free duration leaves time
for another swing.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.arrays import Array
from satsym.solution import Solution
from satsym.solvers.certificate.comparison import Compared
from satsym.solvers.certificate.reintegration.flow import unit_sizes
from satsym.solvers.certificate.seeded.searches import Search, at_its_duration, from_path

UNLIKE = 1.0 / 3.0
"""Share of linearised rates by which they depart from their mean along the way, on average, where motions are nearly
linear: one that keeps to an orbit has a seventh, one that leaves a well or falls from the top more than half."""

SWING, PLACES = np.pi, 41
"""Angle by which the quickest mode turns in time that can be paid for besides, and places at which modes are looked at.
"""

LONGER, SWINGS, FREELY = 12.0, 3.0, 4.0
"""Shares of a duration, or periods, up to which longer ones are looked at that can be paid for: what time alone would
cost is less than what was found. Where time need not cost anything, up to the last share."""

STEPS, SOFTNESS = 300, 0.01
"""Steps of the minimisation from each, because among many swings those cost nearly the same that differ by a push; and
softness of the bounds in it."""

SAMPLES = 401
"""Of a known extremal."""


def searches(solution: Solution, first: Compared, seed: int) -> list[Search]:
    """The minima within the bounds to which extremals lead that are drawn, nearly meet and seem to cost less.

    Parameters
    ----------
    first
        What the first starts came to: none are drawn where they agree, and nothing speaks for several minima.
    seed
        Of what is drawn.
    """
    from satsym.solvers.cold_start import paths
    from satsym.solvers.collocation.scaling import two_point
    from satsym.solvers.drawn_beside import Known, beside

    instance, agree = solution.instance, first.summary.solved == first.summary.tried and not first.several
    if not instance.final or (agree and not far_from_linear(solution) and not may_swing(solution)):
        return []
    problem, rng = at_its_duration(solution), np.random.default_rng(seed)
    even = np.linspace(solution.times[0], solution.times[-1], SAMPLES)
    z = [np.interp(even, solution.times, row) for row in (*solution.x, *solution.lam)] / problem.scale.both
    n, found = problem.states, list[Search]()
    known = Known(z[:n], z[n:], solution.objective / problem.scale.cost, longest(solution))
    for one in beside(problem, known, rng):
        there = replace(problem.instance, tf=instance.t0 + one.duration)
        lasting = problem if one.duration == problem.duration else two_point(there, one.duration)
        path = paths.through(lasting, one.states * problem.scale.state[:, None])
        found.append(from_path(lasting, path, SOFTNESS, solution.objective, STEPS))
    return found


def far_from_linear(solution: Solution) -> bool:
    """Whether linearised rates change much along a solution.

    Those of a linear motion are the same everywhere, and its least cost has one minimum where costs are convex.
    """
    size = unit_sizes(solution)[: len(solution.x)]
    scaled = _slopes(solution, 1) * (size / size[:, None])[:, :, None]
    widths = np.gradient(solution.times)
    mean = (scaled * widths).sum(axis=2, keepdims=True) / widths.sum()
    apart, whole = (float(np.linalg.norm(one, axis=(0, 1)) @ widths) for one in (scaled - mean, scaled))
    return apart > UNLIKE * whole


def may_swing(solution: Solution) -> bool:
    """Whether a free duration leaves time for another swing, which then need not cost more than pushing at once."""
    spare = longest(solution) - float(solution.times[-1] - solution.times[0])
    return spare > 0.0 and spare * _frequency(solution) > SWING


def longest(solution: Solution) -> float:
    """The longest duration in which something is looked for that may cost less: that which is given, if one is."""
    instance, lasting = solution.instance, float(solution.times[-1] - solution.times[0])
    if instance.tf is not None:
        return lasting
    idle = instance.control_set.project(np.zeros_like(solution.u))
    rate = float(np.min(instance.model.running_cost_batch(solution.times, solution.x, idle, instance.parameters)))
    paid = solution.objective / rate if rate > 0.0 else FREELY * lasting
    swings = SWINGS * 2.0 * np.pi / max(_frequency(solution), 1e-300)
    return max(lasting, min(paid, max(LONGER * lasting, swings)))


def _frequency(solution: Solution) -> float:
    """Of the quickest oscillation of linearised motions along a solution."""
    slopes = _slopes(solution, max(1, len(solution.times) // PLACES))
    return float(np.abs(np.linalg.eigvals(slopes.transpose(2, 0, 1)).imag).max())


def _slopes(solution: Solution, step: int) -> Array:
    """The rates by the states, shape (n, n, M), at every so many times."""
    instance, n, times = solution.instance, len(solution.x), solution.times[::step]
    x, u = solution.x[:, ::step], solution.u[:, ::step]
    slopes = np.asarray(instance.model.jacobian_x_batch(times, x, u, instance.parameters))
    return np.broadcast_to(slopes, (n, n, len(times)))
