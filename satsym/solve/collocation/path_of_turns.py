"""A given number of turns: along the spiral that makes them, or unwound from what the free motion makes by itself.

Where the spiral leads to no minimum, the initial state is turned so far that the free motion arrives with as many turns
as it makes in that time, and then moved home: each problem starts from the last.
"""

from __future__ import annotations

from dataclasses import replace

from satsym.solve.collocation import paths
from satsym.solve.collocation.from_path import from_path
from satsym.solve.collocation.path_of_problems import followed
from satsym.solve.collocation.problem import TwoPoint
from satsym.solve.collocation.sqp import Found
from satsym.solve.iteration import Limits
from satsym.solve.symmetry import Spiral

MOST = 30
"""Steps along the spiral itself."""


def along_turns(problem: TwoPoint, spiral: Spiral, limits: Limits) -> Found:
    """The minimum with a number of turns.

    Parameters
    ----------
    problem
        Without bounds, or with soft ones.
    spiral
        That makes them.
    limits
        When to stop.
    """
    found = from_path(problem, spiral.path, limits, MOST)
    if found.minimum or limits.expired:
        return found
    first = from_path(spiral.unwound(0.0), spiral.coasting, limits, MOST)
    begun = first.curve if first.minimum else paths.curve(problem, spiral.coasting)
    unwound = followed(problem, spiral.unwound, begun, limits)
    return replace(unwound, iterations=found.iterations + first.iterations + unwound.iterations)
