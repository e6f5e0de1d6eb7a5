"""Linear systems x' = A x + B u, y = C x + D u, with the names of their variables, and units that suit them.

Ranks and multiplicities are decided by comparing numbers with a tolerance. In km and s a satellite's matrices hold 1
beside 1e-9, and any tolerance would fail. So every state, input and output is given a unit of its own, and time one for
all, such that the logarithms of the nonzero entries are as near to zero as possible. Two systems that differ in their
units alone become the same system.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from satsym.arrays import Array
from satsym.status import BadInput
from satsym.wording import shown, suggestion

if TYPE_CHECKING:
    import control

    from satsym.analysis.linear.rational import Rational


@dataclass(frozen=True, eq=False)
class LinearSystem:
    """A linear system with constant coefficients; its variables are deviations."""

    A: Array
    B: Array
    C: Array
    D: Array
    """The matrices A, B, C and D, shapes (n, n), (n, m), (k, n) and (k, m)."""
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    """Names of the n states, m inputs and k outputs."""
    name: str = ""
    """Name of the system, or of the model that it linearises."""
    exact: Rational | None = None
    """The exact A, B and C, where they are known."""

    def with_inputs(self, names: Sequence[str]) -> LinearSystem:
        """Return the system with only the given inputs, in this order.

        Raises
        ------
        BadInput
            If there is no such input.
        """
        for name in names:
            if name not in self.inputs:
                raise BadInput(
                    f"input {shown(name)}: the system has no input of this name; {suggestion(name, self.inputs)}"
                )
        columns = [self.inputs.index(name) for name in names]
        exact = self.exact and self.exact.with_inputs(columns)
        return replace(self, B=self.B[:, columns], D=self.D[:, columns], inputs=tuple(names), exact=exact)

    def with_feedback(self, K: Array) -> LinearSystem:
        """Return the closed loop under u = v - K x, with v as input: A becomes A - B K, and C becomes C - D K."""
        return replace(self, A=self.A - self.B @ K, C=self.C - self.D @ K, exact=None)

    def transition(self, t: float) -> Array:
        """Return e^(At): the state after a time t without control, from each unit state; shape (n, n)."""
        from scipy.linalg import expm

        return np.asarray(expm(self.A * t))

    def to_control(self) -> control.StateSpace:
        """Return the system as one of python-control, with its names.

        Raises
        ------
        BadInput
            If python-control is not installed.
        """
        try:
            import control
        except ImportError:
            raise BadInput("python-control is not installed; run pip install 'satsym[control]'") from None
        return control.ss(
            self.A,
            self.B,
            self.C,
            self.D,
            states=list(self.states),
            inputs=list(self.inputs),
            outputs=list(self.outputs),
            name=self.name or None,
        )


def system(
    A: ArrayLike,
    B: ArrayLike | None = None,
    C: ArrayLike | None = None,
    D: ArrayLike | None = None,
    *,
    states: Sequence[str] = (),
    inputs: Sequence[str] = (),
    outputs: Sequence[str] = (),
    name: str = "",
    exact: Rational | None = None,
) -> LinearSystem:
    """Build a linear system from matrices.

    Parameters
    ----------
    A
        Shape (n, n).
    B
        Shape (n, m); no inputs by default.
    C
        Shape (k, n); no outputs by default.
    D
        Shape (k, m); zero by default.
    states, inputs, outputs
        Names; by default x1, x2, ...; u1, ...; y1, ...
    name
        Name of the system.
    exact
        The exact A, B and C, where they are known.

    Raises
    ------
    BadInput
        If the shapes do not fit, or a number is not finite.
    """
    a = np.asarray(A, dtype=float)
    n = a.shape[0] if a.ndim else 0
    b = np.zeros((n, 0)) if B is None else np.asarray(B, dtype=float)
    c = np.zeros((0, n)) if C is None else np.asarray(C, dtype=float)
    m, k = b.shape[-1] if b.ndim else 0, c.shape[0] if c.ndim else 0
    d = np.zeros((k, m)) if D is None else np.asarray(D, dtype=float)
    shapes = {"A": (n, n), "B": (n, m), "C": (k, n), "D": (k, m)}
    for (letter, shape), matrix in zip(shapes.items(), (a, b, c, d), strict=True):
        if matrix.shape != shape or n == 0:
            raise BadInput(
                f"{letter}: the shape {matrix.shape} does not fit; give A, B, C and D with the shapes (n, n), (n, "
                "m), (k, n) and (k, m)"
            )
        if not np.isfinite(matrix).all():
            raise BadInput(f"{letter}: has an entry that is not finite; check the parameters")
    return LinearSystem(
        a,
        b,
        c,
        d,
        tuple(states) or _numbered("x", n),
        tuple(inputs) or _numbered("u", m),
        tuple(outputs) or _numbered("y", k),
        name,
        exact,
    )


def _numbered(letter: str, count: int) -> tuple[str, ...]:
    return tuple(f"{letter}{i + 1}" for i in range(count))


TOO_SMALL = 0.1
"""Penalty of an entry that is too small after scaling, relative to one too large: entries near zero, or zero up to
rounding, are not to be enlarged."""
MOST_ROUNDS, LAST_EXPONENT_CHANGE = 50, 0.05
"""Most rounds of reweighting, and the change of an exponent of two below which the weights have converged."""


@dataclass(frozen=True, eq=False)
class Scaled:
    """A system in suitable units: x = states * x', u = inputs * u', y = outputs * y', d/dt = rate * d/dt'."""

    A: Array
    B: Array
    C: Array
    """The matrices of the system in suitable units."""
    states: Array
    inputs: Array
    outputs: Array
    """The units of states, inputs and outputs: powers of two, so that scaling adds no rounding error."""
    rate: float
    """The inverse of the unit of time, also a power of two."""

    @property
    def size(self) -> float:
        """Return the largest singular value of (A B), by which tolerances are multiplied; 1 if all is zero."""
        return float(np.linalg.norm(np.hstack([self.A, self.B]), 2)) or 1.0


def scaled(system: LinearSystem) -> Scaled:
    """Return the system in the units that suit it best."""
    n, m, k = len(system.states), len(system.inputs), len(system.outputs)
    # powers of two: units of states, inputs, outputs, and the rate
    exponents = np.rint(_fit(system, n, m, k)).astype(int)
    x, u, y, rate = np.split(exponents, [n, n + m, n + m + k])
    return Scaled(
        A=np.ldexp(system.A, x[None, :] - x[:, None] - rate),
        B=np.ldexp(system.B, u[None, :] - x[:, None] - rate),
        C=np.ldexp(system.C, x[None, :] - y[:, None]),
        states=np.ldexp(1.0, x),
        inputs=np.ldexp(1.0, u),
        outputs=np.ldexp(1.0, y),
        rate=float(np.ldexp(1.0, rate[0])),
    )


def _fit(system: LinearSystem, n: int, m: int, k: int) -> Array:
    """Return exponents of units that bring the nonzero entries near 1.

    They have the smallest sum of absolute logarithms, found by reweighted least squares.
    """
    rows, sizes = [], []
    last = n + m + k
    for matrix, row_unit, column_unit, per_time in (
        (system.A, 0, 0, 1.0),
        (system.B, 0, n, 1.0),
        (system.C, n + m, 0, 0.0),
    ):
        for i, j in np.argwhere(matrix):
            row = np.zeros(last + 1)
            row[row_unit + i] -= 1.0
            row[column_unit + j] += 1.0
            row[last] = -per_time
            rows.append(row)
            sizes.append(np.log2(abs(matrix[i, j])))
    if not rows:
        return np.zeros(last + 1)
    coefficients, target = np.array(rows), -np.array(sizes)
    weights, found = np.ones(len(rows)), np.zeros(last + 1)
    for _ in range(MOST_ROUNDS):
        root, before = np.sqrt(weights), found
        found = np.linalg.lstsq(coefficients * root[:, None], target * root, rcond=None)[0]
        if np.abs(found - before).max() < LAST_EXPONENT_CHANGE:
            break
        exponents = coefficients @ found - target
        weights = np.where(exponents < 0.0, TOO_SMALL, 1.0) / np.maximum(1.0, np.abs(exponents))
    return np.asarray(found)
