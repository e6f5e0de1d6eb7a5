"""Levels of controls under path constraints, identified in a motion: at bounds, on boundaries, or singular.

A constraint counts as active if its multiplier, relative to the constraint and the cost, exceeds its relative slack.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.control_set import bound_names
from satsym.solvers.search.motion import Motion
from satsym.solvers.search.reading.contacts import Along
from satsym.solvers.switching.boundaries import acting, effects, values
from satsym.solvers.switching.structure import (
    BOUNDARY,
    LOWER,
    SINGULAR,
    UPPER,
    Course,
    Guess,
    Structure,
    constraint_of,
    on_boundary,
)
from satsym.solvers.switching.trajectory import runs

SHORT_ARC, OFF = 0.5, 1e-6
"""Length of an arc at an end, in intervals of the mesh, that is added if no interval shows it; and the largest distance
from a boundary, relative to the constraint's magnitude, that counts as being on it."""

NEAR_BOUNDARY = 1e-2
"""Minimum scale of a constraint's slacks, relative to the terms of the constraint, used if all slacks are smaller."""


def read(at: Motion, shortest: int) -> Guess:
    """Return the structure of a motion, its switching times, and its states and costates.

    Parameters
    ----------
    shortest
        Maximum number of points of a singular arc between bounds that is ignored, as a switch lies between its points.
    """
    held = Along(at)
    edges = 0.5 * (at.times[1:] + at.times[:-1])
    rows, times = [], list[float]()
    for control in range(len(at.u)):
        levels = _without_brief(_levels(held, control), shortest)
        switches = np.flatnonzero(np.diff(levels)) + 1
        row = [int(level) for level in levels[np.append(0, switches)]]
        row, own = _with_ends(held, row, edges[switches].tolist())
        x = np.array([np.interp(own, at.times, values_of) for values_of in at.x])
        rows.append(_with_jumps(held, row, np.array(own), x))
        times += own
    course = Course(at.times, np.concatenate([at.x, at.lam]))
    return Guess(Structure(tuple(rows)), np.array(times), at.lam[:, 0], float(at.times[-1]), course, bounded=True)


def _with_ends(held: Along, row: list[int], times: list[float]) -> tuple[list[int], list[float]]:
    """Return levels and times with a short arc added where the motion starts or ends off the boundary it leads to.

    At the start this arc leads to the boundary, at the end away from it.
    """
    instance, x, end = held.instance, held.at.x, float(held.times[-1])
    for first, place, time in ((True, 0, instance.t0), (False, -1, end)):
        level, brief = row[place], SHORT_ARC * float(held.reaches[place])
        if level < BOUNDARY:
            continue
        which, state = constraint_of(level), x[:, place]
        z = np.append(state, np.zeros(len(state)))[:, None]
        if values(instance, np.array([time]), z)[which, 0] >= -OFF * held.rooms[which]:
            continue
        push = effects(instance, which, time, state)[acting(instance, which)] * (1.0 if first else -1.0)
        level = UPPER if push > 0.0 else LOWER
        row, times = ([level, *row], [time + brief, *times]) if first else ([*row, level], [*times, time - brief])
    return row, times


def _with_jumps(held: Along, row: list[int], times: Array, x: Array) -> tuple[int, ...]:
    """Return levels marked with costate jumps where a boundary is entered from, or left for, a bound beyond it.

    Parameters
    ----------
    times, x
        Times at which levels change, and the states there, shapes (K,) and (n, K).
    """
    instance, sides, found = held.instance, {LOWER: -1.0, UPPER: 1.0}, list(row)
    for place, level in enumerate(row):
        if level < BOUNDARY or instance.model.spec.path_constraints[which := constraint_of(level)].order > 1:
            continue
        beyond = [
            0 <= at < len(times)
            and way
            * sides.get(row[other], 0.0)
            * effects(instance, which, times[at], x[:, at])[acting(instance, which)]
            > 0.0
            for at, other, way in ((place - 1, place - 1, -1.0), (place, (place + 1) % len(row), 1.0))
        ]
        found[place] = on_boundary(which, *beyond)
    return tuple(found)


def _levels(held: Along, control: int) -> NDArray[np.int64]:
    """Return the level of a control at each point."""
    instance, spec = held.instance, held.instance.model.spec
    names = [one.name for one in spec.path_constraints]
    active = _active(held)
    low, high = (names.index(name) for name in bound_names(spec)[control])
    found = np.where(active[low], LOWER, np.where(active[high], UPPER, SINGULAR))
    for k, one in enumerate(spec.path_constraints):
        if one.order and acting(instance, k) == control:
            both = active[k].copy()
            both[1:] &= active[k][:-1]
            found[both & (found == SINGULAR)] = on_boundary(k, one.order > 1, one.order > 1)
    return found


def _active(held: Along) -> NDArray[np.bool_]:
    """Return whether each constraint is active at each point, shape (h, N)."""
    s, z, steps = held.slacks, held.pushes, held.at.steps / held.at.steps.sum()
    room = np.maximum(s.max(axis=1, keepdims=True), NEAR_BOUNDARY * held.rooms[:, None])
    unit = max(abs(held.at.cost), 1e-12) * steps
    return np.asarray(z * room / unit > s / room)


def _without_brief(levels: NDArray[np.int64], shortest: int) -> NDArray[np.int64]:
    """Return levels without short runs of singular levels; each half of a run takes the level beside it."""
    found = levels.copy()
    for first, last in runs(levels == SINGULAR):
        if last - first < shortest and last - first + 1 < len(levels):
            before = levels[first - 1] if first else levels[last + 1]
            after = levels[last + 1] if last + 1 < len(levels) else before
            middle = (first + last + 1) // 2
            found[first:middle], found[middle : last + 1] = before, after
    return found
