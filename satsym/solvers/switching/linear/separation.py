"""Independent check, by SciPy's DOP853, whether costates separate given ends from the reachable set."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.switching.linear.reach import given_rows, goal

TOLERANCE = 1e-11

CLEAR_DISTANCE = 1e-8
"""Minimum distance from the plane, relative to its terms, that integration errors cannot explain."""

LONGEST_STEP = 1.0 / 64.0
"""Maximum step, as a fraction of the duration, so that no switch of a control is missed."""


@dataclass(frozen=True, eq=False)
class Plane:
    """Bounds of the motion of a linear system along given costates, for any initial state and any control bounds."""

    costate: Array
    """Final costates, scaled to a largest magnitude of 1, shape (n,)."""
    first: Array
    """Initial costates, shape (n,)."""
    up: Array
    down: Array
    """Integrals of the positive and of the negative effects of controls along the costates, shape (m,)."""
    drift: float
    moved: float
    """Integral of the effect of the uncontrolled motion along the costates, and of its magnitude."""

    def beyond(self, initial: Array, wanted: Array, lower: Array, upper: Array) -> NDArray[np.bool_]:
        """Return from which initial states, (n, M), no control within bounds, (m, M), reaches the end, shape (M,).

        This proves that the end cannot be reached, as far as the integration is accurate.

        Parameters
        ----------
        wanted
            Required values along the costates, as the terms of each, shape (F, M).
        """
        with np.errstate(invalid="ignore"):
            least = self.drift + self.up @ lower + self.down @ upper
            terms = self.moved + (self.up - self.down) @ np.maximum(np.abs(lower), np.abs(upper))
            begun = self.first[:, None] * initial
            margin = begun.sum(axis=0) + least - wanted.sum(axis=0)
            return np.asarray(
                margin > CLEAR_DISTANCE * (np.abs(begun).sum(axis=0) + np.abs(wanted).sum(axis=0) + terms)
            )


def plane(instance: Instance, costate: Array) -> Plane | None:
    """Return the plane whose normal is the given final costates, shape (n,); ``None`` if the integration fails.

    The motion must be linear. The adjoint equation is integrated backwards, together with the effect of the controls.
    """
    from scipy.integrate import solve_ivp

    assert instance.tf is not None
    model, p, n, m = instance.model, instance.parameters, len(costate), len(instance.lower)
    at_zero, idle = (0.0,) * n, (0.0,) * m

    def backwards(t: float, y: Array) -> Array:
        by_x = np.array(model.jacobian_x(t, at_zero, idle, p)).reshape(n, n)
        pushed = y[:n] @ np.array(model.jacobian_u(t, at_zero, idle, p)).reshape(n, -1)
        drift = y[:n] @ np.array(model.dynamics(t, at_zero, idle, p))
        sides = np.maximum(pushed, 0.0), np.minimum(pushed, 0.0)
        return np.concatenate([-y[:n] @ by_x, *(-side for side in sides), [-drift, -abs(drift)]])

    largest = costate / max(float(np.abs(costate).max()), 1e-300)
    start = np.concatenate([largest, np.zeros(2 * m + 2)])
    longest = LONGEST_STEP * (instance.tf - instance.t0)
    found = solve_ivp(
        backwards, (instance.tf, instance.t0), start, method="DOP853", rtol=TOLERANCE, atol=1e-14, max_step=longest
    )
    if found.status < 0:
        return None
    first, up, down, (drift, moved) = np.split(found.y[:, -1], [n, n + m, n + 2 * m])
    return Plane(largest, first, up, down, float(drift), float(moved))


def separates(instance: Instance, costate: Array) -> bool:
    """Return whether no control within its bounds brings the motion to its end, or beyond, along given final costates.

    Parameters
    ----------
    costate
        Costates at the given final time, shape (n,); zero where the final state is free.
    """
    assert instance.tf is not None
    one, rows = plane(instance, costate), given_rows(instance)
    if one is None:
        return False
    wanted = one.costate[rows] * goal(instance, rows, instance.tf)
    numbers = (np.array(row)[:, None] for row in (instance.initial, wanted, instance.lower, instance.upper))
    return bool(one.beyond(*numbers)[0])
