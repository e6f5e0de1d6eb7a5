"""The regulators of many instances of one model at once; what is not clear is left to the design of one.

Units that balance the first one's Hamiltonian matrix are taken for all. Two routes must agree on each: gains by
structured doubling, with the residual of the Riccati equation, and eigenvalues of the closed loop by those of the
Hamiltonian matrix.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from satsym.analysis.linear.equilibrium import ENTRY_TOLERANCE, LOOKED_AT, linearise
from satsym.analysis.linear.scaling import Scaled, scaled
from satsym.analysis.regulator import batch, riccati
from satsym.analysis.regulator.lqr import DOUBTFUL
from satsym.arrays import Array
from satsym.instance import Instance
from satsym.status import BadInput

AGREEING = 1e-7
"""Relative difference of the characteristic polynomials by both routes, each coefficient in units of the largest
eigenvalue, that is none: coefficients, for eigenvalues that coincide are half as accurate."""


@dataclass(frozen=True, eq=False)
class Regulators:
    """Regulators of M instances."""

    clear: NDArray[np.bool_]
    """Which are sure, shape (M,)."""
    K: Array
    """Gains, shape (M, m, n)."""
    eigenvalues: NDArray[np.complexfloating]
    """Eigenvalues of the closed loops, the largest real part first, shape (M, n)."""
    residual: Array
    """Residuals of the Riccati equations, relative to their terms."""
    cost: Array
    """From the initial states on, shapes (M,)."""


def regulators(instances: Sequence[Instance]) -> Regulators | None:
    """The regulators that the [lqr] tables ask for; ``None`` where each has to be designed by itself.

    Parameters
    ----------
    instances
        Of one model, with the same weights and inputs.
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
        K, P, residual = batch.solve(free, b, weight, r)
        agreeing, eigenvalues = _eigenvalues(free, b, weight, r, K)
        apart = (np.array([one.initial for one in instances]) - points) / states
        cost = np.einsum("ij,ijk,ik->i", apart, P, apart)
    clear = regular & agreeing & (residual <= batch.WANTED)
    return Regulators(clear, (K + ahead) / states, eigenvalues, residual, cost)


def _coefficients(instances: Sequence[Instance], unit: Scaled) -> tuple[Array, Array, Array, NDArray[np.bool_]]:
    """Where each starts to be regulated, A and B there, and whether they stay the same."""
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
    """Sorted eigenvalues of the closed loops, and whether they decay and are those of the Hamiltonian matrices."""
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
    """Coefficients of the polynomials with these roots, shape (M, n + 1)."""
    found = np.zeros((len(roots), roots.shape[1] + 1), dtype=complex)
    found[:, 0] = 1.0
    for k in range(roots.shape[1]):
        found[:, 1:] = found[:, 1:] - roots[:, k, None] * found[:, :-1]
    return found
