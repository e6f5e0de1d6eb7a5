"""Controls where H is not known to be quadratic in them: at which H_u vanishes, or that of H with an active constraint.

The law of the model, with its bounds, is where Newton's steps begin: it says which of several local minima is meant.
Bounds are constraints that hold a control like others, so that beyond them the controls go on as if there were none.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.kernels.evaluation import COMPLEX_STEP
from satsym.solvers.constrained.structure import FREE

STEPS, ENOUGH = 30, 1e-13
"""Newton's steps at most, and the size of one after which another is the last, relative to one plus the control's."""


def stationary(instance: Instance) -> bool:
    """Whether the model states no law on boundaries, so that it has to be found."""
    return bool(instance.model.spec.control_parts)


def by_newton(
    instance: Instance, constraint: int, t: NDArray[Any], z: NDArray[Any]
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Controls, shape (m, N), and the multiplier, shape (N,), of an active constraint that holds controls, or of none.

    Times and values may be complex by a small step: then controls are exact to first order in it.
    """
    spec, n = instance.model.spec, len(instance.initial)
    m, count = len(spec.controls), len(t)
    times, places = np.real(t), np.real(z)
    begun = instance.model.control_law_batch(
        times, places[:n], places[n:], instance.parameters, instance.control_set.arguments
    )
    w = np.zeros((m + (constraint != FREE), count))
    w[:m] = np.broadcast_to(np.asarray(begun), (m, count))
    slopes: Array = np.empty((count, len(w), len(w)))
    for _ in range(STEPS):
        slopes = _slopes(instance, constraint, times, places, w)
        step = _solved(slopes, _conditions(instance, constraint, times, places, w))
        w = w - step
        if not (np.abs(step[:m]) > ENOUGH * (1.0 + np.abs(w[:m]))).any():
            break
    if np.iscomplexobj(t) or np.iscomplexobj(z):
        w = w - _solved(slopes, _conditions(instance, constraint, t, z, w))
    return w[:m], w[m] if constraint != FREE else np.zeros(count)


def smallest_curvature(instance: Instance, constraint: int, t: Array, z: Array) -> float:
    """Least eigenvalue of H_uu, or that of H with an active constraint along what keeps it; infinite where none is."""
    m = len(instance.model.spec.controls)
    u, mu = by_newton(instance, constraint, t, z)
    bordered = _slopes(instance, constraint, t, z, np.concatenate([u, mu[None]])[: m + (constraint != FREE)])
    table = bordered[:, :m, :m]
    if constraint != FREE:
        kept = np.linalg.svd(bordered[:, m:, :m])[2][:, 1:]
        table = kept @ table @ kept.swapaxes(1, 2)
    return float(np.linalg.eigvalsh(table).min(initial=np.inf))


def _conditions(instance: Instance, constraint: int, t: NDArray[Any], z: NDArray[Any], w: NDArray[Any]) -> NDArray[Any]:
    """H_u + mu g_u and g, shape (m + 1, N); H_u alone where no constraint is active."""
    model, n, m, p = instance.model, len(instance.initial), len(instance.model.spec.controls), instance.parameters
    x, u, shape = z[:n], w[:m], (m, len(t))
    slope = np.broadcast_to(np.asarray(model.stationarity_batch(t, x, u, z[n:], p)), shape)
    if constraint == FREE:
        return slope
    bounds = instance.control_set.arguments
    g = np.broadcast_to(np.asarray(model.path_constraints_batch(t, x, u, p, bounds))[constraint], shape[1:])
    return np.concatenate([slope + w[m] * _effect(instance, constraint, t, x, u), g[None]])


def _slopes(instance: Instance, constraint: int, t: Array, z: Array, w: Array) -> Array:
    """Derivatives of the conditions by controls and multiplier, shape (N, m + 1, m + 1)."""
    model, n, m, p = instance.model, len(instance.initial), len(instance.model.spec.controls), instance.parameters
    x, u, count = z[:n], w[:m], len(t)
    found = np.zeros((len(w), len(w), count))
    found[:m, :m] = np.asarray(model.control_hessian_batch(t, x, u, z[n:], p)).reshape(m, m, -1)
    if constraint != FREE:
        found[:m, m] = found[m, :m] = _effect(instance, constraint, t, x, u)
        for j in range(m):
            moved = u.astype(complex)
            moved[j] += 1j * COMPLEX_STEP
            found[:m, j] += w[m] * np.imag(_effect(instance, constraint, t, x, moved)) / COMPLEX_STEP
    return np.moveaxis(found, -1, 0)


def _effect(instance: Instance, constraint: int, t: NDArray[Any], x: NDArray[Any], u: NDArray[Any]) -> NDArray[Any]:
    """g_u of one constraint, shape (m, N)."""
    m, h = len(u), len(instance.model.spec.path_constraints)
    found = np.asarray(instance.model.path_effect_batch(t, x, u, instance.parameters))
    return np.broadcast_to(found.reshape(h, m, -1)[constraint], (m, len(t)))


def _solved(slopes: Array, residual: NDArray[Any]) -> NDArray[Any]:
    """Newton's step, shape of the residual; no number where it is not determined."""
    try:
        return np.asarray(np.linalg.solve(slopes, residual.T[..., None])[..., 0].T)
    except np.linalg.LinAlgError:
        return np.full_like(residual, np.nan)
