"""Whether costates separate a given end from all that is reached, by an integration of its own (SciPy's DOP853)."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.switching.linear.reach import given_rows, goal

TOLERANCE = 1e-11

CLEAR = 1e-8
"""Distance from the plane, relative to the terms that it is the sum of, that no error of integration explains."""

LONGEST = 1.0 / 64.0
"""Share of the duration that a step may be: a control could switch unseen in a longer one."""


def separates(instance: Instance, costate: Array) -> bool:
    """Whether no control within its bounds brings the motion to its end, or beyond, along the costates at the end.

    The motion must be linear. The adjoint equation is integrated backwards, and with it the least that any control
    does along it; so much less than the end asks for is a proof, as far as the integration is right.

    Parameters
    ----------
    costate
        At the given final time, shape (n,); zero where the final state is free.
    """
    from scipy.integrate import solve_ivp

    assert instance.tf is not None
    model, p, n = instance.model, instance.parameters, len(costate)
    low, high = np.array(instance.lower), np.array(instance.upper)
    largest = np.maximum(np.abs(low), np.abs(high))
    at_zero, idle = (0.0,) * n, (0.0,) * len(low)

    def backwards(t: float, y: Array) -> Array:
        by_x = np.array(model.jacobian_x(t, at_zero, idle, p)).reshape(n, n)
        pushed = y[:n] @ np.array(model.jacobian_u(t, at_zero, idle, p)).reshape(n, -1)
        drift = y[:n] @ np.array(model.dynamics(t, at_zero, idle, p))
        least = float(np.minimum(pushed * low, pushed * high).sum())
        terms = abs(drift) + np.abs(pushed) @ largest
        return np.concatenate([-y[:n] @ by_x, [-drift - least, -terms]])

    size = max(float(np.abs(costate).max()), 1e-300)
    start = np.concatenate([costate / size, [0.0, 0.0]])
    longest = LONGEST * (instance.tf - instance.t0)
    found = solve_ivp(
        backwards, (instance.tf, instance.t0), start, method="DOP853", rtol=TOLERANCE, atol=1e-14, max_step=longest
    )
    if found.status < 0:
        return False
    first, least, terms = found.y[:n, -1], float(found.y[n, -1]), float(found.y[n + 1, -1])
    rows = given_rows(instance)
    from_start, wanted = first * np.array(instance.initial), (costate / size)[rows] * goal(instance, rows, instance.tf)
    margin = float(from_start.sum()) + least - float(wanted.sum())
    return margin > CLEAR * (float(np.abs(from_start).sum() + np.abs(wanted).sum()) + abs(terms))
