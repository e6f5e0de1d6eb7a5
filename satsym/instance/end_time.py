"""Inequalities at the end in time alone: where one is met the final time follows from it, as if it were given."""

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
"""States and times at which a derivative of an inequality is looked at: one that is the same at all is constant."""

ITERATIONS, LAST_STEP = 60, 1e-14
"""Steps of Newton's method, and the last one's size, relative to the time it leads to."""

TIME_TOLERANCE = 1e-12
"""Relative difference of final times that are one."""


def in_time_alone(instance: Instance) -> frozenset[str]:
    """Inequalities at the end in which no state occurs."""
    names = stated(instance.model).spec.terminal_inequalities
    if not names:
        return frozenset()
    rng, n = np.random.default_rng(0), len(instance.initial)
    drawn = 10.0 ** rng.uniform(-1.0, 1.0, (DRAWN, n))  # positive, as some states have to be
    with np.errstate(all="ignore"):
        by_state = [inequalities_at(instance, instance.t0 + 1.0, x)[1][:, :n] for x in drawn]
    return frozenset(name for k, name in enumerate(names) if all((rows[k] == 0.0).all() for rows in by_state))


def end_time(instance: Instance, met: Sequence[str]) -> float | None:
    """The final time at which these inequalities in time alone are met; as it is given, or free, where none is.

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
                message = f"{instance.called}: terminal inequality {name}: no final time after the start satisfies it"
                raise BadInput(message)
            raise BadInput(
                f"{instance.called}: terminal inequality {name}: the given final time {found:.6g} does not satisfy it"
            )
        found = root
    return found


def never(instance: Instance) -> str:
    """Say why an inequality in time alone holds at no final time; empty where each may hold.

    Where the final time is free, this is proved of an inequality that is linear in time: one that does not hold at a
    time, and is met at none after the start, never holds. Of others nothing is said.
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
            return f"terminal inequality {name}: no final time after the start satisfies it"
    return ""


def _root(instance: Instance, name: str) -> float | None:
    """Where Newton's method leads from the guessed final time, or a unit after the start; ``None``: not after it."""
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
    """Inequalities at an end.

    Returns
    -------
    values
        Shape (i,), none of which may be positive.
    slopes
        Derivatives by the states and, last, by the time, a row each: (i, n + 1).
    on_time
        What a multiplier of one adds to the transversality condition of the final time, shape (i,).
    """
    model, n = stated(instance.model), len(x)
    c, count = len(model.spec.multipliers), len(model.spec.terminal_inequalities)
    arguments = t, tuple(x.tolist()), (0.0,) * n, (0.0,) * c, instance.parameters, instance.control_set.arguments
    place = slice(n + c - count, n + c)
    values = np.array(model.boundary(*arguments, (0.0,) * 3 * n))[place]
    table = np.array(model.boundary_jacobian(*arguments, (0.0,) * 3 * n)).reshape(n + c + 1, -1)
    return values, table[place][:, [*range(n), -1]], table[-1, 2 * n + c - count : 2 * n + c]
