"""Again and again by compiled shooting: Newton's method on the arcs of the last answer."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.instance import Instance
from satsym.solvers.cold_start import paths
from satsym.solvers.collocation.extremal import Extremal
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.second_variation import negative_directions
from satsym.solvers.iteration import Limits
from satsym.solvers.search.solving import guessed
from satsym.solvers.shooting.arcs import Arcs
from satsym.solvers.shooting.newton import linearised
from satsym.solvers.shooting.quick import quick_newton
from satsym.solvers.shooting.solving import ACCURACY, converged, extremal, without_guess
from satsym.status import Status

Shot = tuple[Arcs, float, int]
"""Arcs that meet, with their error and the iterations."""


class ByShooting:
    """See :class:`satsym.solvers.repeated.repeated.Means`; for instances whose model is compiled."""

    name = "shooting"

    def __init__(self) -> None:
        self._good: Arcs | None = None
        self._steps = 1

    def near(self, case: Instance, limits: Limits) -> Extremal | None:
        """The extremal near the last good one, within the bounds at once."""
        if self._good is None:
            return None
        return self._kept(self._shot(replace(self._good.problem, instance=case), self._good))

    def straight(self, case: Instance, limits: Limits) -> Extremal | None:
        """First without bounds, then within them."""
        if self._good is None or case.tf is None:
            return None
        problem, like = replace(self._good.problem, instance=case), self._good
        free = problem.relaxed(float("inf"))
        states = paths.first(free)(like.mesh)
        found = self._shot(
            free, replace(like, nodes=np.append(states, np.zeros_like(states), axis=0), theta=free.theta)
        )
        if found is None or not _minimum(found[0]):
            return None
        return self._kept(self._shot(problem, found[0]) if problem.control_set.bounded else found)

    def cold(self, case: Instance, limits: Limits) -> Extremal:
        """A cold start, which also decides on arcs and steps; from the search where that leads nowhere."""
        found = without_guess(case, limits)
        if found.status is Status.NOT_CONVERGED:
            found = without_guess(guessed(case, limits), limits)
        if found.status.answered and isinstance(found.path, Arcs):
            self._good, self._steps = found.path, max(found.path.steps // 2, 1)
        return found

    def full(self, found: Extremal, limits: Limits) -> Extremal:
        """With nodes where bounds are met: compiled arcs step onto these times, but do not tell them."""
        if not found.problem.control_set.bounded:
            return found
        return extremal(found.problem, found.path, limits)

    def _shot(self, problem: TwoPoint, start: Arcs) -> Shot | None:
        """Newton on arcs of a neighbouring problem."""
        tolerance = min(ACCURACY, problem.instance.solver.tolerance)
        arcs, error, iterations = quick_newton(replace(start, problem=problem, steps=self._steps), tolerance)
        sound = error <= tolerance and (arcs.nodes[list(problem.positive)] > 0.0).all()
        return (arcs, error, iterations) if sound else None

    def _kept(self, found: Shot | None) -> Extremal | None:
        if found is None:
            return None
        self._good = found[0]
        return converged(*found)


def _minimum(arcs: Arcs) -> bool:
    """Whether an extremal is a strict local minimum without bounds."""
    try:
        return negative_directions(arcs.problem, arcs, linearised(arcs)[0]) == 0
    except np.linalg.LinAlgError:
        return False
