"""Newton's method on the Riccati equation with residuals in twice the precision, and what is then left of the error.

The residual of a nearly right P is a small difference of large terms, and what rounding leaves of it in one precision
says little about P where fast and slow motions lie far apart. Evaluated in some 32 digits it is the residual of this
very P, and the correction D that Newton's method (Kleinman's) makes of it,

    (A - B K)'D + D (A - B K) = -residual,    K = R^-1 B'P,

is its error but for D's square: so the size of the last correction is an estimate of the error, not a bound for it.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from functools import reduce

import numpy as np

from satsym.analysis.orbits.double_double import Pair, add, multiply, negative
from satsym.arrays import Array

ACCURATE = 1e-13
"""A correction below this, found without more precision, shows that none is needed."""

SETTLED = 2e-16
"""A correction below this changes nothing."""

MOST_STEPS = 12
"""Of Newton's method, which needs three or four from a P with some right digits."""


def refined(A: Array, B: Array, Q: Array, R: Array, P: Array) -> tuple[Array, float]:
    """A nearly right solution made right to the last digits, as far as the problem allows.

    Parameters
    ----------
    A, B, Q, R
        Shapes (n, n), (n, m), (n, n) and (m, m).
    P
        Shape (n, n); need not stabilise.

    Returns
    -------
    P : array of shape (n, n)
    error : float
        Estimate of the error of P, relative to it, in units in which its diagonal elements are 1; infinite where
        corrections do not become smaller.
    """
    _, error = _correction(A, B, Q, R, P, rounded)
    if error <= ACCURATE:  # its own rounding included
        return P, max(error, SETTLED)
    correction, error = _correction(A, B, Q, R, P, residual)
    for _ in range(MOST_STEPS):
        if not SETTLED < error < np.inf:
            break
        better = P + correction
        again, left = _correction(A, B, Q, R, better, residual)
        if not left < error and error < 1e-2:  # far away a first step may be a detour
            break
        P, correction, error = better, again, left
    return P, max(error, SETTLED)


def _correction(
    A: Array, B: Array, Q: Array, R: Array, P: Array, residual_of: Callable[..., tuple[Array, Array]]
) -> tuple[Array, float]:
    """What Newton's method would add to P, and its size relative to P."""
    diagonal = np.diag(P)
    if not np.isfinite(P).all() or not (diagonal > 0.0).any():
        return np.zeros_like(P), float("inf") if P.any() else 0.0
    unit = np.exp2(-np.rint(0.5 * np.log2(np.where(diagonal > 0.0, diagonal, 1.0))))  # powers of two round nothing
    weight = np.outer(unit, unit)
    a, b, q, p = A * (unit / unit[:, None]), B / unit[:, None], Q * weight, P * weight
    off, gain = residual_of(a, b, q, R, p)
    if not np.isfinite(off).all():
        return np.zeros_like(P), float("inf")
    try:
        found = lyapunov(a - b @ gain, off)
    except ArithmeticError:
        return np.zeros_like(P), float("inf")
    return found / weight, float(np.linalg.norm(found) / np.linalg.norm(p))


def lyapunov(closed: Array, cost: Array) -> Array:
    """The symmetric X with closed' X + X closed + cost = 0.

    Raises
    ------
    ArithmeticError
        If the sum of two eigenvalues of the closed loop is zero, so that they do not all decay.
    """
    from scipy.linalg import solve_continuous_lyapunov

    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        try:
            found = solve_continuous_lyapunov(closed.T, -cost)
        except RuntimeWarning as warning:
            raise ArithmeticError from warning
    return np.asarray(0.5 * (found + found.T))


def residual(A: Array, B: Array, Q: Array, R: Array, P: Array) -> tuple[Array, Array]:
    """A'P + PA - P B R^-1 B'P + Q in twice the precision, rounded once, and the gain R^-1 B'P."""
    once = _times(_exact(A.T), _exact(P))
    paid = _times(_exact(P), _exact(B))
    gain = _solved(R, _turned(paid))
    terms = [once, _turned(once), negative(_times(paid, gain)), _exact(Q)]
    return reduce(add, terms)[0], gain[0]


def rounded(A: Array, B: Array, Q: Array, R: Array, P: Array) -> tuple[Array, Array]:
    """The same in one precision."""
    gain = np.linalg.solve(R, B.T @ P)
    once = A.T @ P
    return once + once.T - P @ B @ gain + Q, gain


def _solved(R: Array, right: Pair) -> Pair:
    """R^-1 times a matrix: a first solution and its corrections, until they tell nothing more."""
    found = _exact(np.linalg.solve(R, right[0]))
    for _ in range(3):
        left = add(right, negative(_times(_exact(R), found)))
        found = add(found, _exact(np.linalg.solve(R, left[0])))
    return found


def _times(a: Pair, b: Pair) -> Pair:
    """The product of two matrices."""
    columns = range(a[0].shape[1])
    return reduce(
        add, (multiply((a[0][:, k, None], a[1][:, k, None]), (b[0][None, k], b[1][None, k])) for k in columns)
    )


def _exact(matrix: Array) -> Pair:
    return matrix, np.zeros_like(matrix)


def _turned(matrix: Pair) -> Pair:
    return matrix[0].T, matrix[1].T
