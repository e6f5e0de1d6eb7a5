"""Initial guess of a free duration: the time in which constant controls move the states to their final values."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.cold_start.own_time import time_scale
from satsym.solvers.failures import tried
from satsym.solvers.search.controls import Controls
from satsym.solvers.search.sizes import flows, resting, wanted

STEPS = 400
"""Number of steps for which each constant control is simulated."""

FIRST, LONGEST_STEP, SHORTER = 0.01, 0.1, 0.3
"""First step as a fraction of the time scale of the fastest state; largest change of a state in a step, relative to its
required change; factor that shortens a step with a larger change."""

FAR_ENOUGH, SMALLEST_ERROR, LARGEST_ERROR = 0.9, 1e-3, 1e-2
"""Fraction of the required change of a state that counts as sufficient. Smallest and largest relative error of a step
between which the step size is kept."""

SWINGING = 10.0
"""Number of time scales of the motion that are guessed if no constant control moves any state far enough."""

SCALES = 10.0 ** np.arange(-12.0, 7.0)
"""Magnitudes that are tried for controls without bounds."""


def first_duration(instance: Instance, controls: Controls) -> float:
    """Return the given or guessed duration, otherwise the time in which constant controls can move every state.

    If only some states are moved far enough, the guess is at least the time scale of the motion. If no state is, the
    motion has to swing, and several time scales are guessed.
    """
    if instance.tf is not None:
        return instance.tf - instance.t0
    if instance.tf_guess is not None:
        return instance.tf_guess - instance.t0
    moved = _moved(instance, controls)
    if not len(moved):
        return _time_scale(instance)
    if np.isfinite(moved).all():
        return float(moved.max())
    if np.isinf(moved).all():
        return SWINGING * _time_scale(instance)
    return max(float(moved[np.isfinite(moved)].max()), _time_scale(instance))


def _time_scale(instance: Instance) -> float:
    """Return the time scale of the motion; 1 if its linearisation is not finite."""
    return tried(lambda: time_scale(instance)) or 1.0


def _moved(instance: Instance, controls: Controls) -> Array:
    """Return the time at which any constant control has moved each state far enough; infinite if none does."""
    start = np.array(instance.initial)
    goal = np.abs(wanted(instance, instance.t0) - start)
    first = _reached(instance, controls, np.array(_constant(instance, controls)).T, start, goal)
    return np.asarray(first[goal > 0.0])


def _affordable(instance: Instance, controls: Controls, k: int) -> float:
    """Return the power of ten at which a control alone costs about as much as time; 1 if time costs nothing."""
    t, x = np.full(len(SCALES) + 1, instance.t0), np.repeat(np.array(instance.initial)[:, None], len(SCALES) + 1, 1)
    v = np.zeros((controls.count, len(SCALES) + 1))
    v[k, 1:] = SCALES
    running = np.abs(flows(instance, controls, t, x, v)[-1])
    fitting = SCALES[running[1:] <= 2.0 * running[0]]
    within = running[0] > 0.0 and 0 < len(fitting) < len(SCALES)
    return float(fitting[-1]) if within else 1.0


def _constant(instance: Instance, controls: Controls) -> list[Array]:
    """Return zero controls, and each control alone at its bounds or, if unbounded, where it costs as much as time."""
    rest = resting(controls)
    found = [rest]
    for k in range(controls.count):
        low, high = controls.lower[k], controls.upper[k]
        most = 1.0 if np.isfinite(low) and np.isfinite(high) else _affordable(instance, controls, k)
        for value in (high if np.isfinite(high) else most, low if np.isfinite(low) else -most):
            v = np.zeros(controls.count) if controls.norms else rest.copy()
            v[k] = value
            for norm in controls.norms:
                if k in norm.places and norm.spot is not None:
                    v[norm.spot] = abs(value)
            found.append(v)
    return found


def _reached(instance: Instance, controls: Controls, v: Array, start: Array, goal: Array) -> Array:
    """Return the time at which any of many constant controls (k, M) has moved each state far enough; else infinite."""
    size = np.maximum(np.abs(start), np.nan_to_num(goal))
    size[size == 0.0] = np.inf
    positive = np.array([one.positive for one in instance.model.spec.states])
    way = np.where(goal > 0.0, goal, np.inf)[:, None]
    first, count = np.full(len(start), np.inf), v.shape[1]
    x, t = np.repeat(start[:, None], count, 1), np.full(count, instance.t0)
    quick = np.nan_to_num(np.abs(flows(instance, controls, t, x, v)[:-1]) / size[:, None]).max(axis=0)
    slowest = 1.0 if (quick > 0.0).all() else _time_scale(instance)
    h = FIRST * np.where(quick > 0.0, 1.0 / np.where(quick > 0.0, quick, 1.0), slowest)
    for _ in range(STEPS):
        a = flows(instance, controls, t, x, v)[:-1]
        b = flows(instance, controls, t + h / 2, x + h / 2 * a, v)[:-1]
        c = flows(instance, controls, t + h / 2, x + h / 2 * b, v)[:-1]
        d = flows(instance, controls, t + h, x + h * c, v)[:-1]
        after = x + h / 6 * (a + 2 * (b + c) + d)
        left = ~np.isfinite(after).all(axis=0) | (after[positive] <= 0.0).any(axis=0)
        far = (np.abs(after - x) > LONGEST_STEP * way).any(axis=0)
        error = np.abs(after - x - h * b).max(axis=0) / np.maximum(np.abs(after).max(axis=0), 1e-300)
        x, t = np.where(far, x, after), np.where(far, t, t + h)
        arrived = (np.abs(x - start[:, None]) >= FAR_ENOUGH * goal[:, None]) & (goal[:, None] > 0.0) & ~far & ~left
        first = np.minimum(first, np.where(arrived, t - instance.t0, np.inf).min(axis=1))
        grown = np.where(error < SMALLEST_ERROR, 1.3, np.where(error > LARGEST_ERROR, 0.7, 1.0))
        h = h * np.where(far, SHORTER, grown)
        # what is later than the last arrival cannot be a first one
        kept = ~left & (t - instance.t0 < first[goal > 0.0].max(initial=0.0))
        x, t, h, v = x[:, kept], t[kept], h[kept], v[:, kept]
        if not len(t):
            break
    return first
