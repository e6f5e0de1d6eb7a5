"""Jacobi's condition of many extremals at once, by the cost of broken ones with corners at their nodes.

With (x, lambda) -> (A x + B lambda, C x + D lambda) over a segment, its cost has the derivatives lambda by where it
begins, and -lambda by where it ends: by both ends -B^-1 A, -D B^-1, and B^-1 across. If no segment has a conjugate
point of its own, the second derivatives by all corners, a matrix with three block diagonals, are positive definite if
and only if the whole has none (Morse, The calculus of variations in the large, 1934, III).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array

CLEAR_PIVOT = 1e-3
"""Least pivot of what the nodes before one leave of the second derivatives there, in units of the square roots of
these, that is positive beyond doubt."""


def inverses(matrices: Array) -> Array:
    """Inverses of a stack of matrices; without numbers where one is singular."""
    try:
        return np.asarray(np.linalg.inv(matrices))
    except np.linalg.LinAlgError:
        sound = np.isfinite(matrices).all(axis=(-1, -2)) & (np.linalg.det(matrices) != 0.0)
        found = np.full_like(matrices, np.nan)
        found[sound] = np.linalg.inv(matrices[sound])
        return found


def positive(transition: Array, inverse: Array | None = None) -> NDArray[np.bool_]:
    """Whether the second derivatives of the cost by the corners are positive definite beyond doubt, shape (M,).

    Parameters
    ----------
    transition
        Shape (2n, 2n, N, M), in units in which it is symplectic.
    inverse
        B^-1, shape (M, N, n, n), if that is known.
    """
    n = len(transition) // 2
    stack = transition.transpose(3, 2, 0, 1)
    A, B, D = stack[..., :n, :n], stack[..., :n, n:], stack[..., n:, n:]
    inverse = inverses(B) if inverse is None else inverse
    own = -(D[:, :-1] @ inverse[:, :-1] + inverse[:, 1:] @ A[:, 1:])
    own = (own + own.swapaxes(-1, -2)) / 2.0
    diagonal = np.einsum("mkii->mki", own)
    clear = np.asarray((diagonal > 0.0).all(axis=(1, 2)) & np.isfinite(own).all(axis=(1, 2, 3)))
    unit = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
    scaled = np.ascontiguousarray((own * unit[:, :, :, None] * unit[:, :, None, :]).transpose(1, 2, 3, 0))
    across = inverse[:, 1:-1] * unit[:, :-1, :, None] * unit[:, 1:, None, :]
    across = np.ascontiguousarray(across.transpose(1, 2, 3, 0))
    left = scaled[0] if len(scaled) else np.ones((0, 0, len(clear)))
    for k in range(len(scaled)):
        pivots, taken = _eliminated(left, across[k] if k + 1 < len(scaled) else left[:, :0])
        clear &= (pivots > CLEAR_PIVOT).all(axis=0)
        if k + 1 < len(scaled):
            left = scaled[k + 1] - taken
    return clear


def _eliminated(matrix: Array, right: Array) -> tuple[Array, Array]:
    """Pivots of symmetric matrices, shape (n, M), and R' A^-1 R of these and right-hand sides R, shape (n, c, M)."""
    matrix, right, pivots = matrix.copy(), right.copy(), np.empty(matrix.shape[1:])
    taken = np.zeros((right.shape[1], *right.shape[1:]))
    for k in range(len(matrix)):
        pivots[k] = matrix[k, k]
        factors = matrix[k + 1 :, k] / pivots[k]
        matrix[k + 1 :, k + 1 :] -= factors[:, None] * matrix[k, k + 1 :]
        right[k + 1 :] -= factors[:, None] * right[k]
        taken += right[k] * (right[k] / pivots[k])[:, None]
    return pivots, taken
