"""Extremals in a given time, from motions that obey the minimum principle on both sides: from the start and to the end.

Where one from the start comes close to one to the end, both are smoothed together, and then less and less: a motion
that swings another way, to which no start leads that knows nothing of pushing at the right times.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from satsym.instance import Guess
from satsym.solution import Solution
from satsym.solvers.cold_start import paths
from satsym.solvers.cold_start.soft_bounds import within_bounds
from satsym.solvers.collocation.curve import Curve
from satsym.solvers.collocation.problem import Scale, TwoPoint
from satsym.solvers.collocation.scaling import two_point
from satsym.solvers.control.regularised import regularised
from satsym.solvers.drawn_beside import Beside, about
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.attempt import Exact, Origin
from satsym.solvers.switching.by_smoothing import smoothed
from satsym.solvers.switching.cold_start import by_costates
from satsym.solvers.switching.cold_start.homotopy import Stopped, first_smoothing
from satsym.solvers.switching.linear.linear_motion import linear_motion

WORK = 100_000
"""Columns that all of them may take."""

STEPS, SOFTNESS = 300, 0.01
"""Steps of the minimisation from each, and softness of the bounds in it."""


def meetings(solution: Solution, seed: int, limits: Limits) -> Iterator[Exact | None]:
    """What each pair leads to that nearly meets and may cost less than a solution, the cheapest first.

    Nothing where what a linear motion costs at least is known. Where the time is free, those from the start that come
    near to the end at any time lead to one at most.

    Parameters
    ----------
    seed
        Of what is drawn.
    """
    instance = solution.instance
    spec, allowed = instance.model.spec, replace(limits, work=limits.meter.spent + WORK)
    if not instance.final or spec.multipliers or spec.in_arcs or linear_motion(instance) is not None:
        return
    if instance.tf is None:
        sooner = tried(partial(by_costates.sooner, solution, seed, limits))
        if sooner is not None:
            yield replace(sooner, origin=Origin.COSTATES)
        return
    if not solution.lam.any():
        return
    problem = _problem(solution)
    for one in tried(partial(about, solution, problem, seed, closely=True)) or []:
        begun = None if allowed.expired else tried(partial(_begun, solution, problem, one, allowed))
        found = None if begun is None else smoothed(instance, allowed, thorough=False, begun=begun)
        yield None if isinstance(found, Stopped) else found


def _problem(solution: Solution) -> TwoPoint:
    """That of a solution in units of its states and costates."""
    instance, size = solution.instance, np.maximum(np.abs(solution.x).max(axis=1), 1e-300)
    problem = two_point(replace(instance, guess=Guess()), float(solution.times[-1]) - instance.t0)
    return replace(problem, scale=Scale(size, float(np.abs(solution.lam * size[:, None]).max())))


def _begun(solution: Solution, problem: TwoPoint, one: Beside, limits: Limits) -> tuple[TwoPoint, Curve] | None:
    """The regularised problem without the weight of |u|, and its extremal next to a motion."""
    eased = regularised(solution.instance, first_smoothing(solution.instance), 0.0)
    easier = two_point(eased, one.duration)
    path = paths.through(easier, one.states * problem.scale.state[:, None])
    found = within_bounds(easier, path, limits, SOFTNESS, STEPS)
    return (easier, found.curve) if found.solved else None
