"""Which constraints are active when: contacts with boundaries, and the arcs into which they cut the time."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import Enum
from itertools import groupby, pairwise

from satsym.instance import Instance
from satsym.solution import Event as Happening
from satsym.solution import Solution


class Event(Enum):
    """What happens between two arcs."""

    ENTRY = "entry"
    EXIT = "exit"
    TOUCH = "touch"
    INTERIOR = "interior"


Active = tuple[int, ...]
"""Constraints on whose boundaries an arc runs, by their numbers in order."""

FREE: Active = ()
"""On no boundary."""


ROUNDED = 1e-12
"""Share of a time by which two that are the same may differ."""


@dataclass(frozen=True)
class Contact:
    """A constraint on its boundary, from one time to another; for an instant where these are the same."""

    constraint: int
    start: float
    end: float
    jumps: tuple[float, float] = (0.0, 0.0)
    """Multipliers at both of its ends, to begin with; a touch point has the first."""
    opens: bool = False
    """Whether it holds from the start of the motion on."""
    closes: bool = False
    """Whether it holds until the end; a touch point is then met at the end alone."""

    @property
    def touches(self) -> bool:
        """Whether it lasts for an instant only."""
        return self.start == self.end

    @property
    def middle(self) -> float:
        """The middle of both times."""
        return 0.5 * (self.start + self.end)


@dataclass(frozen=True)
class Passage:
    """A point on the way that must be passed."""

    time: float
    jumps: tuple[tuple[int, float], ...]
    """Its conditions, numbered after the path constraints, with multipliers to begin with."""


@dataclass(frozen=True)
class Junction:
    """What happens between two arcs."""

    event: Event
    contact: int
    """Whose event it is, by its number; of a point on the way that of the point."""
    constraint: int
    time: float
    left: int | None
    """The contact that ends where this one begins: from one boundary directly to another."""
    before: Active
    after: Active
    jumps: tuple[tuple[int, float], ...]
    """Constraints along whose gradients costates may jump, with multipliers to begin with."""


@dataclass(frozen=True)
class Structure:
    """Contacts in order of their middles; those of different constraints may overlap.

    Controls may jump where a point on the way is passed, so that contacts end there, and others begin.
    """

    contacts: tuple[Contact, ...]
    passages: tuple[Passage, ...] = ()

    def junctions(self, instance: Instance) -> list[Junction]:
        """Where arcs meet, in order of time.

        Costates jump where a constraint of order two begins or ends to be active. Where another one of order two stays
        active at any junction, its own conditions there ask for a jump along its gradient, too.
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
        """Times, kinds, and contacts of all junctions."""
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
        """Constraints whose contacts end where a point is passed, and those whose contacts begin there."""
        lasting = [one for one in self.contacts if not one.touches]
        ended, started = ({one.constraint for one in lasting if at(one) == time} for at in (_end, _start))
        return ended, started

    def joined(self, contact: int) -> bool:
        """Whether another contact begins where this one ends: from one boundary directly to another."""
        one = self.contacts[contact]
        if one.touches or any(each.time == one.end for each in self.passages):
            return False
        return any(each.start == one.end and not each.touches for each in self.contacts)

    def _followed(self, contact: int) -> int | None:
        """The contact that ends where this one begins."""
        start = self.contacts[contact].start
        places = (k for k, each in enumerate(self.contacts) if each.end == start and not each.touches)
        return next(places, None)

    @property
    def begun(self) -> Active:
        """What is active from the start on."""
        return tuple(sorted(one.constraint for one in self.contacts if one.opens and not one.touches))

    @property
    def ended(self) -> Active:
        """What is active at the end, or touched there."""
        return tuple(sorted(one.constraint for one in self.contacts if one.closes))

    def arcs(self, instance: Instance) -> list[Active]:
        """What is active on each arc."""
        return [self.begun, *(one.after for one in self.junctions(instance))]

    def name(self, instance: Instance) -> str:
        """For messages: ``free, wall, free``; touch points in brackets, what is active at once with plus signs."""
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
        """What two of them have in common that differ in times only."""
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
    """The structure of contacts in any order, those cut within which a point on the way is passed."""
    parts = [part for one in contacts for part in _cut(one, passages)]
    return Structure(tuple(sorted(parts, key=lambda one: one.middle)), passages)


def _cut(contact: Contact, passages: tuple[Passage, ...]) -> list[Contact]:
    """A contact in parts between points on the way."""
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
    """What is active on each arc between events."""
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
    """The events between start and end, where arcs meet; those of one time together, what begins or touches first."""
    inner = [one for one in solution.events if solution.times[0] < one.t < solution.times[-1]]
    groups = (list(group) for _, group in groupby(inner, key=lambda one: one.t))
    return [tuple(sorted(group, key=lambda one: one.kind == "exit")) for group in groups]


def pressing(solution: Solution) -> Active:
    """The constraints on states that may push at the end: those of the last arc, and those that are touched there."""
    spec = solution.instance.model.spec.path_constraints
    names = [one.name for one in spec]
    last = {names.index(one.name) for one in solution.events if one.t >= solution.times[-1]}
    return tuple(sorted(k for k in last.union(stated_arcs(solution)[-1]) if spec[k].order > 0))
