"""The algebraic Riccati equation A'P + PA - P G P + Q = 0 with G = B R^-1 B', one at a time.

From x' = A x + B u and J = integral of x'Qx + u'Ru (no 1/2) the minimum principle gives, with lambda = P x for the
costates of J/2, the Hamiltonian matrix ((A, -G), (-Q, -A')). P comes from its invariant subspace of decaying motions
(A. J. Laub, A Schur method for solving algebraic Riccati equations, IEEE TAC 24, 1979), in units that balance the
matrix, and Newton's method (D. L. Kleinman, IEEE TAC 13, 1968) where that is not accurate enough. What comes of it, or
of SciPy's solver where it does not do, is refined in twice the precision (:mod:`satsym.analysis.regulator.refinement`).
"""

from __future__ import annotations

import warnings

import numpy as np
from numpy.typing import NDArray

from satsym.analysis.regulator.refinement import lyapunov, refined
from satsym.arrays import Array

ACCURATE = 1e-13
"""A residual below this needs no improvement."""
MOST_STEPS = 8
"""Of Newton's method."""
DOUBTFUL = 1e-6
"""An estimated error above this, relative, is none to rely on."""


class NoSolution(ArithmeticError):
    """No solution for which the closed loop is stable was found."""


def hamiltonian(A: Array, G: Array, Q: Array) -> Array:
    """The Hamiltonian matrix ((A, -G), (-Q, -A')), shape (2n, 2n)."""
    n = len(A)
    found = np.empty((2 * n, 2 * n))
    found[:n, :n], found[:n, n:], found[n:, :n], found[n:, n:] = A, -G, -Q, -A.T
    return found


def balancing(matrix: Array) -> Array:
    """Powers of two for the states that make the rows and columns of a Hamiltonian matrix alike in size."""
    from scipy.linalg import matrix_balance

    n = len(matrix) // 2
    _, (scale, _) = matrix_balance(np.abs(matrix), permute=False, separate=True)
    exponents = np.log2(scale)
    return np.exp2(np.rint(0.5 * (exponents[:n] - exponents[n:])))


def solve(A: Array, G: Array, Q: Array) -> tuple[Array, NDArray[np.complexfloating]]:
    """The stabilising solution.

    Parameters
    ----------
    A, G, Q
        Shape (n, n); G and Q symmetric and positive semidefinite.

    Returns
    -------
    P : array of shape (n, n)
    eigenvalues : complex array of shape (n,)
        Of the closed loop A - G P, all with negative real parts.

    Raises
    ------
    NoSolution
        If there is none: the pair is not stabilisable, or a mode on the imaginary axis does not show in Q.
    """
    matrix = hamiltonian(A, G, Q)
    units = balancing(matrix)
    both = np.concatenate([units, 1.0 / units])
    P = _from_subspace(matrix * (both / both[:, None]))
    # from here on in the balanced units
    weight = np.outer(units, units)
    a, g, q = A * (units / units[:, None]), G / weight, Q * weight
    error, eigenvalues = residual(a, g, q, P), np.linalg.eigvals(a - g @ P)
    for _ in range(MOST_STEPS):
        if error <= ACCURATE or not (eigenvalues.real < 0.0).all():
            break
        try:
            better = lyapunov(a - g @ P, q + P @ g @ P)  # what the gain of P costs
        except ArithmeticError:  # nearly singular: there is nothing to gain by a step
            break
        before, error = error, residual(a, g, q, better)
        if not error < 0.5 * before:
            break
        P, eigenvalues = better, np.linalg.eigvals(a - g @ better)
    if not (eigenvalues.real < 0.0).all():
        raise NoSolution
    return P / weight, eigenvalues.astype(complex)


def stabilising(A: Array, B: Array, Q: Array, R: Array) -> tuple[Array, NDArray[np.complexfloating], float]:
    """The stabilising solution, right to the last digits where the problem allows.

    Parameters
    ----------
    A, B, Q, R
        Shapes (n, n), (n, m), (n, n) and (m, m), with J = integral of x'Qx + u'Ru.

    Returns
    -------
    P : array of shape (n, n)
    eigenvalues : complex array of shape (n,)
        Of the closed loop, all with negative real parts.
    error : float
        Estimated, see :func:`satsym.analysis.regulator.refinement.refined`.

    Raises
    ------
    NoSolution
        As :func:`solve`.
    """
    for start in (_by_subspace, _by_scipy):
        try:
            P, error = refined(A, B, Q, R, start(A, B, Q, R))
            eigenvalues = _closed_loop(A, B, R, P)
        except (NoSolution, ValueError):  # SciPy raises the latter, as a LinAlgError, too
            continue
        if error <= DOUBTFUL and (eigenvalues.real < 0.0).all():
            return P, eigenvalues, error
    raise NoSolution


def _by_subspace(A: Array, B: Array, Q: Array, R: Array) -> Array:
    return solve(A, cost_of_control(B, R), Q)[0]


def _by_scipy(A: Array, B: Array, Q: Array, R: Array) -> Array:
    """From an extended pencil, which does without B R^-1 B' and is a better start where that is large."""
    from scipy.linalg import solve_continuous_are

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # about accuracy, which is measured
        return np.asarray(solve_continuous_are(A, B, Q, R))


def _closed_loop(A: Array, B: Array, R: Array, P: Array) -> NDArray[np.complexfloating]:
    """Eigenvalues of A - B R^-1 B'P, in units in which the diagonal elements of P are 1."""
    diagonal = np.diag(P)
    unit = np.exp2(-np.rint(0.5 * np.log2(np.where(diagonal > 0.0, diagonal, 1.0))))
    b = B / unit[:, None]
    gain = np.linalg.solve(R, b.T @ (P * np.outer(unit, unit)))
    return np.linalg.eigvals(A * (unit / unit[:, None]) - b @ gain).astype(complex)


def cost_of_control(B: Array, R: Array) -> Array:
    """G = B R^-1 B'."""
    found = B @ np.linalg.solve(R, B.T)
    return np.asarray(0.5 * (found + found.T))


def residual(A: Array, G: Array, Q: Array, P: Array, rate: Array | float = 0.0) -> float:
    """The norm of A'P + PA - P G P + Q - rate, relative to the sum of those of the four terms.

    Both in units in which each diagonal element of P is 1, so that it is the same whatever the units are. In a finite
    horizon P changes, with the time left, at a `rate`.
    """
    diagonal = np.diag(P)
    if not (diagonal >= 0.0).all() or not np.isfinite(P).all():
        return float("inf")
    unit = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
    weight = np.outer(unit, unit)
    once, twice, q = A.T @ P * weight, P @ G @ P * weight, Q * weight
    size = 2.0 * np.linalg.norm(once) + np.linalg.norm(twice) + np.linalg.norm(q)
    return float(np.linalg.norm(once + once.T - twice + q - rate * weight) / (size or 1.0))


def _from_subspace(matrix: Array) -> Array:
    """P from the decaying motions of the Hamiltonian matrix, which must be half of all."""
    from scipy.linalg.lapack import dgees

    n = len(matrix) // 2
    _, decaying, *_, vectors, _, failed = dgees(lambda real, imaginary: real < 0.0, matrix, sort_t=1, lwork=40 * n)
    if decaying != n or failed:
        raise NoSolution
    try:
        P = np.linalg.solve(vectors[:n, :n].T, vectors[n:, :n].T)
    except np.linalg.LinAlgError:
        raise NoSolution from None
    return 0.5 * (P + P.T)
