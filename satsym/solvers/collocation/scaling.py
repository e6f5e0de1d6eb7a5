"""Conversion of an instance into its scaled two-point problem."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.control_set import UNSMOOTHED
from satsym.instance import Instance
from satsym.solvers.collocation.problem import Scale, TwoPoint
from satsym.solvers.control.regularised import sloping
from satsym.solvers.control.slopes import full_length_smoothing

POINTS = 9
"""Number of points on the straight line at which magnitudes and responses are evaluated."""

NO_SLOPE = 1e-40
"""Largest derivative that counts as zero for vanishing costates, see
:func:`satsym.solvers.control.regularised.sloping`."""

BESIDE, ROUNDED = 0.1, 1e-12
"""Distance beside the straight line, relative to the states, at which derivatives are evaluated again; and derivative
on the line, relative to that beside it, below which it counts as a rounded zero, such as the sine of half a turn."""

NEGLIGIBLE = 1e-3
"""Ratio of a state to the magnitude implied by its effect on other states, below which the latter is used as its
unit."""


def two_point(instance: Instance, duration: float) -> TwoPoint:
    """Return the scaled problem of an instance.

    Parameters
    ----------
    duration
        Duration tf - t0; an initial guess if it is free.
    """
    final = final_argument(instance)
    start, end = np.array(instance.initial), _end(instance, final, duration)
    return TwoPoint(instance, final, duration, _scale(instance, start, end, duration))


def final_argument(instance: Instance) -> tuple[float, ...]:
    """Return the ``final`` argument of the boundary functions."""
    wanted = [instance.final.get(name) for name in instance.model.spec.state_names]
    on_reference = [float(value == "reference") for value in wanted]
    given = [float(value is not None and value != "reference") for value in wanted]
    target = [0.0 if value is None or value == "reference" else float(value) for value in wanted]
    return (*given, *on_reference, *target)


def _end(instance: Instance, final: tuple[float, ...], duration: float) -> Array:
    """Return the final states as far as they are known, and the initial states otherwise."""
    n = len(instance.initial)
    given, on_reference, target = (np.array(final[k * n : (k + 1) * n]) for k in range(3))
    end = np.where(given > 0, target, np.array(instance.initial))
    if on_reference.any():
        curve = np.array(instance.model.reference(instance.t0 + duration, instance.parameters))
        end = np.where(on_reference > 0, curve, end)
    return end


def straight(problem: TwoPoint) -> Array:
    """Return both ends of the straight line in scaled states, shape (n, 2)."""
    end = _end(problem.instance, problem.final, problem.duration)
    return np.stack([problem.initial, end / problem.scale.state], axis=1)


def _scale(instance: Instance, start: Array, end: Array, duration: float) -> Scale:
    """Return units of the states, from the straight line, and the unit of cost with unit response to costates."""
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
