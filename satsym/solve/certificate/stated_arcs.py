"""The arcs of each control as a solution states them, and whether any sign could tell them."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from satsym.solution import Solution
from satsym.solve.switching.structure import LOWER, REST, SINGULAR, UPPER

UNDECIDED = 1e-9
"""Relative distance of a switching function from where it switches, at which no sign can be told."""

MOSTLY = 0.9
"""Share of the nodes of an arc at which a control is at its level: a switching time may be stated wrongly."""

OFF = 1e-9
"""Distance of a control from its levels, relative to the width of its range, at which it is singular."""


Stated = list[list[tuple[float, float, int]]]


def arcs(solution: Solution, control: int) -> list[tuple[float, float, int]]:
    """Start, end and level of each arc of a control, read from a solution: what matters is which are singular."""
    instance = solution.instance
    low, high = instance.lower[control], instance.upper[control]
    times = [instance.t0, *solution.switching_times[control], float(solution.times[-1])]
    weighs = instance.model.magnitude_weight(instance.t0, instance.initial, instance.parameters)[control] > 0.0
    near = {LOWER: low, UPPER: high} | ({REST: min(max(0.0, low), high)} if weighs else {})
    found = []
    for start, end in pairwise(times):
        inside = (solution.times > start) & (solution.times < end)
        values = solution.u[control, inside]
        on = {k: float((np.abs(values - v) <= OFF * (high - low)).mean()) for k, v in near.items() if len(values)}
        likeliest = max(on, key=lambda k: on[k], default=REST if weighs else LOWER)
        found.append((start, end, likeliest if weighs or on.get(likeliest, 1.0) >= MOSTLY else SINGULAR))
    return found


def undecided(solution: Solution, control: int) -> bool:
    """Whether a switching function is for some time at the very value at which the control switches."""
    model, p = solution.instance.model, solution.instance.parameters
    sigma = np.asarray(model.switching_function_batch(solution.times, solution.x, solution.lam, p))[control]
    weight = np.broadcast_to(model.magnitude_weight_batch(solution.times, solution.x, p)[control], sigma.shape)
    margin = np.abs(np.abs(sigma) - weight)
    return bool((margin <= UNDECIDED * (np.abs(sigma) + weight).max()).mean() > 1.0 - MOSTLY)
