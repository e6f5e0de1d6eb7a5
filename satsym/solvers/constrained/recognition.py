"""The structure that a regularised path shows: where multipliers are larger, in their measure, than slacks in theirs.

Neighbouring nodes make an arc, a few of them alone a touch point. Two touch points between which the multiplier of a
boundary arc vanishes are taken for one arc later (:mod:`satsym.solvers.constrained.revision`).
"""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.solvers.constrained.arcs import values
from satsym.solvers.constrained.regularised.interior_point import Path
from satsym.solvers.constrained.regularised.slopes import constraint_slopes, rooms
from satsym.solvers.constrained.regularised.transcription import Program
from satsym.solvers.constrained.structure import Contact, Structure, ordered
from satsym.solvers.switching.trajectory import runs

CLOSE = 1e-3
"""A slack of this share of the largest is small: nodes meet a boundary only nearly."""

SMALL = 1e-4
"""Where no slack is larger than this share of a constraint's terms, these are what slacks are measured by."""

NOTHING = 1e-6
"""Share of the costates below which what a constraint adds to them is nothing."""

ON_BOUNDARY = 1e-9
"""Share of its size along the way by which a constraint may be off its boundary where a motion starts on it."""

INSTANT = 2
"""Intervals within which multipliers of a touch point are spread."""


PARALLEL = 1.0 - 1e-6
"""Squared cosine of the effects of two constraints on the controls from which on they are the same, or opposed."""


def recognised(program: Program, path: Path, resting: bool = False) -> Structure:
    """Contacts with all constraints, those of an order of one as arcs.

    Parameters
    ----------
    resting
        Whether contacts between which slacks stay small are one, though multipliers vanish there.
    """
    found: list[Contact] = []
    model, at = program.instance.model, path.at
    nodes, between = (np.real(program.times(at.duration, middle)) for middle in (False, True))
    g_x, terms = constraint_slopes(program, at)[0], rooms(program, at)
    costates = np.abs(at.y).max(axis=1)
    for k, one in enumerate(model.spec.path_constraints):
        s, z = at.s[k], at.z[k] * program.kept[k]
        room = max(float(s.max()), SMALL * float(terms[k, 0]))
        near = (s < CLOSE * room) & (program.kept[k] > 0.0)
        pushing = (np.abs(g_x[k]) * z / np.maximum(costates[:, None], NOTHING * costates.max() + 1e-300)).max(axis=0)
        counts = near & (z / max(float(z.max()), 1e-300) > s / room)
        for first, last in _spans(near, counts) if resting else runs(_bridged(counts)):
            if one.order == 0 or pushing[first : last + 1].sum() > NOTHING:
                found.append(_contact(k, one.order, between if one.order == 0 else nodes, z, first, last))
    found = _meeting(program, path, found, nodes)
    return ordered([_with_ends(program, one, nodes, terms[:, 0]) for one in found])


def _bridged(flags: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """With single gaps closed."""
    found = flags.copy()
    found[1:-1] |= flags[:-2] & flags[2:]
    return found


def _spans(near: NDArray[np.bool_], counts: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """From the first to the last place that counts, in each run of those that are near."""
    inside = (np.flatnonzero(counts[a : b + 1]) + a for a, b in runs(_bridged(near)))
    return [(int(places[0]), int(places[-1])) for places in inside if len(places)]


def _contact(constraint: int, order: int, times: Array, z: Array, begins: int, ends: int) -> Contact:
    """An arc or a touch point where multipliers count."""
    if order > 1 and ends - begins <= INSTANT:
        weight = z[begins : ends + 1]
        time = float(times[begins : ends + 1] @ weight / weight.sum())
        return Contact(constraint, time, time, (float(weight.sum()), 0.0))
    step = float(times[1] - times[0])
    jumps = (float(z[begins : begins + 3].sum()), float(z[max(ends - 2, begins + 1) : ends + 1].sum()))
    start, end = float(times[begins]), float(times[ends])
    if end - start < step:
        start, end = start - step, end + step
    return Contact(constraint, start, end, jumps)


def _with_ends(program: Program, contact: Contact, times: Array, sizes: Array) -> Contact:
    """A contact that holds from the start on, or until the end, if it does; constraints have sizes."""
    one, step = program.instance, 1.5 * float(times[1] - times[0])
    opens = not contact.touches and contact.start - one.t0 < step and _on_boundary(program, contact.constraint, sizes)
    order, end = one.model.spec.path_constraints[contact.constraint].order, float(times[-1])
    away = not _on_boundary_at_end(program, contact.constraint, sizes)
    if away or end - contact.end >= step or (order > 1 and not contact.touches):
        return replace(contact, opens=opens)
    start = end if end - contact.start <= step else contact.start
    return replace(contact, start=start, end=end, opens=opens and start < end, closes=True)


def _meeting(program: Program, path: Path, contacts: list[Contact], times: Array) -> list[Contact]:
    """Without the gaps of a step between constraints that hold controls and follow each other.

    Those do that cannot be active at once: they push controls the same way, or against each other.
    """
    found, step = sorted(contacts, key=lambda one: one.middle), 1.5 * float(times[1] - times[0])
    effect = constraint_slopes(program, path.at)[1]
    for j, k in combinations(range(len(found)), 2):
        one, other = found[j], found[k]
        held = program.holding[one.constraint] and program.holding[other.constraint]
        if held and one.constraint != other.constraint and abs(other.start - one.end) < step:
            middle, (e, f) = 0.5 * (one.end + other.start), effect[[one.constraint, other.constraint]]
            along = (e * f).sum(axis=0) ** 2 >= PARALLEL * (e * e).sum(axis=0) * (f * f).sum(axis=0)
            if along[int(np.abs(times - middle).argmin())] and one.start < middle < other.end:
                found[j], found[k] = replace(one, end=middle), replace(other, start=middle)
    return found


def _on_boundary_at_end(program: Program, constraint: int, sizes: Array) -> bool:
    """Whether a constraint may be on its boundary at the end, where given states alone may decide that it is not."""
    one, n = program.instance, len(program.instance.initial)
    if one.tf is None or program.kept[constraint, -1] > 0.0:
        return True
    given, t = np.isin(np.arange(n), program.given), np.array([one.tf])
    x = np.where(given, program.target(one.tf - one.t0), 0.0)[:, None]
    ended = values(one, t, x, np.zeros((len(one.model.spec.controls), 1)))[constraint, 0]
    return bool(abs(ended) <= ON_BOUNDARY * sizes[constraint])


def _on_boundary(program: Program, constraint: int, sizes: Array) -> bool:
    """Whether a constraint is on its boundary at the start, or may be because it holds a control."""
    if program.holding[constraint]:
        return True
    one, t = program.instance, np.array([program.instance.t0])
    u = np.zeros((len(one.model.spec.controls), 1))
    begun = values(one, t, np.array(one.initial)[:, None], u)[constraint, 0]
    return bool(abs(begun) <= ON_BOUNDARY * sizes[constraint])
