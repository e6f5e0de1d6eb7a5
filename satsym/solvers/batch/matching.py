"""Newton's linear equations for the nodes of many shooting problems: segments that meet, given ends.

All nodes follow from the initial costates (condensing), so that a system as small as the boundary is left (Bock and
Plitt, A Multiple Shooting Algorithm for Direct Solution of Optimal Control Problems, 1984).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.solvers.batch.condensing import Condensing

CLEAR = 1e-3
"""Least pivot of what the nodes before one leave of the second derivatives there, in units of the square roots of
these, that is positive beyond doubt."""


@dataclass(frozen=True, eq=False)
class Matching:
    """The equations of M problems, linearised."""

    transition: Array
    """Ends of segments by their beginnings, shape (2n, 2n, N, M)."""
    field: Array
    """Nodes by initial costates in their units, shape (2n, n, N+1, M)."""
    inverse: Array
    """Initial costates by what is missing at the end, in units, shape (n, n, M); not finite where nothing decides."""
    units: Array
    """Of states and costates, shape (2n,)."""
    condense: Condensing

    @classmethod
    def of(cls, transition: Array, units: Array, condense: Condensing) -> Matching:
        """The equations with these transitions."""
        rows, count = len(transition), transition.shape[3]
        n = rows // 2
        start = np.zeros((rows, n, count))
        start[np.arange(n, rows), np.arange(n)] = units[n:, None]
        field = condense(transition, start, None)
        reached = (field[:n, :, -1] / units[:n, None, None]).transpose(2, 0, 1)
        return cls(transition, field, inverses(reached).transpose(1, 2, 0), units, condense)

    def only(self, chosen: NDArray[np.intp]) -> Matching:
        """Some of them."""
        if len(chosen) == self.inverse.shape[2]:
            return self
        transition, field, inverse = (rows[..., chosen] for rows in (self.transition, self.field, self.inverse))
        return Matching(transition, field, inverse, self.units, self.condense)

    def correction(self, start: Array, gaps: Array, missing: Array) -> Array:
        """By how much nodes move for segments to meet and end as they should, shape (2n, N+1, M).

        Parameters
        ----------
        start
            Where the first should be, less where it is, shape (n, M).
        gaps
            Where each segment ends, less where the next one begins, shape (2n, N, M).
        missing
            Where the last should end, less the last node, shape (n, M).
        """
        n = len(self.inverse)
        begun = np.concatenate([start, np.zeros_like(start)])
        found = self.condense(self.transition, begun[:, None], gaps)[:, 0]
        wanted = (missing - found[:n, -1]) / self.units[:n, None]
        costates = (self.inverse * wanted).sum(axis=1)
        for column, costate in enumerate(costates):
            found += self.field[:, column] * costate
        return found


def inverses(matrices: Array) -> Array:
    """Of a stack; without numbers where one is singular."""
    try:
        return np.asarray(np.linalg.inv(matrices))
    except np.linalg.LinAlgError:
        sound = np.isfinite(matrices).all(axis=(-1, -2)) & (np.linalg.det(matrices) != 0.0)
        found = np.full_like(matrices, np.nan)
        found[sound] = np.linalg.inv(matrices[sound])
        return found


def positive(transition: Array, inverse: Array | None = None) -> NDArray[np.bool_]:
    """Whether the second derivatives of the cost by the nodes between segments are positive definite, shape (M,).

    With (x, lambda) -> (A x + B lambda, C x + D lambda) over a segment, its cost has the derivatives lambda by where it
    begins, and -lambda by where it ends: by both ends -B^-1 A, -D B^-1, and B^-1 across. If no segment has a conjugate
    point of its own, they are so if and only if the whole has none (Morse, The calculus of variations in the large,
    1934, III). Here that is only said where it is so beyond doubt.

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
        clear &= (pivots > CLEAR).all(axis=0)
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
