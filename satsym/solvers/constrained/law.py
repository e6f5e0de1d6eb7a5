"""Controls where H is not known to be quadratic in them: at which H_u vanishes, or that of H with active constraints.

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
from satsym.solvers.constrained.structure import Active

STEPS, LAST_STEP = 30, 1e-13
"""Newton's steps at most, and the size of one after which another is the last, relative to one plus the control's."""


def stationary(instance: Instance) -> bool:
    """Whether the model states no law on boundaries, so that it has to be found."""
    return bool(instance.model.spec.control_parts)


def by_newton(
    instance: Instance, active: Active, t: NDArray[Any], z: NDArray[Any]
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Controls, shape (m, N), and multipliers, shape (k, N), of active constraints that hold controls.

    Times and values may be complex by a small step: then controls are exact to first order in it.
    """
    spec, n = instance.model.spec, len(instance.initial)
    m, count = len(spec.controls), len(t)
    times, places = np.real(t), np.real(z)
    begun = instance.model.control_law_batch(
        times, places[:n], places[n:], instance.parameters, instance.control_set.arguments
    )
    w = np.zeros((m + len(active), count))
    w[:m] = np.broadcast_to(np.asarray(begun), (m, count))
    slopes: Array = np.empty((count, len(w), len(w)))
    for _ in range(STEPS):
        slopes = _slopes(instance, active, times, places, w)
        step = _solved(slopes, _conditions(instance, active, times, places, w))
        w = w - step
        if not (np.abs(step[:m]) > LAST_STEP * (1.0 + np.abs(w[:m]))).any():
            break
    if np.iscomplexobj(t) or np.iscomplexobj(z):
        w = w - _solved(slopes, _conditions(instance, active, t, z, w))
    return w[:m], w[m:]


def smallest_curvature(instance: Instance, active: Active, t: Array, z: Array) -> float:
    """Least eigenvalue of H_uu, or that of H with active constraints along what keeps these; infinite where none is."""
    m = len(instance.model.spec.controls)
    bordered = _slopes(instance, active, t, z, np.concatenate(by_newton(instance, active, t, z)))
    table = bordered[:, :m, :m]
    if active:
        kept = np.linalg.svd(bordered[:, m:, :m])[2][:, len(active) :]
        table = kept @ table @ kept.swapaxes(1, 2)
    return float(np.linalg.eigvalsh(table).min(initial=np.inf))


def _conditions(instance: Instance, active: Active, t: NDArray[Any], z: NDArray[Any], w: NDArray[Any]) -> NDArray[Any]:
    """H_u + mu' g_u and g, shape (m + k, N)."""
    model, n, m, p = instance.model, len(instance.initial), len(instance.model.spec.controls), instance.parameters
    x, u, h = z[:n], w[:m], len(model.spec.path_constraints)
    slope = np.broadcast_to(np.asarray(model.stationarity_batch(t, x, u, z[n:], p)), (m, len(t)))
    bounds = instance.control_set.arguments
    g = np.broadcast_to(np.asarray(model.path_constraints_batch(t, x, u, p, bounds)), (h, len(t)))[list(active)]
    return np.concatenate([slope + (w[m:, None] * _effects(instance, active, t, x, u)).sum(axis=0), g])


def _slopes(instance: Instance, active: Active, t: Array, z: Array, w: Array) -> Array:
    """Derivatives of the conditions by controls and multipliers, shape (N, m + k, m + k)."""
    model, n, m, p = instance.model, len(instance.initial), len(instance.model.spec.controls), instance.parameters
    x, u, count = z[:n], w[:m], len(t)
    found = np.zeros((len(w), len(w), count))
    found[:m, :m] = np.asarray(model.control_hessian_batch(t, x, u, z[n:], p)).reshape(m, m, -1)
    found[m:, :m] = _effects(instance, active, t, x, u)
    found[:m, m:] = found[m:, :m].swapaxes(0, 1)
    if active:
        moved = u[:, None] + 1j * COMPLEX_STEP * np.eye(m)[:, :, None]  # all at once: calls are dear
        bent = _effects(instance, active, np.tile(t, m), np.tile(x, m), moved.reshape(m, -1))
        bent = np.imag(bent).reshape(len(active), m, m, count) / COMPLEX_STEP
        found[:m, :m] += (w[m:, None, None] * bent).sum(axis=0)
    return np.moveaxis(found, -1, 0)


def _effects(instance: Instance, active: Active, t: NDArray[Any], x: NDArray[Any], u: NDArray[Any]) -> NDArray[Any]:
    """g_u of active constraints, shape (k, m, N)."""
    m, h = len(u), len(instance.model.spec.path_constraints)
    found = np.asarray(instance.model.path_effect_batch(t, x, u, instance.parameters))
    return np.broadcast_to(found.reshape(h, m, -1), (h, m, len(t)))[list(active)]


def _solved(slopes: Array, residual: NDArray[Any]) -> NDArray[Any]:
    """Newton's step, shape of the residual; no number where it is not determined."""
    try:
        return np.asarray(np.linalg.solve(slopes, residual.T[..., None])[..., 0].T)
    except np.linalg.LinAlgError:
        return np.full_like(residual, np.nan)
