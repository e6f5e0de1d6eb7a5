"""Again and again by collocation: scales and mesh are kept, Newton's method starts from the last curve."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.instance import Instance
from satsym.solvers import two_point
from satsym.solvers.cold_start import paths
from satsym.solvers.cold_start.origin import Origin, Start
from satsym.solvers.cold_start.straight_through import straight_through
from satsym.solvers.collocation import mesh as meshes
from satsym.solvers.collocation.accuracy.refinement import NEAR_CORRECTION
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.curve import Curve
from satsym.solvers.collocation.extremal import Extremal
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.newton import newton
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.second_variation import negative_directions
from satsym.solvers.collocation.system import System
from satsym.solvers.iteration import Limits
from satsym.solvers.search.solving import guessed
from satsym.status import Status


class ByCollocation:
    """See :class:`satsym.solvers.repeated.repeated.Means`; nothing is compiled."""

    name = "collocation"

    def __init__(self) -> None:
        self._good: tuple[TwoPoint, Curve] | None = None

    def near(self, case: Instance, limits: Limits) -> Extremal | None:
        """The extremal near the last good one, bounds brought in again."""
        if self._good is None:
            return None
        problem, curve = replace(self._good[0], instance=case), self._good[1]
        free = problem.relaxed(float("inf"))
        system = System(free, curve.mesh, STAGES)
        outcome = newton(system, curve, tolerance=NEAR_CORRECTION)
        if outcome is None or not outcome.solved or not outcome.curve.in_domain(free.positive):
            return None
        assert outcome.linearised is not None
        try:
            least = negative_directions(free, outcome.curve, outcome.linearised.matching) == 0
        except np.linalg.LinAlgError:
            return None
        turn = system.largest_turn(outcome.curve, system.jacobian(outcome.curve))
        if not least or turn > meshes.COARSEST:
            return None
        cost = system.cost(outcome.curve)
        found = replace(outcome, reason=Reason.MINIMUM, cost=cost, hard=False)
        return self._sound(problem, found, limits)

    def straight(self, case: Instance, limits: Limits) -> Extremal | None:
        """Newton's method from the straight line, on the mesh of the last good curve."""
        if self._good is None or case.tf is None:
            return None
        problem, mesh = replace(self._good[0], instance=case), self._good[1].mesh
        free = problem.relaxed(float("inf"))
        found = straight_through(free, paths.on(free, paths.first(free), mesh), limits)
        return self._sound(problem, found, limits) if found else None

    def cold(self, case: Instance, limits: Limits) -> Extremal:
        """A cold start, with a mesh and scales of its own; from the search where that leads nowhere."""
        found = two_point.from_cold_start(case, limits, self._within)
        if found.status is not Status.NOT_CONVERGED:
            return found
        return two_point.from_cold_start(guessed(case, limits), limits, self._within)

    def full(self, found: Extremal, limits: Limits) -> Extremal:
        """Nothing is missing."""
        return found

    def _sound(self, problem: TwoPoint, found: Attempt, limits: Limits) -> Extremal | None:
        start = Start(found, Origin.LAST_ANSWER, found.iterations)
        extremal = self._within(problem, start, limits)
        return extremal if extremal.status.answered else None

    def _within(self, problem: TwoPoint, start: Start, limits: Limits) -> Extremal:
        extremal = two_point.accurate(problem, start, limits)
        if extremal.status.answered:
            self._good = problem, start.found.curve
        return extremal
