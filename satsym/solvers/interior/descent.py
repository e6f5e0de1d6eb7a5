"""The least cost over the times of points, by its derivatives: H(t-) - H(t+) + pi' N_t, and at a free end H + S_t."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from satsym.arrays import Array
from satsym.solvers.constrained.arcs import Arcs
from satsym.solvers.constrained.equations import System
from satsym.solvers.constrained.newton import converged, cost
from satsym.solvers.iteration import Limits

STEPS = 40
"""Of the descent at most."""

APART = 1e-4
"""Least share of the duration between points that counts as a time of its own."""

ABOVE = 1e-6
"""Relative cost by which where Newton's method ends may exceed where it began."""


def optimum(at: Arcs, limits: Limits) -> Arcs | None:
    """The motion of least cost over times near its own, on the same mesh; ``None`` without one."""
    for start in (at, None):
        begun = start or _descended(at, limits)
        found = None if begun is None else converged(replace(begun, fixed_times=None), limits)
        if found is not None and begun is not None and _lower(found, begun):
            return found
    return None


def _lower(found: Arcs, begun: Arcs) -> bool:
    """Whether times are in order, and the cost is no higher than it was: the times may make it a largest one."""
    lasting = found.end - found.instance.t0
    if not np.diff(found.times).min() > APART * lasting or not lasting > 0.0:
        return False
    before = cost(begun)
    return bool(cost(found) <= before + ABOVE * abs(before))


def slopes(arcs: Arcs) -> Array:
    """Derivatives of the cost by the times of points and, where it is free, the final time."""
    found = System(replace(arcs, fixed_times=None), sloped=False).residuals
    count, free = len(arcs.junctions), arcs.instance.tf is None
    rows = found[len(found) - 1 - count :]
    return np.array([row[-1] for row in (rows if free else rows[:-1])])


@dataclass(eq=False)
class _Path:
    """What is known on the way of a descent: the motion to which the last times led."""

    arcs: Arcs
    limits: Limits

    def value(self, logarithms: Array) -> tuple[float, Array]:
        """The cost and its derivatives by logarithms of durations."""
        instance, free = self.arcs.instance, self.arcs.instance.tf is None
        durations = np.exp(logarithms)
        if not free:
            durations *= (self.arcs.end - instance.t0) / durations.sum()
        times = instance.t0 + np.cumsum(durations)
        found = converged(_moved(self.arcs, times if free else times[:-1]), self.limits)
        if found is None:
            return np.inf, np.zeros_like(logarithms)
        self.arcs = found
        by_times = slopes(found)
        by_durations = np.append(np.cumsum(by_times[::-1])[::-1], [] if free else [0.0])
        if not free:
            by_durations = by_durations - by_durations @ durations / durations.sum()
        return cost(found), by_durations * durations


def _moved(arcs: Arcs, times: Array) -> Arcs:
    """The same values at other times."""
    unknown, first = arcs.unknown.copy(), arcs.places[-1]
    unknown[first : first + len(times)] = times
    return replace(arcs, unknown=unknown, fixed_times=tuple(times.tolist()), passed=())


def _descended(at: Arcs, limits: Limits) -> Arcs | None:
    """Where quasi-Newton steps lead; ``None`` where nothing is found on the way."""
    from scipy.optimize import minimize

    path = _Path(at, limits)
    begun = np.log(np.diff(at.times))
    minimize(path.value, begun, jac=True, method="L-BFGS-B", options={"maxiter": STEPS, "maxls": 8})
    return path.arcs
