"""A given number of turns: from the spiral that makes them, driven by a force that fades.

A spiral is no motion: it lacks some rates. With these added to the model it becomes one, and costs no control, so it
is where a path of problems begins; the controls take over what the force leaves. Minimising from the spiral itself
gets stuck where there are many turns, as a small defect early on asks for a large change of phase later.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from satsym.arrays import Array
from satsym.solvers.cold_start import paths
from satsym.solvers.cold_start.path_of_problems import followed
from satsym.solvers.collocation.attempt import Attempt
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.iteration import Limits
from satsym.solvers.symmetry import Spiral

STEP = 1e-5
"""Share of the duration by which a path is differenced."""


def along_turns(problem: TwoPoint, spiral: Spiral, limits: Limits) -> Attempt:
    """The minimum with a number of turns.

    Parameters
    ----------
    problem
        Without bounds, or with soft ones; its duration is given.
    spiral
        That makes them.
    limits
        When to stop.
    """
    return followed(problem, fading(problem, spiral), paths.curve(problem, spiral.path), limits)


def fading(problem: TwoPoint, spiral: Spiral) -> Callable[[float], TwoPoint]:
    """Problems by their share of the way: from the one that the spiral solves without costates, to the given one."""

    def lacking(tau: Array) -> Array:
        its = (spiral.path(tau + STEP) - spiral.path(tau - STEP)) / (2.0 * STEP * problem.duration)
        z = np.concatenate([spiral.path(tau), np.zeros((problem.states, len(tau)))])
        return its - problem.rates(tau, z, problem.theta)[: problem.states]

    return lambda share: problem.forced(lacking, 1.0 - share)
