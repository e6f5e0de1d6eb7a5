"""Many motions of one instance at once, each under a control of its own that may depend on where it is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance

Law = Callable[[int, Array], tuple[Array, Array, Array]]
"""Controls (m, S) at the beginning, the middle and the end of a step, by its number and the states (n, S) there."""


@dataclass(frozen=True, eq=False)
class Together:
    """What S motions came to."""

    states: Array
    """At the nodes, shape (N + 1, n, S)."""
    controls: Array
    """At the beginning of each step, and at the end of the last, shape (N + 1, m, S)."""
    costs: Array
    """The running cost's integral and the terminal cost, shape (S,); infinite where a motion leaves its domain."""


def together(instance: Instance, law: Law, lasting: Array, steps: int, *, costing: bool = True) -> Together:
    """Simulate from the initial state, by the classical Runge-Kutta method; controls are cut to their bounds.

    Parameters
    ----------
    lasting
        How long, shape (S,).
    steps
        Of each motion, N.
    costing
        Whether costs are computed, or left at none.
    """
    model, p, kept = instance.model, instance.parameters, instance.control_set.project
    states, controls = [np.repeat(np.array(instance.initial)[:, None], len(lasting), axis=1)], list[Array]()
    total, h = np.zeros(len(lasting)), lasting / steps

    def running(t: Array, x: Array, u: Array) -> Array:
        return np.asarray(model.running_cost_batch(t, x, u, p))

    with np.errstate(all="ignore"):
        for k in range(steps):
            x, u = states[-1], [kept(one) for one in law(k, states[-1])]
            t, z, slopes = [instance.t0 + (k + share) * h for share in (0.0, 0.5, 1.0)], [x], list[Array]()
            for at, share in ((0, 0.5), (1, 0.5), (1, 1.0), (2, 0.0)):
                slopes.append(np.asarray(model.dynamics_batch(t[at], z[-1], u[at], p)))
                z.append(x + share * h * slopes[-1])
            if costing:
                total += h / 6.0 * (running(t[0], z[0], u[0]) + running(t[2], z[3], u[2]))
                total += h / 3.0 * (running(t[1], z[1], u[1]) + running(t[1], z[2], u[1]))
            states.append(x + h / 6.0 * (slopes[0] + 2.0 * (slopes[1] + slopes[2]) + slopes[3]))
            controls.append(u[0])
        found = np.array(states)
        positive = [i for i, state in enumerate(model.spec.states) if state.positive]
        inside = np.isfinite(found).all(axis=(0, 1)) & (found[:, positive] > 0.0).all(axis=(0, 1))
        if costing:
            ends = zip(instance.t0 + lasting, states[-1].T, inside, strict=True)
            total += [model.terminal_cost(float(t), tuple(end.tolist()), p) if ok else np.inf for t, end, ok in ends]
    return Together(found, np.array([*controls, u[2]]), np.where(inside & np.isfinite(total), total, np.inf))
