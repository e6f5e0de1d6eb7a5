"""The levels that controls take along a regularised path: at bounds, on boundaries, and singular where neither holds.

What is active has a multiplier that is larger, in its measure and that of the cost, than its slack is in its own.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.control_set import bound_names
from satsym.solvers.constrained.regularised.interior_point import Path
from satsym.solvers.constrained.regularised.slopes import rooms
from satsym.solvers.constrained.regularised.transcription import Program, middles
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

SHORT, OFF = 0.5, 1e-6
"""Of an interval, an arc at an end that no interval shows; and share of its size by which a boundary is not met."""

BRIEF = 2
"""Intervals of a singular arc that is none: a switch falls into one of them."""


def recognised(program: Program, path: Path, shortest: int = BRIEF) -> Guess:
    """The structure of a path, its times, and where it leads.

    Parameters
    ----------
    shortest
        Intervals up to which arcs between bounds are none.
    """
    instance, at = program.instance, path.at
    edges = np.append(instance.t0, np.real(program.times(at.duration, False)))
    rows, times = [], list[float]()
    for control in range(len(at.u)):
        levels = _without_brief(_levels(program, path, control), shortest)
        switches = np.flatnonzero(np.diff(levels)) + 1
        row = [int(level) for level in levels[np.append(0, switches)]]
        row, own = _with_ends(program, path, row, edges[switches].tolist())
        near = np.clip(np.searchsorted(edges, own), 0, program.intervals)
        rows.append(_with_jumps(program, path, row, np.array(own), at.x[:, near]))
        times += own
    begin, end = (at.y[:, place] + (at.y[:, place] - at.y[:, beside]) / 2.0 for place, beside in ((0, 1), (-1, -2)))
    lam = np.column_stack([begin, at.y, end])
    x = np.column_stack([at.x[:, 0], middles(at.x), at.x[:, -1]])
    places = np.concatenate([edges[:1], np.real(program.times(at.duration, True)), edges[-1:]])
    course = Course(places, np.concatenate([x, lam]))
    return Guess(Structure(tuple(rows)), np.array(times), begin, float(edges[-1]), course, bounded=True)


def _with_ends(program: Program, path: Path, row: list[int], times: list[float]) -> tuple[list[int], list[float]]:
    """With a brief arc to a boundary that the start is not on, and one away from a boundary that the end is not on."""
    instance, x = program.instance, path.at.x
    end = instance.t0 + path.at.duration
    brief = SHORT * path.at.duration / program.intervals
    for first, place, time in ((True, 0, instance.t0), (False, -1, end)):
        level = row[place]
        if level < BOUNDARY:
            continue
        which, state = constraint_of(level), x[:, place]
        z = np.append(state, np.zeros(len(state)))[:, None]
        if values(instance, np.array([time]), z)[which, 0] >= -OFF * rooms(program, path.at)[which, 0]:
            continue
        push = effects(instance, which, time, state)[acting(instance, which)] * (1.0 if first else -1.0)
        level = UPPER if push > 0.0 else LOWER
        row, times = ([level, *row], [time + brief, *times]) if first else ([*row, level], [*times, time - brief])
    return row, times


def _with_jumps(program: Program, path: Path, row: list[int], times: Array, x: Array) -> tuple[int, ...]:
    """With jumps where a boundary is left for the bound that pushes beyond it, or reached from that which pulls away.

    Parameters
    ----------
    times, x
        When levels change, and states there, shapes (K,) and (n, K).
    """
    instance, sides, found = program.instance, {LOWER: -1.0, UPPER: 1.0}, list(row)
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


def _levels(program: Program, path: Path, control: int) -> NDArray[np.int64]:
    """The level of a control in each interval."""
    instance, spec = program.instance, program.instance.model.spec
    names = [one.name for one in spec.path_constraints]
    active = _active(program, path)
    low, high = (names.index(name) for name in bound_names(spec)[control])
    found = np.where(active[low], LOWER, np.where(active[high], UPPER, SINGULAR))
    for k, one in enumerate(spec.path_constraints):
        if one.order and acting(instance, k) == control:
            both = active[k].copy()
            both[1:] &= active[k][:-1]
            found[both & (found == SINGULAR)] = on_boundary(k, one.order > 1, one.order > 1)
    return found


def _active(program: Program, path: Path) -> NDArray[np.bool_]:
    """Whether each constraint is active, shape (h, N); of those on states at the end of each interval."""
    s, z = path.at.s, path.at.z * program.kept
    room = np.maximum(s.max(axis=1, keepdims=True), 1e-4 * rooms(program, path.at))
    unit = max(abs(path.cost), 1e-12) / program.intervals
    return np.asarray(z * room / unit > s / room)


def _without_brief(levels: NDArray[np.int64], shortest: int) -> NDArray[np.int64]:
    """Without brief runs of no bound and no boundary: each half is taken for what is beside it."""
    found = levels.copy()
    for first, last in runs(levels == SINGULAR):
        if last - first < shortest and last - first + 1 < len(levels):
            before = levels[first - 1] if first else levels[last + 1]
            after = levels[last + 1] if last + 1 < len(levels) else before
            middle = (first + last + 1) // 2
            found[first:middle], found[middle : last + 1] = before, after
    return found
