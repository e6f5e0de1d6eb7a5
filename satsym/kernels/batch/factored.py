"""Values of a tape with postponed factors, so that few multiplications are left.

Numbers, and values that never change, go along with products and quotients, and meet again in sums: there a value that
never changes takes over the factors of the other one, once and for all. So `a - 2*b*c` is `2*(a/2 - b*c)`, one
operation less in each run.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from satsym.kernels.batch.tape import Tape

NAMED = {"fabs": np.abs, "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan, "atan2": np.arctan2}
"""Functions of ``math`` that have other names in NumPy."""

UNIT, INVERSE = "unit", "inverse unit"
"""Input names of a tape for the unit, by whose powers values are multiplied, and for the inverse of the unit."""


class Unsuited(Exception):
    """The code is not a straight line of operations."""


@dataclass(frozen=True)
class Factored:
    """A value of a tape times a number and a power of the unit; without a value, the number alone."""

    value: int | None
    factor: float = 1.0
    power: int = 0
    fixed: int | None = None
    """Constant value that is also postponed as a factor, besides the number and power; ``None`` if there is none."""

    def times(self, factor: float, power: int = 0) -> Factored:
        """Return the value with one more factor and power of the unit."""
        return replace(self, factor=self.factor * factor, power=self.power + power)


class Arithmetic:
    """Arithmetic of factored values.

    Parameters
    ----------
    tape
        Tape that contains the values.
    scales
        Factors of the first quotients of something that never changes; multiplying by them costs nothing.
    late
        Whether values that never change are multiplied in late.
    """

    def __init__(self, tape: Tape, scales: Sequence[float] = (), late: bool = True) -> None:
        self.tape, self.scales, self.late, self.quotients = tape, scales, late, 0

    def lines(self, statements: Sequence[ast.stmt], names: Mapping[str, Factored]) -> dict[str, Factored]:
        """Run assignments; return the values by name.

        Raises
        ------
        Unsuited
            If there is anything else.
        """
        known, self.quotients = dict(names), 0
        for statement in statements:
            match statement:
                case ast.Assign(targets=[ast.Name(id=name)], value=value):
                    known[name] = self.expression(value, known)
                case _:
                    raise Unsuited
        return known

    def expression(self, node: ast.expr, names: Mapping[str, Factored]) -> Factored:
        """Return the value of an expression."""
        match node:
            case ast.Name(id=name):
                return names[name]
            case ast.Constant(value=int() | float() as number):
                return Factored(None, float(number))
            case ast.UnaryOp(op=ast.USub(), operand=inner):
                return self.expression(inner, names).times(-1.0)
            case ast.BinOp(left=left, op=operator, right=right):
                return self._binary(operator, self.expression(left, names), self.expression(right, names))
            case ast.Call(func=ast.Attribute(value=ast.Name(id="math"), attr=name), args=arguments):
                function = NAMED.get(name) or getattr(np, name)
                return self._applied(function, *(self.expression(one, names) for one in arguments))
            case _:
                raise Unsuited

    def _binary(self, operator: ast.operator, a: Factored, b: Factored) -> Factored:
        match operator:
            case ast.Add():
                return self.sum(a, b)
            case ast.Sub():
                return self.sum(a, b.times(-1.0))
            case ast.Mult():
                return self._product(a, b)
            case ast.Div():
                return self._quotient(a, b)
            case ast.Pow():
                return self._applied(np.power, a, b)
            case _:
                raise Unsuited

    def sum(self, a: Factored, b: Factored) -> Factored:
        """Add two values; the sum has the factors of the first if both change from run to run."""
        if not (a.factor and b.factor):
            return b if not a.factor else a
        if a.value is None and b.value is None:
            return Factored(None, a.factor + b.factor)
        if a.value is None or (self._fixed(a) and not self._fixed(b)) or (a.fixed is not None and b.fixed is None):
            a, b = b, a
        a = replace(a, value=self.plain(Factored(a.value, fixed=a.fixed)), fixed=None)
        if self._fixed(b) or b.fixed is not None or (abs(a.factor), a.power) != (abs(b.factor), b.power):
            b = self.like(b, a)
        left, right = self.plain(Factored(a.value)), self.plain(Factored(b.value))
        if a.factor == b.factor:
            return replace(a, value=self.tape.apply(np.add, left, right))
        if a.factor < 0.0:
            return replace(b, value=self.tape.apply(np.subtract, right, left))
        return replace(a, value=self.tape.apply(np.subtract, left, right))

    def like(self, a: Factored, other: Factored) -> Factored:
        """Return the value with the factors of another one."""
        return Factored(self.plain(a.times(1.0 / other.factor, -other.power)), other.factor, other.power)

    def plain(self, a: Factored) -> int:
        """Return the value on the tape after all its postponed multiplications."""
        if a.value is not None and a.fixed is None and (abs(a.factor), a.power) == (1.0, 0):
            return a.value if a.factor > 0.0 else self.tape.apply(np.negative, a.value)
        by = self.tape.constant(a.factor) if a.fixed is None else a.fixed
        if a.fixed is not None and a.factor != 1.0:
            by = self.tape.apply(np.multiply, self.tape.constant(a.factor), by)
        for _ in range(abs(a.power)):
            by = self.tape.apply(np.multiply, by, self.tape.given(UNIT if a.power > 0 else INVERSE, False))
        return by if a.value is None else self.tape.apply(np.multiply, by, a.value)

    def _fixed(self, a: Factored) -> bool:
        return a.value not in self.tape.changing

    def _product(self, a: Factored, b: Factored) -> Factored:
        if a.value is None or b.value is None:
            one, number = (b, a) if a.value is None else (a, b)
            return one.times(number.factor, number.power)
        factors, fixed = (a.factor * b.factor, a.power + b.power), self._both(np.multiply, a.fixed, b.fixed)
        if self.late and self._fixed(a) != self._fixed(b):
            changing, other = (b.value, a.value) if self._fixed(a) else (a.value, b.value)
            return Factored(changing, *factors, self._both(np.multiply, fixed, other))
        return Factored(self.tape.apply(np.multiply, a.value, b.value), *factors, fixed)

    def _quotient(self, a: Factored, b: Factored) -> Factored:
        if not b.factor:  # left to the arrays, which make it infinite
            return self._applied(np.divide, a, b)
        a = a.times(1.0 / b.factor, -b.power)
        if b.value is None:
            return a
        if self._fixed(a) and not self._fixed(b):
            scale = self.scales[self.quotients] if self.quotients < len(self.scales) else 1.0
            self.quotients += 1
            above = self.plain(Factored(a.value, a.factor * scale))
            above = above if b.fixed is None else self.tape.apply(np.divide, above, b.fixed)
            return Factored(self.tape.apply(np.divide, above, b.value), 1.0 / scale, a.power)
        if self.late and self._fixed(b) and not self._fixed(a):
            return replace(a, fixed=self._both(np.divide, a.fixed, b.value))
        value = self.tape.apply(np.divide, self.plain(Factored(a.value)), b.value)
        return replace(a, value=value, fixed=self._both(np.divide, a.fixed, b.fixed))

    def _both(self, function: Callable[..., Any], a: int | None, b: int | None) -> int | None:
        """Combine two values that never change, of which ``None`` stands for one."""
        if b is None:
            return a
        if a is None:
            return b if function is np.multiply else self.tape.apply(function, self.tape.constant(1.0), b)
        return self.tape.apply(function, a, b)

    def _applied(self, function: Callable[..., Any], *operands: Factored) -> Factored:
        return Factored(self.tape.apply(function, *(self.plain(one) for one in operands)))
