"""Matrices: exact where their entries are, else with numbers; a vector is a column, or a list of numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.auditing.propositions.values import is_exact, is_number, measured

_SEED = 3


def det(of: Any) -> Any:
    """The determinant, exact where the matrix has letters."""
    return of.det(method="berkowitz") if is_exact(of) and of.free_symbols else np.linalg.det(numeric(of))


def inverse(of: Any) -> Any:
    """The inverse, exact where the matrix has letters."""
    return of.inv() if is_exact(of) and of.free_symbols else np.linalg.inv(numeric(of))


def transpose(of: Any) -> Any:
    """The transpose."""
    return of.T


def eye(size: int) -> Any:
    """The identity."""
    from satsym.symbolic.lookup import formulas

    return formulas.exact_matrix([[str(int(i == j)) for j in range(size)] for i in range(size)])


def shape(of: Any) -> list[int]:
    """Numbers of rows and columns."""
    return [int(size) for size in of.shape]


def entries(of: Any) -> list[Any]:
    """All entries, row by row."""
    return list(of) if is_exact(of) else np.asarray(of).ravel().tolist()


def rows(of: Any, places: Sequence[int]) -> Any:
    """Some rows of a matrix, counted from one."""
    chosen = [place - 1 for place in places]
    return of.extract(chosen, list(range(of.cols))) if is_exact(of) else np.asarray(of)[chosen]


def hstack(parts: Sequence[Any]) -> Any:
    """Matrices beside each other."""
    return parts[0].hstack(*parts) if all(map(is_exact, parts)) else np.column_stack([numeric(part) for part in parts])


def diagonal(parts: Sequence[Any]) -> Any:
    """Numbers, or square matrices, along the diagonal of a matrix that is zero elsewhere."""
    from satsym.symbolic.lookup import formulas

    size = len(parts)
    if all(is_exact(part) and is_number(part) for part in parts):
        zero = parts[0] - parts[0]
        return formulas.matrix_of([[parts[i] if i == j else zero for j in range(size)] for i in range(size)])
    from scipy.linalg import block_diag

    return np.asarray(block_diag(*[np.atleast_2d(numeric(part)) for part in parts]))


def kernel(of: Any) -> list[Any]:
    """Columns that span what a matrix maps to zero, exact where it has letters."""
    if is_exact(of) and of.free_symbols:
        return list(of.nullspace(simplify=True))
    from scipy.linalg import null_space

    return list(null_space(numeric(of), rcond=1e-9).T)


def exp(x: Any) -> Any:
    """The exponential of a number, or of each point of a curve; exact of an exact number."""
    from satsym.symbolic.lookup import formulas

    return formulas.function("exp", [x]) if is_exact(x) else np.exp(x)


def factorial(n: int) -> int:
    """1 times 2 times ... times n."""
    return math.factorial(n)


def naturals(count: int) -> list[int]:
    """0, 1, 2, ...: so many."""
    return list(range(count))


def vectors(of: Any) -> list[Array]:
    """Vectors to try with a square matrix, or of a size: zero, units, random ones, and the matrix's own directions.

    These are what it maps to zero, and if it is symmetric its eigenvectors.
    """
    size = of if isinstance(of, int) else int(of.shape[0])
    rng = np.random.default_rng(_SEED)
    found = [np.zeros(size), *np.eye(size), *rng.normal(size=(2 * size, size))]
    if isinstance(of, int):
        return found
    a = numeric(of)
    return [*found, *(np.linalg.eigh(a)[1].T if (a == a.T).all() else kernel(a))]


def numeric(of: Any) -> Array:
    """A matrix, a column or a number with plain numbers."""
    return np.asarray(measured(of) if is_exact(of) else of)
