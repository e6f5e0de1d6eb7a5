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
"""States at which an inequality is looked at: a derivative that vanishes at all of these vanishes everywhere."""

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
        by_state = [_rows(instance, instance.t0 + 1.0, x)[1][:, :n] for x in drawn]
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
            when = "after the start" if found is None else f"{found:.6g} that is given"
            raise BadInput(f"{instance.called}: terminal inequality {name}: it is met at no final time {when}")
        found = root
    return found


def _root(instance: Instance, name: str) -> float | None:
    """Where Newton's method leads from the guessed final time, or a unit after the start; ``None``: not after it."""
    which = stated(instance.model).spec.terminal_inequalities.index(name)
    x = np.ones(len(instance.initial))
    t = instance.t0 + 1.0 if instance.tf_guess is None else instance.tf_guess
    for _ in range(ITERATIONS):
        with np.errstate(all="ignore"):
            values, slopes = _rows(instance, t, x)
            step = float(values[which] / slopes[which, -1])
        if not np.isfinite(step):
            return None
        t -= step
        if abs(step) <= LAST_STEP * max(abs(t), 1.0):
            return t if t > instance.t0 else None
    return None


def _rows(instance: Instance, t: float, x: Array) -> tuple[Array, Array]:
    """Inequalities at an end, shape (i,), and their derivatives by state, costate, multipliers and time, a row each."""
    model, n = stated(instance.model), len(x)
    c, count = len(model.spec.multipliers), len(model.spec.terminal_inequalities)
    arguments = t, tuple(x.tolist()), (0.0,) * n, (0.0,) * c, instance.parameters, instance.control_set.arguments
    place = slice(n + c - count, n + c)
    values = np.array(model.boundary(*arguments, (0.0,) * 3 * n))[place]
    return values, np.array(model.boundary_jacobian(*arguments, (0.0,) * 3 * n)).reshape(n + c + 1, -1)[place]
