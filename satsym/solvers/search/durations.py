"""A first guess of a duration that is free: how long controls take to move the states as far as they are to go."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.cold_start.durations import time_scale
from satsym.solvers.search.controls import Controls
from satsym.solvers.search.sizes import flow, resting, wanted

STEPS = 400
"""In which each constant control is followed."""

FIRST, LONGEST, SHORTER = 0.01, 0.1, 0.3
"""Share of the time of the quickest state that the first step takes, share of a state's way that a step goes at most,
and by how much a step is shortened that goes further."""

FAR, SMALLEST, LARGEST = 0.9, 1e-3, 1e-2
"""Share of the way that is far enough; between which errors of a step it keeps its length."""


def first_duration(instance: Instance, controls: Controls) -> float:
    """The duration that is given or guessed, or else the least in which constant controls have moved every state."""
    if instance.tf is not None:
        return instance.tf - instance.t0
    if instance.tf_guess is not None:
        return instance.tf_guess - instance.t0
    return _moved(instance, controls) or time_scale(instance)


def _moved(instance: Instance, controls: Controls) -> float | None:
    start = np.array(instance.initial)
    goal = np.abs(wanted(instance, instance.t0) - start)
    first = np.full(len(start), np.inf)
    for v in _constant(controls):
        first = np.minimum(first, _reached(instance, controls, v, start, goal))
    found = first[(goal > 0.0) & np.isfinite(first)]
    return float(found.max()) if len(found) else None


def _constant(controls: Controls) -> list[Array]:
    """Controls at rest, and each of them at both of its bounds."""
    rest = resting(controls)
    found = [rest]
    for k in range(controls.count):
        low, high = controls.lower[k], controls.upper[k]
        for value in (high if np.isfinite(high) else 1.0, low if np.isfinite(low) else -1.0):
            v = np.zeros(controls.count) if controls.norms else rest.copy()
            v[k] = value
            for norm in controls.norms:
                if k in norm.places and norm.spot is not None:
                    v[norm.spot] = abs(value)
            found.append(v)
    return found


def _reached(instance: Instance, controls: Controls, v: Array, start: Array, goal: Array) -> Array:
    """When each state has moved far enough; infinite where that is never seen."""
    size = np.maximum(np.abs(start), np.nan_to_num(goal))
    size[size == 0.0] = np.inf
    positive = np.array([one.positive for one in instance.model.spec.states])
    first, x, t = np.full(len(start), np.inf), start, instance.t0
    speed = np.abs(flow(instance, controls, t, x, v)[:-1]) / size
    quick = float(np.nan_to_num(speed).max())
    h, way = FIRST * (1.0 / quick if quick > 0.0 else time_scale(instance)), np.where(goal > 0.0, goal, np.inf)
    for _ in range(STEPS):
        a = flow(instance, controls, t, x, v)[:-1]
        b = flow(instance, controls, t + h / 2, x + h / 2 * a, v)[:-1]
        c = flow(instance, controls, t + h / 2, x + h / 2 * b, v)[:-1]
        d = flow(instance, controls, t + h, x + h * c, v)[:-1]
        after = x + h / 6 * (a + 2 * (b + c) + d)
        if not np.isfinite(after).all() or (after[positive] <= 0.0).any():
            break
        if (np.abs(after - x) > LONGEST * way).any():
            h *= SHORTER
            continue
        error = float(np.abs(after - x - h * b).max() / max(np.abs(after).max(), 1e-300))
        t, x = t + h, after
        arrived = (np.abs(x - start) >= FAR * goal) & (goal > 0.0)
        first = np.where(arrived, np.minimum(first, t - instance.t0), first)
        h *= 1.3 if error < SMALLEST else 0.7 if error > LARGEST else 1.0
    return first
