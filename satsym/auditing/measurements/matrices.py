"""Operations on matrices, exact for exact entries, otherwise numerical; a vector is a column or a list of numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.auditing.propositions.values import is_exact, is_number, measured

_SEED = 3


def det(of: Any) -> Any:
    """Return the determinant, exact if the matrix contains letters."""
    return of.det(method="berkowitz") if is_exact(of) and of.free_symbols else np.linalg.det(numeric(of))


def inverse(of: Any) -> Any:
    """Return the inverse, exact if the matrix contains letters."""
    return of.inv() if is_exact(of) and of.free_symbols else np.linalg.inv(numeric(of))


def transpose(of: Any) -> Any:
    """Return the transpose of a matrix."""
    return of.T


def eye(size: int) -> Any:
    """Return the identity matrix."""
    from satsym.symbolic.lookup import formulas

    return formulas.exact_matrix([[str(int(i == j)) for j in range(size)] for i in range(size)])


def shape(of: Any) -> list[int]:
    """Return the numbers of rows and columns."""
    return [int(size) for size in of.shape]


def entries(of: Any) -> list[Any]:
    """Return all entries, row by row."""
    return list(of) if is_exact(of) else np.asarray(of).ravel().tolist()


def rows(of: Any, places: Sequence[int]) -> Any:
    """Return some rows of a matrix; the first row is number one."""
    chosen = [place - 1 for place in places]
    return of.extract(chosen, list(range(of.cols))) if is_exact(of) else np.asarray(of)[chosen]


def hstack(parts: Sequence[Any]) -> Any:
    """Return matrices stacked horizontally."""
    return parts[0].hstack(*parts) if all(map(is_exact, parts)) else np.column_stack([numeric(part) for part in parts])


def diagonal(parts: Sequence[Any]) -> Any:
    """Return the block-diagonal matrix of numbers or square matrices."""
    from satsym.symbolic.lookup import formulas

    size = len(parts)
    if all(is_exact(part) and is_number(part) for part in parts):
        zero = parts[0] - parts[0]
        return formulas.matrix_of([[parts[i] if i == j else zero for j in range(size)] for i in range(size)])
    from scipy.linalg import block_diag

    return np.asarray(block_diag(*[np.atleast_2d(numeric(part)) for part in parts]))


def kernel(of: Any) -> list[Any]:
    """Return a basis of the null space of a matrix as columns, exact if the matrix contains letters."""
    if is_exact(of) and of.free_symbols:
        return list(of.nullspace(simplify=True))
    from scipy.linalg import null_space

    return list(null_space(numeric(of), rcond=1e-9).T)


def exp(x: Any) -> Any:
    """Return the exponential of a number or of each point of a curve; exact for an exact number."""
    from satsym.symbolic.lookup import formulas

    return formulas.function("exp", [x]) if is_exact(x) else np.exp(x)


def factorial(n: int) -> int:
    """Return the factorial of n."""
    return math.factorial(n)


def naturals(count: int) -> list[int]:
    """Return the list 0, 1, 2, ... with `count` entries."""
    return list(range(count))


def vectors(of: Any) -> list[Array]:
    """Return test vectors for a square matrix or a dimension: zero, unit, random vectors and special directions.

    The special directions are the eigenvectors of a symmetric matrix, and a basis of the null space of any other
    matrix.
    """
    size = of if isinstance(of, int) else int(of.shape[0])
    rng = np.random.default_rng(_SEED)
    found = [np.zeros(size), *np.eye(size), *rng.normal(size=(2 * size, size))]
    if isinstance(of, int):
        return found
    a = numeric(of)
    return [*found, *(np.linalg.eigh(a)[1].T if (a == a.T).all() else kernel(a))]


def numeric(of: Any) -> Array:
    """Return a matrix, column or number as an array of numbers."""
    return np.asarray(measured(of) if is_exact(of) else of)
