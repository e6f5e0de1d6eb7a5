"""Arcs of controls at their bounds, identified in a motion by its switching functions, and made exact."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers.iteration import Limits
from satsym.solvers.search.motion import Motion
from satsym.solvers.search.reading.extremals import read_norm
from satsym.solvers.search.transcription import DEGREE
from satsym.solvers.switching.answers import answered
from satsym.solvers.switching.attempt import Exact, Origin, attempt
from satsym.solvers.switching.cold_start.recognition import LONG_ARC, Sample, guess
from satsym.solvers.switching.magnitudes import moving
from satsym.solvers.switching.structure import LOWER, SINGULAR, UPPER, Course, Guess, Structure
from satsym.solvers.switching.throttled import signs, switched

POINTS, NEAR_END, FAINT_COSTATE = 401, 1e-3, 1e-9
"""Number of times at which the uncontrolled motion is evaluated; largest distance from the final state, relative to the
state's magnitude, that counts as arriving; relative magnitude of costates of the final states that are reached."""

AT_BOUND = 0.02
"""Largest distance of a control from its bound, relative to its range, that counts as being at the bound."""

RAISED = 0.03
"""Relative amount by which switching functions are raised and lowered for further guesses. An arc on which a switching
function exceeds its threshold only slightly may be shorter than a mesh interval and invisible on the mesh."""

SHORT_ARC = 1e-3
"""Length of an arc that is added before or after a singular arc, relative to this arc."""

CLOSE_SWITCHES = 0.02
"""Largest difference of switching times, relative to the time between the first and the last switch, at which two
guesses of the same structure count as equal."""


def exact(instance: Instance, at: Motion, limits: Limits) -> Solution | None:
    """Return the extremal in exact arcs near a motion, as a solution; ``None`` if none is found."""
    began = time.perf_counter()
    found = arcs(instance, at, limits)
    return None if found is None else answered(instance, found, (), began)


def arcs(instance: Instance, at: Motion, limits: Limits) -> Exact | None:
    """Return the extremal in exact arcs near a motion; ``None`` if none is found.

    Controls are assumed to be bang-bang first. If this fails and controls are off their bounds for long, they are
    assumed to be singular there.
    """
    known: list[Guess] = []
    with np.errstate(all="ignore"):
        for one in _guesses(instance, at):
            if all(one.structure != other.structure or _apart(one, other) for other in known):
                found = attempt(instance, one, limits)
                if found is not None:
                    return replace(found, origin=Origin.SEARCH)
                known.append(one)
    return None


def at_rest(instance: Instance, limits: Limits) -> Solution | None:
    """Return the uncontrolled motion as a solution if it reaches the end and is an extremal, otherwise ``None``."""
    began = time.perf_counter()
    with np.errstate(all="ignore"):
        found = _at_rest(instance, limits)
    return None if found is None else answered(instance, replace(found, origin=Origin.REST), (), began)


def _at_rest(instance: Instance, limits: Limits) -> Exact | None:
    least = instance.control_set.switching[0]
    if instance.tf is None or any(least):
        return None
    n, p, model = len(instance.initial), instance.parameters, instance.model
    times, none = np.linspace(instance.t0, instance.tf, POINTS), np.zeros((len(model.spec.controls), POINTS))
    x, middle, _ = model.forward(times, instance.initial, none, none[:, 1:], p)
    fixed = [(i, instance.final[name]) for i, name in enumerate(model.spec.state_names) if name in instance.final]
    size = np.abs(x).max(axis=1)
    size = np.where(size > NEAR_END * size.max(), size, size.max())
    if any(isinstance(end, float) and not abs(x[i, -1] - end) <= NEAR_END * size[i] for i, end in fixed):
        return None
    given = np.array([name in instance.final for name in model.spec.state_names])
    slope = np.array(model.terminal_gradient(instance.tf, tuple(x[:, -1].tolist()), p))
    end = np.where(
        given, FAINT_COSTATE / size, slope
    )  # any that are small enough do, but where all vanish nothing has a slope
    lam, _ = model.backward(times, tuple(end.tolist()), x, middle, none, none[:, 1:], p)
    costates = lam[:, 0] if np.isfinite(lam).all() else np.zeros(n)
    return attempt(instance, Guess(Structure(((LOWER,),) * len(least)), np.zeros(0), costates, instance.tf), limits)


def _apart(one: Guess, other: Guess) -> bool:
    """Return whether two guesses of the same structure have different switching times."""
    lasting = float(np.ptp(one.times)) if len(one.times) else 0.0
    return bool(np.abs(one.times - other.times).max(initial=0.0) > CLOSE_SWITCHES * lasting)


def _guesses(instance: Instance, at: Motion) -> Iterator[Guess]:
    n, z = len(at.x), np.concatenate([at.x, at.lam])
    u = np.concatenate([at.u[:, :1], at.u], axis=1)
    seen = Sample(at.times, z, u, *signs(instance, at.times, z[:n], z[n:]))
    plain = guess(instance, seen)
    if not instance.model.spec.throttled:
        yield plain
        off, rounded = _off_bounds(instance, seen)
        if off.any():
            singular = guess(instance, rounded, off)
            yield singular
            yield from _otherwise(singular, instance.t0)
        for factor in (1.0 + RAISED, 1.0 - RAISED) if seen.weight.any() else ():
            yield guess(instance, replace(seen, sigma=factor * seen.sigma))
        return
    read = read_norm(at)
    if read is not None and any(read[0]):  # burns that are shorter than an interval are not read
        levels, edges = read
        structure = Structure((tuple(UPPER if label else LOWER for label in levels),))
        yield replace(plain, structure=structure, times=edges[1:-1])
    if plain.structure.levels == ((UPPER,),):
        yield _paused(plain, seen)
    filled = _filled(instance, seen)
    spread = guess(instance, replace(seen, sigma=seen.sigma - _threshold(seen.times, seen.sigma, filled)))
    for one in (plain, spread):
        yield one
        short = replace(one, times=_concentrated(one, seen.times, filled))
        yield short
        at_once = _from_the_start(instance, short)
        if at_once is not None:
            yield at_once


def _off_bounds(instance: Instance, seen: Sample) -> tuple[NDArray[np.bool_], Sample]:
    """Return where controls are off both bounds for long, shape (m, N), and a sample with signs for the other arcs.

    The control of a programme may jump between its bounds from point to point on a singular arc. It therefore counts as
    off its bounds between any two stretches that it spends at a bound for long or, at either end of the motion, for an
    interval.
    """
    low, high = instance.control_set.box
    edge, lasting = AT_BOUND * (high - low), float(np.ptp(seen.times))
    at = np.where(seen.u > high - edge, 1, np.where(seen.u < low + edge, -1, 0))
    plain = ~np.array(moving(instance))[:, None] & (seen.weight == 0.0)
    off, sigma = np.zeros(at.shape, bool), seen.sigma.copy()
    for row, labels in enumerate(at):
        for first, last, label in _stretches(labels):
            outer = last - first >= DEGREE and (first == 0 or last == len(labels) - 1)
            if label and (outer or seen.times[last] - seen.times[first] >= LONG_ARC * lasting):
                sigma[row, first : last + 1] = -label * np.maximum(np.abs(sigma[row, first : last + 1]), 1e-300)
            else:
                off[row, first : last + 1] = True
        off[row] &= plain[row]
        for first, last, label in _stretches(off[row]):
            if label and seen.times[last] - seen.times[first] < LONG_ARC * lasting:
                off[row, first : last + 1] = False
    return off, replace(seen, sigma=sigma)


def _otherwise(first: Guess, t0: float) -> Iterator[Guess]:
    """Yield guesses of a single control whose first or last singular arc begins or ends otherwise.

    One that misses the initial or the final state by little begins shortly after the start or is left shortly before
    the end, by less than an interval. One on which the control approaches its bound without reaching it takes the place
    of the arc at this bound.
    """
    row, edges = first.structure.levels[0], np.array([t0, *first.times, first.end])
    if len(first.structure.levels) > 1:
        return
    if row[0] == SINGULAR:
        times = np.append(t0 + SHORT_ARC * (edges[1] - t0), first.times)
        for level in (LOWER, UPPER):
            yield replace(first, structure=first.structure.with_levels(0, (level, *row)), times=times)
    if row[-1] == SINGULAR:
        times = np.append(first.times, first.end - SHORT_ARC * (first.end - edges[-2]))
        for level in (LOWER, UPPER):
            yield replace(first, structure=first.structure.with_levels(0, (*row, level)), times=times)
    for k in range(1, len(row)):
        if row[k - 1] == SINGULAR and row[k + 1 : k + 2] != (SINGULAR,):
            longer = first.structure.with_levels(0, (*row[:k], *row[k + 1 :]))
            yield replace(first, structure=longer, times=np.delete(first.times, k - 1))


def _stretches(labels: NDArray[Any]) -> list[tuple[int, int, Any]]:
    """Return first and last index and value of each run of equal labels."""
    edges = np.flatnonzero(np.diff(np.asarray(labels, int))) + 1
    return [(int(a), int(b) - 1, labels[a]) for a, b in pairwise([0, *edges.tolist(), len(labels)])]


def _filled(instance: Instance, seen: Sample) -> Array:
    """Return switching controls as a fraction of the range between their bounds, shape (r, N)."""
    low, high = (np.array(bounds)[:, None] for bounds in instance.control_set.switching)
    return np.clip((switched(instance, seen.u) - low) / np.where(high > low, high - low, 1.0), 0.0, 1.0)


def _paused(first: Guess, seen: Sample) -> Guess:
    """Return a guess with a short arc at the lower bound added where the switching function is largest.

    It is used for a guess without switches: if there is hardly any spare time, the controls of a programme do not show
    such an arc.
    """
    middle, half = float(seen.times[int(np.argmax(seen.sigma[0]))]), CLOSE_SWITCHES / 2.0 * float(np.ptp(seen.times))
    middle = min(max(middle, seen.times[0] + 2.0 * half), seen.times[-1] - 2.0 * half)
    structure = first.structure.with_levels(0, (UPPER, LOWER, UPPER))
    return replace(first, structure=structure, times=np.array([middle - half, middle + half]))


def _threshold(times: Array, sigma: Array, filled: Array) -> Array:
    """Return thresholds for switching functions such that arcs at upper bounds last as long as a given total, (r, 1).

    The total is the time integral of the controls of a programme as fractions of their ranges. The threshold is zero if
    controls are at their bounds. If other controls cost nearly the same, the controls of the programme are spread over
    a time in which the signs of switching functions mean little.
    """
    widths = np.gradient(times)
    found = []
    for own, full in zip(sigma, filled, strict=True):
        by = np.argsort(own)
        lasting = np.cumsum(widths[by])
        place = min(int(np.searchsorted(lasting, float(full @ widths))), len(by) - 1)
        found.append(float(own[by][place]))
    return np.array(found)[:, None]


def _concentrated(first: Guess, times: Array, filled: Array) -> Array:
    """Return switching times for arcs at upper bounds into which controls are concentrated, with the same integral."""
    rows = zip(first.structure.levels, first.structure.by_control(first.times), filled, strict=True)
    return np.concatenate([_lasting(times, *row) for row in rows])


def _lasting(times: Array, levels: tuple[int, ...], switches: Array, filled: Array) -> Array:
    """Return switching times of a control for arcs at its upper bound with the same time integral as its values."""
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


def _from_the_start(instance: Instance, first: Guess) -> Guess | None:
    """Return a guess without its initial wait at the lower bound, with all later switches advanced by the wait.

    If such a wait changes almost nothing, as on a nearly circular orbit, the equations hardly determine when to begin,
    and the best time may be the earliest. ``None`` if the guess does not begin with a wait.
    """
    row = first.structure.levels[0]
    if len(first.structure.levels) > 1 or len(row) < 3 or row[0] != LOWER or first.course is None:
        return None
    wait = first.times[0] - instance.t0
    times = first.times[1:] - wait
    if row[-1] != LOWER:
        row, times = (*row, LOWER), np.append(times, first.end - wait)
    costates = first.course.at(float(first.times[0]))[len(instance.initial) :]
    course = Course(first.course.times - wait, first.course.z)
    structure = first.structure.with_levels(0, row[1:])
    return replace(first, structure=structure, times=times, costates=costates, course=course)
