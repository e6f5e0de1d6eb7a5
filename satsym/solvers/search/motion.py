"""A solved programme as a motion in the model's units, with costates and multipliers from those of its rows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.instance.unknowns import Place
from satsym.solvers.search.nlp import Found
from satsym.solvers.search.transcription import DEGREE, RADAU, basis

START = np.array([[one(0.0)] for one in basis(RADAU)])
"""Weights of the points of an interval in the value at its start."""


@dataclass(frozen=True, eq=False)
class Motion:
    """What a programme found.

    Attributes
    ----------
    instance
        With the values that were found for what it leaves free besides states at the end and the final time.
    times, x, lam
        Of all points, the start first: (N + 1,), (n, N + 1), (n, N + 1).
    u
        Controls at the points but the first, (m, N).
    eta, steps
        Multipliers of path constraints there, (c, N), and the lengths of time that belong to the points.
    """

    instance: Instance
    times: Array
    x: Array
    u: Array
    lam: Array
    eta: Array
    steps: Array
    cost: float


def motion(found: Found) -> Motion:
    """The motion that a programme found."""
    programme = found.programme
    x, v, durations, free, start = programme.unpacked(found.unknown)
    n, points, scale = len(x), programme.count, programme.sizes.cost
    rows = found.multipliers[programme.kinds["defects"].places].reshape(points, n).T
    lam = -rows / programme.sizes.states[:, None] / programme.weights * scale
    first = lam[:, :DEGREE] @ START
    steps = (programme.steps @ durations) * programme.weights
    held = len(programme.points.kept)
    eta = np.empty((0, points))
    if held:
        eta = found.multipliers[programme.kinds["path"].places].reshape(points, held).T * scale / steps
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
    return Motion(instance, times, x, u, np.concatenate([first, lam], axis=1), eta, steps, found.objective)
