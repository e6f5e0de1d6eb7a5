"""Conversion of a solved programme into a motion in the model's units, with costates and multipliers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.control_set import bound_names
from satsym.instance import Instance
from satsym.instance.unknowns import Place
from satsym.solvers.constrained.arcs import sizes, values
from satsym.solvers.search.nlp import Found
from satsym.solvers.search.transcription import DEGREE, RADAU, basis

CROSSED = 1e-3
"""Violation of a path constraint between the points of a motion, relative to its magnitude, that is tolerated."""

START = np.array([[one(0.0)] for one in basis(RADAU)])
"""Weights of the points of an interval in the extrapolated value at its start."""


@dataclass(frozen=True, eq=False)
class Motion:
    """The motion that solves a nonlinear programme.

    Attributes
    ----------
    instance
        Instance with the values found for its free parameters, initial states and initial time.
    times, x, lam
        Times, states and costates at all points, the initial one first: (N + 1,), (n, N + 1), (n, N + 1).
    u
        Controls at all points but the first, (m, N).
    pushes, steps
        Multipliers of path constraints, including bounds of controls, each times the time weight of its point, (h, N);
        and these time weights, (N,).
    nu
        Multipliers of the terminal constraints.
    passed, jumps
        Times of the waypoints, and multipliers of all of their conditions.
    """

    instance: Instance
    times: Array
    x: Array
    u: Array
    lam: Array
    pushes: Array
    steps: Array
    cost: float
    nu: Array
    passed: Array
    jumps: Array


def motion(found: Found) -> Motion:
    """Return the motion that solves a programme."""
    programme = found.programme
    x, v, durations, free, start = programme.unpacked(found.unknown)
    n, points, scale = len(x), programme.count, programme.sizes.cost
    rows = found.multipliers[programme.kinds["defects"].places].reshape(points, n).T
    lam = -rows / programme.sizes.states[:, None] / programme.weights * scale
    first = lam[:, :DEGREE] @ START
    steps = (programme.steps @ durations) * programme.weights
    instance, parameters = programme.instance, iter(free.tolist())
    for one in instance.free:
        if one.place is Place.PARAMETER:
            instance = one.at(instance, next(parameters))
        elif one.place is Place.INITIAL:
            instance = one.at(instance, float(x[one.index, 0]))
        else:
            instance = one.at(instance, start)
    times = programme.times(durations, start)
    u = programme.controls.controls(v)
    nu: Array = np.zeros(len(instance.model.spec.multipliers))
    if len(nu):
        rows = found.multipliers[programme.kinds["ends"].places]
        nu = rows[len(rows) - programme.points.inequalities - len(nu) :][: len(nu)] * scale
    passed = times[DEGREE * np.cumsum([len(mesh) - 1 for mesh in programme.meshes])[:-1]]
    jumps = found.multipliers[programme.kinds["way"].places] * scale if len(passed) else np.empty(0)
    whole = np.concatenate([first, lam], axis=1)
    return Motion(instance, times, x, u, whole, _pushes(found), steps, found.objective, nu, passed, jumps)


def violates(at: Motion) -> bool:
    """Return whether a motion violates a path constraint halfway between its points."""
    if not at.instance.model.spec.path_constraints:
        return False
    points = at.times[1:], at.x[:, 1:], at.u
    middles = (0.5 * (row[..., :-1] + row[..., 1:]) for row in points)
    return bool((values(at.instance, *middles) > CROSSED * sizes(at.instance, *points)[:, None]).any())


def _pushes(found: Found) -> Array:
    """Return the multipliers (h, N) of all path constraints at the points, including those of bounds of controls."""
    programme, spec = found.programme, found.programme.instance.model.spec
    points, kept, scale = programme.count, programme.points.kept, programme.sizes.cost
    pushes = np.zeros((len(spec.path_constraints), points))
    if kept:
        pushes[kept] = found.multipliers[programme.kinds["path"].places].reshape(points, len(kept)).T * scale
    numbers = {one.name: number for number, one in enumerate(spec.path_constraints)}
    variables = slice(programme.first_variable, programme.first_duration)
    for pressures, side in zip(found.pressures[:, variables], range(2), strict=True):
        table = pressures.reshape(points, programme.controls.count).T * scale
        for control, names in enumerate(bound_names(spec)):
            if names and names[side] in numbers:
                pushes[numbers[names[side]]] = table[control] / programme.sizes.variables[control]
    return pushes
