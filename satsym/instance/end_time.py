"""Inequalities at the end that involve time alone: an active one determines the final time, as if it were given."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from satsym.kernels.active import stated
from satsym.status import BadInput

if TYPE_CHECKING:
    from satsym.arrays import Array
    from satsym.instance.types import Instance

DRAWN = 8
"""Number of random states and times at which a derivative of an inequality is evaluated to see whether it is constant.
"""

ITERATIONS, LAST_STEP = 60, 1e-14
"""Most steps of Newton's method, and the size of the last step, relative to the time."""

TIME_TOLERANCE = 1e-12
"""Largest relative difference of equal final times."""


def in_time_alone(instance: Instance) -> frozenset[str]:
    """Return the inequalities at the end that involve no state."""
    names = stated(instance.model).spec.terminal_inequalities
    if not names:
        return frozenset()
    rng, n = np.random.default_rng(0), len(instance.initial)
    drawn = 10.0 ** rng.uniform(-1.0, 1.0, (DRAWN, n))  # positive, as some states have to be
    with np.errstate(all="ignore"):
        by_state = [inequalities_at(instance, instance.t0 + 1.0, x)[1][:, :n] for x in drawn]
    return frozenset(name for k, name in enumerate(names) if all((rows[k] == 0.0).all() for rows in by_state))


def end_time(instance: Instance, met: Sequence[str]) -> float | None:
    """Return the final time at which the active inequalities in time alone are equalities.

    Without an active one, the final time is the given one, or free.

    Raises
    ------
    BadInput
        If there is none after the start, or another one is given.
    """
    found = instance.tf
    for name in met:
        root = _root(instance, name)
        if root is None or (found is not None and abs(root - found) > TIME_TOLERANCE * max(abs(root), abs(found))):
            if found is None:
                message = (
                    f"{instance.called}: terminal inequality {name}: no final time after the initial time satisfies it"
                )
                raise BadInput(message)
            raise BadInput(
                f"{instance.called}: terminal inequality {name}: the given final time {found:.6g} does not satisfy it"
            )
        found = root
    return found


def never(instance: Instance) -> str:
    """Explain why an inequality in time alone holds at no final time; empty where each may hold.

    Where the final time is free, this is decided only for an inequality that is linear in time: it never holds if it
    does not hold at some time, and is an equality at none after the start.
    """
    names = stated(instance.model).spec.terminal_inequalities
    last = instance.t0 + 1.0 if instance.tf_guess is None else instance.tf_guess
    at = last if instance.tf is None else instance.tf
    x = np.ones(len(instance.initial))
    values, slopes, _ = inequalities_at(instance, at, x)
    above = values > TIME_TOLERANCE * np.abs(slopes[:, -1] * at)
    for name in sorted(in_time_alone(instance)):
        k = names.index(name)
        if not above[k]:
            continue
        if instance.tf is not None:
            return f"terminal inequality {name}: the given final time {instance.tf:.6g} does not satisfy it"
        times = instance.t0 + (last - instance.t0) * 10.0 ** np.random.default_rng(0).uniform(-1.0, 1.0, DRAWN)
        linear = all(inequalities_at(instance, t, x)[1][k, -1] == slopes[k, -1] for t in times)
        if linear and _root(instance, name) is None:
            return f"terminal inequality {name}: no final time after the initial time satisfies it"
    return ""


def _root(instance: Instance, name: str) -> float | None:
    """Return the limit of Newton's method from the guessed final time; ``None`` if it is not after the start."""
    which = stated(instance.model).spec.terminal_inequalities.index(name)
    x = np.ones(len(instance.initial))
    t = instance.t0 + 1.0 if instance.tf_guess is None else instance.tf_guess
    for _ in range(ITERATIONS):
        with np.errstate(all="ignore"):
            values, slopes, _ = inequalities_at(instance, t, x)
            step = float(values[which] / slopes[which, -1])
        if not np.isfinite(step):
            return None
        t -= step
        if abs(step) <= LAST_STEP * max(abs(t), 1.0):
            return t if t > instance.t0 else None
    return None


def inequalities_at(instance: Instance, t: float, x: Array) -> tuple[Array, Array, Array]:
    """Evaluate the inequalities at an end.

    Returns
    -------
    values
        Shape (i,), none of which may be positive.
    slopes
        Derivatives by the states and, last, by the time, a row each: (i, n + 1).
    on_time
        Contribution of a multiplier of one to the transversality condition of the final time, shape (i,).
    """
    model, n = stated(instance.model), len(x)
    c, count = len(model.spec.multipliers), len(model.spec.terminal_inequalities)
    arguments = t, tuple(x.tolist()), (0.0,) * n, (0.0,) * c, instance.parameters, instance.control_set.arguments
    place = slice(n + c - count, n + c)
    values = np.array(model.boundary(*arguments, (0.0,) * 3 * n))[place]
    table = np.array(model.boundary_jacobian(*arguments, (0.0,) * 3 * n)).reshape(n + c + 1, -1)
    return values, table[place][:, [*range(n), -1]], table[-1, 2 * n + c - count : 2 * n + c]
