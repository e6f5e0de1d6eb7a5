"""The classes of random instances: how each is drawn, how many there are, and who answers independently."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from tests.bench.truth import closed, duality, lines, multistart, orbits, programs
from tests.bench.truth.answer import Answer
from tests.bench.truth.case import Case


@dataclass(frozen=True)
class Class:
    """A class of instances.

    Attributes
    ----------
    drawn
        From a generator, the class's name and a number to an instance.
    answered
        From an instance to an independent answer.
    size
        How many instances belong to the bench.
    """

    drawn: Callable[[np.random.Generator, str, int], Case]
    answered: Callable[[Case], Answer]
    size: int


CLASSES: dict[str, Class] = {
    "orbit 1: all given": Class(orbits.given, multistart.best, 35),
    "orbit 2: state given": Class(orbits.state_given, multistart.best, 30),
    "orbit 3: time given": Class(orbits.time_given, multistart.best, 35),
    "orbit 4: rendezvous": Class(orbits.rendezvous, multistart.best, 30),
    "orbit 5: free": Class(orbits.all_free, multistart.best, 30),
    "orbit in km": Class(orbits.in_kilometres, multistart.best, 25),
    "orbit, any angle": Class(orbits.any_angle, multistart.best, 20),
    "orbit, box": Class(orbits.boxed, multistart.best, 30),
    "orbit, lopsided": Class(orbits.lopsided, multistart.best, 30),
    "orbit, floor": Class(orbits.above_floor, multistart.settled, 80),
    "orbit, one-sided": Class(orbits.one_sided, multistart.best, 30),
    "orbit, tight": Class(orbits.tight, multistart.best, 30),
    "orbit, ball": Class(orbits.ball, multistart.best, 30),
    "orbit, tight ball": Class(orbits.tight_ball, multistart.best, 20),
    "orbit, box, ends 2-5": Class(orbits.boxed_ends, multistart.best, 30),
    "orbit, rewarded": Class(orbits.rewarded, multistart.best, 20),
    "line, time": Class(lines.line_time, closed.line_time, 50),
    "line, time, one-sided": Class(lines.line_time_one_sided, closed.line_time, 30),
    "line, kept": Class(lines.line_kept, multistart.settled, 120),
    "line, energy": Class(lines.line_energy, duality.least_energy, 30),
    "line, fuel": Class(lines.line_fuel, programs.least_fuel, 40),
    "line, fuel, free time": Class(lines.line_fuel_free, closed.line_fuel_free, 40),
    "chain, time": Class(lines.chain_time, programs.minimum_time, 30),
    "chain, energy": Class(lines.chain_energy, duality.least_energy, 30),
    "chain, fuel": Class(lines.chain_fuel, programs.least_fuel, 30),
    "oscillator, time": Class(lines.spring_time, programs.minimum_time, 30),
    "oscillator, energy": Class(lines.spring_energy, duality.least_energy, 30),
    "oscillator, fuel": Class(lines.spring_fuel, programs.least_fuel, 30),
    "relative, energy": Class(lines.rendezvous_energy, duality.least_energy, 20),
    "relative, box": Class(lines.rendezvous_box, duality.least_energy, 40),
    "relative, ball": Class(lines.rendezvous_ball, duality.least_energy, 30),
    "transfer, plane": Class(orbits.plane, multistart.best, 30),
    "transfer, space": Class(orbits.space, multistart.best, 20),
    "hill, steered": Class(lines.hill_steered, multistart.best, 20),
    "hill, pushed": Class(lines.hill_pushed, multistart.best, 20),
    "conjugate, 1 axis": Class(lines.conjugate_one, closed.conjugate, 25),
    "conjugate, 2 axes": Class(lines.conjugate_two, closed.conjugate, 20),
    "end on an ellipse": Class(lines.ellipse, closed.ellipse, 25),
    "end on a line": Class(lines.line_end, closed.line_end, 15),
    "end on a line, time": Class(lines.line_end_time, closed.line_end_time, 25),
    "end weighed": Class(lines.weighed, closed.weighed, 30),
    "end weighed, box": Class(lines.weighed_within, multistart.best, 20),
    "end weighed, 1 state": Class(lines.one_within, closed.one_within_bounds, 25),
}


def drawn(family: str, number: int) -> Case:
    """One instance, the same at every call."""
    seed = [zlib.crc32(family.encode()), number]
    return CLASSES[family].drawn(np.random.default_rng(seed), family, number)


def in_turn(families: list[str]) -> Iterator[tuple[str, int]]:
    """Classes in turn, so that a record broken off has of each nearly as many, in proportion."""
    largest = max(CLASSES[family].size for family in families)
    pairs = [
        ((number + 0.5) / CLASSES[family].size * largest, k, family, number)
        for k, family in enumerate(families)
        for number in range(CLASSES[family].size)
    ]
    yield from ((family, number) for _, _, family, number in sorted(pairs))
