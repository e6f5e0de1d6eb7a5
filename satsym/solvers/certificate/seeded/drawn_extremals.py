"""Competitors from extremals that are drawn, where a motion is likely to have several minima that few starts show.

So it is where starts disagree or lead nowhere, where a motion is far from linear, and where a free duration leaves time
for another swing.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.solution import Solution
from satsym.solvers.certificate.comparison import Compared
from satsym.solvers.certificate.reintegration.flow import unit_sizes
from satsym.solvers.certificate.seeded.searches import Search, at_its_duration, from_near, from_path
from satsym.solvers.spare_time import frequency, longest, rates_by_states

UNLIKE = 1.0 / 3.0
"""Share of linearised rates by which they depart from their mean along the way, on average, where motions are nearly
linear: one that keeps to an orbit has a seventh, one that leaves a well or falls from the top more than half."""

SWING = np.pi
"""Angle by which the quickest mode turns in time that can be paid for besides."""

STEPS, SOFTNESS = 300, 0.01
"""Steps of the minimisation from each, because among many swings those cost nearly the same that differ by a push; and
softness of the bounds in it."""


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
    from satsym.solvers.drawn_beside import about

    instance = solution.instance
    if not instance.final or not several_likely(solution, first):
        return []
    problem, by_law = at_its_duration(solution), instance.model.spec.directional or instance.model.spec.stationary
    found, free = list[Search](), by_law and instance.tf is None
    for one in about(solution, problem, seed, closely=by_law):
        there = instance if free else replace(problem.instance, tf=instance.t0 + one.duration)
        lasting = two_point(there, one.duration) if free or one.duration != problem.duration else problem
        if by_law:  # which decides everything: no descent of states knows where it jumps
            found.append(from_near(lasting, one.z * problem.scale.both, solution.objective))
            continue
        path = paths.through(lasting, one.states * problem.scale.state[:, None])
        found.append(from_path(lasting, path, SOFTNESS, solution.objective, STEPS))
    return found


def several_likely(solution: Solution, first: Compared) -> bool:
    """Whether there may be minima that few starts show, by what the first ones came to and by the motion."""
    agree = first.summary.solved == first.summary.tried and not first.several
    return not agree or far_from_linear(solution) or may_swing(solution)


def far_from_linear(solution: Solution) -> bool:
    """Whether linearised rates change much along a solution.

    Those of a linear motion are the same everywhere, and its least cost has one minimum where costs are convex.
    """
    size = unit_sizes(solution)[: len(solution.x)]
    scaled = rates_by_states(solution, 1) * (size / size[:, None])[:, :, None]
    widths = np.gradient(solution.times)
    mean = (scaled * widths).sum(axis=2, keepdims=True) / widths.sum()
    apart, whole = (float(np.linalg.norm(one, axis=(0, 1)) @ widths) for one in (scaled - mean, scaled))
    return apart > UNLIKE * whole


def may_swing(solution: Solution) -> bool:
    """Whether a free duration leaves time for another swing, which then need not cost more than pushing at once."""
    spare = longest(solution) - float(solution.times[-1] - solution.times[0])
    return spare > 0.0 and spare * frequency(solution) > SWING
