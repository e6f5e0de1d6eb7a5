"""The weights of a linear-quadratic regulator: matrices, diagonals, or allowed deviations."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from satsym.instance.resolve import known, quantity
from satsym.spec import Variable
from satsym.status import BadInput
from satsym.wording import shown

if TYPE_CHECKING:
    from satsym.instance.types import LqrOptions

Row = tuple[float, ...]
Matrix = tuple[Row, ...]
ROUNDING = 1e-12
"""Largest asymmetry, or negative eigenvalue, of an accepted matrix, relative to its entries."""


def checked(
    Q: Sequence[float | Sequence[float]],
    R: Sequence[float | Sequence[float]],
    N: Sequence[float | Sequence[float]] | None,
    states: int,
    inputs: int,
) -> tuple[Matrix, Matrix, Matrix | None]:
    """Return all weights as full matrices, after checks.

    Parameters
    ----------
    Q, R
        Rows, or the diagonal.
    N
        Rows, or ``None`` for zero.
    states, inputs
        Numbers of states and of inputs.

    Raises
    ------
    BadInput
        If a shape does not fit, Q or R is not symmetric or R is not positive definite.
    """
    q, r = _matrix(Q, states, "Q"), _matrix(R, inputs, "R")
    if smallest_eigenvalue(r) <= ROUNDING:
        raise BadInput("[lqr] R: not positive definite, so some input costs nothing; give positive weights")
    return q, r, None if N is None else _cross(N, states, inputs)


def _cross(rows: Sequence[float | Sequence[float]], states: int, inputs: int) -> Matrix:
    """Return the cross weights, a row for each state."""
    found = tuple(tuple(row) if isinstance(row, Sequence) else () for row in rows)
    if len(found) != states or any(len(row) != inputs for row in found):
        raise BadInput(
            f"[lqr] N: the matrix has the wrong shape; give a row for each state ({states}) with a number for "
            f"each active input ({inputs})"
        )
    return found


def entries(states: Sequence[str], inputs: Sequence[str]) -> tuple[str, ...]:
    """Return the names of weights: ``Q.x`` and ``R.u`` on the diagonals, ``N.x.u``."""
    return (
        *(f"Q.{name}" for name in states),
        *(f"R.{name}" for name in inputs),
        *(f"N.{state}.{control}" for state in states for control in inputs),
    )


def entry(options: LqrOptions | None, name: str, states: Sequence[str]) -> float | None:
    """Return a weight by name; ``None`` without a regulator, or where it does not use that input."""
    if options is None or (place := _place(options, name, states)) is None:
        return None
    letter, i, j = place
    rows = getattr(options, letter)
    return 0.0 if rows is None else float(rows[i][j])


def placed(options: LqrOptions | None, name: str, value: float, states: Sequence[str]) -> LqrOptions | None:
    """Return the options of a regulator with another value of one weight, without checks."""
    if options is None or (place := _place(options, name, states)) is None:
        return options
    letter, i, j = place
    rows = [list(row) for row in getattr(options, letter) or [[0.0] * len(options.inputs) for _ in states]]
    rows[i][j] = value
    changed: dict[str, Any] = {letter: tuple(map(tuple, rows))}
    return replace(options, **changed)


def _place(options: LqrOptions, name: str, states: Sequence[str]) -> tuple[str, int, int] | None:
    """Return matrix, row and column of a weight."""
    letter, first, *second = name.split(".")
    rows = options.inputs if letter == "R" else states
    columns, last = (options.inputs, second[0]) if second else (rows, first)
    return (letter, rows.index(first), columns.index(last)) if first in rows and last in columns else None


def semidefinite(matrix: Sequence[Sequence[float]]) -> bool:
    """Tell whether a symmetric matrix is positive semidefinite up to rounding."""
    return smallest_eigenvalue(matrix) >= -ROUNDING


def from_allowed(
    allowed: Mapping[str, float | str], states: Sequence[Variable], inputs: Sequence[Variable]
) -> tuple[Row, Row]:
    """Return the diagonals of Q and R by Bryson's rule: a weight of 1/d^2 for an allowed deviation d.

    Parameters
    ----------
    allowed
        Allowed deviations by name, in the unit of each variable or with a unit of their own: of every input, and of at
        least one state. The other states are not weighed.

    Raises
    ------
    BadInput
        If a name is unknown or missing, or a deviation is not positive.
    """
    known(allowed, (*states, *inputs), "state or active input", "lqr.allowed")
    for variable in inputs:
        if variable.symbol not in allowed:
            raise BadInput(f"[lqr.allowed] {variable.symbol}: missing; every active input needs an allowed deviation")
    if not any(variable.symbol in allowed for variable in states):
        raise BadInput(
            "[lqr.allowed] no state has an allowed deviation, so the cost does not depend on the states; add one"
        )
    return tuple(_weight(allowed, v) for v in states), tuple(_weight(allowed, v) for v in inputs)


def _weight(allowed: Mapping[str, float | str], variable: Variable) -> float:
    if variable.symbol not in allowed:
        return 0.0
    key, given = f"[lqr.allowed] {variable.symbol}", allowed[variable.symbol]
    deviation = quantity(given, variable.unit, key)
    if not 1e-100 < deviation < 1e100:
        raise BadInput(f"{key}: an allowed deviation must be positive, not {shown(given)}; give a positive number")
    return 1.0 / deviation**2


def _matrix(rows: Sequence[float | Sequence[float]], size: int, name: str) -> Matrix:
    """Return a symmetric matrix from its rows or its diagonal."""
    wanted = f"give {size} numbers (the diagonal) or {size} rows of {size} numbers"
    diagonal = [row for row in rows if not isinstance(row, Sequence)]
    if len(rows) != size or len(diagonal) not in (0, size):
        raise BadInput(
            f"[lqr] {name}: the number of entries ({len(rows)}) is wrong, or single numbers are mixed with rows; "
            f"{wanted}"
        )
    if diagonal:
        return tuple(tuple(x if i == j else 0.0 for j in range(size)) for i, x in enumerate(diagonal))
    matrix = tuple(tuple(row) for row in rows if isinstance(row, Sequence))
    for i, row in enumerate(matrix):
        if len(row) != size:
            raise BadInput(f"[lqr] {name}: row {i + 1} has {len(row)} numbers; {wanted}")
    for i in range(size):
        for j in range(i):
            limit = ROUNDING * max(abs(matrix[i][j]), math.sqrt(abs(matrix[i][i]) * abs(matrix[j][j])))
            if not abs(matrix[i][j] - matrix[j][i]) <= limit:
                raise BadInput(f"[lqr] {name}: not symmetric at row {i + 1}, column {j + 1}; use (A + A')/2")
    return matrix


def smallest_eigenvalue(matrix: Sequence[Sequence[float]]) -> float:
    """Return the smallest eigenvalue of the matrix scaled to unit diagonal, whose sign is independent of units."""
    import numpy as np

    values = np.array(matrix)
    diagonal = np.diag(values)
    if (diagonal <= 0.0).any():
        # such a matrix is at best semidefinite, and then a zero on the diagonal has nothing but zeros in its row
        at_best = (diagonal >= 0.0).all() and not values[diagonal == 0.0].any()
        kept = values[diagonal > 0.0][:, diagonal > 0.0].tolist()
        return min(0.0, smallest_eigenvalue(kept) if kept else 0.0) if at_best else -1.0
    unit = 1.0 / np.sqrt(diagonal)
    return float(np.linalg.eigvalsh(values * np.outer(unit, unit))[0])
