"""Tests of path constraints and of their multipliers along an extremal of exact arcs."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.switching.boundary import BoundaryField, pushed
from satsym.solvers.switching.extremal_arcs import Arc
from satsym.solvers.switching.field import NUDGE
from satsym.solvers.switching.structure import SINGULAR, jumps, on_boundary
from satsym.solvers.switching.trajectory import Trajectory, Violation, runs

LENGTH_BESIDE = 0.01
"""Fraction of a boundary arc that is given to a new singular arc beside it."""


def acting(instance: Instance, constraint: int) -> int:
    """Return the index of the control that affects the last time derivative of a constraint most."""
    rng, x = np.random.default_rng(0), np.array(instance.initial)
    drawn = np.where(x == 0.0, 1.0, x) * rng.uniform(0.5, 1.0, len(x))
    return int(np.abs(effects(instance, constraint, instance.t0, drawn)).argmax())


def effects(instance: Instance, constraint: int, time: float, x: Array) -> Array:
    """Return the derivatives of the last time derivative of a constraint with respect to the controls, shape (m,)."""
    m, order = len(instance.model.spec.controls), instance.model.spec.path_constraints[constraint].order
    places = np.repeat(x[:, None], m, axis=1)
    rates = instance.model.path_rates_batch(np.full(m, time), places, 1j * NUDGE * np.eye(m), instance.parameters)
    return np.asarray(np.imag(np.asarray(rates)[constraint, order - 1]) / NUDGE)


def values(instance: Instance, times: Array, z: Array) -> Array:
    """Return the values of all path constraints, shape (h, N), with controls at rest."""
    model, rest = instance.model, np.zeros((len(instance.model.spec.controls), len(times)))
    bounds = instance.control_set.arguments
    return np.asarray(
        model.path_constraints_batch(times, z[: len(instance.initial)], rest, instance.parameters, bounds)
    )


def off_boundaries(trajectory: Trajectory, slack: float = 1e-9) -> list[Violation]:
    """Return the intervals on which a path constraint is violated or a boundary multiplier has the wrong sign."""
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
                level = (
                    _left(arcs, which, first, len(times) - 1 - last, control)
                    if pressed
                    else on_boundary(k, order > 1, order > 1)
                )
                low, high = float(times[max(first - 1, 0)]), float(times[min(last + 1, len(times) - 1)])
                found.append(Violation(control, which, low, high, level, float(amounts[first : last + 1].max())))
    return [*found, *_pulling(arcs, slack)]


def _pulling(arcs: list[Arc], slack: float) -> list[Violation]:
    """Return costate jumps of the wrong sign, as places between arcs at which a singular arc is inserted."""
    found = []
    for k, (before, after) in enumerate(pairwise(arcs)):
        for which, one in ((k, before), (k + 1, after)):
            if not isinstance(one.field, BoundaryField) or not jumps(one.field.levels[one.field.acting])[which == k]:
                continue
            by, size = jump(one.field, before.end, before.after, after.before)
            if -by > slack * size:
                span = LENGTH_BESIDE * (one.end - one.start)
                low, high = (one.end - span, one.end) if which == k else (one.start, one.start + span)
                found.append(Violation(one.field.acting, which, low, high, SINGULAR, -by / size))
    return found


def jump(field: BoundaryField, time: float, before: Array, after: Array) -> tuple[float, float]:
    """Return the multiplier of the costates' jump along a constraint gradient, and a multiplier of typical size."""
    slope = pushed(field.instance, field.constraint, time, before, 0.0)[1][0]
    length = max(float(slope @ slope), 1e-300)
    lam = np.abs(before[field.n :]).max()
    return float((before - after)[field.n :] @ slope) / length, float(lam / np.sqrt(length))


def _left(arcs: list[Arc], which: int, before: int, after: int, control: int) -> int:
    """Return the level to which a control leaves a boundary: that of an adjacent arc, or singular."""
    if not before and which:
        return arcs[which - 1].field.levels[control]
    if not after and which < len(arcs) - 1:
        return arcs[which + 1].field.levels[control]
    return SINGULAR
