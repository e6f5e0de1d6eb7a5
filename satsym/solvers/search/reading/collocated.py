"""The extremal that collocation finds near a motion, if its control may jump or reach bounds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.arrays import Array
from satsym.instance import Guess, Instance
from satsym.solution import Solution
from satsym.solvers.cold_start.by_newton import SAMPLES
from satsym.solvers.search.motion import Motion

WORK = 20_000
"""Maximum number of points at which equations may be linearised from a motion."""


def exact(instance: Instance, at: Motion) -> Solution | None:
    """Return the extremal that collocation finds from a motion with limited work; ``None`` if it finds none."""
    from satsym.solvers import two_point

    found = two_point.solve(replace(guessing(instance, at.times, at.x, at.lam), work=WORK))
    if not found.status.answered:
        return None
    return replace(found, instance=instance, message=f"{found.message}, found by the direct search")


def guessing(instance: Instance, times: Array, x: Array, lam: Array) -> Instance:
    """Return an instance whose initial guess is given by the states, costates and duration of a motion."""
    names, even = instance.model.spec.state_names, np.linspace(times[0], times[-1], SAMPLES)
    states, costates = (
        {name: tuple(np.interp(even, times, row).tolist()) for name, row in zip(names, rows, strict=True)}
        for rows in (x, lam)
    )
    end = float(times[-1]) if instance.tf is None else None
    return replace(instance, guess=Guess(states, costates), tf_guess=end)
