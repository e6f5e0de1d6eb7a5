"""From a cold start to a minimum without bounds: Newton's method from the straight line, else a minimisation.

The straight line in the state space is that between the ends or, where nothing is asked of the end, the uncontrolled
motion; or else what is guessed. What this does not solve is left to the direct search.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from satsym.solvers.cold_start import paths
from satsym.solvers.cold_start.from_path import STRAIGHT_THROUGH, from_path
from satsym.solvers.cold_start.origin import Origin, Start
from satsym.solvers.cold_start.straight_through import straight_through
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.curve import Curve
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.newton import newton
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.system import System
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits


def cold_start(problem: TwoPoint, limits: Limits) -> Start:
    """Find a minimum of a problem without bounds, or an extremal that is none.

    Parameters
    ----------
    problem
        Bounds are ignored.

    Raises
    ------
    ArithmeticError
        If the equations at the start are singular.
    """
    free = problem.relaxed(float("inf"))
    path = paths.first(free)
    line = paths.start(free, path)
    with np.errstate(all="ignore"):
        found = tried(partial(_minimum, free, line, limits))
    if found is None:
        raise ArithmeticError("the equations of the cold start are singular")
    if found.minimum and found.curve.in_domain(free.positive):
        origin = Origin.GUESS if problem.instance.guess else Origin.STRAIGHT_LINE
        return Start(found, origin, found.iterations)
    saddle = None if limits.expired else _extremal(free, line)
    if found.minimum:
        found = replace(found, reason=Reason.OUT_OF_DOMAIN)
    return Start(found, Origin.NO_MINIMUM, found.iterations, saddle=saddle)


def _minimum(problem: TwoPoint, line: Curve, limits: Limits) -> Attempt:
    """The minimum to which the straight line leads as a first guess, or why it leads to none."""
    return straight_through(problem, line, limits) or from_path(problem, paths.first(problem), limits)


def _extremal(problem: TwoPoint, start: Curve) -> Attempt | None:
    """What Newton's method finds from a curve, whether a minimum or not."""
    system = System(problem, start.mesh, STAGES)
    outcome = newton(system, start, most=STRAIGHT_THROUGH)
    if outcome is None or not outcome.solved or not outcome.curve.in_domain(problem.positive):
        return None
    return Attempt(outcome.curve, Reason.SADDLE, outcome.iterations, system.cost(outcome.curve))
