"""Whether any motion to the given end keeps to the path constraints: the least by which one of them is violated.

Where motion and constraints are convex that is a convex programme, whose solution leaves no other.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.constrained.arcs import sizes as measured
from satsym.solvers.constrained.convexity import convex
from satsym.solvers.iteration import Limits
from satsym.solvers.search import nlp, starts
from satsym.solvers.search.controls import controls_of
from satsym.solvers.search.programme import Programme
from satsym.solvers.search.sizes import sizes_of
from satsym.solvers.search.transcription import FREE, Places

INTERVALS = (40, 80)
"""Intervals of the meshes on which the least violation is looked for."""

REMAINING, UNAVOIDABLE = 0.5, 1e-6
"""Share of the violation on the coarse mesh that is left on the fine one, and share of the constraint's size, above
which it is unavoidable."""

PUSHING = 1e-2
"""Share of the largest multiplier from which on a constraint stands against the others."""


class Eased(Programme):
    """A programme that minimises its last unknown: by which share of their sizes path constraints may be positive."""

    def __post_init__(self) -> None:
        super().__post_init__()
        self.unknowns += 1
        path = self.kinds["path"]
        self.held = np.arange(path.first, path.first + len(path.upper))

    def begun(self) -> Array:
        """Unknowns of the straight line, eased as much as that needs."""
        w = starts.begun(self, starts.Plan())
        y, _, _ = self._local(np.append(w, 0.0))
        n, given = self.points.states, self.controls.given
        found = measured(self.instance, y[self._time], y[:n], y[n : n + given])
        self.room = np.repeat(found[None, self.points.kept], self.count, 0).ravel()
        over = super().values(np.append(w, 0.0))[self.held] / self.room
        return np.append(w, max(float(over.max()), 0.0) + 1.0)

    @cached_property
    def bounds(self) -> tuple[Array, Array]:
        """Lower and upper bounds of the unknowns."""
        low, high = super().bounds
        return np.append(low, 0.0), np.append(high, FREE)

    def objective(self, w: Array) -> float:
        """The last unknown."""
        return float(w[-1])

    def gradient(self, w: Array) -> Array:
        """The derivatives of :meth:`objective` by all unknowns."""
        return np.append(np.zeros(self.unknowns - 1), 1.0)

    def values(self, w: Array) -> Array:
        """The rows."""
        found = super().values(w)
        found[self.held] -= w[-1] * self.room
        return found

    def jacobian(self, w: Array) -> Array:
        """Entries of the rows' derivatives, at the places of :attr:`jacobian_places`."""
        return np.concatenate([super().jacobian(w), -self.room])

    @cached_property
    def jacobian_places(self) -> tuple[Places, Places]:
        """Rows and columns of :meth:`jacobian`."""
        rows, columns = super().jacobian_places
        return np.concatenate([rows, self.held]), np.append(columns, np.full(len(self.held), self.unknowns - 1))

    def hessian(self, w: Array, multipliers: Array, factor: float) -> Array:
        """Second derivatives of the Lagrangian: the objective is linear."""
        return super().hessian(w, multipliers, 0.0)


def contradiction(instance: Instance, limits: Limits) -> str:
    """What stands against each other where no motion of a convex problem is admissible; empty where that is not shown.

    Parameters
    ----------
    instance
        With path constraints.
    limits
        When to give up.
    """
    controls = controls_of(instance)
    if controls is None or instance.tf is None or not convex(instance):
        return ""
    left, names = list[float](), list[str]()
    for intervals in INTERVALS:
        mesh, lasting = np.linspace(0.0, 1.0, intervals + 1), instance.tf - instance.t0
        with np.errstate(all="ignore"):
            programme = Eased(instance, controls, [mesh], sizes_of(instance, controls, lasting))
            found = nlp.solve(programme, programme.begun(), limits)
        if not found.solved:
            return ""
        left.append(float(found.unknown[-1]))
        pushes = found.multipliers[programme.held].reshape(programme.count, -1).sum(axis=0)
        spec = instance.model.spec.path_constraints
        kept = [spec[place].name for place in programme.points.kept]
        names = [name for name, push in zip(kept, pushes, strict=True) if push > PUSHING * pushes.max()]
    if not left[1] > max(UNAVOIDABLE, REMAINING * left[0]):
        return ""
    against = ", ".join(names)
    return f"no motion to the given end satisfies the path constraints ({against}): one of them is always violated"
