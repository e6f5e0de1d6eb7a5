"""The least time in which a linear motion reaches an end: no shorter one is left out (Neustadt, Eaton).

A costate at the end is a hyperplane; as long as the set of ends that are reached lies on one side of it and the given
end on the other, the time is too short. From one such time to the first at which the plane no longer tells them apart
nothing can arrive; there another plane is looked for (Neustadt, Synthesizing time optimal control systems, Journal of
Mathematical Analysis and Applications 1, 1960; Eaton, An iterative solution to time-optimal control, ibid. 5, 1962).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.linear.linear_motion import LinearMotion
from satsym.solvers.switching.linear.reach import THERE, Reach, given_rows, goal, steps

PLANES = 200
"""Planes that are looked for."""

HORIZON = 2**17
"""Steps after which a plane that still tells them apart does so for ever, as far as anyone will wait."""

BEFORE = (3e-3, 3e-4, 3e-2)
"""Shares of the least time before it at which its costate is looked for: at it there is hardly any distance left."""

PRECISE = 1e-8
"""Share of its distance by which that hyperplane may be nearer than the set; its direction is as good as the root."""

BEYOND_ARRIVAL = 1e-3
"""Share of a duration by which the search goes on beyond it, where nothing exact came of it."""

FARTHER = 1.5
"""So many times farther it goes each time."""

TIRED = 16
"""Times it does so."""


@dataclass(frozen=True)
class Arrival:
    """A time in which the end may be reached first, and costates there that say how."""

    duration: float
    """From the start; nothing arrives in less than the first of them."""
    costates: tuple[Array, ...]
    """Costates of all states at the end, shape (n,), without a scale, one for each way to look for them."""


def arrivals(instance: Instance, motion: LinearMotion, limits: Limits) -> Iterator[Arrival]:
    """Times that are not too short, the shortest first: the first is the least, as far as steps can tell.

    Nothing is given where no time is found.
    """
    rows, n = given_rows(instance), len(instance.initial)
    apart = np.array(instance.initial)[rows] - goal(instance, rows, instance.t0)
    size = np.maximum(np.abs(np.array(instance.initial)[rows]), np.abs(goal(instance, rows, instance.t0)))
    costate: Array = np.zeros(n)
    costate[rows] = apart / np.where(size > 0.0, size, 1.0) ** 2
    duration = _beyond(instance, motion, costate, 0.0, _scale(instance, motion))
    further, tired = BEYOND_ARRIVAL, 0
    for _ in range(PLANES):
        if duration is None or limits.expired or tired > TIRED:
            return
        reach = Reach(instance, motion, duration)
        limits.spend(reach.count)
        distance, costate = reach.separation()
        later = _beyond(instance, motion, costate, duration, duration) if distance > THERE else duration
        if later is not None and later <= duration * (1.0 + THERE):
            before = (Reach(instance, motion, duration * (1.0 - fraction)).separation(PRECISE) for fraction in BEFORE)
            yield Arrival(duration, tuple(costate for distance, costate in before if distance > 0.0))
            later, further, tired = duration * (1.0 + further), further * FARTHER, tired + 1
        duration = later


def _scale(instance: Instance, motion: LinearMotion) -> float:
    """A duration to begin with: that in which full controls change the state as much as it is to be changed."""
    rates = motion.states @ np.array(instance.initial) + motion.drift
    rates = np.abs(rates) + np.abs(motion.controls) @ np.maximum(np.abs(instance.lower), np.abs(instance.upper))
    rows = given_rows(instance)
    apart = np.abs(np.array(instance.initial)[rows] - goal(instance, rows, instance.t0))
    found = [float(a / b) for a, b in zip(apart, rates[rows], strict=True) if a > 0.0 and b > 0.0]
    quickest = float(np.abs(np.linalg.eigvals(motion.states)).max(initial=0.0))
    return max(found, default=1.0 / quickest if quickest > 0.0 else 1.0)


def _beyond(instance: Instance, motion: LinearMotion, costate: Array, after: float, scale: float) -> float | None:
    """The first duration after one at which a plane no longer tells the end from what is reached."""
    length = scale / steps(motion, scale)
    rows = given_rows(instance)
    low, high = np.array(instance.lower), np.array(instance.upper)
    count = max(2 * int(np.ceil(after / length)), 512)
    first = int(np.round(after / length))
    while count <= HORIZON:
        _, acting, drift = motion.step(length)
        sides = costate @ motion.powers(length, count)
        pushed = sides[:-1] @ acting
        gained = sides[:-1] @ drift + np.minimum(pushed * low, pushed * high).sum(axis=1)
        values = sides @ np.array(instance.initial) + np.append(0.0, np.cumsum(gained))
        if "reference" in instance.final.values():
            goals = np.array([goal(instance, rows, instance.t0 + length * k) for k in range(first, count + 1)])
            values[first:] -= goals @ costate[rows]
        else:
            values -= float(costate[rows] @ goal(instance, rows, instance.t0))
        past = np.flatnonzero(~(values[first:] > 0.0))
        if len(past):
            k = first + int(past[0])
            if not np.isfinite(values[k]):
                return None
            if k == first:
                return after
            fraction = values[k - 1] / (values[k - 1] - values[k])
            found = length * (k - 1 + float(fraction))
            if k < 20 and after == 0.0 and found < scale:
                return _beyond(instance, motion, costate, 0.0, found)
            return found
        first, count = count, 2 * count
    return None
