"""Arcs on the boundaries of path constraints, read from a motion by way of a regularised path, and made exact."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers.constrained import solving
from satsym.solvers.iteration import Limits, Meter, unsolved
from satsym.solvers.search.motion import Motion
from satsym.status import Status


def exact(instance: Instance, at: Motion, limits: Limits) -> Solution | None:
    """The extremal of exact arcs that a motion is near; ``None`` where there is none."""
    with np.errstate(all="ignore"):
        found = solving.near(_as_found(instance, at), replace(limits, meter=Meter()))
    return None if found is None else replace(found, message=f"{found.message}, by the search")


def _as_found(instance: Instance, at: Motion) -> Solution:
    """A motion as other solvers hand theirs over."""
    u = np.concatenate([at.u[:, :1], at.u], axis=1)
    nothing = unsolved(instance, "search", 0.0)
    return replace(nothing, status=Status.CONVERGED, objective=at.cost, times=at.times, x=at.x, u=u, lam=at.lam)
