"""The arcs of each control as a solution states them, and whether signs of switching functions could show them."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from satsym.arrays import Array
from satsym.solution import Solution
from satsym.solvers.switching.boundaries import acting
from satsym.solvers.switching.field import Field
from satsym.solvers.switching.structure import LOWER, REST, SINGULAR, UPPER, on_boundary
from satsym.solvers.switching.throttled import resting as rests
from satsym.solvers.switching.throttled import shown_by, signs, switched
from satsym.solvers.switching.trajectory import deciding

UNDECIDED = 1e-9
"""Relative distance of a switching function from its switching value below which its sign cannot be determined."""

MOSTLY = 0.9
"""Fraction of the nodes of an arc at which a control has to be at a level for the arc to have this level; it is less
than 1 since a stated switching time may be wrong."""

OFF = 1e-9
"""Distance of a control from its levels, relative to its range, above which it is singular."""


Stated = list[list[tuple[float, float, int]]]


def arcs(solution: Solution, control: int) -> list[tuple[float, float, int]]:
    """Return start, end and level of each arc of a control, as stated by a solution, mainly to find singular arcs."""
    instance = solution.instance
    low, high = (bounds[control] for bounds in instance.control_set.switching)
    switches = solution.switching_times[shown_by(instance)[control]]
    times = [instance.t0, *switches, float(solution.times[-1])]
    weighs = rests(instance)[control]
    resting = weighs or indifferent(solution, control)
    near = {LOWER: low, UPPER: high} | ({REST: min(max(0.0, low), high)} if resting else {})
    found = []
    for start, end in pairwise(times):
        inside = (solution.times > start) & (solution.times < end)
        values = switched(instance, solution.u[:, inside])[control]
        on = {k: float((np.abs(values - v) <= OFF * (high - low)).mean()) for k, v in near.items() if len(values)}
        likeliest = max(on, key=lambda k: on[k], default=REST if resting else LOWER)
        level = likeliest if resting or on.get(likeliest, 1.0) >= MOSTLY else SINGULAR
        found.append((start, end, _on_boundary(solution, control, (start + end) / 2.0) or level))
    return found


def _on_boundary(solution: Solution, control: int, time: float) -> int | None:
    """Return the level of a control that keeps a path constraint active at a time, from events; otherwise ``None``."""
    names, found = [one.name for one in solution.instance.model.spec.path_constraints], None
    for event in solution.events:
        constraint = names.index(event.name)
        if event.t < time and acting(solution.instance, constraint) == control:
            found = on_boundary(constraint) if event.kind == "entry" else None
    return found


def jump(solution: Solution, time: float) -> Array:
    """Return the jump of states and costates that a solution states at a time, shape (2n,)."""
    z, places = np.concatenate([solution.x, solution.lam]), np.flatnonzero(solution.times == time)
    return np.asarray(z[:, places[-1]] - z[:, places[0]] if len(places) > 1 else np.zeros(len(z)))


def decided_by_none(solution: Solution, control: int) -> bool:
    """Return whether a switching function vanishes too often to show where a control without singular arcs switches."""
    low, high = solution.instance.control_set.switching
    if low[control] == high[control]:
        return False
    return undecided(solution, control) > 1.0 - MOSTLY and all(k < SINGULAR for *_, k in arcs(solution, control))


def indifferent(solution: Solution, control: int) -> bool:
    """Return whether H leaves a control undetermined along the whole motion, without a singular arc to follow."""
    if solution.instance.model.spec.throttled or undecided(solution, control) < MOSTLY:
        return False
    instance, k = solution.instance, len(solution.times) // 2
    levels = tuple(SINGULAR if i == control else LOWER for i in range(len(instance.lower)))
    z = np.concatenate([solution.x[:, k], solution.lam[:, k]])
    slope = abs(Field(instance, levels).legendre(float(solution.times[k]), z.tolist()))
    size = float((np.abs(solution.x).max(axis=1) * np.abs(solution.lam).max(axis=1)).sum())
    room = instance.upper[control] - instance.lower[control]
    return not slope * room**2 > UNDECIDED * size / float(solution.times[-1] - solution.times[0])


def undecided(solution: Solution, control: int) -> float:
    """Return the fraction of nodes at which a switching function equals the value at which the control switches."""
    instance = solution.instance
    sigma, weight = signs(instance, solution.times, solution.x, solution.lam)
    margin, sizes = np.abs(np.abs(sigma) - weight), (np.abs(sigma) + weight).max(axis=1)
    return float((margin[control] <= UNDECIDED * deciding(instance, sizes)[control]).mean())
