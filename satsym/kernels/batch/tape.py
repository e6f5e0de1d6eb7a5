"""Straight-line code on arrays: each operation once, what stays as it is beforehand, into buffers that are used again.

NumPy spends more time in making arrays than in computing them. Here every operation has its place for the result, which
is free again after its last use, and equal operations of a step are made once.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from satsym.arrays import Array

ALIGNED = 64
"""Bytes at whose multiples buffers begin, so that vectors are loaded whole."""

BINARY: Mapping[type, Callable[..., Any]] = {
    ast.Add: np.add,
    ast.Sub: np.subtract,
    ast.Mult: np.multiply,
    ast.Div: np.divide,
    ast.Pow: np.power,
}
NAMED = {"fabs": np.abs, "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan, "atan2": np.arctan2}
COMMUTATIVE = (np.add, np.multiply)


class Unsuited(Exception):
    """Code that is no straight line of operations."""


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

    def lines(self, lines: Sequence[str], names: Mapping[str, int]) -> dict[str, int]:
        """Assignments, by the names that they give values.

        Raises
        ------
        Unsuited
            If there is anything else.
        """
        known = dict(names)
        for statement in ast.parse("\n".join(lines)).body:
            match statement:
                case ast.Assign(targets=[ast.Name(id=name)], value=value):
                    known[name] = self.expression(value, known)
                case _:
                    raise Unsuited
        return known

    def expression(self, node: ast.expr, names: Mapping[str, int]) -> int:
        """The value of an expression."""
        match node:
            case ast.Name(id=name):
                return names[name]
            case ast.Constant(value=int() | float() as value):
                return self.constant(float(value))
            case ast.UnaryOp(op=ast.USub(), operand=inner):
                return self.apply(np.negative, self.expression(inner, names))
            case ast.BinOp(left=left, op=operator, right=right) if type(operator) in BINARY:
                sides = self.expression(left, names), self.expression(right, names)
                return self.apply(BINARY[type(operator)], *sides)
            case ast.Call(func=ast.Attribute(value=ast.Name(id="math"), attr=name), args=arguments):
                function = NAMED.get(name) or getattr(np, name)
                return self.apply(function, *(self.expression(one, names) for one in arguments))
            case _:
                raise Unsuited

    def _number(self, key: Any, made: Operation | float | str) -> int:
        if key not in self._known:
            self._known[key] = len(self.made)
            self.made.append(made)
        return self._known[key]


@dataclass(frozen=True, eq=False)
class Bound:
    """A tape with arrays."""

    first: list[tuple[Callable[..., Any], tuple[Array, ...]]]
    each: list[tuple[Callable[..., Any], tuple[Array, ...]]]
    """What is called once, and in each run, with what."""

    def begin(self) -> None:
        """What does not change from run to run."""
        for function, arguments in self.first:
            function(*arguments)

    def run(self) -> None:
        """The rest."""
        for function, arguments in self.each:
            function(*arguments)


def bound(tape: Tape, given: Mapping[str, Array], results: Sequence[tuple[int, str]], columns: int) -> Bound:
    """Give every value a place.

    Parameters
    ----------
    given
        Arrays by name; results go into some of them, once everything else is computed.
    results
        Values, and the names of what they are added to.
    columns
        Of each buffer.
    """
    last, needed = _last_uses(tape, results)
    places: dict[int, Array] = {}
    free: list[Array] = []
    first, each = [], []
    for value in needed:
        made = tape.made[value]
        if isinstance(made, str):
            places[value] = given[made]
            continue
        if isinstance(made, float):
            places[value] = np.array(made)
            continue
        operands = tuple(places[k] for k in made.operands)
        if value not in tape.changing:
            shape = np.broadcast_shapes(*(one.shape for one in operands))
            places[value] = aligned(columns) if shape else np.empty(())
            first.append((made.function, (*operands, places[value])))
            continue
        ending = {k for k in made.operands if last[k] == value and isinstance(tape.made[k], Operation)}
        free += [places[k] for k in sorted(ending) if k in tape.changing]
        places[value] = free.pop() if free else aligned(columns)
        each.append((made.function, (*operands, places[value])))
    each += [(np.add, (given[name], places[value], given[name])) for value, name in results]
    return Bound(first, each)


def _last_uses(tape: Tape, results: Sequence[tuple[int, str]]) -> tuple[dict[int, int], list[int]]:
    """By value, the last that is made of it, beyond all for results; and which are needed, in order."""
    wanted, stack = set[int](), [value for value, _ in results]
    while stack:
        value = stack.pop()
        if value not in wanted:
            wanted.add(value)
            made = tape.made[value]
            stack += made.operands if isinstance(made, Operation) else ()
    last: dict[int, int] = {}
    needed = sorted(wanted)
    for value in needed:
        made = tape.made[value]
        for operand in made.operands if isinstance(made, Operation) else ():
            last[operand] = value
    return last | {value: len(tape.made) for value, _ in results}, needed


def aligned(columns: int) -> Array:
    """A buffer."""
    size = 8 * columns
    raw = np.empty(size + ALIGNED, dtype=np.uint8)
    begin = -raw.ctypes.data % ALIGNED
    return raw[begin : begin + size].view(np.float64)
