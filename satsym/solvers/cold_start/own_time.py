"""Time scales of an instance, from its fastest mode or from the required changes and possible rates of its states."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.collocation.scaling import NO_SLOPE
from satsym.solvers.control.regularised import sloping

STEP = 1e-6
"""Step of the finite difference for second derivatives, relative to the required change of the states."""

SLOWEST = 1e4
"""Ratio to the shortest time of all states above which a time is attributed to rounding and ignored."""


def own_time(instance: Instance) -> float | None:
    """Return an estimate of the time in which the slowest state can reach its final value; ``None`` if unknown.

    A state has to change by ``d``, from its initial to its given final value. At the initial time it has the rate ``v``
    and the second derivative ``a``, uncontrolled and with each control at each of its finite bounds. Its time is the
    smallest of all values ``|d/v|`` and ``sqrt|d/a|``.
    """
    names, start = instance.model.spec.state_names, np.array(instance.initial)
    goal = [instance.final.get(name) for name in names]
    way = np.array(
        [float(end) - x if isinstance(end, float | int) else 0.0 for end, x in zip(goal, start, strict=True)]
    )
    if not way.any():
        return None
    with np.errstate(all="ignore"):
        u = _extremes(instance)
        v = _rates(instance, 0.0, start[:, None], u)
        step = STEP * float(np.nanmin(np.where(v != 0.0, np.abs(way).max() / np.abs(v), np.inf)))
        a = (_rates(instance, step, start[:, None] + step * v, u) - v) / step
        far = np.abs(way)[:, None]
        times = np.minimum(far / np.abs(v), np.sqrt(far / np.abs(a))).min(axis=1)
    times = times[(way != 0.0) & np.isfinite(times) & (times > 0.0)]
    return float(times[times <= SLOWEST * times.min()].max()) if times.size else None


def time_scale(instance: Instance) -> float:
    """Return the time scale of the fastest mode, 1/|eigenvalue| of f_x at the initial state with zero controls.

    If all eigenvalues are zero, the result is :func:`own_time`, or one if that is unknown.
    """
    n = len(instance.initial)
    none = np.zeros((n, 1))
    nothing = tuple((sloping(instance, none) if instance.model.spec.throttled else none)[:, 0].tolist())
    slopes = instance.model.canonical_jacobian(
        instance.t0, instance.initial, nothing, instance.parameters, instance.control_set.without_bounds.arguments
    )
    fastest = np.abs(np.linalg.eigvals(np.array(slopes).reshape(2 * n, 2 * n)[:n, :n])).max()
    if np.isfinite(fastest) and fastest > NO_SLOPE:
        return 1.0 / float(fastest)
    return own_time(instance) or 1.0


def _extremes(instance: Instance) -> Array:
    """Return zero controls, and each control at each of its finite bounds, projected to the control set, as columns."""
    count = len(instance.model.spec.controls)
    columns = [np.zeros(count)]
    for bounds in instance.control_set.around(count):
        for place, bound in enumerate(np.ravel(bounds)):
            if np.isfinite(bound):
                columns.append(np.where(np.arange(count) == place, bound, 0.0))
    return np.asarray(instance.control_set.project(np.array(columns).T))


def _rates(instance: Instance, later: float, x: Array, u: Array) -> Array:
    """Return the time derivatives of the states at a later time, one column for each column of controls."""
    columns = u.shape[1]
    given = np.full(columns, instance.t0 + later), np.broadcast_to(x, (len(x), columns)).copy(), u
    return np.asarray(instance.model.dynamics_batch(*given, instance.parameters))
