"""Number of steps that the fastest mode of a model requires, and exact propagation of linear motions."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance

STABLE = 2.0
"""Largest product of step and decay rate at which RK4 is stable; for oscillations nearly 2.8."""


def fastest(instance: Instance) -> float:
    """Return the magnitude of the fastest eigenvalue that does not grow, at the initial state with zero controls."""
    model, n = instance.model, len(instance.initial)
    try:
        entries = model.jacobian_x(
            instance.t0, instance.initial, (0.0,) * len(model.spec.controls), instance.parameters
        )
    except ArithmeticError:
        return 0.0
    A = np.reshape(entries, (n, n))
    values = np.linalg.eigvals(A) if np.isfinite(A).all() else np.zeros(1)
    return float(np.abs(values[values.real <= 0.0]).max(initial=0.0))


def stable_steps(instance: Instance, steps: int, most: int) -> int:
    """Return the given number of steps, doubled until RK4 is stable for the fastest mode, but at most `most`."""
    assert instance.tf is not None
    rate = fastest(instance) * abs(instance.tf - instance.t0)
    while rate > STABLE * steps and 2 * steps <= most:
        steps *= 2
    return steps


def propagated(instance: Instance, nodes: Array, gain: Array | None) -> tuple[Array, Array] | None:
    """Return the states of a linear motion at equidistant nodes, by e^(Ah) in two half steps, and in one step.

    Parameters
    ----------
    instance
        The instance.
    nodes
        Equidistant nodes, shape (N+1,).
    gain
        Gain of the law u = -K x, shape (m, n); by default the motion is uncontrolled.

    Returns
    -------
    (x, coarser) or None
        Both results, shapes (n, N+1); ``None`` if the motion is not linear with constant coefficients and unbounded
        controls.
    """
    from scipy.linalg import expm

    model, n, m = instance.model, len(instance.initial), len(instance.model.spec.controls)
    if not model.spec.linear or not model.spec.autonomous or instance.control_set.bounded:
        return None
    at = (instance.t0, (0.0,) * n, (0.0,) * m, instance.parameters)
    A = np.reshape(model.jacobian_x(*at), (n, n))
    if gain is not None:
        A = A - np.reshape(model.jacobian_u(*at), (n, m)) @ gain
    h = (nodes[-1] - nodes[0]) / (len(nodes) - 1)
    whole, half = np.asarray(expm(A * h)), np.asarray(expm(A * (h / 2.0)))
    x, coarser = (np.empty((n, len(nodes))) for _ in range(2))
    x[:, 0] = coarser[:, 0] = instance.initial
    for k in range(1, len(nodes)):
        x[:, k] = half @ (half @ x[:, k - 1])
        coarser[:, k] = whole @ coarser[:, k - 1]
    return x, coarser
