"""Contacts with the boundaries of path constraints, identified in a motion where multipliers outweigh slacks.

A contact is a boundary arc or a touch point. Multipliers and slacks are each compared relative to their scales.
Neighbouring points form an arc, a few isolated ones a touch point. Two touch points between which the multiplier of a
boundary arc would vanish are joined to one arc later (:mod:`satsym.solvers.constrained.revision`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.constrained.arcs import conditions, decided_at_end, effects, given_end, gradients, values
from satsym.solvers.constrained.structure import Contact, Passage, Structure, ordered
from satsym.solvers.search.motion import Motion
from satsym.solvers.switching.trajectory import runs

CLOSE_SLACK = 1e-3
"""Slack, relative to the largest one, below which a point counts as close to a boundary."""

SMALL_SLACK = 1e-2
"""Minimum scale of the slacks of a constraint, relative to its terms, used if all slacks are smaller."""

NOTHING = 1e-6
"""Contribution of a constraint to the costates, relative to their magnitude, below which it is ignored."""

ON_BOUNDARY = 1e-9
"""Largest distance from the boundary, relative to the constraint's magnitude, at which a motion counts as starting on
it."""

INSTANT = 2
"""Maximum number of steps between points over which the multiplier of a touch point is spread."""

PARALLEL = 1.0 - 1e-6
"""Squared cosine between the effects of two constraints on the controls above which the effects count as parallel."""


@dataclass(frozen=True, eq=False)
class Along:
    """Path constraints along a motion, at all points but the first."""

    at: Motion

    @property
    def instance(self) -> Instance:
        """The instance with the values that were found for its free quantities."""
        return self.at.instance

    @property
    def times(self) -> Array:
        """Times of the points, shape (N,)."""
        return self.at.times[1:]

    @cached_property
    def kept(self) -> Array:
        """Ones and zeros (h, N): zero for a constraint at the final time if given final states determine it."""
        table = np.ones(self.at.pushes.shape)
        table[decided_at_end(self.instance), -1] = 0.0
        return table

    @cached_property
    def pushes(self) -> Array:
        """Multipliers times the time weights of the points, shape (h, N)."""
        return np.maximum(self.at.pushes, 0.0) * self.kept

    @cached_property
    def slopes(self) -> tuple[Array, Array]:
        """Gradients of the constraints by states and by controls, shapes (h, n, N) and (h, m, N)."""
        place = self.instance, self.times, self.at.x[:, 1:], self.at.u
        return gradients(*place), effects(*place)

    @cached_property
    def slacks(self) -> Array:
        """Slacks, the amounts by which constraints are below zero, shape (h, N)."""
        return np.maximum(-values(self.instance, self.times, self.at.x[:, 1:], self.at.u), 0.0)

    @cached_property
    def rooms(self) -> Array:
        """Scale of each constraint, shape (h,): the largest slack or, if that is larger, the largest sum of terms."""
        by_x, by_u = self.slopes
        terms = (np.abs(by_x) * np.abs(self.at.x[:, 1:])).sum(axis=1) + (np.abs(by_u) * np.abs(self.at.u)).sum(axis=1)
        found = np.maximum(self.slacks, terms).max(axis=1)
        return np.where(found > 0.0, found, 1.0)

    @cached_property
    def reaches(self) -> Array:
        """The longer of the two steps beside each point, shape (N,)."""
        steps = np.diff(self.at.times)
        return np.maximum(steps, np.append(steps[1:], 0.0))


def read(at: Motion, resting: bool = False) -> Structure:
    """Return the structure of contacts and waypoints that a motion shows.

    Parameters
    ----------
    resting
        Whether contacts are joined if slacks between them stay small, although multipliers vanish there.
    """
    held, found = Along(at), list[Contact]()
    by_x, costates = held.slopes[0], np.abs(at.lam).max(axis=1)[:, None]
    for k, one in enumerate(held.instance.model.spec.path_constraints):
        s, z = held.slacks[k], held.pushes[k]
        room = max(float(s.max()), SMALL_SLACK * float(held.rooms[k]))
        near = (s < CLOSE_SLACK * room) & (held.kept[k] > 0.0)
        pushing = (np.abs(by_x[k]) * z / np.maximum(costates, NOTHING * costates.max() + 1e-300)).max(axis=0)
        counts = near & (z / max(float(z.max()), 1e-300) > s / room)
        for first, last in _spans(near, counts) if resting else runs(_bridged(counts)):
            if one.order == 0 or pushing[first : last + 1].sum() > NOTHING:
                found.append(_contact(held, k, one.order, first, last))
    return ordered([_with_ends(held, one) for one in _meeting(held, found)], _passages(at))


def _passages(at: Motion) -> tuple[Passage, ...]:
    """Return the waypoints with their times and the multipliers of the costate jumps there."""
    which, first = conditions(at.instance), len(at.instance.model.spec.path_constraints)
    jumps = (tuple((k, float(at.jumps[k - first])) for k in own) for own in which)
    return tuple(Passage(time, own) for time, own in zip(at.passed.tolist(), jumps, strict=True))


def _bridged(flags: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return flags of points, also set where both neighbouring points are flagged."""
    found = flags.copy()
    found[1:-1] |= flags[:-2] & flags[2:]
    return found


def _spans(near: NDArray[np.bool_], counts: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return the first and last flagged point of each run of points that are near the boundary of a constraint."""
    inside = (np.flatnonzero(counts[a : b + 1]) + a for a, b in runs(_bridged(near)))
    return [(int(places[0]), int(places[-1])) for places in inside if len(places)]


def _contact(held: Along, constraint: int, order: int, begins: int, ends: int) -> Contact:
    """Return a boundary arc or a touch point from the interval in which multipliers are significant."""
    times, z = held.times, held.pushes[constraint]
    if order > 1 and ends - begins <= INSTANT:
        weight = z[begins : ends + 1]
        time = float(times[begins : ends + 1] @ weight / weight.sum())
        return Contact(constraint, time, time, (float(weight.sum()), 0.0))
    step = float(held.reaches[begins])
    jumps = (float(z[begins : begins + 3].sum()), float(z[max(ends - 2, begins + 1) : ends + 1].sum()))
    start, end = float(times[begins]), float(times[ends])
    if end - start < step:
        start, end = start - step, end + step
    return Contact(constraint, start, end, jumps)


def _with_ends(held: Along, contact: Contact) -> Contact:
    """Return the contact, extended to the initial or final time if the constraint is active there, else unchanged."""
    one, order = held.instance, held.instance.model.spec.path_constraints[contact.constraint].order
    opens = not contact.touches and contact.start - one.t0 < 1.5 * held.reaches[0] and _on_boundary(held, contact)
    end, step = float(held.times[-1]), 1.5 * float(held.reaches[-1])
    away = not _on_boundary_at_end(held, contact)
    if away or end - contact.end >= step or (order > 1 and not contact.touches):
        return replace(contact, opens=opens)
    start = end if end - contact.start <= step else contact.start
    return replace(contact, start=start, end=end, opens=opens and start < end, closes=True)


def _meeting(held: Along, contacts: list[Contact]) -> list[Contact]:
    """Return contacts with gaps of one step closed between control constraints that follow each other directly.

    These are constraints that cannot be active at the same time, because they affect the controls in parallel.
    """
    found, effect = sorted(contacts, key=lambda one: one.middle), held.slopes[1]
    orders = [one.order for one in held.instance.model.spec.path_constraints]
    for j, k in combinations(range(len(found)), 2):
        one, other = found[j], found[k]
        middle = 0.5 * (one.end + other.start)
        place = int(np.abs(held.times - middle).argmin())
        both = orders[one.constraint] == 0 == orders[other.constraint] and one.constraint != other.constraint
        if both and abs(other.start - one.end) < 1.5 * held.reaches[place]:
            e, f = effect[[one.constraint, other.constraint], :, place]
            along = (e @ f) ** 2 >= PARALLEL * (e @ e) * (f @ f)
            if along and one.start < middle < other.end:
                found[j], found[k] = replace(one, end=middle), replace(other, start=middle)
    return found


def _on_boundary_at_end(held: Along, contact: Contact) -> bool:
    """Return whether a constraint may be active at the final time, unless given final states exclude it."""
    one, constraint = held.instance, contact.constraint
    if one.tf is None or held.kept[constraint, -1] > 0.0:
        return True
    x = np.nan_to_num(given_end(one, one.tf))[:, None]
    ended = values(one, np.array([one.tf]), x, np.zeros((len(one.model.spec.controls), 1)))[constraint, 0]
    return bool(abs(ended) <= ON_BOUNDARY * held.rooms[constraint])


def _on_boundary(held: Along, contact: Contact) -> bool:
    """Return whether a constraint is active at the initial time, or may be because it involves the control."""
    one, constraint = held.instance, contact.constraint
    if one.model.spec.path_constraints[constraint].order == 0:
        return True
    u = np.zeros((len(one.model.spec.controls), 1))
    begun = values(one, np.array([one.t0]), np.array(one.initial)[:, None], u)[constraint, 0]
    return bool(abs(begun) <= ON_BOUNDARY * held.rooms[constraint])
