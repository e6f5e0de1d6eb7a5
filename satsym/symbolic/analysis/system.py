"""A linear system with constant coefficients, as matrices with names."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp


@dataclass(frozen=True)
class LinearSystem:
    """x' = A x + B u, y = C x + D u."""

    a: sp.ImmutableMatrix
    b: sp.ImmutableMatrix
    c: sp.ImmutableMatrix
    d: sp.ImmutableMatrix
    """Shapes (n, n), (n, m), (number of outputs, n), (number of outputs, m)."""
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    """Names, in order."""

    def __post_init__(self) -> None:
        n, m, k = len(self.states), len(self.inputs), len(self.outputs)
        shapes = [self.a.shape, self.b.shape, self.c.shape, self.d.shape]
        if not n or shapes != [(n, n), (n, m), (k, n), (k, m)]:
            raise ValueError(f"a linear system with {n} states, {m} inputs and {k} outputs has no matrices {shapes}")


def linear_system(a: sp.MatrixBase, b: sp.MatrixBase | None = None, c: sp.MatrixBase | None = None) -> LinearSystem:
    """A system from its matrices alone, named x1, x2, ..., u1, ... and y1, ...; what is left out is empty."""
    a = sp.ImmutableMatrix(a)
    b = sp.ImmutableMatrix(sp.zeros(a.rows, 0) if b is None else b)
    c = sp.ImmutableMatrix(sp.zeros(0, a.rows) if c is None else c)
    names = [tuple(f"{letter}{k + 1}" for k in range(n)) for letter, n in (("x", a.rows), ("u", b.cols), ("y", c.rows))]
    return LinearSystem(a, b, c, sp.ImmutableMatrix(sp.zeros(c.rows, b.cols)), *names)
