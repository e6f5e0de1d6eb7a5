"""What is wrong with an extremal of a structure, and which structures to try instead."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.arrays import Array
from satsym.solvers.constrained.arcs import Arcs, control, gradient, values
from satsym.solvers.constrained.arcs import multiplier as multiplier_of
from satsym.solvers.constrained.arcs import sizes as measured
from satsym.solvers.constrained.structure import FREE, Contact, Event, Structure
from satsym.solvers.switching.trajectory import runs

SLACK = 1e-9
"""Violation of a constraint, relative to its size along the way, and negative share of a multiplier, that are none."""

STEEP = 1e-7
"""Second rate of a constraint at a touch point, times the square of the duration and over its size, that is none."""

DENSE = 8
"""Places an interval at which constraints are looked at."""

BESIDE = 0.05
"""Share of the duration around a touch point within which a violation makes an arc of it."""


def wrong(arcs: Arcs) -> tuple[str, list[Structure]]:
    """A reason why this is no extremal of the problem, empty if it is one; and what to try instead."""
    flaws = (_disordered, _pulling, _resting, _violated, _rising, _pulling_along)
    return next((found for found in (flaw(arcs) for flaw in flaws) if found is not None), ("", []))


def contacts(arcs: Arcs) -> list[Contact]:
    """The contacts of the structure, with the times and jumps that were found."""
    found, times = [], arcs.times
    k = 0
    pressed = (float(arcs.unknown[-1]), 0.0) if arcs.pressed else (0.0, 0.0)
    for number, one in enumerate(arcs.structure.contacts):
        last = number == len(arcs.structure.contacts) - 1
        if one.touches and last and arcs.structure.ends:
            found.append(Contact(one.constraint, float(times[-1]), float(times[-1]), pressed))
            continue
        if one.touches:
            found.append(Contact(one.constraint, float(times[k + 1]), float(times[k + 1]), (arcs.jump(k), 0.0)))
            k += 1
            continue
        start, end, jumps = float(times[0]), float(times[-1]), [0.0, 0.0]
        if number > 0 and arcs.structure.joined(number - 1):
            k -= 1  # the end of the one before is its entry
        if not (number == 0 and arcs.structure.starts):
            start, jumps[0], k = float(times[k + 1]), arcs.jump(k), k + 1
        if arcs.structure.joined(number):
            end, k = float(times[k + 1]), k + 1
        elif not (last and arcs.structure.ends):
            end, jumps[1], k = float(times[k + 1]), arcs.jump(k), k + 1
        else:
            jumps[1] = pressed[0]
        found.append(Contact(one.constraint, start, end, (jumps[0], jumps[1])))
    return found


def along(arcs: Arcs, arc: int) -> tuple[Array, Array]:
    """Times between the nodes and values (2n, N) there."""
    a, b = arcs.times[arc : arc + 2]
    times = a + (b - a) * np.linspace(0.0, 1.0, DENSE * arcs.intervals[arc] + 1)
    return times, arcs.at(arc, times)


def sizes(arcs: Arcs) -> Array:
    """Of each constraint along the way, shape (h,)."""
    places = (_with_controls(arcs, arc) for arc in range(len(arcs.intervals)))
    return np.asarray(np.max([measured(arcs.instance, *place) for place in places], axis=0))


def constrained(arcs: Arcs, arc: int) -> tuple[Array, Array]:
    """Times between the nodes of an arc and all constraints there, shape (h, N)."""
    place = _with_controls(arcs, arc)
    return place[0], values(arcs.instance, *place)


def _with_controls(arcs: Arcs, arc: int) -> tuple[Array, Array, Array]:
    """Times between the nodes, states and controls there."""
    times, z = along(arcs, arc)
    return times, z[: arcs.n], control(arcs.instance, arcs.structure.arcs[arc], times, z)


def _order(arcs: Arcs, constraint: int) -> int:
    return arcs.instance.model.spec.path_constraints[constraint].order


def _instead(arcs: Arcs, place: int | slice, *others: Contact) -> Structure:
    """The structure with other contacts in place of one or some; flags of ends hold for what stays an arc there."""
    kept = contacts(arcs)
    kept[place if isinstance(place, slice) else slice(place, place + 1)] = others
    first, last = arcs.times[0], arcs.times[-1]
    starts = arcs.structure.starts and bool(kept) and kept[0].start <= first
    return Structure(tuple(kept), starts, arcs.structure.ends and bool(kept) and kept[-1].end >= last)


def _touch(one: Contact) -> Contact:
    return Contact(one.constraint, one.middle, one.middle, (sum(one.jumps), 0.0))


def _disordered(arcs: Arcs) -> tuple[str, list[Structure]] | None:
    """Arcs that end before they begin."""
    lasting = arcs.end - arcs.instance.t0
    for place, one in enumerate(contacts(arcs)):
        if not one.touches and one.end - one.start < SLACK * lasting:
            tries = [_instead(arcs, place, _touch(one))] if _order(arcs, one.constraint) > 1 else []
            return "an arc on a boundary has no length", [*tries, _instead(arcs, place)]
    if np.diff(arcs.times).min() <= 0.0:
        known = contacts(arcs)
        joins = [_joined(arcs, k) for k in range(len(known) - 1) if known[k].end >= known[k + 1].start]
        others = [_instead(arcs, place) for place in range(len(known))]
        return "contacts change places", [*(one for one in joins if one is not None), *others]
    return None


def _joined(arcs: Arcs, place: int) -> Structure | None:
    """With no free arc between two contacts, of constraints that hold controls."""
    first, second = contacts(arcs)[place : place + 2]
    if _order(arcs, first.constraint) + _order(arcs, second.constraint) > 0:
        return None
    middle = 0.5 * (first.end + second.start)
    kept = replace(first, end=middle), replace(second, start=middle)
    return _instead(arcs, slice(place, place + 2), *kept)


def _pulling(arcs: Arcs) -> tuple[str, list[Structure]] | None:
    """Jumps with a negative multiplier."""
    known = contacts(arcs)
    largest = max([abs(jump) for one in known for jump in one.jumps], default=0.0)
    costates = max(float(np.abs(arcs.nodes(k)[:, arcs.n :]).max()) for k in range(len(arcs.intervals)))
    for place, one in enumerate(known):
        t, arc = np.array([one.middle]), int(np.searchsorted(arcs.times[1:-1], one.middle))
        push = float(np.abs(gradient(arcs.instance, one.constraint, t, arcs.at(arc, t)[: arcs.n])).max())
        if min(one.jumps) < -SLACK * max(largest, costates / max(push, 1e-300)):
            tries = [] if one.touches or _order(arcs, one.constraint) < 2 else [_instead(arcs, place, _touch(one))]
            return "a multiplier at a junction is negative", [*tries, _instead(arcs, place)]
    return None


def _resting(arcs: Arcs) -> tuple[str, list[Structure]] | None:
    """Free arcs between two touch points that lie on the boundary: they are arcs on it, whose multiplier vanishes."""
    known, room, k = contacts(arcs), sizes(arcs), -1
    for arc, boundary in enumerate(arcs.structure.arcs):
        k += arc > 0 and boundary < 0
        if boundary >= 0 or not 0 <= k < len(known) - 1:
            continue
        first, second = known[k : k + 2]
        both = first.constraint
        if not (first.touches and second.touches and second.constraint == both):
            continue
        if np.abs(constrained(arcs, arc)[1][both]).max() < SLACK * room[both]:
            one = Contact(both, first.start, second.start, (first.jumps[0], second.jumps[0]))
            return "a free arc lies on a boundary", [_instead(arcs, slice(k, k + 2), one)]
    return None


def _rising(arcs: Arcs) -> tuple[str, list[Structure]] | None:
    """Touch points at which the constraint would be crossed: its second rate is positive on one side."""
    room, lasting, instance, n = sizes(arcs), arcs.end - arcs.instance.t0, arcs.instance, arcs.n
    places = [k for k, one in enumerate(contacts(arcs)) if one.touches and one.start < arcs.end]
    for junction, place in zip(
        [k for k, j in enumerate(arcs.junctions) if j.event is Event.TOUCH], places, strict=True
    ):
        one, t = contacts(arcs)[place], arcs.times[junction + 1 : junction + 2]
        for z in (arcs.node(junction, -1)[:, None], arcs.node(junction + 1, 0)[:, None]):
            u = control(instance, FREE, t, z)
            rates = np.asarray(instance.model.path_rates_batch(t, z[:n], u, instance.parameters)).reshape(-1, 2)
            if rates[one.constraint, 1] * lasting**2 > STEEP * room[one.constraint]:
                half = 0.5 * np.sqrt(float(rates[one.constraint, 1]) * lasting**2 / room[one.constraint])
                half = min(half * lasting, 0.25 * lasting, one.start - arcs.times[0], arcs.times[-1] - one.start)
                longer = Contact(one.constraint, one.start - half, one.start + half, (one.jumps[0] / 2,) * 2)
                return "a constraint rises at its touch point", [_instead(arcs, place, longer)]
    return None


def _violated(arcs: Arcs) -> tuple[str, list[Structure]] | None:
    """Constraints that are positive between contacts."""
    room, worst = sizes(arcs), None
    for arc, boundary in enumerate(arcs.structure.arcs):
        times, g = constrained(arcs, arc)
        g = g / room[:, None]
        if boundary >= 0:
            g[boundary] = 0.0
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
    gap = slice((first := sum(one.middle < 0.5 * (start + end) for one in known)), first)
    own = Contact(constraint, start, end)
    added = [own] if _order(arcs, constraint) < 2 else [_touch(own), own]
    return reason, found + [_instead(arcs, gap, each) for each in added]


def _instead_of_active(arcs: Arcs, constraint: int, start: float, end: float) -> Structure | None:
    """With a constraint active in place of another while it is violated, both of which hold controls."""
    for place, one in enumerate(contacts(arcs)):
        if one.touches or not one.start <= 0.5 * (start + end) <= one.end:
            continue
        if _order(arcs, constraint) + _order(arcs, one.constraint) > 0:
            return None
        low, high = max(start, one.start), min(end, one.end)
        parts = [replace(one, end=low), Contact(constraint, low, high), replace(one, start=high)]
        return _instead(arcs, place, *(part for part in parts if part.end > part.start))
    return None


def _merged(arcs: Arcs, constraint: int, start: float, end: float) -> list[Structure]:
    """With one arc in place of two contacts with a constraint between which it is violated."""
    known = contacts(arcs)
    place = sum(one.middle < 0.5 * (start + end) for one in known)
    if not 0 < place < len(known):
        return []
    first, second = known[place - 1 : place + 1]
    if first.constraint != constraint or second.constraint != constraint:
        return []
    jumps = first.jumps[0], second.jumps[0 if second.touches else 1]
    return [_instead(arcs, slice(place - 1, place + 1), Contact(constraint, first.start, second.end, jumps))]


def _pulling_along(arcs: Arcs) -> tuple[str, list[Structure]] | None:
    """Boundary arcs with a negative multiplier somewhere: shorter ones, touch points at both ends, or one."""
    known, place = contacts(arcs), -1
    for arc, boundary in enumerate(arcs.structure.arcs):
        if boundary < 0:
            continue
        place = next(k for k in range(place + 1, len(known)) if not known[k].touches)
        if multiplier(arcs, arc).min() >= -SLACK * _pressure(arcs):
            continue
        one, reason = known[place], "a multiplier along a boundary is negative"
        if _order(arcs, boundary) < 2:
            return reason, [_instead(arcs, place, *_pushing(arcs, arc, one))]
        ends = [Contact(boundary, t, t, (jump, 0.0)) for t, jump in zip((one.start, one.end), one.jumps, strict=True)]
        shorter = [_instead(arcs, place, *parts)] if (parts := _released(arcs, arc, one)) else []
        return reason, [*shorter, _instead(arcs, place, *ends), _instead(arcs, place, _touch(one))]
    return None


def _pushing(arcs: Arcs, arc: int, one: Contact) -> list[Contact]:
    """Where the multiplier along an arc is positive; of a constraint on states alone nowhere, as it has to be kept."""
    if _order(arcs, one.constraint) > 0:
        return []
    times = along(arcs, arc)[0]
    return [Contact(one.constraint, float(times[a]), float(times[b])) for a, b in runs(multiplier(arcs, arc) > 0.0)]


def _released(arcs: Arcs, arc: int, one: Contact) -> list[Contact]:
    """Where the multiplier along an arc is positive longest, with touch points in place of the ends that are left.

    The arc begins and ends within, as a free arc beside a touch point makes it shorter still.
    """
    times, margin = along(arcs, arc)[0], BESIDE * (one.end - one.start)
    first, last = max(runs(multiplier(arcs, arc) > 0.0), key=lambda run: run[1] - run[0], default=(0, 0))
    start, end = float(times[first]) + margin, float(times[last]) - margin
    if not start < end:
        return []
    begins, ends = first == 0, last == len(times) - 1
    jumps = one.jumps[0] if begins else 0.0, one.jumps[1] if ends else 0.0
    return [
        *([] if begins else [Contact(one.constraint, one.start, one.start, (one.jumps[0], 0.0))]),
        Contact(one.constraint, one.start if begins else start, one.end if ends else end, jumps),
        *([] if ends else [Contact(one.constraint, one.end, one.end, (one.jumps[1], 0.0))]),
    ]


def multiplier(arcs: Arcs, arc: int) -> Array:
    """eta along an arc on a boundary, shape (N,)."""
    times, z = along(arcs, arc)
    return multiplier_of(arcs.instance, arcs.structure.arcs[arc], times, z)


def _pressure(arcs: Arcs) -> float:
    """What multipliers are measured by: the largest of them, or jumps over the duration."""
    along_arcs = [float(np.abs(multiplier(arcs, k)).max()) for k, b in enumerate(arcs.structure.arcs) if b >= 0]
    jumps = [abs(arcs.jump(k)) for k in range(len(arcs.junctions))]
    jumps += [abs(float(arcs.unknown[-1]))] if arcs.pressed else []
    return max([*along_arcs, *(jump / (arcs.end - arcs.instance.t0) for jump in jumps), 1e-300])
