"""Tests of an extremal with a given structure of arcs, and structures to try instead if a test fails."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from itertools import combinations, pairwise

import numpy as np

from satsym.arrays import Array
from satsym.solvers.constrained.active import control, deciding, multipliers
from satsym.solvers.constrained.arcs import Arcs, effects, gradient, values
from satsym.solvers.constrained.arcs import sizes as measured
from satsym.solvers.constrained.structure import FREE, Active, Contact, Event, Passage, Structure, ordered
from satsym.solvers.switching.trajectory import runs

SLACK = 1e-9
"""Violation of a constraint, relative to its magnitude, and relative magnitude of a negative multiplier, that are
tolerated."""

ZERO_CURVATURE = 1e-7
"""Second time derivative of a constraint at a touch point, scaled by duration and magnitude, that counts as zero."""

DENSE = 8
"""Number of points in each interval at which constraints are evaluated."""

ROUNDED = 1e-11
"""Fraction of the duration by which coinciding junctions may be in the wrong order."""

PARALLEL = 1.0 - 1e-6
"""Squared cosine between the effects of two constraints on the controls above which the effects count as parallel."""

BESIDE = 0.05
"""Fraction of the duration around a touch point within which a violation turns it into an arc."""


def wrong(arcs: Arcs) -> tuple[str, list[Structure]]:
    """Return why arcs are no extremal of the problem (empty if they are one), and structures to try instead."""
    flaws = (_disordered, _pulling, _violated, _rising, _pulling_along)
    return next((found for found in (flaw(arcs) for flaw in flaws) if found is not None), ("", []))


def contacts(arcs: Arcs) -> list[Contact]:
    """Return the contacts of the structure, with the times and multipliers that were found."""
    times, found = arcs.times, []
    moved = {one.time: found.time for one, found in zip(arcs.structure.passages, passages(arcs), strict=True)}
    at = {(one.contact, one.event): k for k, one in enumerate(arcs.junctions)}
    left = {one.left: k for k, one in enumerate(arcs.junctions) if one.left is not None}
    for number, one in enumerate(arcs.structure.contacts):
        touch, entry, gone = (at.get((number, event)) for event in (Event.TOUCH, Event.ENTRY, Event.EXIT))
        pressed = arcs.pressure(one.constraint) if one.closes else 0.0
        if one.touches:
            time = float(times[-1] if touch is None else times[touch + 1])
            jump = pressed if touch is None else arcs.jump(touch, one.constraint)
            found.append(replace(one, start=time, end=time, jumps=(jump, 0.0)))
            continue
        gone = left.get(number, gone)
        start, end = (float(times[d] if k is None else times[k + 1]) for k, d in ((entry, 0), (gone, -1)))
        start, end = moved.get(one.start, start), moved.get(one.end, end)
        jumps = (
            0.0 if entry is None else arcs.jump(entry, one.constraint),
            pressed if gone is None else arcs.jump(gone, one.constraint),
        )
        found.append(replace(one, start=start, end=end, jumps=jumps))
    return found


def passages(arcs: Arcs) -> tuple[Passage, ...]:
    """Return the waypoints, with the times and multipliers that were found."""
    met = ((k, one) for k, one in enumerate(arcs.junctions) if one.event is Event.INTERIOR)
    return tuple(
        Passage(float(arcs.times[k + 1]), tuple((which, arcs.jump(k, which)) for which, _ in one.jumps))
        for k, one in met
    )


def along(arcs: Arcs, arc: int) -> tuple[Array, Array]:
    """Return closely spaced times on an arc, and the values (2n, N) there."""
    a, b = arcs.times[arc : arc + 2]
    times = a + (b - a) * np.linspace(0.0, 1.0, DENSE * arcs.intervals[arc] + 1)
    return times, arcs.at(arc, times)


def sizes(arcs: Arcs) -> Array:
    """Return the magnitude of each constraint along the motion, shape (h,)."""
    places = (_with_controls(arcs, arc) for arc in range(len(arcs.intervals)))
    return np.asarray(np.max([measured(arcs.instance, *place) for place in places], axis=0))


def constrained(arcs: Arcs, arc: int) -> tuple[Array, Array]:
    """Return closely spaced times on an arc, and the values of all constraints there, shape (h, N)."""
    place = _with_controls(arcs, arc)
    return place[0], values(arcs.instance, *place)


def _with_controls(arcs: Arcs, arc: int) -> tuple[Array, Array, Array]:
    """Return closely spaced times on an arc, and the states and controls there."""
    times, z = along(arcs, arc)
    return times, z[: arcs.n], control(arcs.instance, arcs.active[arc], times, z)


def _order(arcs: Arcs, constraint: int) -> int:
    return arcs.instance.model.spec.path_constraints[constraint].order


def _instead(arcs: Arcs, places: int | Iterable[int], *others: Contact) -> Structure:
    """Return the structure with some contacts replaced by others."""
    gone = {places} if isinstance(places, int) else set(places)
    kept = (one for k, one in enumerate(contacts(arcs)) if k not in gone)
    return ordered([*kept, *others], passages(arcs))


def _ends_kept(one: Contact, *parts: Contact) -> list[Contact]:
    """Return parts of a contact, with the flags of lasting from the start or until the end for the outer parts only."""
    return [
        replace(part, opens=one.opens and part.start <= one.start, closes=one.closes and part.end >= one.end)
        for part in parts
    ]


def _touch(one: Contact) -> Contact:
    return Contact(one.constraint, one.middle, one.middle, (sum(one.jumps), 0.0))


def _disordered(arcs: Arcs) -> tuple[str, list[Structure]] | None:
    """Find arcs of negative length, and junctions in the wrong order."""
    lasting, known = arcs.end - arcs.instance.t0, contacts(arcs)
    for place, one in enumerate(known):
        if not one.touches and one.end - one.start < SLACK * lasting:
            tries = [_instead(arcs, place, _touch(one))] if _order(arcs, one.constraint) > 1 else []
            return "an arc on a boundary has no length", [*tries, _instead(arcs, place)]
    if np.diff(arcs.times).min() < -ROUNDED * lasting:
        sorted_ = ordered(known, passages(arcs))
        tries = [sorted_] if _possible(arcs, sorted_) else []
        crossed = [(j, k) for j, k in combinations(range(len(known)), 2) if known[j].end >= known[k].start]
        joins = [_joined(arcs, j, k) for j, k in crossed]
        others = [_instead(arcs, place) for place in range(len(known))]
        return "contacts change places", [*tries, *(one for one in joins if one is not None), *others]
    return None


def _possible(arcs: Arcs, structure: Structure) -> bool:
    """Return whether a structure is possible: controls can keep all active constraints, each once at a time."""
    m = len(arcs.instance.model.spec.controls)
    every = structure.arcs(arcs.instance)
    opposed = any(_opposed(arcs, j, k) for active in every for j, k in combinations(active, 2))
    pairs = combinations(structure.contacts, 2)
    twice = any(a.constraint == b.constraint and max(a.start, b.start) < min(a.end, b.end) for a, b in pairs)
    return not opposed and not twice and max(map(len, every)) <= m


def _opposed(arcs: Arcs, one: int, other: int) -> bool:
    """Return whether two control constraints affect the controls in the same or the opposite direction."""
    if _order(arcs, one) + _order(arcs, other) > 0:
        return False
    z = arcs.node(0, 0)[: arcs.n, None]
    u = control(arcs.instance, FREE, t := np.array([arcs.instance.t0]), arcs.node(0, 0)[:, None])
    e, f = effects(arcs.instance, t, z, u)[[one, other], :, 0]
    return bool((e @ f) ** 2 >= PARALLEL * (e @ e) * (f @ f))


def _joined(arcs: Arcs, one: int, other: int) -> Structure | None:
    """Return the structure with two contacts of incompatible control constraints extended to meet; else ``None``."""
    first, second = contacts(arcs)[one], contacts(arcs)[other]
    if first.constraint == second.constraint or not _opposed(arcs, first.constraint, second.constraint):
        return None
    middle = 0.5 * (first.end + second.start)
    return _instead(arcs, (one, other), replace(first, end=middle), replace(second, start=middle))


def _pulling(arcs: Arcs) -> tuple[str, list[Structure]] | None:
    """Find jumps with a negative multiplier."""
    known = contacts(arcs)
    jumps = _jumps(arcs)
    pressures = [abs(arcs.pressure(k)) for k in arcs.pressed]
    largest = max([*(abs(jump) for *_, jump in jumps), *pressures], default=0.0)
    costates = max(float(np.abs(arcs.nodes(k)[:, arcs.n :]).max()) for k in range(len(arcs.intervals)))

    def none(constraint: int, time: float) -> float:
        t, arc = np.array([time]), int(np.searchsorted(arcs.times[1:-1], time))
        push = float(np.abs(gradient(arcs.instance, constraint, t, arcs.at(arc, t)[: arcs.n])).max())
        return -SLACK * max(largest, costates / max(push, 1e-300))

    for place, one in enumerate(known):
        if min(one.jumps) < none(one.constraint, one.middle):
            tries = [] if one.touches or _order(arcs, one.constraint) < 2 else [_instead(arcs, place, _touch(one))]
            return "a multiplier at a junction is negative", [*tries, _instead(arcs, place)]
    for k, which, jump in jumps:
        if which != arcs.junctions[k].constraint and jump < none(which, float(arcs.times[k + 1])):
            return "a multiplier at a junction is negative", []
    return None


def _jumps(arcs: Arcs) -> list[tuple[int, int, float]]:
    """Return the jumps of all path constraints as junction, constraint and multiplier."""
    met = ((k, one) for k, one in enumerate(arcs.junctions) if one.event is not Event.INTERIOR)
    return [(k, which, arcs.jump(k, which)) for k, one in met for which, _ in one.jumps]


def _one_contact(first: Contact, second: Contact) -> Contact:
    """Return one contact that extends from the start of a contact to the end of a later one."""
    jumps = first.jumps[0], second.jumps[0 if second.touches else 1]
    return Contact(first.constraint, first.start, second.end, jumps, first.opens, second.closes)


def _between(arcs: Arcs, constraint: int, start: float, end: float) -> Array:
    """Return the values of a constraint on the arcs between two times, shape (N,)."""
    inside = [k for k in range(len(arcs.intervals)) if start <= arcs.times[k] and arcs.times[k + 1] <= end]
    return np.concatenate([constrained(arcs, k)[1][constraint] for k in inside] or [np.full(1, np.inf)])


def _rising(arcs: Arcs) -> tuple[str, list[Structure]] | None:
    """Find touch points that would be crossed, because the constraint's second derivative is positive on one side."""
    room, lasting, instance, n = sizes(arcs), arcs.end - arcs.instance.t0, arcs.instance, arcs.n
    for k, junction in enumerate(arcs.junctions):
        if junction.event is not Event.TOUCH:
            continue
        one, t = contacts(arcs)[junction.contact], arcs.times[k + 1 : k + 2]
        for z in (arcs.node(k, -1)[:, None], arcs.node(k + 1, 0)[:, None]):
            u = control(instance, junction.after, t, z)
            rates = np.asarray(instance.model.path_rates_batch(t, z[:n], u, instance.parameters)).reshape(-1, 2)
            if rates[one.constraint, 1] * lasting**2 > ZERO_CURVATURE * room[one.constraint]:
                half = 0.5 * np.sqrt(float(rates[one.constraint, 1]) * lasting**2 / room[one.constraint])
                half = min(half * lasting, 0.25 * lasting, one.start - arcs.times[0], arcs.times[-1] - one.start)
                longer = Contact(one.constraint, one.start - half, one.start + half, (one.jumps[0] / 2,) * 2)
                return "a constraint rises at its touch point", [_instead(arcs, junction.contact, longer)]
    return None


def _violated(arcs: Arcs) -> tuple[str, list[Structure]] | None:
    """Find constraints that are violated between contacts."""
    room, worst = sizes(arcs), None
    if not len(room):
        return None
    for arc, active in enumerate(arcs.active):
        times, g = constrained(arcs, arc)
        g = g / room[:, None]
        g[list(active)] = 0.0
        constraint = int(g.max(axis=1).argmax())
        most = float(g[constraint].max())
        if most > SLACK and (worst is None or most > worst[0]):
            row = g[constraint]
            first, last = next((a, b) for a, b in runs(row > SLACK) if row[a : b + 1].max() == most)
            worst = most, constraint, float(times[first]), float(times[last])
    if worst is None:
        return None
    _, constraint, start, end = worst
    reason = f"{arcs.instance.model.spec.path_constraints[constraint].name} is violated"
    lasting, known = arcs.end - arcs.instance.t0, contacts(arcs)
    found = _merged(arcs, constraint, start, end)
    for place, one in enumerate(known):
        if one.touches and one.constraint == constraint and abs(0.5 * (start + end) - one.start) < BESIDE * lasting:
            half = max(abs(start - one.start), abs(end - one.start), 0.01 * lasting)
            low, high = max(one.start - half, arcs.times[0]), min(one.start + half, arcs.times[-1])
            found.append(_instead(arcs, place, Contact(constraint, low, high, (one.jumps[0] / 2,) * 2)))
    if (within := _instead_of_active(arcs, constraint, start, end)) is not None:
        return reason, [within, *found]
    held = _order(arcs, constraint) == 0
    begins, ends = held and start <= arcs.times[0], held and end >= arcs.times[-1]
    own = Contact(constraint, start, end, opens=begins, closes=ends)
    added = [own] if _order(arcs, constraint) < 2 else [_touch(own), own]
    tries = [*found, *(_instead(arcs, (), each) for each in added)]
    return reason, [one for one in tries if _possible(arcs, one)]


def _instead_of_active(arcs: Arcs, constraint: int, start: float, end: float) -> Structure | None:
    """Return the structure with a violated constraint in place of an active one that is incompatible, or ``None``."""
    for place, one in enumerate(contacts(arcs)):
        if one.touches or not one.start <= 0.5 * (start + end) <= one.end:
            continue
        if not _opposed(arcs, constraint, one.constraint):
            continue
        low, high = max(start, one.start), min(end, one.end)
        parts = [replace(one, end=low), replace(one, constraint=constraint, start=low, end=high)]
        parts.append(replace(one, start=high))
        return _instead(arcs, place, *_ends_kept(one, *(part for part in parts if part.end > part.start)))
    return None


def _merged(arcs: Arcs, constraint: int, start: float, end: float) -> list[Structure]:
    """Return structures with one arc in place of two contacts between which their constraint is violated."""
    known = contacts(arcs)
    own = [k for k, one in enumerate(known) if one.constraint == constraint]
    place = sum(known[k].middle < 0.5 * (start + end) for k in own)
    if not 0 < place < len(own):
        return []
    pair = own[place - 1 : place + 1]
    return [_instead(arcs, pair, _one_contact(*(known[k] for k in pair)))]


def _pulling_along(arcs: Arcs) -> tuple[str, list[Structure]] | None:
    """Find boundary arcs with a negative multiplier; try shorter arcs, or touch points, instead."""
    for place, one in enumerate(contacts(arcs)):
        if one.touches or multiplier(arcs, place)[1].min() >= -SLACK * _pressure(arcs):
            continue
        boundary, reason = one.constraint, "a multiplier along a boundary is negative"
        if _order(arcs, boundary) < 2:
            return reason, [_instead(arcs, place, *_pushing(arcs, place, one))]
        ends = [Contact(boundary, t, t, (jump, 0.0)) for t, jump in zip((one.start, one.end), one.jumps, strict=True)]
        ends = [replace(end, closes=one.closes and end.end >= one.end) for end in ends]
        shorter = [_instead(arcs, place, *parts)] if (parts := _released(arcs, place, one)) else []
        return reason, [*shorter, _instead(arcs, place, *ends), _instead(arcs, place, _touch(one))]
    return None


def simpler(arcs: Arcs) -> list[Structure]:
    """Return structures without superfluous junctions, whose times nothing determines; they need not be extremals."""
    return [one for one in (_without_idle(arcs), _without_gap(arcs)) if one is not None]


def _without_gap(arcs: Arcs) -> Structure | None:
    """Return the structure with two contacts joined to one arc if their constraint stays active between them.

    Control constraints are left out: a bound that the law reaches by itself is no arc (:func:`_without_idle`).
    """
    known, room = contacts(arcs), sizes(arcs)
    for constraint in sorted({one.constraint for one in known}):
        if _order(arcs, constraint) == 0:
            continue
        own = [k for k, one in enumerate(known) if one.constraint == constraint]
        for j, k in pairwise(own):
            if np.abs(_between(arcs, constraint, known[j].end, known[k].start)).max() < SLACK * room[constraint]:
                return _instead(arcs, (j, k), _one_contact(known[j], known[k]))
    return None


def _without_idle(arcs: Arcs) -> Structure | None:
    """Return the structure without superfluous arcs of control constraints; ``None`` if it has none.

    The multiplier of such an arc vanishes because the law keeps the constraint by itself, so its ends are undetermined.
    """
    room, idle = sizes(arcs), list[int]()
    for place, one in enumerate(contacts(arcs)):
        if _order(arcs, one.constraint) > 0:
            continue
        push = (deciding(arcs.instance, active, one.constraint, t, z) for active, t, z in _of(arcs, one))
        if max(float(np.abs(by).max()) for by in push) <= SLACK / 2 * room[one.constraint]:
            idle.append(place)
    return _instead(arcs, idle) if idle else None


def _of(arcs: Arcs, one: Contact) -> Iterable[tuple[Active, Array, Array]]:
    """Yield active constraints, times and values on each arc of a contact."""
    for arc, active in enumerate(arcs.active):
        a, b = arcs.times[arc : arc + 2]
        if one.constraint in active and one.start <= 0.5 * (a + b) <= one.end:
            yield active, *along(arcs, arc)


def _pushing(arcs: Arcs, place: int, one: Contact) -> list[Contact]:
    """Return the parts of an arc with positive multiplier; none for constraints on states alone."""
    if _order(arcs, one.constraint) > 0:
        return []
    times, eta = multiplier(arcs, place)
    parts = (replace(one, start=float(times[a]), end=float(times[b])) for a, b in runs(eta > 0.0) if b > a)
    return _ends_kept(one, *parts)


def _released(arcs: Arcs, place: int, one: Contact) -> list[Contact]:
    """Return the longest part of an arc with positive multiplier, and touch points in place of its former ends.

    The new arc is a little shorter than this part, since a free arc beside a touch point shortens it further.
    """
    times, eta = multiplier(arcs, place)
    margin = BESIDE * (one.end - one.start)
    first, last = max(runs(eta > 0.0), key=lambda run: run[1] - run[0], default=(0, 0))
    start, end = float(times[first]) + margin, float(times[last]) - margin
    if not start < end:
        return []
    begins, ends = first == 0, last == len(times) - 1
    jumps = one.jumps[0] if begins else 0.0, one.jumps[1] if ends else 0.0
    low, high = one.start if begins else start, one.end if ends else end
    return [
        *([] if begins else [Contact(one.constraint, one.start, one.start, (one.jumps[0], 0.0))]),
        *_ends_kept(one, replace(one, start=low, end=high, jumps=jumps)),
        *([] if ends else [Contact(one.constraint, one.end, one.end, (one.jumps[1], 0.0))]),
    ]


def multiplier(arcs: Arcs, place: int) -> tuple[Array, Array]:
    """Return times along a contact, and its multiplier eta there, shapes (N,)."""
    one, times, eta = contacts(arcs)[place], [], []
    for active, t, z in _of(arcs, one):
        times.append(t)
        eta.append(multipliers(arcs.instance, active, t, z)[active.index(one.constraint)])
    return np.concatenate(times), np.concatenate(eta)


def _pressure(arcs: Arcs) -> float:
    """Return the scale of multipliers: the largest along arcs, or of jumps divided by the duration."""
    arcs_of = [k for k, one in enumerate(contacts(arcs)) if not one.touches]
    along_arcs = [float(np.abs(multiplier(arcs, k)[1]).max()) for k in arcs_of]
    jumps = [abs(jump) for *_, jump in _jumps(arcs)]
    jumps += [abs(arcs.pressure(k)) for k in arcs.pressed]
    return max([*along_arcs, *(jump / (arcs.end - arcs.instance.t0) for jump in jumps), 1e-300])
