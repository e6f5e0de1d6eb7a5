"""Straight-line code on arrays: each operation once, what stays as it is beforehand, into buffers that are used again.

NumPy spends more time in making arrays than in computing them. Here every operation has its place for the result, which
is free again after its last use, and equal operations of a step are made once.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.lapack import blas

ALIGNED = 64
"""Bytes at whose multiples buffers begin, so that vectors are loaded whole."""

COMMUTATIVE = (np.add, np.multiply)


@dataclass(frozen=True)
class Moved:
    """What adds to an array a multiple of another, in its place: BLAS does so at once, NumPy with two calls."""

    by: float

    def __call__(self, x: Array, slope: Array) -> None:
        blas().daxpy(slope, x, None, self.by)


@dataclass(frozen=True)
class Operation:
    """What is done with which values."""

    function: Callable[..., Any]
    operands: tuple[int, ...]


@dataclass
class Tape:
    """Values, by number, and how each is made."""

    made: list[Operation | float | str] = field(default_factory=list)
    """An operation, a constant, or the name of what is given."""
    changing: set[int] = field(default_factory=set)
    """Values that are others in each run."""
    _known: dict[Any, int] = field(default_factory=dict)

    def given(self, name: str, changes: bool) -> int:
        """What has a name, and whether it changes from run to run."""
        value = self._number(name, name)
        if changes:
            self.changing.add(value)
        return value

    def apply(self, function: Callable[..., Any], *operands: int) -> int:
        """An operation."""
        ordered = tuple(sorted(operands)) if function in COMMUTATIVE else operands
        value = self._number((function, ordered), Operation(function, operands))
        if self.changing.intersection(operands):
            self.changing.add(value)
        return value

    def constant(self, value: float) -> int:
        """A number."""
        return self._number(("constant", value), value)

    def needed(self, wanted: Collection[int]) -> list[int]:
        """The values that some are made of, and these, in order."""
        found, stack = set[int](), list(wanted)
        while stack:
            value = stack.pop()
            if value not in found:
                found.add(value)
                made = self.made[value]
                stack += made.operands if isinstance(made, Operation) else ()
        return sorted(found)

    def operations(self, wanted: Collection[int]) -> int:
        """How many are made in each run."""
        return sum(value in self.changing and isinstance(self.made[value], Operation) for value in self.needed(wanted))

    def _number(self, key: Any, made: Operation | float | str) -> int:
        if key not in self._known:
            self._known[key] = len(self.made)
            self.made.append(made)
        return self._known[key]


Calls = list[tuple[Callable[..., Any], tuple[Any, ...]]]


@dataclass(frozen=True, eq=False)
class Bound:
    """A tape with arrays."""

    first: Calls
    each: Calls
    """What is called once, and in each run, with what."""

    def begin(self) -> None:
        """What does not change from run to run."""
        for function, arguments in self.first:
            function(*arguments)

    def run(self) -> None:
        """The rest."""
        for function, arguments in self.each:
            function(*arguments)


@dataclass
class Buffers:
    """Arrays for values, which several runs of one tape share."""

    columns: int
    fixed: dict[int, Array] = field(default_factory=dict)
    """Arrays that hold values which do not change, by their place on the tape."""
    free: list[Array] = field(default_factory=list)
    """Arrays that nobody needs now."""

    def taken(self) -> Array:
        """One of those that are free, or a new one."""
        return self.free.pop() if self.free else aligned(self.columns)


def bound(tape: Tape, given: Mapping[str, Array], results: Mapping[int, Array], buffers: Buffers) -> Bound:
    """Give every value a place.

    Parameters
    ----------
    given
        Arrays by name.
    results
        Values that are wanted, each an operation, and where they go.
    buffers
        For all others.
    """
    needed = tape.needed(results)
    last = {operand: value for value in needed for operand in _operands(tape, value)}
    places: dict[int, Array] = dict(results)
    lent, first, each = set[int](), Calls(), Calls()
    for value in needed:
        made = tape.made[value]
        if not isinstance(made, Operation):
            places[value] = given[made] if isinstance(made, str) else np.array(made)
            continue
        operands = tuple(places[k] for k in made.operands)
        if value not in tape.changing:
            known = value in buffers.fixed and value not in results
            if known:
                places[value] = buffers.fixed[value]
                continue
            if value not in results:
                shape = np.broadcast_shapes(*(one.shape for one in operands))
                places[value] = buffers.fixed[value] = aligned(buffers.columns) if shape else np.empty(())
            first.append((made.function, (*operands, places[value])))
            continue
        for k in sorted({k for k in made.operands if last[k] == value}):
            if k in lent:
                buffers.free.append(places[k])
        if isinstance(made.function, Moved):
            places[value] = operands[0]
            each.append((blas().daxpy, (operands[1], operands[0], None, made.function.by)))
            continue
        if value not in results:
            places[value] = buffers.taken()
            lent.add(value)
        each.append((made.function, (*operands, places[value])))
    return Bound(first, each)


def _operands(tape: Tape, value: int) -> tuple[int, ...]:
    made = tape.made[value]
    return made.operands if isinstance(made, Operation) else ()


def aligned(*shape: int) -> Array:
    """A buffer."""
    size = 8 * math.prod(shape)
    raw = np.empty(size + ALIGNED, dtype=np.uint8)
    begin = -raw.ctypes.data % ALIGNED
    return raw[begin : begin + size].view(np.float64).reshape(shape)
