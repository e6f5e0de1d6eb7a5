"""The structure of controls in a box: the successive levels of each control, and its switching times."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from satsym.arrays import Array

LOWER, REST, UPPER, SINGULAR, BOUNDARY = -1, 0, 1, 2, 3
"""Levels of a control: at a bound, at the admissible value of smallest magnitude, on a singular arc, or, from
``BOUNDARY`` on, on the boundary of a path constraint, see :func:`on_boundary`."""

NAMES = {LOWER: "-", REST: "0", UPPER: "+", SINGULAR: "s"}


def on_boundary(constraint: int, begins: bool = False, ends: bool = False) -> int:
    """Return the level on the boundary of a constraint, with flags for costate jumps at the arc's start and end.

    For constraints of order one, costates only jump where the control meets its bound.
    """
    return BOUNDARY + 4 * constraint + begins + 2 * ends


def constraint_of(level: int) -> int:
    """Return the index of the constraint to which a boundary level belongs."""
    return (level - BOUNDARY) // 4


def jumps(level: int) -> tuple[bool, bool]:
    """Return whether costates jump at the start and at the end of an arc with a given level."""
    kind = (level - BOUNDARY) % 4 if level >= BOUNDARY else 0
    return bool(kind & 1), bool(kind & 2)


def named(level: int) -> str:
    """Return the name of a level in messages; boundaries are numbered if there are several."""
    return NAMES.get(level, f"b{constraint_of(level) + 1 if constraint_of(level) else ''}")


@dataclass(frozen=True)
class Event:
    """The switch of one control from a level to the next."""

    time: float
    """Time of the switch."""
    control: int
    """Index of the control."""
    number: int
    """Number of earlier switches of the same control."""
    column: int
    """Position of the time among the switching times of all controls, one control after the other."""


@dataclass(frozen=True)
class Structure:
    """Levels of each control in order of time; a control with k switches has k + 1 levels."""

    levels: tuple[tuple[int, ...], ...]

    @property
    def switches(self) -> int:
        """Return the number of switches of all controls."""
        return sum(len(row) - 1 for row in self.levels)

    @property
    def name(self) -> str:
        """Return the structure as text, such as ``+-`` or ``-0+ | +-``."""
        return " | ".join("".join(map(named, row)) for row in self.levels)

    @property
    def jumps(self) -> list[tuple[int, int, int]]:
        """Return the jumps of the costates: control, index of its switch, and constraint that causes the jump."""
        return [
            (control, number, constraint_of(level))
            for control, row in enumerate(self.levels)
            for number, pair in enumerate(pairwise(row))
            for level, jumping in zip(pair, (jumps(pair[0])[1], jumps(pair[1])[0]), strict=True)
            if jumping
        ]

    def by_control(self, times: Array) -> list[Array]:
        """Return the switching times of each control, from those of all controls."""
        ends = np.cumsum([len(row) - 1 for row in self.levels])
        return np.split(np.asarray(times, dtype=float), ends[:-1])

    def events(self, times: Array) -> list[Event]:
        """Return all switches in order of time.

        Switches of one control keep their order even if their times, during an iteration, do not.
        """
        keyed: list[tuple[float, int, Event]] = []
        column = 0
        for control, own in enumerate(self.by_control(times)):
            latest = -np.inf
            for number, time in enumerate(own.tolist()):
                latest = max(latest, time)
                keyed.append((latest, column, Event(time, control, number, column)))
                column += 1
        return [event for _, _, event in sorted(keyed, key=lambda entry: entry[:2])]

    def with_levels(self, control: int, row: tuple[int, ...]) -> Structure:
        """Return the structure with other levels of one control."""
        return Structure((*self.levels[:control], row, *self.levels[control + 1 :]))

    def without_arc(self, control: int, arc: int) -> tuple[Structure, list[int]]:
        """Return the structure without one arc of a control, and the indices of the remaining times.

        Adjacent arcs at the same level are joined.
        """
        row = self.levels[control]
        first = sum(len(other) - 1 for other in self.levels[:control])
        gone = {arc - 1 if arc == len(row) - 1 else arc}
        kept = [*row[:arc], *row[arc + 1 :]]
        if 0 < arc < len(row) - 1 and row[arc - 1] == row[arc + 1]:
            gone, kept = {arc - 1, arc}, [*row[:arc], *row[arc + 2 :]]
        return self.with_levels(control, tuple(kept)), [c for c in range(self.switches) if c - first not in gone]

    def durations(self, times: Array, start: float, end: float) -> list[Array]:
        """Return the lengths of the arcs of each control."""
        return [np.diff([start, *own, end]) for own in self.by_control(times)]


@dataclass(frozen=True, eq=False)
class Course:
    """States and costates along a motion near an extremal."""

    times: Array
    z: Array
    """Times, and states above costates, shapes (N,) and (2n, N)."""

    def at(self, time: float) -> Array:
        """Return interpolated states and costates at a time, shape (2n,)."""
        return np.array([np.interp(time, self.times, row) for row in self.z])

    def sizes(self) -> Array:
        """Return the largest magnitudes of states and costates, shape (2n,)."""
        return np.asarray(np.abs(self.z).max(axis=1))


@dataclass(frozen=True, eq=False)
class Guess:
    """Initial guess of an extremal of exact arcs."""

    structure: Structure
    times: Array
    """Levels and switching times."""
    costates: Array
    """Initial costates."""
    end: float
    """The final time."""
    course: Course | None = None
    """States and costates along the motion if they are known from another source than integration, else ``None``."""
    bounded: bool = False
    """Whether path constraints are required to hold."""
