"""The derivative of H with respect to controls that are directions; where it vanishes, it determines no direction."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.control_set import ControlSet
from satsym.instance import Instance

VANISHING, MOMENT = 1e-9, 1e-4
"""Derivative of H, relative to its largest value, below which it counts as zero; and relative to its median, below
which a direction counts as having a singular point."""

INSTANT = 1e-6
"""Relative step of the finite difference with respect to explicit time."""


def slope(instance: Instance, places: Sequence[int], t: Array, x: Array, lam: Array) -> Array:
    """Return the derivative of H with respect to a direction or to the cosine and sine of an angle, (components, N).

    For a single control in a box it is the derivative with the best direction of the vector that the control
    multiplies.

    Parameters
    ----------
    places
        Indices of the controls that form the direction.
    t, x, lam
        Times (N,), states and costates, (n, N).
    """
    model, p = instance.model, instance.parameters
    switched = [at for at, part in instance.control_set.parts if part.throttled]
    if any(at == tuple(places) and part.kind == "box" for at, part in instance.control_set.parts):
        slopes_of_all = model.throttle_slope_batch(t, x, lam, p, instance.control_set.arguments)
        return np.asarray(slopes_of_all)[[switched.index(tuple(places))]]
    u = np.zeros((len(model.spec.controls), len(t)))

    def slopes() -> Array:
        with np.errstate(all="ignore"):  # the norm of another vector has no slope where that is none
            return np.array(np.broadcast_to(model.stationarity_batch(t, x, u, lam, p), u.shape))[list(places)]

    if places[0] in instance.control_set.angles:
        across = slopes()
        u[places[0]] = np.pi / 2.0
        return np.concatenate([-slopes(), across])
    u[places[0]] = 1.0  # to both sides, so that what depends on the norm falls out
    ahead = slopes()
    u[places[0]] = -1.0
    return np.asarray((ahead + slopes()) / 2.0)


def undecided(instance: Instance, t: Array, x: Array, lam: Array) -> NDArray[np.bool_]:
    """Return the directions that H does not determine at an instant, shape (m, N)."""
    found = np.zeros((len(instance.model.spec.controls), len(t)), dtype=bool)
    for places, part in instance.control_set.parts:
        if part.directed and part.kind != "box":
            size = np.linalg.norm(slope(instance, places, t, x, lam), axis=0)
            found[list(places)] = ~(size > VANISHING * size.max(initial=0.0))
    return found


def continued(instance: Instance, t: Array, x: Array, lam: Array, u: Array) -> Array:
    """Return continuous controls over time: angles without jumps by a turn, undetermined directions held."""
    open_ones, found = undecided(instance, t, x, lam), np.array(u)
    for row, unknown in enumerate(open_ones):
        if unknown.any() and not unknown.all():
            known = np.flatnonzero(~unknown)
            before = np.searchsorted(known, np.arange(len(t)), side="right") - 1
            found[row] = found[row, known[np.maximum(before, 0)]]
    return instance.control_set.continued(found)


def full_length_smoothing(instance: Instance) -> float:
    """Return the smoothing at which full-length controls cost about as much again as time and states.

    If only the end has a cost, its rate of growth is used instead, at rest or, if that vanishes, at full length.
    """
    idle = instance.control_set.project(np.zeros((len(instance.model.spec.controls), 1)))[:, 0]
    directed = [(places, part.reach) for places, part in instance.control_set.parts if part.directed]
    cost = abs(cost_rate(instance, idle))
    if not cost:
        full = np.array(idle)
        for places, reach in directed:
            full[places[0]] = reach
        cost = abs(cost_rate(instance, full))
    effort = sum(reach**2 for _, reach in directed)
    return 2.0 * (cost if 0.0 < cost < float("inf") else 1.0) / effort


def cost_rate(instance: Instance, u: Array) -> float:
    """Return the rate of the cost at the start under a control: running cost plus the rate of the terminal cost."""
    model, p, t, x = instance.model, instance.parameters, instance.t0, instance.initial
    found = float(model.running_cost(t, x, tuple(u.tolist()), p))
    if model.spec.has_terminal_cost:
        rates = model.dynamics(t, x, tuple(u.tolist()), p)
        found += sum(a * b for a, b in zip(model.terminal_gradient(t, x, p), rates, strict=True))
        step = INSTANT * max(abs(t), 1.0)
        found += float(model.terminal_cost(t + step, x, p) - model.terminal_cost(t - step, x, p)) / (2.0 * step)
    return found


def without_poles(instance: Instance, t: Array, x: Array, lam: Array) -> ControlSet:
    """Return a control set whose law is differentiable along an extremal, even if the derivative of H vanishes.

    This happens, for example, at an end with free velocities: the sensitivity of a direction to the costates grows
    without limit, but its effect vanishes. The smoothing is so small that it only matters for a last moment.
    """
    smallest, usual = float("inf"), 0.0
    for places, part in instance.control_set.parts:
        if part.directed and part.kind != "box":  # on an arc a single control keeps its level, whatever the slope
            size = np.linalg.norm(slope(instance, places, t, x, lam), axis=0) / part.radius
            smallest, usual = min(smallest, float(size.min())), max(usual, float(np.median(size)))
    if not smallest < MOMENT * usual:
        return instance.control_set
    return instance.control_set.regularised(MOMENT * usual, 1.0)
