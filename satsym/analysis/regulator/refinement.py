"""Newton's method on the Riccati equation with residuals in twice the precision, and an estimate of the error left.

The residual of a nearly right P is a small difference of large terms, and what rounding leaves of it in one precision
says little about P where fast and slow motions lie far apart. Evaluated in some 32 digits it is the residual of this
very P, and the correction D that Newton's method (Kleinman's) makes of it,

    (A - B K)'D + D (A - B K) = -residual,    K = R^-1 B'P,

is its error but for D's square: so the size of the last correction is an estimate of the error, not a bound for it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import reduce

import numpy as np
from numpy.typing import NDArray

from satsym.analysis.orbits.double_double import Pair, add, multiply, negative
from satsym.arrays import Array
from satsym.lapack import lapack

ACCURATE = 1e-13
"""Largest correction, in double precision, after which no refinement in higher precision is needed."""

LAST_CORRECTION = 2e-16
"""Size of a correction after which refinement ends."""

MOST_STEPS = 12
"""Most steps of Newton's method, which needs three or four from a P with some right digits."""


@dataclass(frozen=True, eq=False)
class Refined:
    """A Riccati solution refined to the last digits, as far as the problem allows."""

    P: Array
    """The refined solution, shape (n, n)."""
    error: float
    """Estimated error of P, relative to P in units of :func:`units_of`; infinite where corrections do not decrease."""
    eigenvalues: NDArray[np.complexfloating]
    """Eigenvalues of the closed loop, shape (n,); NaN where there is no correction of P."""


@dataclass(frozen=True, eq=False)
class _Correction:
    """The correction of P by Newton's method, its size relative to P, and the eigenvalues under the gain of P."""

    step: Array
    size: float
    eigenvalues: NDArray[np.complexfloating]


def refined(A: Array, B: Array, Q: Array, R: Array, P: Array) -> Refined:
    """Refine a nearly right Riccati solution to the last digits, as far as the problem allows.

    Parameters
    ----------
    A, B, Q, R
        Shapes (n, n), (n, m), (n, n) and (m, m).
    P
        Shape (n, n); need not stabilise.
    """
    left = _correction(A, B, Q, R, P, rounded)
    if left.size <= ACCURATE:  # its own rounding included
        return Refined(P, max(left.size, LAST_CORRECTION), left.eigenvalues)
    left = _correction(A, B, Q, R, P, residual)
    for _ in range(MOST_STEPS):
        if not LAST_CORRECTION < left.size < np.inf:
            break
        better = P + left.step
        again = _correction(A, B, Q, R, better, residual)
        if not again.size < left.size and left.size < 1e-2:  # far away a first step may be a detour
            break
        P, left = better, again
    return Refined(P, max(left.size, LAST_CORRECTION), left.eigenvalues)


def _correction(
    A: Array, B: Array, Q: Array, R: Array, P: Array, residual_of: Callable[..., tuple[Array, Array]]
) -> _Correction:
    if not np.isfinite(P).all() or not P.any():
        return _none(P) if P.any() else _Correction(P, 0.0, np.linalg.eigvals(A).astype(complex))
    unit = np.exp2(np.rint(np.log2(units_of(P))))  # powers of two round nothing
    weight = np.outer(unit, unit)
    a, b, q, p = A * (unit / unit[:, None]), B / unit[:, None], Q * weight, P * weight
    off, gain = residual_of(a, b, q, R, p)
    if not np.isfinite(off).all():
        return _none(P)
    try:
        found, eigenvalues = lyapunov(a - b @ gain, off)
    except ArithmeticError:
        return _none(P)
    return _Correction(found / weight, float(np.linalg.norm(found) / np.linalg.norm(p)), eigenvalues)


def units_of(P: Array) -> Array:
    """Return units of the states in which the diagonal elements of P are 1 or -1, shape (n,).

    An indefinite P may have larger elements off its diagonal; then the largest of each row counts.
    """
    size = np.sqrt(np.abs(np.diag(P)))
    if (np.abs(P) > 2.0 * np.outer(size, size)).any():
        size = np.sqrt(np.abs(P).max(axis=1))
    return np.asarray(1.0 / np.where(size > 0.0, size, 1.0))


def _none(P: Array) -> _Correction:
    return _Correction(np.zeros_like(P), float("inf"), np.full(len(P), complex("nan")))


def lyapunov(closed: Array, cost: Array) -> tuple[Array, NDArray[np.complexfloating]]:
    """Return the symmetric X with closed' X + X closed + cost = 0, and the eigenvalues of the closed loop.

    By the Schur form of the closed loop (R. H. Bartels and G. W. Stewart, CACM 15, 1972).

    Raises
    ------
    ArithmeticError
        If the sum of two eigenvalues of the closed loop is zero, so that they do not all decay.
    """
    form, _, real, imaginary, vectors, _, failed = lapack().dgees(_unsorted, closed, lwork=40 * len(closed))
    if failed:
        raise ArithmeticError
    found, scale, perturbed = lapack().dtrsyl(form, form, vectors.T @ cost @ vectors, trana="T")
    if perturbed:
        raise ArithmeticError
    found = vectors @ found @ vectors.T / -scale
    return 0.5 * (found + found.T), real + 1j * imaginary


def _unsorted(*_: float) -> bool:
    """Select every eigenvalue, for Schur forms whose eigenvalues may be in any order."""
    return True


def residual(A: Array, B: Array, Q: Array, R: Array, P: Array) -> tuple[Array, Array]:
    """Return A'P + PA - P B R^-1 B'P + Q in twice the precision, rounded once, and the gain R^-1 B'P."""
    once = _times(_exact(A.T), _exact(P))
    paid = _times(_exact(P), _exact(B))
    gain = _solved(R, _turned(paid))
    terms = [once, _turned(once), negative(_times(paid, gain)), _exact(Q)]
    return reduce(add, terms)[0], gain[0]


def rounded(A: Array, B: Array, Q: Array, R: Array, P: Array) -> tuple[Array, Array]:
    """Return the residual of the Riccati equation and the gain R^-1 B'P, in double precision alone."""
    gain = np.linalg.solve(R, B.T @ P)
    once = A.T @ P
    return once + once.T - P @ B @ gain + Q, gain


def _solved(R: Array, right: Pair) -> Pair:
    """Return R^-1 times a matrix, by a first solution and corrections until these are negligible."""
    found = _exact(np.linalg.solve(R, right[0]))
    for _ in range(3):
        left = add(right, negative(_times(_exact(R), found)))
        found = add(found, _exact(np.linalg.solve(R, left[0])))
    return found


def _times(a: Pair, b: Pair) -> Pair:
    """Return the product of two matrices in twice the precision."""
    columns = range(a[0].shape[1])
    return reduce(
        add, (multiply((a[0][:, k, None], a[1][:, k, None]), (b[0][None, k], b[1][None, k])) for k in columns)
    )


def _exact(matrix: Array) -> Pair:
    return matrix, np.zeros_like(matrix)


def _turned(matrix: Pair) -> Pair:
    return matrix[0].T, matrix[1].T
