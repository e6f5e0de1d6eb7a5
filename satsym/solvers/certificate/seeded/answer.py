"""The answer that competitors are compared with, as what searches for these may be led to.

A search that comes near it need not find it once more by minimising: Newton's method, with the equations as they are
linearised along the answer, leads there at a fraction of what that takes. That it does is not supposed but done, and
where each of its steps leaves a fraction of the distance there is no other extremal between.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from satsym.arrays import Array
from satsym.solution import Solution
from satsym.solvers.failures import tried

if TYPE_CHECKING:
    from satsym.solvers.certificate.comparison import Competitor
    from satsym.solvers.collocation.curve import Curve
    from satsym.solvers.collocation.linearised import Linearised
    from satsym.solvers.collocation.system import System

NEAR = 0.5
"""Largest distance from the answer, relative as in :meth:`Step.size`, from which this is tried."""

SHRINKING, STEPS = 0.3, 5
"""Share of the distance that each step may leave, and steps at most."""

ARRIVED = 1e-6
"""Distance that is none."""

CLOSE = 1e-3
"""Largest correction of a solution's own values on a mesh on which its equations are linearised."""


@dataclass(frozen=True, eq=False)
class Near:
    """The surroundings of an extremal."""

    system: System
    curve: Curve
    """The extremal on the mesh of the system."""
    linearised: Linearised

    def leads(self, curve: Curve) -> bool:
        """Whether Newton's method leads to it from a curve of the same problem."""
        there = curve.on(self.system.mesh, self.system.order)
        left = self._distance(there)
        if not left <= NEAR:
            return False
        for _ in range(STEPS):
            there = there.moved(self.linearised.step(self.system.residual(there)), 1.0)
            before, left = left, self._distance(there)
            if not left <= SHRINKING * before:
                return False
            if left <= ARRIVED:
                return True
        return False

    def _distance(self, curve: Curve) -> float:
        from satsym.solvers.collocation.curve import Step

        apart = Step(curve.nodes - self.curve.nodes, curve.stages - self.curve.stages, curve.theta - self.curve.theta)
        return apart.size(self.curve)


@dataclass(frozen=True, eq=False)
class Answer:
    """A solution whose competitors are looked for."""

    solution: Solution

    @cached_property
    def near(self) -> Near | None:
        """Its surroundings among motions without bounds; ``None`` where it meets one, or multipliers are unknown."""
        with np.errstate(all="ignore"):
            return tried(self._near)

    @cached_property
    def once_more(self) -> Competitor | None:
        """The extremal in these surroundings, with its own cost, which may be less than the stated one."""
        from satsym.solvers.certificate.seeded.searches import accurate

        assert self.near is not None
        near = self.near
        return accurate(near.system.problem, near.curve, self.solution.objective, near.linearised)

    def _near(self) -> Near | None:
        from satsym.solvers.certificate.seeded.searches import at_its_duration
        from satsym.solvers.cold_start import paths
        from satsym.solvers.collocation import mesh as meshes
        from satsym.solvers.collocation.continuation import kept
        from satsym.solvers.collocation.curve import Curve, stage_times
        from satsym.solvers.collocation.gauss import STAGES
        from satsym.solvers.collocation.newton import newton
        from satsym.solvers.collocation.system import System

        problem, times = at_its_duration(self.solution), self.solution.times
        if problem.unknowns:
            return None
        z = np.concatenate([self.solution.x, self.solution.lam]) / problem.scale.both

        def at(tau: Array) -> Array:
            when = times[0] + (times[-1] - times[0]) * tau.ravel()
            return np.array([np.interp(when, times, row) for row in z]).reshape(len(z), *tau.shape)

        even = np.linspace(0.0, 1.0, paths.POINTS)
        mesh = meshes.along(problem, even, at(even)[: problem.states], problem.theta)
        curve = Curve(mesh, at(mesh), at(stage_times(mesh, STAGES)), problem.theta)
        if not kept(problem, curve):
            return None
        system = System(problem.softened(1.0), mesh, STAGES)
        found = newton(system, curve, CLOSE, 1)
        if found is None or not found.solved or found.linearised is None:
            return None
        return Near(system, found.curve, found.linearised)
