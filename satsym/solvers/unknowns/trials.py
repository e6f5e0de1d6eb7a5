"""The problem with a choice of what is free given, solved for one choice after the other."""

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
from satsym.solvers.iteration import hurried
from satsym.status import Status
from satsym.wording import counted

Solver = Callable[[Instance, Progress | None], Solution]
"""A solver of an instance with everything given."""


@dataclass(frozen=True, eq=False)
class Trial:
    """The solution with what is free given."""

    at: Array
    """In units, from the first guess."""
    solution: Solution
    slope: Array
    """Slope of the minimum cost, by each unit."""
    residual: float
    """The largest of them, relative."""

    @property
    def cost(self) -> float:
        """The minimum cost."""
        return self.solution.objective

    @property
    def size(self) -> float:
        """The size of the cost, and of what it changes by."""
        return max(abs(self.cost), float(np.abs(self.slope).max(initial=0.0)), 1e-300)


class Late(Exception):
    """Time was up in the midst of a trial."""


@dataclass(eq=False)
class Trials:
    """Solves for one choice after the other, and remembers what came of it."""

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
        """What is free."""
        return self.instance.free

    def chosen(self, at: Array) -> Instance | None:
        """The instance with everything given; ``None`` outside the domain."""
        found = self.instance
        for unknown, unit, step in zip(self.unknowns, self.unit, at, strict=True):
            value = unknown.of(self.instance) + float(unit * step)
            if not (math.isfinite(value) and unknown.admits(self.instance, value)):
                return None
            found = unknown.at(found, value)
        begun = hurried(found, self.deadline)
        if begun is None:
            raise Late
        return replace(begun, free=())

    def __call__(self, at: Array) -> Trial | None:
        """The trial at a choice; ``None`` where that has no answer."""
        chosen = self.chosen(at)
        if chosen is None:
            return None
        found = self.solver(chosen, self.progress)
        self.tried += 1
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
        """A choice, in words."""
        chosen = zip(self.unknowns, self.unit, at, strict=True)
        return ", ".join(f"{u.name} = {u.of(self.instance) + float(unit * step):.10g}" for u, unit, step in chosen)

    @property
    def count(self) -> str:
        """How many there were, in words."""
        return counted(self.tried, "solution")


def unit_of(unknown: Unknown, instance: Instance) -> float:
    """By what an unknown may reasonably change: its size, that of its end, or the duration."""
    if unknown.place is Place.TIME:
        end = instance.tf if instance.tf is not None else instance.tf_guess
        return 1.0 if end is None else end - instance.t0
    goal = instance.final.get(unknown.name) if unknown.place is Place.INITIAL else None
    sizes = [abs(unknown.of(instance)), abs(goal) if isinstance(goal, float) else 0.0]
    return max(sizes) or 1.0
