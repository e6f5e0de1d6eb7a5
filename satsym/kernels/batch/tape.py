"""Straight-line code on arrays: equal operations once, constant ones beforehand, results in reused buffers.

NumPy spends more time in making arrays than in computing them. Here every operation has a place for its result, which
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
"""Alignment of buffers in bytes, for vector loads."""

COMMUTATIVE = (np.add, np.multiply)


@dataclass(frozen=True)
class Moved:
    """The in-place addition of a multiple of one array to another: one call of BLAS, two of NumPy."""

    by: float

    def __call__(self, x: Array, slope: Array) -> None:
        blas().daxpy(slope, x, None, self.by)


@dataclass(frozen=True)
class Operation:
    """An operation of a tape and the numbers of its arguments."""

    function: Callable[..., Any]
    operands: tuple[int, ...]


@dataclass
class Tape:
    """Numbered values, each with the operation that makes it."""

    made: list[Operation | float | str] = field(default_factory=list)
    """For each value, its operation, its constant, or its name as an input."""
    changing: set[int] = field(default_factory=set)
    """Indices of the values that change from run to run."""
    _known: dict[Any, int] = field(default_factory=dict)

    def given(self, name: str, changes: bool) -> int:
        """Add a named input, and whether it changes from run to run."""
        value = self._number(name, name)
        if changes:
            self.changing.add(value)
        return value

    def apply(self, function: Callable[..., Any], *operands: int) -> int:
        """Add an operation on values."""
        ordered = tuple(sorted(operands)) if function in COMMUTATIVE else operands
        value = self._number((function, ordered), Operation(function, operands))
        if self.changing.intersection(operands):
            self.changing.add(value)
        return value

    def constant(self, value: float) -> int:
        """Add a number."""
        return self._number(("constant", value), value)

    def needed(self, wanted: Collection[int]) -> list[int]:
        """Return the values that some values depend on, and these, in order."""
        found, stack = set[int](), list(wanted)
        while stack:
            value = stack.pop()
            if value not in found:
                found.add(value)
                made = self.made[value]
                stack += made.operands if isinstance(made, Operation) else ()
        return sorted(found)

    def operations(self, wanted: Collection[int]) -> int:
        """Count the operations for some values in each run."""
        return sum(value in self.changing and isinstance(self.made[value], Operation) for value in self.needed(wanted))

    def _number(self, key: Any, made: Operation | float | str) -> int:
        if key not in self._known:
            self._known[key] = len(self.made)
            self.made.append(made)
        return self._known[key]


Calls = list[tuple[Callable[..., Any], tuple[Any, ...]]]


@dataclass(frozen=True, eq=False)
class Bound:
    """A tape with arrays for its values."""

    first: Calls
    each: Calls
    """Function calls that are made once, and those that are made in each run, with their arguments."""

    def begin(self) -> None:
        """Compute the values that do not change from run to run."""
        for function, arguments in self.first:
            function(*arguments)

    def run(self) -> None:
        """Compute the values that change from run to run."""
        for function, arguments in self.each:
            function(*arguments)


@dataclass
class Buffers:
    """Arrays for values, shared by several runs of one tape."""

    columns: int
    fixed: dict[int, Array] = field(default_factory=dict)
    """Arrays of values that do not change, by their position on the tape."""
    free: list[Array] = field(default_factory=list)
    """Arrays that are free for reuse."""

    def taken(self) -> Array:
        """Return a free buffer, or a new one."""
        return self.free.pop() if self.free else aligned(self.columns)


def bound(tape: Tape, given: Mapping[str, Array], results: Mapping[int, Array], buffers: Buffers) -> Bound:
    """Bind a tape to arrays: give every value a place.

    Parameters
    ----------
    given
        Arrays by name.
    results
        Requested values, each of them an operation, and the arrays to which they are written.
    buffers
        Buffers for all other values.
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
    """Return a buffer whose memory is aligned for vector instructions."""
    size = 8 * math.prod(shape)
    raw = np.empty(size + ALIGNED, dtype=np.uint8)
    begin = -raw.ctypes.data % ALIGNED
    return raw[begin : begin + size].view(np.float64).reshape(shape)
