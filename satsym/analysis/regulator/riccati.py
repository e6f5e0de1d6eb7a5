"""The algebraic Riccati equation A'P + PA - P G P + Q = 0 with G = B R^-1 B', one at a time.

A cross weight N, J = integral of x'Qx + 2x'Nu + u'Ru, is taken out beforehand by u = v - R^-1 N'x: A - B R^-1 N' takes
the place of A and Q - N R^-1 N' that of Q. Neither this nor Q need be positive semidefinite: what is looked for is the
one solution P that makes the closed loop stable, and where it exists no other control that does so costs less (J. C.
Willems, Least squares stationary optimal control and the algebraic Riccati equation, IEEE TAC 16, 1971).

From x' = A x + B u and J = integral of x'Qx + u'Ru (no 1/2) the minimum principle gives, with lambda = P x for the
costates of J/2, the Hamiltonian matrix ((A, -G), (-Q, -A')). P comes from its invariant subspace of decaying motions
(A. J. Laub, A Schur method for solving algebraic Riccati equations, IEEE TAC 24, 1979), in units that balance the
matrix. What comes of it, or of SciPy's solver where it does not do, is refined by Newton's method (D. L. Kleinman, IEEE
TAC 13, 1968) in twice the precision (:mod:`satsym.analysis.regulator.refinement`).
"""

from __future__ import annotations

import warnings

import numpy as np

from satsym.analysis.regulator.refinement import Refined, refined, units_of
from satsym.arrays import Array
from satsym.lapack import lapack

DOUBTFUL = 1e-6
"""Largest estimated relative error of a solution that is accepted."""


class NoSolution(ArithmeticError):
    """No Riccati solution with a stable closed loop was found."""


def without_cross(A: Array, B: Array, Q: Array, R: Array, N: Array | None) -> tuple[Array, Array, Array]:
    """Remove a cross weight: return A - B R^-1 N', Q - N R^-1 N' and R^-1 N', with broadcast leading axes."""
    if N is None or not N.any():
        return A, Q, np.zeros((B.shape[-1], A.shape[-1]))
    ahead = np.linalg.solve(R, np.swapaxes(N, -1, -2))
    rest = Q - N @ ahead
    return A - B @ ahead, 0.5 * (rest + np.swapaxes(rest, -1, -2)), ahead


def hamiltonian(A: Array, G: Array, Q: Array) -> Array:
    """Return the Hamiltonian matrix ((A, -G), (-Q, -A')), shape (2n, 2n)."""
    n = len(A)
    found = np.empty((2 * n, 2 * n))
    found[:n, :n], found[:n, n:], found[n:, :n], found[n:, n:] = A, -G, -Q, -A.T
    return found


def balancing(matrix: Array) -> Array:
    """Return powers of two for the states that make rows and columns of a Hamiltonian matrix similar in size."""
    n = len(matrix) // 2
    *_, scale, _ = lapack().dgebal(np.abs(matrix), scale=1, permute=0)
    exponents = np.log2(scale)
    return np.exp2(np.rint(0.5 * (exponents[:n] - exponents[n:])))


def stabilising(A: Array, B: Array, Q: Array, R: Array) -> Refined:
    """Return the stabilising Riccati solution, accurate to the last digits where the problem allows.

    Parameters
    ----------
    A, B, Q, R
        Shapes (n, n), (n, m), (n, n) and (m, m), with J = integral of x'Qx + u'Ru.

    Raises
    ------
    NoSolution
        If none is found: the pair is not stabilisable, or a mode on the imaginary axis does not show in Q.
    """
    for start in (_by_subspace, _by_scipy):
        try:
            found = refined(A, B, Q, R, start(A, B, Q, R))
        except (NoSolution, ValueError):  # SciPy raises the latter, as a LinAlgError, too
            continue
        if found.error <= DOUBTFUL and (found.eigenvalues.real < 0.0).all():
            return found
    raise NoSolution


def _by_subspace(A: Array, B: Array, Q: Array, R: Array) -> Array:
    matrix = hamiltonian(A, cost_of_control(B, R), Q)
    units = balancing(matrix)
    both = np.concatenate([units, 1.0 / units])
    return _from_subspace(matrix * (both / both[:, None])) / np.outer(units, units)


def _by_scipy(A: Array, B: Array, Q: Array, R: Array) -> Array:
    """Solve the Riccati equation by SciPy's extended pencil, which avoids B R^-1 B': better where that is large."""
    from scipy.linalg import solve_continuous_are

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # about accuracy, which is measured
        return np.asarray(solve_continuous_are(A, B, Q, R))


def cost_of_control(B: Array, R: Array) -> Array:
    """Return G = B R^-1 B'."""
    found = B @ np.linalg.solve(R, B.T)
    return np.asarray(0.5 * (found + found.T))


def residual(A: Array, G: Array, Q: Array, P: Array, rate: Array | float = 0.0) -> float:
    """Return the norm of A'P + PA - P G P + Q - rate, relative to the sum of the norms of the four terms.

    Both are taken in units in which each diagonal element of P is 1 or -1, so that the result does not depend on units.
    In a finite horizon P changes, with the time left, at a `rate`.
    """
    if not np.isfinite(P).all():
        return float("inf")
    unit = units_of(P)
    weight = np.outer(unit, unit)
    once, twice, q = A.T @ P * weight, P @ G @ P * weight, Q * weight
    size = 2.0 * np.linalg.norm(once) + np.linalg.norm(twice) + np.linalg.norm(q)
    return float(np.linalg.norm(once + once.T - twice + q - rate * weight) / (size or 1.0))


def _from_subspace(matrix: Array) -> Array:
    """Return P from the decaying motions of the Hamiltonian matrix, which must be half of all."""
    n = len(matrix) // 2
    _, decaying, *_, vectors, _, failed = lapack().dgees(
        lambda real, imaginary: real < 0.0, matrix, sort_t=1, lwork=40 * n
    )
    if decaying != n or failed:
        raise NoSolution
    try:
        P = np.linalg.solve(vectors[:n, :n].T, vectors[n:, :n].T)
    except np.linalg.LinAlgError:
        raise NoSolution from None
    return 0.5 * (P + P.T)
