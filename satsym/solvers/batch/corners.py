"""Jacobi's condition for many extremals at once, from the cost of broken extremals with corners at their nodes.

If the transition matrix of a segment is (x, lambda) -> (A x + B lambda, C x + D lambda), the second derivatives of its
cost with respect to its end points are -B^-1 A and -D B^-1, with the mixed derivative B^-1. If no segment has a
conjugate point of its own, the block-tridiagonal matrix of the second derivatives with respect to all corners is
positive definite if and only if the whole extremal has no conjugate point (Morse, The calculus of variations in the
large, 1934, III).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array

CLEAR_PIVOT = 1e-3
"""Smallest pivot in the factorisation of the second derivatives that counts as clearly positive.

Pivots refer to the matrix scaled to a unit diagonal. A smaller pivot leaves the extremal to a closer examination.
"""


def inverses(matrices: Array) -> Array:
    """Return the inverses of a stack of matrices; NaN for singular matrices."""
    try:
        return np.asarray(np.linalg.inv(matrices))
    except np.linalg.LinAlgError:
        sound = np.isfinite(matrices).all(axis=(-1, -2)) & (np.linalg.det(matrices) != 0.0)
        found = np.full_like(matrices, np.nan)
        found[sound] = np.linalg.inv(matrices[sound])
        return found


def positive(transition: Array, inverse: Array | None = None) -> NDArray[np.bool_]:
    """Return whether the second derivatives with respect to the corners are clearly positive definite, shape (M,).

    Parameters
    ----------
    transition
        Transition matrices of the segments, shape (2n, 2n, N, M), in units in which they are symplectic.
    inverse
        The inverses B^-1, shape (M, N, n, n), if they are known.
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
    """Return pivots of symmetric matrices A, shape (n, M), and R' A^-1 R for right-hand sides R, shape (n, c, M)."""
    matrix, right, pivots = matrix.copy(), right.copy(), np.empty(matrix.shape[1:])
    taken = np.zeros((right.shape[1], *right.shape[1:]))
    for k in range(len(matrix)):
        pivots[k] = matrix[k, k]
        factors = matrix[k + 1 :, k] / pivots[k]
        matrix[k + 1 :, k + 1 :] -= factors[:, None] * matrix[k, k + 1 :]
        right[k + 1 :] -= factors[:, None] * right[k]
        taken += right[k] * (right[k] / pivots[k])[:, None]
    return pivots, taken
