"""Limits of the final state: how far a motion exceeds them, which are active, and the extremal with these limits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.instance.end_time import inequalities_at
from satsym.instance.ends import Side
from satsym.kernels.active import stated
from satsym.solution import Solution
from satsym.solvers.search.motion import Motion
from satsym.status import BadInput

BEYOND_LIMIT = 1e-9
"""Largest distance beyond a limit, relative to the limited quantity, that counts as satisfying it."""

NEAR_LIMIT = 1e-6
"""Distance before a limit, relative to the limited quantity, within which it counts as active in a solution of the
interior-point code."""


def beyond(instance: Instance, times: Array, x: Array) -> dict[tuple[str, Side], float]:
    """Return by how much the end exceeds its limits, relative to the limited quantities; negative inside the limits.

    A limit that is active in the instance is left out, since the boundary residual contains it.

    Parameters
    ----------
    times, x
        Times and states of the motion, shapes (N,) and (n, N).
    """
    names, found = instance.model.spec.state_names, {}
    largest = np.abs(x).max(axis=1)
    for name, limits in instance.ranges.items():
        i = names.index(name)
        size = max([float(largest[i]), *(abs(v) for v in limits if np.isfinite(v)), 1e-300])
        for side in instance.end_limits[name]:
            found[name, side] = side.outward * (float(x[i, -1]) - side.of(limits)) / size
    inequalities = stated(instance.model).spec.terminal_inequalities
    if inequalities:
        values, slopes, _ = inequalities_at(instance, float(times[-1]), x[:, -1])
        sizes = np.abs(slopes) @ np.append(largest, times[-1] - times[0])
        for name, value, size in zip(inequalities, values.tolist(), sizes.tolist(), strict=True):
            found[name, Side.UPPER] = value / max(size, 1e-300)
    return {place: by for place, by in found.items() if instance.met.get(place[0]) is not place[1]}


def limits_met(instance: Instance, at: Motion) -> dict[str, Side]:
    """Return the active limits at the end of a motion, by name."""
    return {name: side for (name, side), by in beyond(instance.meeting({}), at.times, at.x).items() if by > -NEAR_LIMIT}


def guessed_end(instance: Instance, at: Motion) -> Instance:
    """Return the instance with a motion's final time as its initial guess of a free final time."""
    return instance if instance.tf is not None else replace(instance, tf_guess=float(at.times[-1]))


def exact_within(instance: Instance, at: Motion, exact: Callable[[Instance], Solution | None]) -> Solution | None:
    """Return the extremal with the limits that are active in a motion, unless it exceeds another limit (``None``).

    Parameters
    ----------
    exact
        Function that finds the extremal near the motion, for an instance with given active limits.
    """
    try:
        found = exact(guessed_end(instance, at).meeting(limits_met(instance, at)))
    except BadInput:  # a time that is none
        return None
    if found is None or max(beyond(found.instance, found.times, found.x).values(), default=0.0) > BEYOND_LIMIT:
        return None
    return found
