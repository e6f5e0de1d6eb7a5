"""From a guessed structure to an extremal of exact arcs, by Newton's method and repairs of the structure.

An arc whose length becomes negative is removed; where a control is not at the level that minimises H, an arc at the
better level is inserted.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.failures import FAILURES, tried
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.boundaries import off_boundaries
from satsym.solvers.switching.extremal_arcs import ROUGH
from satsym.solvers.switching.newton import Equations, Refined, solve
from satsym.solvers.switching.stops import stops
from satsym.solvers.switching.structure import BOUNDARY, SINGULAR, Guess, constraint_of, jumps, on_boundary
from satsym.solvers.switching.trajectory import Trajectory, Violation, violations

REPAIRS = 8
"""Maximum number of changes of a guessed structure."""

SOLVED = 1e-10
"""Largest relative residual of an extremal."""

SIZED = 1e-6
"""Minimum scale of a state in the extremal, relative to its scale in the guess."""

FAINT_COSTATE = 1e-40
"""Magnitude, relative to the largest scale, below which a state counts as zero. Such states only move because zero
costates are replaced by tiny ones."""

EVALUATED = 250
"""Approximate number of evaluations on an arc, by which the work of corrections is counted."""

NO_TIME = 1e-11
"""Length of an arc, relative to the duration, below which it counts as zero."""

FLEETING = 1e-4
"""Length, relative to the duration, below which an arc beside a singular arc or at an end is removed if an extremal
without it exists. Such an arc can come from a double zero of a switching function, and its effect is negligible."""


class Origin(Enum):
    """Sources of exact arcs, with the texts for messages."""

    STRUCTURE = "the given structure"
    REST = "rest"
    REACH = "the reachable set"
    SMOOTHED = "the regularised problem with the weight {:.1e}"
    MINIMUM_TIME = "the structure of the minimum-time solution"
    SEARCH = "a direct search"


@dataclass(frozen=True, eq=False)
class Exact:
    """An extremal of exact arcs that minimises H everywhere."""

    refined: Refined
    trajectory: Trajectory
    """The structure with its times, and the arcs."""
    iterations: int
    """Number of corrections in all attempts."""
    origin: Origin = Origin.STRUCTURE
    smoothing: float = 0.0
    """Source of the arcs, and the smoothing parameter of the regularised problem if they come from one."""


def attempt(instance: Instance, first: Guess, limits: Limits) -> Exact | None:
    """Make a guess exact, with repairs of its structure; ``None`` if this fails."""
    return tried(lambda: _attempt(instance, first, limits))


def _attempt(instance: Instance, first: Guess, limits: Limits) -> Exact | None:
    at, met, iterations = first, {first.structure}, 0
    while len(met) <= REPAIRS and not limits.expired:
        found = _solved(instance, at, limits)
        if found is None:
            return None
        iterations += found.iterations
        limits.spend(EVALUATED * found.iterations * len(found.arcs))
        start, end = instance.t0, found.at.end
        shortest, none = _shortest(found, start), NO_TIME * (end - start)
        if shortest is not None and shortest[0] < (none if found.stops else -none):
            at = replace(_dropped(found, *shortest[1:]), course=at.course, bounded=at.bounded)
        else:
            exact = _collapsed(instance, found)
            if exact is None:
                return None
            faults = violations(exact[1])
            if first.bounded:
                faults += off_boundaries(exact[1])
            if limits.watch:
                limits.watch(exact[1].cost(instance), max((fault.amount for fault in faults), default=found.residual))
            if not faults:
                return _plainer(instance, exact[0], at, limits) or Exact(*exact, iterations)
            worst = max(faults, key=lambda fault: fault.amount)
            at = replace(_inserted(exact[0], exact[1], worst), course=at.course, bounded=at.bounded)
        if at.structure in met:
            return None
        met.add(at.structure)
    return None


def _plainer(instance: Instance, found: Refined, at: Guess, limits: Limits) -> Exact | None:
    """Return the extremal without a very short arc beside a singular arc or at an end, if one exists, else ``None``."""
    lengths, lasting = found.structure.durations(found.at.times, instance.t0, found.at.end), found.at.end - instance.t0
    for control, (row, own) in enumerate(zip(found.structure.levels, lengths, strict=True)):
        for arc in np.flatnonzero(own < FLEETING * lasting).tolist():
            beside = SINGULAR in row[max(arc - 1, 0) : arc + 2] or arc in (0, len(row) - 1)
            if beside and row[arc] != SINGULAR and len(row) > 1:
                less = replace(_dropped(found, control, arc), course=at.course, bounded=at.bounded)
                return attempt(instance, less, limits)
    return None


def nearest(instance: Instance, at: Guess, limits: Limits) -> Refined | None:
    """Return the extremal of a structure or a least-squares approximation; ``None`` if the iteration fails."""
    equations = Equations(instance, at.structure, sizes(instance, at), at.end - instance.t0)
    return solve(equations, equations.start(at.costates, at.times, at.end), limits.watch)


def _solved(instance: Instance, at: Guess, limits: Limits) -> Refined | None:
    """Return the extremal of a structure, accurate relative to the magnitudes of its own states, or ``None``.

    The states of the guess may be larger, so that accuracy relative to these is not enough.
    """
    found = nearest(instance, at, limits) or _in_parts(instance, at, limits)
    for last in (False, True):
        if found is None or found.residual > SOLVED or not found.at.end > instance.t0:
            return None
        own = replace(found, sizes=_own_sizes(instance, found))
        residual = _residual(instance, own)
        if residual <= SOLVED or last:
            return replace(own, residual=residual) if residual <= SOLVED else None
        equations, known = _equations(instance, own), own.at
        found = solve(
            equations, equations.start(known.costates, known.times, known.end, known.stops, known.jumps), limits.watch
        )
    return None


def _in_parts(instance: Instance, at: Guess, limits: Limits) -> Refined | None:
    """Return the extremal by multiple shooting, if errors grow so much that arcs need restarts; otherwise ``None``."""
    course, n = at.course, len(instance.initial)
    if course is None:
        return None
    known = course.sizes()
    own = _sized(np.maximum(known[:n], given(instance)), known[n:])
    places, times = stops(instance, at, course, own)
    if not places:
        return None
    equations = Equations(instance, at.structure, own, at.end - instance.t0, places)
    values = np.array([course.at(time) for time in times])
    return solve(equations, equations.start(at.costates, at.times, at.end, values), limits.watch)


def _equations(instance: Instance, found: Refined) -> Equations:
    return Equations(instance, found.structure, found.sizes, found.at.end - instance.t0, found.stops)


def _residual(instance: Instance, found: Refined) -> float:
    """Return the largest residual of the arcs, relative to their scales."""
    equations = _equations(instance, found)
    return float(np.abs(equations.residual(found.at, found.arcs)[0]).max(initial=0.0))


def _own_sizes(instance: Instance, found: Refined) -> Array:
    """Return scales of the states, from their values and rates at the ends of arcs, and the known costate scales."""
    n = len(instance.initial)
    states = np.maximum(given(instance), SIZED * found.sizes[:n])
    for arc in found.arcs:
        for t, z in ((arc.start, arc.before), (arc.end, arc.after)):
            moved = (arc.end - arc.start) * np.array(arc.field.rates(t, z.tolist())[:n])
            states = np.maximum(states, np.maximum(np.abs(z[:n]), np.abs(moved)))
    return np.concatenate([states, found.sizes[n:]])


def given(instance: Instance) -> Array:
    """Return magnitudes of the given initial and final states."""
    final = map(instance.final.get, instance.model.spec.state_names)
    given = [abs(v) if isinstance(v, float | int) else 0.0 for v in final]
    return np.maximum(np.abs(np.array(instance.initial)), np.array(given))


def sizes(instance: Instance, at: Guess) -> Array:
    """Return scales of states, from given ends and the guessed motion, and scales of costates, from their guess."""
    n = len(instance.initial)
    states = given(instance)
    equations = Equations(instance, at.structure, np.ones(2 * n), at.end - instance.t0)
    try:
        arcs = equations.arcs(equations.start(at.costates, at.times, at.end), slopes=False, tolerance=ROUGH)
        for arc in arcs:
            states = np.maximum(states, np.abs(arc.after[:n]))
    except FAILURES:
        pass
    return _sized(states, np.abs(at.costates))


def _sized(states: Array, costates: Array) -> Array:
    """Return scales of states and costates, with zeros replaced."""
    states = np.where(states > FAINT_COSTATE * states.max(), states, 1.0)
    cost = float((states * costates).max())
    return np.concatenate([states, np.maximum(costates, 1e-3 * cost / states if cost > 0.0 else 1.0)])


def _shortest(found: Refined, start: float) -> tuple[float, int, int] | None:
    """Return length, control and index of the shortest arc; ``None`` without switches."""
    lengths = found.structure.durations(found.at.times, start, found.at.end)
    arcs = [(float(value), i, k) for i, row in enumerate(lengths) if len(row) > 1 for k, value in enumerate(row)]
    return min(arcs) if arcs else None


def _dropped(found: Refined, control: int, arc: int) -> Guess:
    structure, kept = found.structure.without_arc(control, arc)
    times = found.at.times[kept]
    return Guess(structure, times, found.at.costates, found.at.end)


def _collapsed(instance: Instance, found: Refined) -> tuple[Refined, Trajectory] | None:
    """Return the extremal without arcs of no length if it still solves the equations, otherwise ``None``."""
    start, end = instance.t0, found.at.end
    while True:
        shortest = _shortest(found, start)
        if shortest is None or shortest[0] > NO_TIME * (end - start):
            break
        left = _dropped(found, *shortest[1:])
        kept = (
            found.at.jumps if len(left.structure.jumps) == len(found.at.jumps) else np.zeros(len(left.structure.jumps))
        )
        at = replace(found.at, times=left.times, jumps=kept)
        equations = Equations(instance, left.structure, found.sizes, end - start)
        found = replace(found, structure=left.structure, at=at, arcs=equations.arcs(at, slopes=False))
        found = replace(found, residual=_residual(instance, found))
    if found.residual > SOLVED:
        return None
    return found, Trajectory.of(found.arcs, found.sizes)


def _inserted(found: Refined, trajectory: Trajectory, fault: Violation) -> Guess:
    """Return a guess with an arc at the better level inserted where a control does not minimise H."""
    own = found.structure.by_control(found.at.times)
    times, row = own[fault.control], found.structure.levels[fault.control]
    middle = (fault.start + fault.end) / 2.0
    arc = int(np.searchsorted(times, middle))
    begin = times[arc - 1] if arc > 0 else trajectory.arcs[0].start
    end = times[arc] if arc < len(times) else found.at.end
    level, present = fault.level, row[arc]
    if fault.beyond and present >= BOUNDARY:  # it comes to its bound on the boundary, or leaves it there
        late, (begins, ends) = bool(fault.end + fault.start > begin + end), jumps(present)
        present = on_boundary(constraint_of(present), begins or not late, ends or late)
        row = (*row[:arc], present, *row[arc + 1 :])
    near = 1e-9 * (trajectory.arcs[-1].end - trajectory.arcs[0].start)
    if fault.start <= begin + near:
        levels = (*row[:arc], level, *row[arc:]) if arc == 0 or row[arc - 1] != level else row
        moved = np.insert(times, arc, fault.end) if levels is not row else _moved(times, arc - 1, fault.end)
    elif fault.end >= end - near:
        last = arc == len(times)
        levels = (*row[: arc + 1], level, *row[arc + 1 :]) if last or row[arc + 1] != level else row
        moved = np.insert(times, arc, fault.start) if levels is not row else _moved(times, arc, fault.start)
    else:
        levels = (*row[: arc + 1], level, present, *row[arc + 1 :])
        moved = np.insert(times, arc, [fault.start, fault.end])
    own[fault.control] = moved
    structure = found.structure.with_levels(fault.control, levels)
    return Guess(structure, np.concatenate(own), found.at.costates, found.at.end)


def _moved(times: Array, place: int, to: float) -> Array:
    changed = times.copy()
    changed[place] = to
    return changed
