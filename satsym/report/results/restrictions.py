"""The states that each path constraint depends on, so that it can be drawn over them. This module draws nothing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.control_set import stated_constraints
from satsym.instance import Instance

PROBES = 24
"""Number of points of a trajectory at which the dependence of a constraint is tested."""
MOVED = 0.1
"""Relative change of each quantity in the test of dependence."""
EXACT = 1e-12
"""Relative change of a constraint up to which it does not depend on the changed quantity."""


@dataclass(frozen=True, eq=False)
class Restriction:
    """A path constraint that depends on states and on time alone.

    Attributes
    ----------
    name
        Of the constraint.
    states
        Places of the states that it depends on.
    timed
        Whether it depends on time besides.
    """

    name: str
    states: frozenset[int]
    timed: bool
    _place: int
    _instance: Instance
    _time: float
    _state: Array
    _control: Array

    def values(self, states: dict[int, Array], times: Array | float | None = None) -> Array:
        """Evaluate the constraint, positive where it is violated, for values of its states.

        Parameters
        ----------
        states
            By their places; arrays of one shape. Others are as they are somewhere on the way.
        times
            Of this shape, too, where it depends on time.
        """
        shape = np.broadcast_shapes(*map(np.shape, states.values()), () if times is None else np.shape(times))
        size = int(np.prod(shape))
        x = np.tile(self._state[:, None], size)
        for i, values in states.items():
            x[i] = np.broadcast_to(values, shape).ravel()
        t = np.full(size, self._time) if times is None else np.broadcast_to(times, shape).ravel().astype(float)
        return _rows(self._instance, t, x, np.tile(self._control[:, None], size))[self._place].reshape(shape)


def of(instance: Instance, times: Array, x: Array, u: Array) -> list[Restriction]:
    """Return the path constraints that depend on no control.

    Parameters
    ----------
    times, x, u
        A trajectory: (N+1,), (n, N+1), (m, N+1).
    """
    stated = stated_constraints(instance.model.spec)
    known = np.flatnonzero(np.isfinite(x).all(axis=0) & np.isfinite(u).all(axis=0))
    if not stated or not known.size:
        return []
    probes = known[np.linspace(0, len(known) - 1, PROBES).round().astype(int)]
    t, x, u = times[probes].astype(float), x[:, probes], u[:, probes]
    base, random = _rows(instance, t, x, u), np.random.default_rng(0)

    def moved(row: Array) -> Array:
        size = float(np.abs(row).max(initial=0.0)) or 1.0
        return row + MOVED * size * random.uniform(0.5, 1.0, row.shape)

    def differ(rows: Array) -> Array:
        return np.asarray((np.abs(rows - base) > EXACT * np.maximum(1.0, np.abs(base))).any(axis=1))

    by_time = differ(_rows(instance, moved(t), x, u))
    by_control = differ(_rows(instance, t, x, np.array([moved(row) for row in u]).reshape(u.shape)))
    by_state = [differ(_rows(instance, t, np.vstack([x[:i], moved(x[i])[None], x[i + 1 :]]), u)) for i in range(len(x))]
    middle = PROBES // 2
    return [
        Restriction(
            name,
            frozenset(i for i, differs in enumerate(by_state) if differs[k]),
            bool(by_time[k]),
            k,
            instance,
            float(t[middle]),
            x[:, middle],
            u[:, middle],
        )
        for name, k in stated.items()
        if not by_control[k]
    ]


def within(restrictions: Sequence[Restriction], states: Sequence[int], timed: bool = False) -> list[Restriction]:
    """Return the restrictions that depend on these states alone, and on time where that is allowed."""
    return [one for one in restrictions if one.states and one.states <= set(states) and (timed or not one.timed)]


def _rows(instance: Instance, t: Array, x: Array, u: Array) -> Array:
    """Evaluate all path constraints, shape (c, N)."""
    with np.errstate(all="ignore"):
        return np.asarray(
            instance.model.path_constraints_batch(t, x, u, instance.parameters, instance.control_set.arguments)
        )
