"""In which directions the controls of a sweep are free, seen from where they are and where the law wants them.

Within a box a control is free or held. On a ball a control that is held can still turn: it moves on a sphere, so
gradients count only as far as they are tangential, and the curvature of the sphere adds to the Hessian.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.solvers.sweep.sweeps import Sweep, SweepProblem, unbounded_law

ON_SPHERE = 1e-9
"""Relative distance from the sphere within which a control is on it."""


@dataclass(frozen=True, eq=False)
class Tangent:
    """The free directions."""

    moves: NDArray[np.bool_]
    """Where a control moves along them; elsewhere a bound holds it. Shape (m, M)."""
    normal: Array | None = None
    """Unit normals of the sphere, zero where a control is not on it, shape (m, M); ``None`` without a ball."""
    curvature: Array | float = 1.0
    """The Hessian of H on the sphere, relative to H_uu; 1 elsewhere. Shape (M,), or a number."""

    def along(self, field: Array) -> Array:
        """A field without its normal components, shape (m, M)."""
        return field if self.normal is None else field - self.normal * (self.normal * field).sum(axis=0)

    def free(self, field: Array) -> Array:
        """The same, and zero where controls are held."""
        return np.where(self.moves, self.along(field), 0.0)


def tangent(problem: SweepProblem, sweep: Sweep) -> Tangent:
    """The free directions at the control of a sweep."""
    instance = problem.instance
    wanted = unbounded_law(problem, sweep)
    free = instance.control_set.active(wanted) == 0
    if instance.model.spec.control_set != "ball" or free.all():
        return Tangent(free)
    norm, excess = np.linalg.norm(sweep.u, axis=0), np.linalg.norm(wanted, axis=0) / instance.max_norm
    outside = (excess > 1.0) & (norm >= (1.0 - ON_SPHERE) * instance.max_norm)
    held = outside & ((sweep.u * wanted).sum(axis=0) > 0.0)  # from the far side the way is through the ball
    return Tangent(
        moves=free | held,
        normal=np.where(held, sweep.u / np.where(held, norm, 1.0), 0.0),
        curvature=np.where(held, excess, 1.0),
    )
