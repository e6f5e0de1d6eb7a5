"""Structures of constrained extremals: contacts with constraint boundaries, and the arcs between their ends.

A contact is a boundary arc or a touch point of one path constraint.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import Enum
from itertools import groupby, pairwise

from satsym.instance import Instance
from satsym.solution import Event as Happening
from satsym.solution import Solution


class Event(Enum):
    """Kind of a junction between two arcs."""

    ENTRY = "entry"
    EXIT = "exit"
    TOUCH = "touch"
    INTERIOR = "interior"


Active = tuple[int, ...]
"""Indices of the constraints that are active on an arc, in ascending order."""

FREE: Active = ()
"""No active constraint."""


ROUNDED = 1e-12
"""Relative difference of two times that count as equal."""


@dataclass(frozen=True)
class Contact:
    """An interval on which a constraint is active: a boundary arc, or a touch point if start and end are equal."""

    constraint: int
    start: float
    end: float
    jumps: tuple[float, float] = (0.0, 0.0)
    """Initial guesses of the multipliers at both ends; a touch point has the first only."""
    opens: bool = False
    """Whether the constraint is active from the initial time on."""
    closes: bool = False
    """Whether the constraint is active until the final time; a touch point is then at the final time."""

    @property
    def touches(self) -> bool:
        """Return whether the contact is a touch point."""
        return self.start == self.end

    @property
    def middle(self) -> float:
        """Return the mean of both times."""
        return 0.5 * (self.start + self.end)


@dataclass(frozen=True)
class Passage:
    """A waypoint that must be passed."""

    time: float
    jumps: tuple[tuple[int, float], ...]
    """Conditions of the waypoint, by indices after those of the path constraints, with initial guesses of their
    multipliers."""


@dataclass(frozen=True)
class Junction:
    """A junction between two arcs."""

    event: Event
    contact: int
    """Index of the contact that begins, ends or touches here, or of the waypoint."""
    constraint: int
    time: float
    left: int | None
    """Index of another contact that ends where this contact begins, otherwise ``None``."""
    before: Active
    after: Active
    jumps: tuple[tuple[int, float], ...]
    """Constraints along whose gradients costates may jump, with initial guesses of the multipliers."""


@dataclass(frozen=True)
class Structure:
    """Contacts in the order of their mean times; contacts of different constraints may overlap.

    Controls may jump at a waypoint, so that contacts end there and new ones begin.
    """

    contacts: tuple[Contact, ...]
    passages: tuple[Passage, ...] = ()

    def junctions(self, instance: Instance) -> list[Junction]:
        """Return the junctions of arcs, in order of time.

        Costates jump where a constraint of order two becomes active or inactive. If another constraint of order two
        stays active at any junction, its conditions there require a jump along its gradient, too.
        """
        orders = [one.order for one in instance.model.spec.path_constraints]
        known, found = set(self.begun), list[Junction]()
        for time, event, number in self._events():
            if event is Event.INTERIOR:
                before = tuple(sorted(known))
                ended, started = self._changing(time)
                known = (known - ended) | started
                after, jumps = tuple(sorted(known)), list(self.passages[number].jumps)
                found.append(Junction(event, number, number, time, None, before, after, tuple(jumps)))
                continue
            one = self.contacts[number]
            left, before = self._followed(number) if event is Event.ENTRY else None, tuple(sorted(known))
            if event is Event.ENTRY:
                known.add(one.constraint)
            elif event is Event.EXIT:
                known.discard(one.constraint)
            if left is not None:
                known.discard(self.contacts[left].constraint)
            stays = [k for k in before if k in known and k != one.constraint and orders[k] > 1]
            jumps = [(k, 0.0) for k in stays]
            if event is Event.TOUCH or orders[one.constraint] > 1:
                jumps.insert(0, (one.constraint, one.jumps[event is Event.EXIT]))
            found.append(
                Junction(event, number, one.constraint, time, left, before, tuple(sorted(known)), tuple(jumps))
            )
        return found

    def _events(self) -> list[tuple[float, Event, int]]:
        """Return times, kinds, and indices of contacts or waypoints of all junctions."""
        found = [(one.time, Event.INTERIOR, number) for number, one in enumerate(self.passages)]
        passed = {one.time for one in self.passages}
        for number, one in enumerate(self.contacts):
            if one.touches:
                found += [] if one.closes else [(one.start, Event.TOUCH, number)]
                continue
            found += [] if one.opens or one.start in passed else [(one.start, Event.ENTRY, number)]
            lasts = one.closes or one.end in passed or self.joined(number)
            found += [] if lasts else [(one.end, Event.EXIT, number)]
        return sorted(found, key=lambda each: each[0])

    def _changing(self, time: float) -> tuple[set[int], set[int]]:
        """Return the constraints whose contacts end at a waypoint, and the constraints whose contacts begin there."""
        lasting = [one for one in self.contacts if not one.touches]
        ended, started = ({one.constraint for one in lasting if at(one) == time} for at in (_end, _start))
        return ended, started

    def joined(self, contact: int) -> bool:
        """Return whether another contact begins where a given contact ends."""
        one = self.contacts[contact]
        if one.touches or any(each.time == one.end for each in self.passages):
            return False
        return any(each.start == one.end and not each.touches for each in self.contacts)

    def _followed(self, contact: int) -> int | None:
        """Return the index of the contact that ends where a given contact begins, or ``None``."""
        start = self.contacts[contact].start
        places = (k for k, each in enumerate(self.contacts) if each.end == start and not each.touches)
        return next(places, None)

    @property
    def begun(self) -> Active:
        """Return the constraints that are active from the initial time on."""
        return tuple(sorted(one.constraint for one in self.contacts if one.opens and not one.touches))

    @property
    def ended(self) -> Active:
        """Return the constraints that are active or touched at the final time."""
        return tuple(sorted(one.constraint for one in self.contacts if one.closes))

    def arcs(self, instance: Instance) -> list[Active]:
        """Return the active constraints on each arc."""
        return [self.begun, *(one.after for one in self.junctions(instance))]

    def name(self, instance: Instance) -> str:
        """Return the structure as text, such as ``free, wall, free``.

        Touch points are in brackets; simultaneously active constraints are joined by plus signs.
        """
        names = [one.name for one in instance.model.spec.path_constraints]
        points = [one.name for one in instance.model.spec.interior]

        def said(active: Active) -> str:
            return " + ".join(names[k] for k in active) or "free"

        words = [said(self.begun)]
        for one in self.junctions(instance):
            words += [f"[{names[one.constraint]}]"] if one.event is Event.TOUCH else []
            words += [f"[{points[one.constraint]}]"] if one.event is Event.INTERIOR else []
            words.append(said(one.after))
        words += [f"[{names[one.constraint]}]" for one in self.contacts if one.closes and one.touches]
        return ", ".join(words)

    @property
    def key(self) -> tuple[object, ...]:
        """Return a key that is equal for structures that differ in times only."""
        events = (
            (event, *map(frozenset, self._changing(time)))
            if event is Event.INTERIOR
            else (event, self.contacts[k].constraint, self.joined(k))
            for time, event, k in self._events()
        )
        return (self.begun, self.ended, *events)


def _start(contact: Contact) -> float:
    return contact.start


def _end(contact: Contact) -> float:
    return contact.end


def ordered(contacts: Iterable[Contact], passages: tuple[Passage, ...] = ()) -> Structure:
    """Return the structure of contacts given in any order, with contacts divided at waypoints."""
    parts = [part for one in contacts for part in _cut(one, passages)]
    return Structure(tuple(sorted(parts, key=lambda one: one.middle)), passages)


def _cut(contact: Contact, passages: tuple[Passage, ...]) -> list[Contact]:
    """Return the parts of a contact between waypoints."""
    times = [one.time for one in passages]
    near = ROUNDED * (abs(contact.start) + abs(contact.end))
    start, end = (next((t for t in times if abs(t - at) <= near), at) for at in (contact.start, contact.end))
    edges = [start, *(t for t in times if start < t < end), end]
    if len(edges) == 2:
        return [replace(contact, start=start, end=end)]
    return [
        replace(contact, start=a, end=b, opens=contact.opens and a == start, closes=contact.closes and b == end)
        for a, b in pairwise(edges)
    ]


def stated_arcs(solution: Solution) -> list[Active]:
    """Return the active constraints on each arc of a solution, from its events."""
    names = [one.name for one in solution.instance.model.spec.path_constraints]
    known = {names.index(one.name) for one in solution.events if one.t <= solution.times[0]}
    found = [tuple(sorted(known))]
    for group in within(solution):
        for one in group:
            if one.kind == "entry":
                known.add(names.index(one.name))
            elif one.kind == "exit":
                known.discard(names.index(one.name))
        found.append(tuple(sorted(known)))
    return found


def within(solution: Solution) -> list[tuple[Happening, ...]]:
    """Return the events of a solution at its junctions, grouped by time; entries and touch points come before exits."""
    inner = [one for one in solution.events if solution.times[0] < one.t < solution.times[-1]]
    groups = (list(group) for _, group in groupby(inner, key=lambda one: one.t))
    return [tuple(sorted(group, key=lambda one: one.kind == "exit")) for group in groups]


def pressing(solution: Solution) -> Active:
    """Return constraints on states that may have a multiplier at the final time: active on the last arc, or touched."""
    spec = solution.instance.model.spec.path_constraints
    names = [one.name for one in spec]
    last = {names.index(one.name) for one in solution.events if one.t >= solution.times[-1]}
    return tuple(sorted(k for k in last.union(stated_arcs(solution)[-1]) if spec[k].order > 0))
