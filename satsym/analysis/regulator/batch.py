"""Ten thousand Riccati equations at once, by structured doubling on arrays whose last axis counts the problems.

See :mod:`satsym.analysis.regulator.doubling` for the iteration. It starts not from a short step but from the Cayley
transform with a shift g, which turns an eigenvalue s of the closed loop into (s + g)/(s - g), small where g is near
|s|. The geometric mean of the |s| is known beforehand, from the determinant of the Hamiltonian matrix. Every answer is
judged by its residual; the few that elimination without pivots spoils are solved anew, one at a time.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from satsym.analysis.regulator import riccati
from satsym.arrays import Array

BLOCK = 2048
"""Problems at a time, so that a handful of matrices stay in the cache."""
MOST_DOUBLINGS = 60
LAST_CHANGE = 1e-10
"""Relative change after which nothing is left to gain: the next one would be its square."""
WANTED = 5e-13
"""Residual above which a problem is solved anew."""


def solve(
    A: ArrayLike, B: ArrayLike, Q: ArrayLike, R: ArrayLike, N: ArrayLike | None = None
) -> tuple[Array, Array, Array]:
    """Stabilising solutions and gains of many problems with J = integral of x'Qx + 2x'Nu + u'Ru.

    Parameters
    ----------
    A, B, Q, R
        Shapes (..., n, n), (..., n, m), (..., n, n) and (..., m, m), whose leading axes are broadcast. Q and R are
        taken to be symmetric, and R positive definite.
    N
        Shape (..., n, m); zero by default.

    Returns
    -------
    K : array of shape (..., m, n)
    P : array of shape (..., n, n)
    residual : array of shape (...)
        See :func:`satsym.analysis.regulator.riccati.residual`. All three are NaN where nothing stabilises.
    """
    a, b, q, r = (np.asarray(matrix, dtype=np.float64) for matrix in (A, B, Q, R))
    n = a.shape[-1]
    free, weight, ahead = riccati.without_cross(a, b, q, r, None if N is None else np.asarray(N, dtype=np.float64))
    lead = np.broadcast_shapes(*(matrix.shape[:-2] for matrix in (free, b, weight, r)))
    per_costate = np.linalg.solve(r, np.swapaxes(b, -1, -2))  # R^-1 B'
    a, g, q = (np.broadcast_to(each, (*lead, n, n)).reshape(-1, n, n) for each in (free, b @ per_costate, weight))
    P, left = np.empty(a.shape), np.empty(len(a))
    for start in range(0, len(a), BLOCK):
        part = slice(start, start + BLOCK)
        P[part], left[part] = _block(a[part], g[part], q[part])
    b, r = (np.broadcast_to(each, (*lead, *each.shape[-2:])).reshape(-1, *each.shape[-2:]) for each in (b, r))
    for i in np.flatnonzero(~(left <= WANTED)):
        try:
            P[i] = riccati.stabilising(a[i], b[i], q[i], r[i]).P
            left[i] = riccati.residual(a[i], g[i], q[i], P[i])
        except riccati.NoSolution:
            P[i], left[i] = np.nan, np.nan
    P = P.reshape(*lead, n, n)
    return per_costate @ P + ahead, P, left.reshape(lead)


def _block(a: Array, g: Array, q: Array) -> tuple[Array, Array]:
    """Solutions and residuals of a block of problems, first axis first."""
    A, G, Q = (np.ascontiguousarray(np.moveaxis(each, 0, -1)) for each in (a, g, q))
    with np.errstate(all="ignore"):  # what is not finite has a residual that says so
        P = _doubled(A, G, Q, _mean_eigenvalue(a, g, q))
        return np.moveaxis(P, -1, 0), _residual(A, G, Q, P)


def _mean_eigenvalue(a: Array, g: Array, q: Array) -> Array:
    """Geometric mean of the absolute eigenvalues of the closed loops; shape (M,)."""
    n = a.shape[-1]
    matrix = np.block([[a, -g], [-q, -np.swapaxes(a, -1, -2)]])
    return np.asarray(np.exp(np.linalg.slogdet(matrix)[1] / (2 * n)))


def _doubled(A: Array, G: Array, Q: Array, shift: Array) -> Array:
    """Structured doubling from the Cayley transform with this shift; last axis last."""
    one = np.eye(len(A))[:, :, None]
    shifted = A - shift * one
    inverse = _inverse(shifted)
    W = _inverse(_turned(shifted) + _product(Q, _product(inverse, G)))
    E: Array = one + 2.0 * shift * _turned(W)
    S = _symmetric(2.0 * shift * _product(inverse, _product(G, W)))
    T = _symmetric(2.0 * shift * _product(W, _product(Q, inverse)))
    for _ in range(MOST_DOUBLINGS):
        W = _inverse(one + _product(S, T))
        onward = _product(W, E)
        gained = _symmetric(_product(_turned(E), _product(T, onward)))
        T = T + gained
        if not (np.abs(_diagonal(gained)) > LAST_CHANGE * np.abs(_diagonal(T))).any():
            break
        S = S + _symmetric(_product(_product(E, _product(W, S)), _turned(E)))
        E = _product(E, onward)
    return T


def _residual(A: Array, G: Array, Q: Array, P: Array) -> Array:
    """As :func:`satsym.analysis.regulator.riccati.residual`, of each problem; shape (M,)."""
    diagonal = _diagonal(P)
    unit = 1.0 / np.sqrt(np.where(diagonal == 0.0, 1.0, np.abs(diagonal)))
    weight = unit[:, None] * unit
    once, twice, q = _product(_turned(A), P) * weight, _product(P, _product(G, P)) * weight, Q * weight
    size = 2.0 * _norm(once) + _norm(twice) + _norm(q)
    return np.asarray(_norm(once + _turned(once) - twice + q) / np.where(size == 0.0, 1.0, size))


def _inverse(matrix: Array) -> Array:
    """Inverses by Gauss and Jordan's elimination, without looking for pivots."""
    found = matrix.copy()
    for k in range(len(found)):
        pivot = 1.0 / found[k, k]
        row = found[k] * pivot
        row[k] = pivot
        column = found[:, k].copy()
        column[k] = 0.0
        found[:, k] = 0.0
        found -= column[:, None] * row
        found[k] = row
    return found


def _product(a: Array, b: Array) -> Array:
    return np.einsum("ikm,kjm->ijm", a, b)


def _turned(matrix: Array) -> Array:
    return np.swapaxes(matrix, 0, 1)


def _symmetric(matrix: Array) -> Array:
    return np.asarray(0.5 * (matrix + _turned(matrix)))


def _diagonal(matrix: Array) -> Array:
    return np.einsum("iim->im", matrix)


def _norm(matrix: Array) -> Array:
    return np.asarray(np.sqrt(np.einsum("ijm,ijm->m", matrix, matrix)))
