"""Arcs of full level as short as they are without smoothing: what is smoothed does the same in a longer time.

Smoothing spreads a short burn over a time that may be many times as long, so that its signs, read off as they are, make
a structure whose arcs do far too much. What an arc does is the integral of its level: arcs of full level with the same
integrals, round the same centres, are about those of the exact extremal while much is smoothed still.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.switching.cold_start.recognition import Sample
from satsym.solvers.switching.structure import LOWER, UPPER, Course, Guess
from satsym.solvers.switching.throttled import switched


def concentrated(instance: Instance, seen: Sample, first: Guess) -> Guess:
    """A guess that was read off a smoothed extremal, each of its arcs at an upper bound with the integral of that."""
    low, high = (np.array(bounds)[:, None] for bounds in instance.control_set.switching)
    room = np.where(high > low, high - low, 1.0)
    filled = np.clip((switched(instance, seen.u) - low) / room, 0.0, 1.0)
    rows = zip(first.structure.levels, first.structure.by_control(first.times), filled, strict=True)
    return replace(first, times=np.concatenate([_times(seen.times, *row) for row in rows]))


def _times(times: Array, levels: tuple[int, ...], switches: Array, filled: Array) -> Array:
    """Switching times of one control, whose level is so far between its bounds."""
    edges = np.concatenate([times[:1], switches, times[-1:]])
    found = switches.copy()
    for arc, level in enumerate(levels):
        if level != UPPER or len(levels) == 1:
            continue
        # from the middle of the arc before it to that of the one after it
        begin = times[0] if arc == 0 else (edges[arc - 1] + edges[arc]) / 2.0
        end = times[-1] if arc == len(levels) - 1 else (edges[arc + 1] + edges[arc + 2]) / 2.0
        own = (times >= begin) & (times <= end)
        lasting = float(np.trapezoid(filled[own], times[own]))
        centre = float(np.trapezoid(filled[own] * times[own], times[own])) / max(lasting, 1e-300)
        if arc == 0:
            found[0] = times[0] + lasting
        elif arc == len(levels) - 1:
            found[-1] = times[-1] - lasting
        else:
            found[arc - 1 : arc + 1] = centre - lasting / 2.0, centre + lasting / 2.0
    return found


def from_the_start(instance: Instance, first: Guess) -> Guess | None:
    """The same begun at once: without a wait at its lower bound of one control, all that follows as much earlier.

    Where such a wait next to changes nothing, as on an orbit that is next to circular, the equations hardly tell when
    to begin, and the best time may be the earliest. ``None`` where it does not wait before it acts and after it.
    """
    row = first.structure.levels[0]
    if len(first.structure.levels) > 1 or len(row) < 3 or row[0] != LOWER or row[-1] != LOWER or first.course is None:
        return None
    structure, kept = first.structure.without_arc(0, 0)
    wait = first.times[0] - instance.t0
    costates = first.course.at(float(first.times[0]))[len(instance.initial) :]
    course = Course(first.course.times - wait, first.course.z)
    return replace(first, structure=structure, times=first.times[kept] - wait, costates=costates, course=course)
