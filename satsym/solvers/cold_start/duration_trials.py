"""Problems of given durations, solved: from a cold start, or from the extremal of a neighbouring duration."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from satsym.instance import Instance
from satsym.solvers.cold_start import paths
from satsym.solvers.cold_start.first_minimum import cold_start
from satsym.solvers.cold_start.origin import Start
from satsym.solvers.collocation import mesh as meshes
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.curve import Curve, stage_times
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.linearised import linearise
from satsym.solvers.collocation.newton import newton
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.scaling import two_point
from satsym.solvers.collocation.second_variation import negative_directions
from satsym.solvers.collocation.system import System
from satsym.solvers.iteration import Limits

NEGLIGIBLE = 1e-30
"""Share of the problem's own cost below which time costs nothing: what costates that are not quite zero leave."""


@dataclass(frozen=True, eq=False)
class Try:
    """The problem of a given duration, solved."""

    problem: TwoPoint
    """With that duration, without bounds."""
    start: Start
    """Its extremal."""
    cost: float
    slope: float
    """What it costs, and the derivative of that by the duration."""
    floor: float
    """What every unit of time costs at least along this motion, without any control."""

    @property
    def duration(self) -> float:
        """The given duration."""
        return self.problem.duration


@dataclass(frozen=True, eq=False)
class Minimum:
    """An extremal whose duration is the cheapest among its neighbours: its cost, its problem, and how it was found."""

    cost: float
    problem: TwoPoint
    start: Start
    message: str = ""

    @property
    def duration(self) -> float:
        """What was found for it."""
        return float(self.start.found.curve.theta[-1])


class Trials:
    """Durations are given to an instance whose final time is free; the last attempt is kept, steps are counted."""

    def __init__(self, instance: Instance, limits: Limits, first: float) -> None:
        self.instance, self.limits, self.first = instance, limits, first
        self.steps = 0
        self._last: tuple[float, Curve] | None = None

    @cached_property
    def unit(self) -> float:
        """The problem's own scale of costs."""
        return self.free(self.first).scale.cost

    @cached_property
    def at_once(self) -> float:
        """What ending without any motion costs; infinite where that is no end."""
        return self.free(self.first).at_once

    @cached_property
    def credit(self) -> float:
        """What the end brings in right at the start: time has to cost it as well before that is too dear."""
        instance = self.instance
        if not instance.model.spec.has_terminal_cost:
            return 0.0
        return max(0.0, -float(instance.model.terminal_cost(instance.t0, instance.initial, instance.parameters)))

    @property
    def last(self) -> tuple[TwoPoint, Curve]:
        """The last attempt, for the record."""
        problem = self.free(self.first)
        duration, curve = self._last or (self.first, paths.curve(problem, paths.first(problem)))
        if len(curve.theta) < problem.unknowns:
            curve = replace(curve, theta=np.append(curve.theta, duration))
        return problem, curve

    def free(self, duration: float) -> TwoPoint:
        """The problem with the duration free, and this one to start from; without bounds."""
        return two_point(self.instance, duration).relaxed(float("inf"))

    def given(self, duration: float) -> TwoPoint:
        """The problem with this duration; without bounds."""
        fixed = replace(self.instance, tf=self.instance.t0 + duration, tf_guess=None)
        return two_point(fixed, duration).relaxed(float("inf"))

    def cold(self, duration: float) -> Try | None:
        """Solved from a cold start."""
        problem = self.given(duration)
        start = cold_start(problem, self.limits)
        self.steps += start.steps
        self._last = duration, start.found.curve
        return self._tried(problem, start) if start.found.minimum else None

    def beside(self, near: Try, duration: float) -> Try | None:
        """Solved from the extremal of another duration; ``None`` where that is too far away."""
        problem = self.given(duration)
        curve = _in_units_of(problem, near)
        found = self._settled(problem, curve.on(meshes.laid(problem, curve), STAGES), hard=True)
        return self._tried(problem, replace(near.start, found=found, steps=self.steps)) if found else None

    def accurate(self, rough: Try) -> Try:
        """The same extremal, on the same mesh, as accurate as Newton's method makes it."""
        found = self._settled(rough.problem, rough.start.found.curve, rough.start.found.hard)
        return self._tried(rough.problem, replace(rough.start, found=found)) if found else rough

    def freed(self, near: Try) -> Minimum | None:
        """The minimum over the duration to which Newton's method leads from a given one."""
        problem, curve = replace(near.problem, instance=self.instance), near.start.found.curve
        curve = replace(curve, theta=np.append(curve.theta, near.duration))
        found = self._settled(problem, curve, near.start.found.hard)
        if found is None:
            return None
        start = replace(near.start, found=found, steps=self.steps)
        return Minimum(found.cost * problem.scale.cost, problem, start)

    def _settled(self, problem: TwoPoint, curve: Curve, hard: bool) -> Attempt | None:
        """The minimum of a problem near an extremal of another one, on the mesh of a curve."""
        system = System(problem, curve.mesh, curve.order)
        outcome = newton(system, curve, tolerance=1e-9)
        if outcome is None:
            return None
        self.steps += outcome.iterations
        if not outcome.solved:
            return None
        jacobian = system.jacobian(outcome.curve)
        try:
            final = linearise(system, outcome.curve, system.residual(outcome.curve), jacobian)
            if negative_directions(problem, outcome.curve, final.matching):
                return None
        except np.linalg.LinAlgError:
            return None
        if system.largest_turn(outcome.curve, jacobian) > meshes.COARSEST:
            return None
        return Attempt(outcome.curve, Reason.MINIMUM, outcome.iterations, system.cost(outcome.curve), hard)

    def _tried(self, problem: TwoPoint, start: Start) -> Try:
        duration, curve = problem.duration, start.found.curve
        free = replace(problem, instance=self.instance)
        residual = free.boundary(curve.nodes[:, -1], np.append(curve.theta, duration))
        idle = curve.flat.copy()
        idle[problem.states :] = 0.0
        tau = stage_times(curve.mesh, curve.order).ravel()
        floor = problem.running_cost(tau, idle, curve.theta).min() * problem.scale.cost
        slope = residual[-1] * problem.scale.cost / duration
        floor = floor if floor > NEGLIGIBLE * problem.scale.cost / duration else 0.0  # idle costates are not quite zero
        return Try(problem, start, float(start.found.cost * problem.scale.cost), float(slope), float(floor))


def _in_units_of(problem: TwoPoint, near: Try) -> Curve:
    """The extremal of another duration, over the scaled time, in the units of a problem."""
    curve, units = near.start.found.curve, near.problem.scale
    ratio = units.both / problem.scale.both
    multipliers = curve.theta * units.cost / problem.scale.cost
    return Curve(curve.mesh, curve.nodes * ratio, curve.stages * ratio[:, :, None], multipliers)
