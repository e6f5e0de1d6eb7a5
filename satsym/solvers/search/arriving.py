"""Motions that come as close as possible to the given final state, at any cost, by minimisation of the miss.

The miss is the deviation of the motion from the final conditions. The starts are motions that obey the equations of
motion.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.iteration import Limits
from satsym.solvers.search import nlp
from satsym.solvers.search.controls import Controls
from satsym.solvers.search.nlp import Found
from satsym.solvers.search.programme import Programme
from satsym.solvers.search.sizes import sizes_of
from satsym.solvers.search.starts import planning
from satsym.solvers.search.starts.planning import Plan
from satsym.solvers.search.transcription import FREE, Function

ARRIVED = 1e-4
"""Relative miss up to which a motion counts as arriving at the final state; mesh and minimisation may cause it."""

ITERATIONS = 120
"""Maximum number of iterations of the interior-point code. If these do not suffice, more rarely help."""


class Missing(Programme):
    """Nonlinear programme that minimises half the squared deviation from the final conditions, in scaled units."""

    def __post_init__(self) -> None:
        names = self.instance.model.spec.state_names
        numbers = [isinstance(self.instance.final.get(name), float | int) for name in names]
        self.given = np.flatnonzero(numbers)
        self.on_reference = [i for i, name in enumerate(names) if self.instance.final.get(name) == "reference"]
        self.factor = 0.0
        super().__post_init__()

    @cached_property
    def bounds(self) -> tuple[Array, Array]:
        """Return lower and upper bounds of the unknowns, without those that the final conditions would set.

        Controls without bounds are limited to what the mesh can represent: values that could correct the whole miss
        within one interval. Beyond this limit, states jump between points and no longer obey the equations of motion.
        """
        low, high = (row.copy() for row in super().bounds)
        variables = slice(self.first_variable, self.first_duration)
        low[variables] = np.where(np.isinf(low[variables]), -self.intervals, low[variables])
        high[variables] = np.where(np.isinf(high[variables]), self.intervals, high[variables])
        at = self.points.states * self.count + self.given
        low[at], high[at] = -FREE, FREE
        for i in self.given:
            if self.instance.model.spec.states[i].positive:
                low[self.points.states * self.count + i] = 1e-4
        return low, high

    @cached_property
    def limits(self) -> tuple[Array, Array]:
        """Return lower and upper limits of the constraint rows, without limits for the final conditions."""
        low, high = (row.copy() for row in super().limits)
        if "ends" in self.kinds:
            low[self.kinds["ends"].places], high[self.kinds["ends"].places] = -FREE, FREE
        return low, high

    def missed_by(self, w: Array) -> Array:
        """Return the deviations of given unknowns from the final conditions, in scaled units."""
        return self.missed(self._at(w, [self.count]))[:, 0]

    def missed(self, y: Array) -> Array:
        """Return the deviations from the final conditions at local variables (l, M), in scaled units.

        Ranges are left out, because :attr:`bounds` keep the final states within them.
        """
        states = [*self.given, *self.on_reference]
        found = self.points.misses(y)[: len(self.given) + len(self.points.ends(y))]
        found[: len(states)] /= self.sizes.states[states, None]
        return found

    def _half(self, y: Array) -> Array:
        return np.asarray((self.missed(y) ** 2).sum(axis=0)[None] / 2.0)

    def objective(self, w: Array) -> float:
        """Return half the squared deviation from the final conditions."""
        return float(self._half(self._at(w, [self.count]))[0, 0])

    def gradient(self, w: Array) -> Array:
        """Return the derivatives of :meth:`objective` with respect to all unknowns."""
        into, places = self._end_into(self.count)
        found = np.zeros(self.unknowns)
        np.add.at(found, places, self.points.slopes(self._half, self._at(w, [self.count]))[0, :, 0] @ into)
        return found

    def hessian(self, w: Array, multipliers: Array, factor: float) -> Array:
        """Return the entries of the Hessian of the Lagrangian."""
        self.factor = factor
        return super().hessian(w, multipliers, 0.0)

    def _weighed_at_end(self, factor: float) -> list[tuple[Function, int, Array]]:
        return [(self._half, self.count, np.array([self.factor]))]


def arriving(
    instance: Instance, controls: Controls, meshes: Sequence[Array], plan: Plan, duration: float, limits: Limits
) -> Found:
    """Minimise the deviation from the final conditions from a given plan of a start.

    The start is a motion that obeys its equations, found without final conditions, unless the plan is the straight line
    to the final state. Scales of states are the larger ones of the problems with and without final conditions.

    Parameters
    ----------
    duration
        The duration, or its initial guess if it is free.
    """
    free = replace(instance, final={})
    sizes, moved = (sizes_of(one, controls, duration) for one in (instance, free))
    sizes = replace(sizes, states=np.maximum(sizes.states, moved.states))
    programme = Missing(instance, controls, meshes, sizes)
    begun = programme if not plan.arriving else Missing(free, controls, meshes, sizes)
    return nlp.solve(programme, planning.begun(begun, plan), limits, ITERATIONS)


def missed(found: Found) -> Array:
    """Return the deviations of a motion from the final conditions, in scaled units."""
    assert isinstance(found.programme, Missing)
    return found.programme.missed_by(found.unknown)


def distance(found: Found) -> float:
    """Return the largest deviation of a motion from the final conditions, in scaled units."""
    return float(np.abs(missed(found)).max(initial=0.0))


def arrived(found: Found) -> bool:
    """Return whether a motion meets the final conditions within the accuracy of the mesh."""
    return found.solved and distance(found) <= ARRIVED
