"""Eigenvalues with their multiplicities and Jordan blocks, decided numerically with stated tolerances.

An eigenvalue of algebraic multiplicity m comes out of any algorithm as m numbers, up to the m-th root of the rounding
error apart; their mean is accurate. Neighbours are therefore tried as one eigenvalue s, and kept together only if the
null spaces of A - s, (A - s)^2, ... together have m dimensions. These dimensions also tell the Jordan blocks (Weyr's
characteristic); they are found by deflation, never by forming powers (Golub and Wilkinson, SIAM Review 18, 1976).

Not tried are numbers that stand alone: those which relative errors of the entries of A, and the rounding errors of the
algorithm, move by much less than what parts them from all others. A slow motion beside a fast one, as that of a
satellite beside its wheel's in sprung gimbals, has eigenvalues that are next to zero for the matrix, and well known.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.analysis.linear.scaling import scaled
from satsym.analysis.linear.system import system
from satsym.arrays import Array

NULL = 1e-9
"""A singular value below this, relative to the size of the matrix, is zero: so eigenvalues that are nearer to one
another are taken for one."""

SPREAD = 1e-12
"""The m numbers that stand for an eigenvalue of multiplicity m are at most the m-th root of this apart."""

AXIS = 1e-11
"""A real or imaginary part below this, relative to the size of the matrix, is zero."""


ENTRIES, ROUNDING = 1e-12, 1e-15
"""Errors of the entries, relative to each, and of the algorithm, relative to the matrix."""

ALONE = 30.0
"""An eigenvalue that is so many times farther from all others than these errors move it stands alone."""


@dataclass(frozen=True)
class Eigenvalue:
    """An eigenvalue of a matrix."""

    value: complex
    """Exactly real, or exactly on the imaginary axis, where it is so within the tolerance."""
    blocks: tuple[int, ...]
    """Sizes of its Jordan blocks, the largest first."""

    @property
    def algebraic(self) -> int:
        """Multiplicity as a root of the characteristic polynomial."""
        return sum(self.blocks)

    @property
    def geometric(self) -> int:
        """Number of independent eigenvectors."""
        return len(self.blocks)


def spectrum(A: Array) -> tuple[Eigenvalue, ...]:
    """Eigenvalues of a real square matrix, the largest real part first.

    Parameters
    ----------
    A
        Shape (n, n), in any units.
    """
    fitted = scaled(system(A))
    size = float(np.exp2(np.rint(np.log2(np.linalg.norm(fitted.A, 2) or 1.0))))  # a power of two adds no error
    numbers, alone = _alone(fitted.A / size)
    rest = numbers[~alone]
    groups = [(complex(value), [1]) for value in numbers[alone]]
    groups += _told_apart(_without(fitted.A / size, numbers, alone), rest, _tree(rest)) if len(rest) else []
    found = [
        Eigenvalue(_clean(value) * size * fitted.rate, tuple(sum(added > i for added in weyr) for i in range(weyr[0])))
        for value, weyr in groups
    ]
    return tuple(sorted(found, key=lambda each: (-each.value.real, abs(each.value.imag), -each.value.imag)))


def _alone(A: Array) -> tuple[NDArray[np.complexfloating], NDArray[np.bool_]]:
    """Eigenvalues of a matrix of size 1, and which of them are simple beyond doubt."""
    from scipy.linalg import eig

    numbers, left, right = eig(A, left=True, right=True)
    apart = np.abs(numbers[:, None] - numbers) + np.diag(np.full(len(A), np.inf))
    entries = ENTRIES * np.einsum("ij,ik,kj->j", np.abs(left), np.abs(A), np.abs(right))
    overlap = np.abs(np.einsum("ij,ij->j", left.conj(), right))
    by_entries = np.divide(entries, overlap, out=np.where(entries > 0.0, np.inf, 0.0), where=overlap > 0.0)
    # what is zero because of where A has no entries is so for the algorithm, too
    by_both = by_entries + np.divide(ROUNDING, overlap, out=np.full(len(A), np.inf), where=overlap > ROUNDING)
    far = apart > np.maximum(NULL, ALONE * np.maximum(by_both[:, None], by_entries))
    return numbers, far.all(axis=1)


def _without(A: Array, numbers: NDArray[np.complexfloating], alone: NDArray[np.bool_]) -> Array:
    """The matrix on the invariant subspace of the eigenvalues that do not stand alone."""
    if not alone.any():
        return A
    from scipy.linalg import schur

    form, _, count = schur(A, sort=lambda re, im: not alone[np.abs(numbers - complex(re, im)).argmin()])
    return np.asarray(form[:count, :count])


def _tree(numbers: NDArray[np.complexfloating]) -> Any:
    """The numbers joined nearest first, as a binary tree."""
    if len(numbers) == 1:
        return None
    from scipy.cluster.hierarchy import linkage, to_tree

    pairs = np.triu_indices(len(numbers), 1)
    return to_tree(linkage(np.abs(numbers[:, None] - numbers)[pairs], "single"))


def _told_apart(A: Array, numbers: NDArray[np.complexfloating], tree: Any) -> list[tuple[complex, list[int]]]:
    """Eigenvalues among these numbers, each with the dimensions that each power of A - s adds to its null space."""
    if tree is None or tree.is_leaf():
        return [(complex(numbers[0 if tree is None else tree.id]), [1])]
    together = numbers[tree.pre_order()]
    mean, count = complex(together.mean()), len(together)
    if np.abs(together - mean).max() <= SPREAD ** (1.0 / count):
        weyr = _weyr(A, _clean(mean))
        if sum(weyr) == count:
            return [(mean, weyr)]
    return [found for branch in (tree.left, tree.right) for found in _told_apart(A, numbers, branch)]


def _weyr(A: Array, value: complex) -> list[int]:
    """By how much each power of A - s enlarges the null space."""
    rest = A - value * np.eye(len(A)) if value.imag else A - value.real * np.eye(len(A))
    found: list[int] = []
    while len(rest):
        _, singular, right = np.linalg.svd(rest)
        rank = int((singular > NULL).sum())
        if rank == len(rest):
            break
        found.append(len(rest) - rank)
        kept = right[:rank]
        rest = kept @ rest @ kept.conj().T
    return found


def _clean(value: complex) -> complex:
    real = value.real if abs(value.real) > AXIS else 0.0
    return complex(real, value.imag if abs(value.imag) > AXIS else 0.0)
