"""Units that suit a linear system: in them its entries are near 1, whatever units it was written in.

Ranks and multiplicities are decided by comparing numbers with a tolerance. In km and s a satellite's matrices hold
1 beside 1e-9, and any tolerance would be fooled. So every state, input and output is given a unit of its own, and
time one for all, such that the logarithms of the nonzero entries are as near to zero as they can be. Two systems
that differ in their units alone become the same system.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from satsym.analysis.linear.system import LinearSystem
from satsym.arrays import Array

TOO_SMALL = 0.1
"""What it costs that an entry comes out too small, relative to one too large: nothing that is near zero, or is so but
for rounding, shall be blown up to match the rest."""
MOST_ROUNDS, LAST_EXPONENT_CHANGE = 50, 0.05
"""Most rounds of reweighting, and the change of an exponent of two below which the weights have settled."""


@dataclass(frozen=True, eq=False)
class Scaled:
    """A system in units that suit it: x = states * x', u = inputs * u', y = outputs * y', d/dt = rate * d/dt'."""

    A: Array
    B: Array
    C: Array
    """Matrices of the system in the units that suit it."""
    states: Array
    inputs: Array
    outputs: Array
    """The units, powers of two, so that scaling adds no rounding error."""
    rate: float
    """Likewise, the inverse of the unit of time."""

    @property
    def size(self) -> float:
        """Largest singular value of A and B side by side, with which tolerances are multiplied; 1 if all is zero."""
        return float(np.linalg.norm(np.hstack([self.A, self.B]), 2)) or 1.0


def scaled(system: LinearSystem) -> Scaled:
    """The system in the units that suit it best."""
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
    """Exponents that bring the nonzero entries near 1: least sum of their absolute logarithms, by reweighting."""
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
