"""Whether an extremal of exact arcs keeps to path constraints, and is pressed against those on whose boundary it is."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.switching.boundary import BoundaryField
from satsym.solvers.switching.extremal_arcs import Arc
from satsym.solvers.switching.field import NUDGE
from satsym.solvers.switching.structure import BOUNDARY, SINGULAR
from satsym.solvers.switching.trajectory import Trajectory, Violation, runs


def acting(instance: Instance, constraint: int) -> int:
    """The control that moves the last rate of a constraint."""
    spec, rng = instance.model.spec, np.random.default_rng(0)
    order, m, x = spec.path_constraints[constraint].order, len(spec.controls), np.array(instance.initial)
    moved = rng.uniform(0.5, 1.0, m)[:, None] + 1j * NUDGE * np.eye(m)
    places = np.repeat((np.where(x == 0.0, 1.0, x) * rng.uniform(0.5, 1.0, len(x)))[:, None], m, axis=1)
    rates = instance.model.path_rates_batch(np.full(m, instance.t0), places, moved, instance.parameters)
    return int(np.abs(np.imag(np.asarray(rates)[constraint, order - 1])).argmax())


def values(instance: Instance, times: Array, z: Array) -> Array:
    """All path constraints, shape (h, N), those that bound a control at its rest."""
    model, rest = instance.model, np.zeros((len(instance.model.spec.controls), len(times)))
    bounds = instance.control_set.arguments
    return np.asarray(
        model.path_constraints_batch(times, z[: len(instance.initial)], rest, instance.parameters, bounds)
    )


def off_boundaries(trajectory: Trajectory, slack: float = 1e-9) -> list[Violation]:
    """Stretches on which a path constraint is violated, or where its multiplier on its boundary has the wrong sign."""
    arcs, tables = trajectory.arcs, trajectory.looked_at
    instance = arcs[0].field.instance
    constraints = [values(instance, *table) for table in tables]
    room = np.maximum(np.max([np.abs(g).max(axis=1) for g in constraints], axis=0), 1e-300)
    on = [arc.field if isinstance(arc.field, BoundaryField) else None for arc in arcs]
    pushes = [None if one is None else one.multiplier(*table) for one, table in zip(on, tables, strict=True)]
    pressure = max((float(np.abs(push).max()) for push in pushes if push is not None), default=1.0)
    found = []
    for k, order in enumerate(one.order for one in instance.model.spec.path_constraints):
        for which, (field, push, g) in enumerate(zip(on, pushes, constraints, strict=True)) if order else ():
            pressed = field is not None and field.constraint == k
            amounts = -push / pressure if pressed and push is not None else g[k] / room[k]
            for first, last in runs(amounts > slack):
                control, times = acting(instance, k), tables[which][0]
                level = _left(arcs, which, first, len(times) - 1 - last, control) if pressed else BOUNDARY + k
                low, high = float(times[max(first - 1, 0)]), float(times[min(last + 1, len(times) - 1)])
                found.append(Violation(control, which, low, high, level, float(amounts[first : last + 1].max())))
    return found


def _left(arcs: list[Arc], which: int, before: int, after: int, control: int) -> int:
    """The level for which a control leaves a boundary: that of the nearer neighbour where nothing is between."""
    if not before and which:
        return arcs[which - 1].field.levels[control]
    if not after and which < len(arcs) - 1:
        return arcs[which + 1].field.levels[control]
    return SINGULAR
