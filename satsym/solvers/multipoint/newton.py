"""Damped Newton's method for the equations of an extremal in arcs, on successively finer meshes.

The length of steps is measured in the metric of the present derivatives, see Deuflhard, Newton Methods for Nonlinear
Problems (2011), section 3.3.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from satsym.arrays import Array
from satsym.solvers.collocation.gauss import STAGES, scheme
from satsym.solvers.failures import FAILURES
from satsym.solvers.iteration import Limits
from satsym.solvers.multipoint.equations import Problem, between, cost, points, system

SOLVED = 1e-11
"""Largest component of the last step, relative to the scales of the unknowns, at which the iteration has converged."""

ROUNDED, AMPLIFIED = 1e-9, 10.0
"""Size of a step, relative to the scales of the unknowns, below which it may consist of rounding, which sensitive
equations amplify. If such a step is not followed by a smaller one, the iteration has converged as far as it can, and
the solution may change by ``AMPLIFIED`` times as much between two meshes."""

SHORTEST, MOST_STEPS = 1e-3, 40
"""Smallest damping factor of a step, and maximum number of steps."""

SETTLED_SOLUTION = 1e-11
"""Relative change of cost, times, and initial and final values between two meshes at which refinement ends."""

FINEST = 2000
"""Maximum number of intervals of all arcs together."""


@dataclass(frozen=True, eq=False)
class Extremal:
    """Unknowns that solve the equations of a problem."""

    problem: Problem
    unknown: Array
    step: float
    """Relative magnitude of the last Newton step or of the change from the previous mesh, whichever is larger."""
    iterations: int

    @property
    def cost(self) -> float:
        """Return the cost of the extremal."""
        return cost(self.problem, self.unknown)

    @property
    def times(self) -> Array:
        """Return the times at which arcs begin and end."""
        return self.problem.times(self.unknown)


def newton(problem: Problem, v: Array, limits: Limits) -> Extremal | None:
    """Solve the equations on one mesh; ``None`` if the iteration fails."""
    from scipy.sparse.linalg import splu

    units = problem.units()
    for iteration in range(1, MOST_STEPS + 1):
        if limits.expired:
            return None
        try:
            residual, slopes = system(problem, v)
            inverse = splu(slopes, permc_spec="NATURAL")  # arcs are in order, with few columns after them
            step = inverse.solve(residual)
        except (*FAILURES, RuntimeError):  # which says that the derivatives are singular
            return None
        whole, length = float(np.abs(step / units).max()), 1.0
        if not np.isfinite(whole):
            return None
        while True:
            there = v - length * step
            again = inverse.solve(system(problem, there, sloped=False)[0])
            after = float(np.abs(again / units).max())
            if after <= (1.0 - length / 4.0) * whole or after < SOLVED:
                break
            if whole < ROUNDED:
                return Extremal(problem, v, whole, iteration)
            length /= 2.0
            if length < SHORTEST:
                return None
        v = there
        limits.spend(len(v) // len(units[: 2 * problem.n]))
        if length == 1.0 and after < SOLVED:
            return Extremal(problem, v, after, iteration)
    return None


def solved(problem: Problem, v: Array, limits: Limits) -> Extremal | None:
    """Solve the equations on meshes with successively halved intervals until the solution converges; else ``None``."""
    found = newton(problem, v, limits)
    last = 0.0 if found is None else found.step
    while found is not None and sum(found.problem.intervals) < FINEST:
        finer = newton(*_refined(found), limits)
        if finer is None:
            return None
        change, rounding, last = _change(found, finer), max(last, finer.step), finer.step
        found = replace(finer, iterations=found.iterations + finer.iterations, step=max(finer.step, change))
        if change < max(SETTLED_SOLUTION, AMPLIFIED * rounding if rounding > SOLVED else 0.0):
            return found
    return None


def _refined(found: Extremal) -> tuple[Problem, Array]:
    """Return the problem and its unknowns interpolated on intervals of half the length."""
    old, v = found.problem, found.unknown
    problem = replace(old, meshes=tuple(np.sort(np.append(one, 0.5 * (one[:-1] + one[1:]))) for one in old.meshes))
    own, parts = np.concatenate([[0.0], scheme(STAGES).nodes]), []
    for arc, mesh in enumerate(problem.meshes):
        shares = np.append(points(mesh, own).ravel(), 1.0)
        rows = between(old, v, arc, shares).T
        rows[-1] = old.values(v, arc)[0][-1]
        parts.append(rows.ravel())
    return problem, np.concatenate([*parts, v[old.layout.junctions :]])


def _change(found: Extremal, finer: Extremal) -> float:
    """Return the largest relative change between two meshes, of initial and final values, times, and cost."""
    both, duration, _ = found.problem.sizes
    pairs = [(one.problem.layout, one.unknown) for one in (found, finer)]
    d = len(both)
    edges = [np.concatenate([v[:d], v[at.arcs[-1] - d : at.arcs[-1]]]) / np.tile(both, 2) for at, v in pairs]
    times = [one.times / duration for one in (found, finer)]
    costs = [one.cost for one in (found, finer)]
    size = max(abs(costs[1]), float((both[: d // 2] * both[d // 2 :]).max()))
    return max(
        float(np.abs(edges[0] - edges[1]).max()),
        float(np.abs(times[0] - times[1]).max()),
        abs(costs[0] - costs[1]) / size,
    )
