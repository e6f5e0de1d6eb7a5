"""Simulation of many motions of one instance at once, each under its own controls."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance


def costs_together(instance: Instance, controls: Array, lasting: Array) -> Array:
    """Return the costs of S motions from the initial state, shape (S,); infinite if a motion leaves its domain.

    All motions are integrated at once by the classical Runge-Kutta method; controls are projected to their bounds.

    Parameters
    ----------
    instance
        The instance.
    controls
        Controls at the nodes and midpoints of N steps, shape (m, 2 N + 1, S).
    lasting
        Durations, shape (S,).
    """
    model, p, kept = instance.model, instance.parameters, instance.control_set.project
    states = [np.repeat(np.array(instance.initial)[:, None], len(lasting), axis=1)]
    steps = controls.shape[1] // 2
    total, h = np.zeros(len(lasting)), lasting / steps

    def running(t: Array, x: Array, u: Array) -> Array:
        return np.asarray(model.running_cost_batch(t, x, u, p))

    with np.errstate(all="ignore"):
        for k in range(steps):
            x, u = states[-1], [kept(controls[:, j]) for j in range(2 * k, 2 * k + 3)]
            t, z, slopes = [instance.t0 + (k + share) * h for share in (0.0, 0.5, 1.0)], [x], list[Array]()
            for at, share in ((0, 0.5), (1, 0.5), (1, 1.0), (2, 0.0)):
                slopes.append(np.asarray(model.dynamics_batch(t[at], z[-1], u[at], p)))
                z.append(x + share * h * slopes[-1])
            total += h / 6.0 * (running(t[0], z[0], u[0]) + running(t[2], z[3], u[2]))
            total += h / 3.0 * (running(t[1], z[1], u[1]) + running(t[1], z[2], u[1]))
            states.append(x + h / 6.0 * (slopes[0] + 2.0 * (slopes[1] + slopes[2]) + slopes[3]))
        found = np.array(states)
        positive = [i for i, state in enumerate(model.spec.states) if state.positive]
        inside = np.isfinite(found).all(axis=(0, 1)) & (found[:, positive] > 0.0).all(axis=(0, 1))
        ends = zip(instance.t0 + lasting, states[-1].T, inside, strict=True)
        total += [_terminal_cost(instance, float(t), end) if ok else np.inf for t, end, ok in ends]
    return np.where(inside & np.isfinite(total), total, np.inf)


def _terminal_cost(instance: Instance, t: float, end: Array) -> float:
    """Return the terminal cost of a final state; infinite if it overflows."""
    try:
        return instance.model.terminal_cost(t, tuple(end.tolist()), instance.parameters)
    except OverflowError:
        return float("inf")
