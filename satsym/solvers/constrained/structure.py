"""Which constraint is active when: contacts with boundaries, and the arcs into which they cut the time."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from satsym.instance import Instance
from satsym.solution import Event as Happening
from satsym.solution import Solution


class Event(Enum):
    """What happens between two arcs."""

    ENTRY = "entry"
    EXIT = "exit"
    TOUCH = "touch"


FREE = -1
"""In place of a constraint's number: on no boundary."""


@dataclass(frozen=True)
class Contact:
    """A constraint on its boundary, from one time to another; for an instant where these are the same."""

    constraint: int
    start: float
    end: float
    jumps: tuple[float, float] = (0.0, 0.0)
    """Multipliers at both of its ends, to begin with; a touch point has the first."""

    @property
    def touches(self) -> bool:
        """Whether it lasts for an instant only."""
        return self.start == self.end

    @property
    def middle(self) -> float:
        """Of both times."""
        return 0.5 * (self.start + self.end)


@dataclass(frozen=True)
class Junction:
    """Between two arcs."""

    event: Event
    constraint: int
    time: float
    jump: float | None
    """Multiplier of the jump of costates to begin with; ``None`` where they do not jump."""


@dataclass(frozen=True)
class Structure:
    """Contacts in order of time, none of which overlaps another."""

    contacts: tuple[Contact, ...]
    starts: bool = False
    """Whether the first of them holds from the start on."""
    ends: bool = False
    """Whether the last of them holds until the end; a touch point is then met at the end alone."""

    def junctions(self, instance: Instance) -> list[Junction]:
        """Where arcs meet."""
        orders, found = [one.order for one in instance.model.spec.path_constraints], list[Junction]()
        for k, one in enumerate(self.contacts):
            jumps = one.jumps if orders[one.constraint] > 1 else (None, None)
            if one.touches and self.ends and k == len(self.contacts) - 1:
                continue
            if one.touches:
                found.append(Junction(Event.TOUCH, one.constraint, one.start, one.jumps[0]))
                continue
            if not (k == 0 and self.starts):
                found.append(Junction(Event.ENTRY, one.constraint, one.start, jumps[0]))
            if not (k == len(self.contacts) - 1 and self.ends) and not self.joined(k):
                found.append(Junction(Event.EXIT, one.constraint, one.end, jumps[1]))
        return found

    def joined(self, contact: int) -> bool:
        """Whether the next contact begins where this one ends: from one boundary directly to another."""
        return contact + 1 < len(self.contacts) and self.contacts[contact].end == self.contacts[contact + 1].start

    @property
    def arcs(self) -> list[int]:
        """The constraint on whose boundary each arc runs, or that none does."""
        found = [] if self.starts else [FREE]
        for k, one in enumerate(self.contacts):
            found += [FREE] if one.touches else [one.constraint] if self.joined(k) else [one.constraint, FREE]
        return found[:-1] if self.ends else found

    def name(self, instance: Instance) -> str:
        """For messages: ``free, wall, free``; touch points in brackets."""
        spec = instance.model.spec.path_constraints
        words = [] if self.starts else ["free"]
        for k, one in enumerate(self.contacts):
            name = spec[one.constraint].name
            words += [f"[{name}]" if one.touches else name, *([] if self.joined(k) else ["free"])]
        return ", ".join(words[:-1] if self.ends else words)

    @property
    def key(self) -> tuple[object, ...]:
        """What two of them have in common that differ in times only."""
        contacts = ((one.constraint, one.touches, self.joined(k)) for k, one in enumerate(self.contacts))
        return (self.starts, self.ends, *contacts)


def stated_arcs(solution: Solution) -> list[int]:
    """The constraint on whose boundary each arc between events runs, or that none does."""
    names = [one.name for one in solution.instance.model.spec.path_constraints]
    begun = [one.name for one in solution.events if one.t <= solution.times[0]]
    found = [names.index(begun[0]) if begun else FREE]
    for one in within(solution):
        found.append(names.index(one.name) if one.kind == "entry" else FREE)
    return found


def within(solution: Solution) -> tuple[Happening, ...]:
    """The events between start and end, where arcs meet."""
    return tuple(one for one in solution.events if solution.times[0] < one.t < solution.times[-1])


def pressing(solution: Solution) -> int:
    """The constraint on states that may push at the end: that of the last arc, or that is touched there; or none."""
    names = [one.name for one in solution.instance.model.spec.path_constraints]
    last = [one for one in solution.events if one.t >= solution.times[-1]]
    found = names.index(last[0].name) if last else stated_arcs(solution)[-1]
    return FREE if found != FREE and solution.instance.model.spec.path_constraints[found].order == 0 else found
