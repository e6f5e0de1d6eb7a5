"""Controls of models without closed control law: zeros of H_u, or of the derivative of H plus active constraints.

The bounded law of the model is the start of Newton's method: it selects one of several local minima. Bounds are treated
as control constraints like others, so that without them the controls are continued as if unbounded.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.kernels.evaluation import COMPLEX_STEP
from satsym.solvers.constrained.structure import Active

STEPS, LAST_STEP = 30, 1e-8
"""Maximum number of Newton steps, and the size of a step, relative to 1 plus the control, below which it is the last:
the error after it is about the square of its size."""


def stationary(instance: Instance) -> bool:
    """Return whether the model has no closed control law on boundaries, so that controls are found iteratively."""
    return bool(instance.model.spec.control_parts)


def by_newton(
    instance: Instance, active: Active, t: NDArray[Any], z: NDArray[Any]
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return controls, shape (m, N), and multipliers, shape (k, N), of active control constraints.

    Times and values may have complex steps; controls are then exact to first order in these.
    """
    spec, n = instance.model.spec, len(instance.initial)
    m, count = len(spec.controls), len(t)
    times, places = np.real(t), np.real(z)
    begun = instance.model.control_law_batch(
        times, places[:n], places[n:], instance.parameters, instance.control_set.arguments
    )
    w = np.zeros((m + len(active), count))
    w[:m] = np.broadcast_to(np.asarray(begun), (m, count))
    for _ in range(STEPS):
        step = _solved(_slopes(instance, active, times, places, w), _conditions(instance, active, times, places, w))
        w = w - step
        if not (np.abs(step[:m]) > LAST_STEP * (1.0 + np.abs(w[:m]))).any():
            break
    if np.iscomplexobj(t) or np.iscomplexobj(z):
        w = w - _solved(_slopes(instance, active, times, places, w), _conditions(instance, active, t, z, w))
    return w[:m], w[m:]


def smallest_curvature(instance: Instance, active: Active, t: Array, z: Array) -> float:
    """Return the smallest eigenvalue of H_uu on the active constraints; infinite if these fix all controls."""
    m = len(instance.model.spec.controls)
    bordered = _slopes(instance, active, t, z, np.concatenate(by_newton(instance, active, t, z)))
    table = bordered[:, :m, :m]
    if active:
        kept = np.linalg.svd(bordered[:, m:, :m])[2][:, len(active) :]
        table = kept @ table @ kept.swapaxes(1, 2)
    return float(np.linalg.eigvalsh(table).min(initial=np.inf))


def _conditions(instance: Instance, active: Active, t: NDArray[Any], z: NDArray[Any], w: NDArray[Any]) -> NDArray[Any]:
    """Return the residuals of the equations for controls and multipliers, H_u + mu' g_u and g, shape (m + k, N)."""
    model, n, m, p = instance.model, len(instance.initial), len(instance.model.spec.controls), instance.parameters
    x, u, h = z[:n], w[:m], len(model.spec.path_constraints)
    slope = np.broadcast_to(np.asarray(model.stationarity_batch(t, x, u, z[n:], p)), (m, len(t)))
    bounds = instance.control_set.arguments
    g = np.broadcast_to(np.asarray(model.path_constraints_batch(t, x, u, p, bounds)), (h, len(t)))[list(active)]
    return np.concatenate([slope + (w[m:, None] * _effects(instance, active, t, x, u)).sum(axis=0), g])


def _slopes(instance: Instance, active: Active, t: Array, z: Array, w: Array) -> Array:
    """Return the Jacobian, shape (N, m + k, m + k), of the equations that determine controls and multipliers."""
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
    """Return g_u of active constraints, shape (k, m, N)."""
    m, h = len(u), len(instance.model.spec.path_constraints)
    found = np.asarray(instance.model.path_effect_batch(t, x, u, instance.parameters))
    return np.broadcast_to(found.reshape(h, m, -1), (h, m, len(t)))[list(active)]


def _solved(slopes: Array, residual: NDArray[Any]) -> NDArray[Any]:
    """Return the Newton step, in the shape of the residual; NaN if the system is singular."""
    try:
        return np.asarray(np.linalg.solve(slopes, residual.T[..., None])[..., 0].T)
    except np.linalg.LinAlgError:
        return np.full_like(residual, np.nan)
