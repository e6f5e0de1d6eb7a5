"""From an instance to its scaled two-point problem."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.control_set import UNSMOOTHED
from satsym.instance import Instance
from satsym.solvers.collocation.problem import Scale, TwoPoint
from satsym.solvers.control.regularised import sloping
from satsym.solvers.control.slopes import full_length_smoothing

POINTS = 9
"""Points of the straight line at which sizes and responses are looked at."""

NO_SLOPE = 1e-40
"""Largest slope of costates that are none, see :func:`satsym.solvers.control.regularised.sloping`."""

BESIDE, ROUNDED = 0.1, 1e-12
"""How far beside the straight line slopes are looked at once more, as a share of the sizes of states, and the share of
a slope there below which one on the line is a zero that was rounded, as the sine of half a turn is."""

NEGLIGIBLE = 1e-3
"""A state this much smaller along the way than what it does to the others is scaled by the latter."""


def two_point(instance: Instance, duration: float) -> TwoPoint:
    """The scaled problem of an instance.

    Parameters
    ----------
    duration
        tf - t0; where it is free, a first guess.
    """
    final = final_argument(instance)
    start, end = np.array(instance.initial), _end(instance, final, duration)
    return TwoPoint(instance, final, duration, _scale(instance, start, end, duration))


def final_argument(instance: Instance) -> tuple[float, ...]:
    """The ``final`` argument of the boundary functions."""
    wanted = [instance.final.get(name) for name in instance.model.spec.state_names]
    on_reference = [float(value == "reference") for value in wanted]
    given = [float(value is not None and value != "reference") for value in wanted]
    target = [0.0 if value is None or value == "reference" else float(value) for value in wanted]
    return (*given, *on_reference, *target)


def _end(instance: Instance, final: tuple[float, ...], duration: float) -> Array:
    """Where the motion should end, as far as that is known; elsewhere the initial state."""
    n = len(instance.initial)
    given, on_reference, target = (np.array(final[k * n : (k + 1) * n]) for k in range(3))
    end = np.where(given > 0, target, np.array(instance.initial))
    if on_reference.any():
        curve = np.array(instance.model.reference(instance.t0 + duration, instance.parameters))
        end = np.where(on_reference > 0, curve, end)
    return end


def straight(problem: TwoPoint) -> Array:
    """The straight line's two ends in scaled states, shape (n, 2)."""
    end = _end(problem.instance, problem.final, problem.duration)
    return np.stack([problem.initial, end / problem.scale.state], axis=1)


def _scale(instance: Instance, start: Array, end: Array, duration: float) -> Scale:
    """Sizes of the states along the straight line; the cost that makes the response to costates one."""
    n, model = len(start), instance.model
    places = np.linspace(0.0, 1.0, POINTS)
    path, times = start[:, None] + (end - start)[:, None] * places, instance.t0 + duration * places
    control_set = instance.control_set
    if model.spec.directional and control_set.smoothing <= UNSMOOTHED:  # nothing responds to costates that vanish
        control_set = control_set.regularised(full_length_smoothing(instance), 1.0)
    free = control_set.without_bounds.arguments
    none = sloping(instance, np.zeros_like(path))
    size = np.abs(path).max(axis=1)
    beside = path + BESIDE * np.where(size > 0.0, size, 1.0)[:, None]
    slopes, aside = np.empty((2 * n, 2 * n, POINTS)), np.empty((2 * n, 2 * n, POINTS))
    with np.errstate(all="ignore"):
        for at, found in ((path, slopes), (beside, aside)):
            model.canonical_jacobian_batch(times, at, none, instance.parameters, free, out=found)
        slopes, aside = np.abs(slopes).max(axis=2), np.abs(aside).max(axis=2)
        slopes[:n, :n][slopes[:n, :n] < ROUNDED * aside[:n, :n]] = 0.0
    # some laws say nothing of costates that vanish, and there some that Newton finds jump
    slopes[~((slopes >= NO_SLOPE) & np.isfinite(slopes))] = 0.0
    table = slopes[:n, :n].tolist()
    for j in range(n):
        sizes = size.tolist()
        through = [
            sizes[i] / (table[i][j] * duration) for i in range(n) if i != j and table[i][j] > 0.0 and sizes[i] > 0.0
        ]
        least = min(through, default=1.0)
        if sizes[j] < NEGLIGIBLE * least:
            size[j] = least
    response = float((slopes[:n, n:] / (size[:, None] * size)).max())
    return Scale(size, 1.0 / (duration * response) if response > 0.0 else 1.0)
