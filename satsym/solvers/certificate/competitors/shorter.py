"""Competitors of linear motions in a free time: shorter durations, and all that is reached in them."""

from __future__ import annotations

import numpy as np

from satsym.solution import Solution
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.linear.linear_motion import linear_motion
from satsym.solvers.switching.linear.reach import THERE, Reach, given_rows

SEED, DURATIONS = 20012, 12
"""Seed of the shorter durations that are drawn, and how many there are."""


def shorter(solution: Solution, limits: Limits) -> list[float]:
    """Costs in shorter durations of a linear motion, NaN where one is too short, from which nothing is left out.

    None where the motion is not linear, or where its time is given or costs nothing.
    """
    instance, rng = solution.instance, np.random.default_rng(SEED)
    motion = None if instance.model.spec.multipliers or instance.tf is not None else linear_motion(instance)
    if motion is None or not motion.priced or not motion.rate > 0.0 or not len(given_rows(instance)):
        return []
    lasting = float(solution.times[-1]) - instance.t0
    edges = np.linspace(0.0, 1.0, DURATIONS + 1)
    fractions = np.append(rng.uniform(edges[:-1], edges[1:])[:-1], 1.0 - 10.0 ** rng.uniform(-3.0, -2.0))
    costs = list[float]()
    for fraction in fractions.tolist():
        reach = Reach(instance, motion, fraction * lasting)
        limits.spend(reach.count)
        if reach.separation()[0] > THERE:
            costs.append(float("nan"))
            continue
        priced = reach.minimum_cost() if motion.weight.any() or motion.slope.any() else None
        costs.append(motion.rate * reach.duration + (priced.cost if priced is not None else 0.0))
    return costs
