"""The structure of controls in a box: the levels that each takes one after the other, and when it switches."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from satsym.arrays import Array

LOWER, REST, UPPER, SINGULAR, BOUNDARY = -1, 0, 1, 2, 3
"""Levels: on a bound, at the admissible value of least magnitude, as the singular condition has it, or, from the last
of these on, as a path constraint has it on its boundary; see :func:`on_boundary`."""

NAMES = {LOWER: "-", REST: "0", UPPER: "+", SINGULAR: "s"}


def on_boundary(constraint: int, begins: bool = False, ends: bool = False) -> int:
    """The level on the boundary of a constraint, and whether costates jump where such an arc begins and where it ends.

    Of constraints of order one they do only where the control meets its bound there.
    """
    return BOUNDARY + 4 * constraint + begins + 2 * ends


def constraint_of(level: int) -> int:
    """On whose boundary a level is."""
    return (level - BOUNDARY) // 4


def jumps(level: int) -> tuple[bool, bool]:
    """Whether costates jump at the start of an arc, and at its end."""
    kind = (level - BOUNDARY) % 4 if level >= BOUNDARY else 0
    return bool(kind & 1), bool(kind & 2)


def named(level: int) -> str:
    """For messages; boundaries are numbered where there are several."""
    return NAMES.get(level, f"b{constraint_of(level) + 1 if constraint_of(level) else ''}")


@dataclass(frozen=True)
class Event:
    """One control's passage from a level to the next."""

    time: float
    """When."""
    control: int
    """Which control."""
    number: int
    """How many of its switches were before."""
    column: int
    """Place of the time among those of all controls, one control after the other."""


@dataclass(frozen=True)
class Structure:
    """Levels of each control in order of time; a control with k switches has k + 1."""

    levels: tuple[tuple[int, ...], ...]

    @property
    def switches(self) -> int:
        """Switches of all controls."""
        return sum(len(row) - 1 for row in self.levels)

    @property
    def name(self) -> str:
        """For messages: ``+-`` or ``-0+ | +-``."""
        return " | ".join("".join(map(named, row)) for row in self.levels)

    @property
    def jumps(self) -> list[tuple[int, int, int]]:
        """Where costates jump: control, which of its switches, and the constraint along whose gradient they do."""
        return [
            (control, number, constraint_of(level))
            for control, row in enumerate(self.levels)
            for number, pair in enumerate(pairwise(row))
            for level, jumping in zip(pair, (jumps(pair[0])[1], jumps(pair[1])[0]), strict=True)
            if jumping
        ]

    def by_control(self, times: Array) -> list[Array]:
        """The times of each control, from those of all."""
        ends = np.cumsum([len(row) - 1 for row in self.levels])
        return np.split(np.asarray(times, dtype=float), ends[:-1])

    def events(self, times: Array) -> list[Event]:
        """All switches in the order in which they are passed.

        Those of one control keep their order even where their times, on the way to a solution, do not.
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
        """The structure with other levels of one control."""
        return Structure((*self.levels[:control], row, *self.levels[control + 1 :]))

    def without_arc(self, control: int, arc: int) -> tuple[Structure, list[int]]:
        """The structure less one arc of a control, and the columns of the times that are left.

        Neighbours at the same level become one.
        """
        row = self.levels[control]
        first = sum(len(other) - 1 for other in self.levels[:control])
        gone = {arc - 1 if arc == len(row) - 1 else arc}
        kept = [*row[:arc], *row[arc + 1 :]]
        if 0 < arc < len(row) - 1 and row[arc - 1] == row[arc + 1]:
            gone, kept = {arc - 1, arc}, [*row[:arc], *row[arc + 2 :]]
        return self.with_levels(control, tuple(kept)), [c for c in range(self.switches) if c - first not in gone]

    def durations(self, times: Array, start: float, end: float) -> list[Array]:
        """Lengths of the arcs of each control."""
        return [np.diff([start, *own, end]) for own in self.by_control(times)]


@dataclass(frozen=True, eq=False)
class Course:
    """States and costates along something near an extremal."""

    times: Array
    z: Array
    """Shapes (N,) and (2n, N)."""

    def at(self, time: float) -> Array:
        """States and costates between the times, shape (2n,)."""
        return np.array([np.interp(time, self.times, row) for row in self.z])

    def sizes(self) -> Array:
        """Sizes of states and costates, shape (2n,)."""
        return np.asarray(np.abs(self.z).max(axis=1))


@dataclass(frozen=True, eq=False)
class Guess:
    """Where to look for an extremal of exact arcs."""

    structure: Structure
    times: Array
    """Levels and switching times."""
    costates: Array
    """At the start."""
    end: float
    """The final time."""
    course: Course | None = None
    """Where it leads, if that is known better than by following it."""
    bounded: bool = False
    """Whether path constraints have to hold."""
