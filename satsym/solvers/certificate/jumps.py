"""Jumps of a control law along a solution from one minimiser of H to another, and others that stay as good."""

from __future__ import annotations

import numpy as np

from satsym.arrays import distinct
from satsym.solution import Check, Solution
from satsym.solvers.certificate.reintegration.flow import unit_sizes
from satsym.solvers.certificate.reintegration.passages import passages

CROSSED = 1e-9
"""Least rate at which one minimiser of H overtakes another, in units of what the jump changes of the rates."""

LOOKED_AT, GRID = 9, 201
"""Times within a solution and values of a control at which other minimisers of H are looked for."""

EQUAL, OTHER_CONTROL = 1e-9, 1e-3
"""Share of H's range by which one may be worse that is as good, and of the control's by which it is another one."""


def checks(solution: Solution) -> list[Check]:
    """What jumps must keep for the second variation to be known, each a deficit that must not be positive."""
    every, tied = passages(solution), ties(solution)
    unknown, unit = sum(not one.located for one in every), unit_sizes(solution)
    crossing = [one.saltation(solution, unit) for one in every if one.located]
    flat = sum(not -one.speed > CROSSED * float(np.abs(one.leap).max()) for one in crossing)
    found = (
        [Check("second variation unknown: the control jumps between minimisers", float(unknown), 0.0)]
        if unknown
        else []
    )
    found += (
        [Check("the two minimisers of H at a jump are still equally good after it", float(flat), 0.0)]
        if crossing
        else []
    )
    return found + ([Check("another minimiser of H remains equally good", float(tied), 0.0)] if tied else [])


def ties(solution: Solution) -> int:
    """How often, from one of the times looked at to the next, another value of a control stays as good for H.

    Where that is so for a while, no control is the best one: any two may take turns. At single instants it may be so.
    """
    if not solution.instance.model.spec.stationary:
        return 0
    nodes = distinct(np.linspace(0, solution.times.size - 1, LOOKED_AT + 2).astype(int)[1:-1])
    tied = np.array([_tied(solution, int(node)) for node in nodes])
    return int((tied[1:] & tied[:-1]).sum())


def _tied(solution: Solution, node: int) -> bool:
    """Whether H has another minimiser at a node, one control being changed at a time."""
    from scipy.optimize import minimize_scalar

    instance, model = solution.instance, solution.instance.model
    t, x, u, lam = solution.times[node], solution.x[:, node], solution.u[:, node], solution.lam[:, node]
    wide = 1.0 + 2.0 * float(np.abs(solution.u).max())
    for k, variable in enumerate(model.spec.controls):
        low, high = max(instance.lower[k], -wide), min(instance.upper[k], wide)

        def h(value: float, k: int = k) -> float:
            return float(model.hamiltonian(t, x, (*u[:k], value, *u[k + 1 :]), lam, instance.parameters))

        grid = np.linspace(low, high, GRID)
        values = np.array([h(value) for value in grid])
        padded = np.pad(values, 1, constant_values=np.inf)
        lowest = np.flatnonzero((values <= padded[:-2]) & (values <= padded[2:]))
        for at in map(int, lowest):
            ends = grid[max(at - 1, 0)], grid[min(at + 1, GRID - 1)]
            other = minimize_scalar(h, bounds=ends, method="bounded", options={"xatol": 1e-10 * (high - low)})
            distance = abs(other.x - u[k])
            if variable.kind == "angle":
                distance = abs(np.remainder(other.x - u[k] + np.pi, 2.0 * np.pi) - np.pi)
            best = min(other.fun, values[at])
            if distance > OTHER_CONTROL * (high - low) and best - h(u[k]) <= EQUAL * np.ptp(values):
                return True
    return False
