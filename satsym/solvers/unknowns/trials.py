"""Solutions of a problem for given values of its free initial states, initial time and parameters."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.instance.unknowns import Place, Unknown
from satsym.solution import Progress, Solution
from satsym.solvers.certificate.start import slope
from satsym.solvers.improving import starting_from
from satsym.solvers.iteration import hurried
from satsym.status import BadInput, Status
from satsym.wording import counted

Solver = Callable[[Instance, Progress | None], Solution]
"""Function that solves an instance without free initial values and parameters."""


@dataclass(frozen=True, eq=False)
class Trial:
    """Solution for one choice of the free initial values and parameters."""

    at: Array
    """Change of the free quantities from their initial guess, relative to their scales."""
    solution: Solution
    slope: Array
    """Derivatives of the minimum cost with respect to the scaled free quantities."""
    residual: float
    """Largest relative derivative of the minimum cost."""

    @property
    def cost(self) -> float:
        """Return the minimum cost."""
        return self.solution.objective

    @property
    def size(self) -> float:
        """Return the scale of the cost, from its magnitude and its derivatives."""
        return max(abs(self.cost), float(np.abs(self.slope).max(initial=0.0)), 1e-300)


class Late(Exception):
    """Raised if the time limit is reached during a trial."""


@dataclass(eq=False)
class Trials:
    """Solver for successive choices of the free initial values and parameters, which keeps the results."""

    instance: Instance
    solver: Solver
    progress: Progress | None
    deadline: float
    unit: Array
    last: Solution | None = None
    costs: list[float] = field(default_factory=list)
    tried: int = 0
    iterations: int = 0

    @property
    def unknowns(self) -> tuple[Unknown, ...]:
        """Return the free initial values and parameters."""
        return self.instance.free

    def chosen(self, at: Array) -> Instance | None:
        """Return the instance with the free quantities set to chosen values; ``None`` if these are not admissible."""
        found = self.instance
        for unknown, unit, step in zip(self.unknowns, self.unit, at, strict=True):
            value = unknown.of(self.instance) + float(unit * step)
            if not (math.isfinite(value) and unknown.admits(self.instance, value)):
                return None
            found = unknown.at(found, value)
        begun = hurried(found, self.deadline)
        if begun is None:
            raise Late
        if begun.model.spec.in_arcs and self.last is not None and self.last.status.answered:
            begun = replace(begun, guess=starting_from(self.last).guess)  # it stays on the same side of obstacles
        return replace(begun, free=())

    def __call__(self, at: Array) -> Trial | None:
        """Return the trial for chosen values of the free quantities; ``None`` if the problem has no solution there."""
        chosen = self.chosen(at)
        if chosen is None:
            return None
        self.tried += 1
        try:
            found = self.solver(chosen, self.progress)
        except BadInput:  # the chosen initial state violates a path constraint
            return None
        self.iterations += found.iterations
        if found.status is Status.TIME_LIMIT:
            raise Late
        self.last = found if self.last is None or found.status.answered else self.last
        if not found.status.answered:
            return None
        slopes = [slope(found, unknown) for unknown in self.unknowns]
        values = self.unit * np.array([one.value for one in slopes])
        if not (np.isfinite(values).all() and math.isfinite(found.objective)):
            return None
        self.costs.append(float(found.objective))
        return Trial(at, found, values, max(one.relative for one in slopes))

    def values(self, at: Array) -> str:
        """Return chosen values of the free quantities as text."""
        chosen = zip(self.unknowns, self.unit, at, strict=True)
        return ", ".join(f"{u.name} = {u.of(self.instance) + float(unit * step):.10g}" for u, unit, step in chosen)

    @property
    def count(self) -> str:
        """Return the number of solved problems as text."""
        return counted(self.tried, "solution")


def unit_of(unknown: Unknown, instance: Instance) -> float:
    """Return the scale of an unknown: its magnitude, that of its given final value, or the duration."""
    if unknown.place is Place.TIME:
        end = instance.tf if instance.tf is not None else instance.tf_guess
        return 1.0 if end is None else end - instance.t0
    goal = instance.final.get(unknown.name) if unknown.place is Place.INITIAL else None
    sizes = [abs(unknown.of(instance)), abs(goal) if isinstance(goal, float) else 0.0]
    return max(sizes) or 1.0
