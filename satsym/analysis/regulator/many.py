"""Regulators of many instances of one model at once; unclear cases are left to the design of a single one.

Units that balance the first one's Hamiltonian matrix are taken for all. Two routes must agree on each: gains by
structured doubling, with the residual of the Riccati equation, and eigenvalues of the closed loop by those of the
Hamiltonian matrix.

Structured doubling (:mod:`satsym.analysis.regulator.lqr`) is done here on arrays whose last axis counts the
problems. It starts not from a short step but from the Cayley transform with a shift g, which turns an eigenvalue s of
the closed loop into (s + g)/(s - g), small where g is near |s|. The geometric mean of the |s| is known beforehand, from
the determinant of the Hamiltonian matrix. Every answer is judged by its residual; the few that elimination without
pivots spoils are solved anew, one at a time.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from satsym.analysis.linear.equilibrium import ENTRY_TOLERANCE, LOOKED_AT, linearise
from satsym.analysis.linear.system import Scaled, scaled
from satsym.analysis.regulator import riccati
from satsym.analysis.regulator.lqr import DOUBTFUL
from satsym.arrays import Array
from satsym.instance import Instance
from satsym.status import BadInput

BLOCK = 2048
"""Number of problems solved at a time, so that their matrices stay in the cache."""
MOST_DOUBLINGS = 60
LAST_CHANGE = 1e-10
"""Relative change after which doubling ends: the next change would be the square of it."""
WANTED = 5e-13
"""Largest residual with which a problem counts as solved."""


def solve(
    A: ArrayLike, B: ArrayLike, Q: ArrayLike, R: ArrayLike, N: ArrayLike | None = None
) -> tuple[Array, Array, Array]:
    """Compute stabilising solutions and gains of many problems with J = integral of x'Qx + 2x'Nu + u'Ru.

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
    """Return solutions and residuals of a block of problems, with problems along the first axis."""
    A, G, Q = (np.ascontiguousarray(np.moveaxis(each, 0, -1)) for each in (a, g, q))
    with np.errstate(all="ignore"):  # what is not finite has a residual that says so
        P = _doubled(A, G, Q, _mean_eigenvalue(a, g, q))
        return np.moveaxis(P, -1, 0), _residual(A, G, Q, P)


def _mean_eigenvalue(a: Array, g: Array, q: Array) -> Array:
    """Return the geometric mean of the absolute eigenvalues of the closed loops; shape (M,)."""
    n = a.shape[-1]
    matrix = np.block([[a, -g], [-q, -np.swapaxes(a, -1, -2)]])
    return np.asarray(np.exp(np.linalg.slogdet(matrix)[1] / (2 * n)))


def _doubled(A: Array, G: Array, Q: Array, shift: Array) -> Array:
    """Apply structured doubling from the Cayley transform with this shift; the last axis counts problems."""
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
    """Return the relative residual of the Riccati equation of each problem; shape (M,).

    It is that of :func:`satsym.analysis.regulator.riccati.residual`.
    """
    diagonal = _diagonal(P)
    unit = 1.0 / np.sqrt(np.where(diagonal == 0.0, 1.0, np.abs(diagonal)))
    weight = unit[:, None] * unit
    once, twice, q = _product(_turned(A), P) * weight, _product(P, _product(G, P)) * weight, Q * weight
    size = 2.0 * _norm(once) + _norm(twice) + _norm(q)
    return np.asarray(_norm(once + _turned(once) - twice + q) / np.where(size == 0.0, 1.0, size))


def _inverse(matrix: Array) -> Array:
    """Invert matrices by Gauss-Jordan elimination without pivoting."""
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


AGREEING = 1e-7
"""Largest relative difference of the closed loop's characteristic polynomials by both routes, each coefficient in units
of the largest eigenvalue. Coefficients are compared, because coinciding eigenvalues are half as accurate."""


@dataclass(frozen=True, eq=False)
class Regulators:
    """The regulators of M instances of one model."""

    clear: NDArray[np.bool_]
    """Whether each regulator is reliable, shape (M,)."""
    K: Array
    """Gains, shape (M, m, n)."""
    eigenvalues: NDArray[np.complexfloating]
    """Eigenvalues of the closed loops, the largest real part first, shape (M, n)."""
    residual: Array
    """Residuals of the Riccati equations, relative to their terms."""
    cost: Array
    """Cost from the initial state of each instance on, shape (M,)."""


def regulators(instances: Sequence[Instance]) -> Regulators | None:
    """Design the regulators of the [lqr] tables; ``None`` where each must be designed separately.

    Parameters
    ----------
    instances
        Instances of one model, with the same weights and inputs.
    """
    first = instances[0]
    spec, options = first.model.spec, first.lqr
    if options is None or options.horizon is not None or not (spec.has_reference or spec.linear):
        return None
    try:
        system = linearise(first).system
    except BadInput:
        return None
    used, unit = [system.inputs.index(name) for name in options.inputs], scaled(system)
    q, r, cross = np.array(options.Q), np.array(options.R), None if options.N is None else np.array(options.N)
    with np.errstate(all="ignore"):
        points, A, B, constant = _coefficients(instances, unit)
        b = system.B[:, used]
        like, weight, _ = riccati.without_cross(system.A, b, q, r, cross)
        states = riccati.balancing(riccati.hamiltonian(like, riccati.cost_of_control(b, r), weight))
        a, b = A * states / states[:, None], B[:, :, used] / states[:, None]
        regular = constant & np.isfinite(a).all(axis=(1, 2)) & np.isfinite(b).all(axis=(1, 2))
        a[~regular], b[~regular] = -np.eye(len(states)), 0.0
        q = q * np.outer(states, states)
        # from here on for v = u + R^-1 N'x, so that there is no cross weight any more
        free, weight, ahead = riccati.without_cross(a, b, q, r, None if cross is None else cross * states[:, None])
        K, P, residual = solve(free, b, weight, r)
        agreeing, eigenvalues = _eigenvalues(free, b, weight, r, K)
        apart = (np.array([one.initial for one in instances]) - points) / states
        cost = np.einsum("ij,ijk,ik->i", apart, P, apart)
    clear = regular & agreeing & (residual <= WANTED)
    return Regulators(clear, (K + ahead) / states, eigenvalues, residual, cost)


def _coefficients(instances: Sequence[Instance], unit: Scaled) -> tuple[Array, Array, Array, NDArray[np.bool_]]:
    """Return the initial deviations, A and B of the instances, and whether the coefficients are constant."""
    first, count = instances[0], len(instances)
    model, n, m = first.model, len(first.initial), len(first.model.spec.controls)
    p = tuple(np.array([one.parameters for one in instances]).reshape(count, -1).T)
    t0, u = np.array([one.t0 for one in instances]), np.zeros((m, count))

    def there(t: Array) -> tuple[Array, Array, Array]:
        x = model.reference_batch(t, p) if model.spec.has_reference else np.zeros((n, count))
        x = np.broadcast_to(x, (n, count))
        by_x = np.broadcast_to(model.jacobian_x_batch(t, x, u, p), (n, n, count))
        by_u = np.broadcast_to(model.jacobian_u_batch(t, x, u, p), (n, m, count))
        return x.T, by_x.transpose(2, 0, 1), by_u.transpose(2, 0, 1)

    points, A, B = there(t0)
    constant = np.ones(count, dtype=bool)
    for ahead in LOOKED_AT:
        _, later, pushing = there(t0 + ahead / (unit.rate * unit.size))
        change = np.concatenate([(later - A) * unit.states, (pushing - B) * unit.inputs], axis=2)
        within = ENTRY_TOLERANCE * unit.rate * unit.size
        constant &= (np.abs(change) / unit.states[:, None] <= within).all(axis=(1, 2))
    return points, A.copy(), B, constant


def _eigenvalues(
    a: Array, b: Array, q: Array, r: Array, K: Array
) -> tuple[NDArray[np.bool_], NDArray[np.complexfloating]]:
    """Return sorted closed-loop eigenvalues, and whether they decay and are those of the Hamiltonian matrices."""
    count, n = a.shape[:2]
    g = b @ np.linalg.solve(r, b.swapaxes(1, 2))
    weights = np.broadcast_to(q, a.shape)
    matrix = np.concatenate([np.concatenate([a, -g], axis=2), np.concatenate([-weights, -a.swapaxes(1, 2)], axis=2)], 1)
    both = np.linalg.eigvals(matrix).astype(complex)
    decaying = np.take_along_axis(both, np.argsort(both.real, axis=1), axis=1)[:, :n]
    sound = np.asarray(np.isfinite(K).all(axis=(1, 2)))
    given = np.where(sound[:, None, None], a - b @ np.nan_to_num(K), np.eye(n))
    found = np.linalg.eigvals(given).astype(complex)
    order = np.array([np.lexsort((-one.imag, np.abs(one.imag), -one.real)) for one in found]).reshape(count, n)
    found = np.take_along_axis(found, order, axis=1)
    size = np.abs(found).max(axis=1)
    off = np.abs(_polynomials(found / size[:, None]) - _polynomials(decaying / size[:, None])).max(axis=1)
    fastest = np.maximum(size, np.abs(np.linalg.eigvals(a)).max(axis=1))
    return (off <= AGREEING) & (found.real.max(axis=1) <= -DOUBTFUL * fastest), found


def _polynomials(roots: NDArray[np.complexfloating]) -> NDArray[np.complexfloating]:
    """Return the coefficients of the polynomials with these roots, shape (M, n + 1)."""
    found = np.zeros((len(roots), roots.shape[1] + 1), dtype=complex)
    found[:, 0] = 1.0
    for k in range(roots.shape[1]):
        found[:, 1:] = found[:, 1:] - roots[:, k, None] * found[:, :-1]
    return found
