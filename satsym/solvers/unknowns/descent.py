"""From a choice of what is free down to where the minimum cost is least: a trust region over what solutions tell.

Symmetric rank-one updates know of negative curvature; differences of slopes tell at the end how the minimum cost is
curved: upwards at a minimum, downwards at a saddle, which is left to both sides.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from satsym.arrays import Array
from satsym.solution import Solution
from satsym.solvers.certificate.free_start import second_derivative
from satsym.solvers.certificate.start import FLAT, STATIONARY, STILL, Curvature, softest
from satsym.solvers.improving import without_minimiser
from satsym.solvers.unknowns.trials import Trial, Trials
from satsym.status import BadInput

SETTLED_SLOPE = 1e-11
"""Slope, relative, at which nothing is left to be gained."""

ITERATIONS, POLISHING, DEPARTURES = 60, 4, 3
"""Steps of the trust region, of Newton's method at its end, and saddles that are left."""

FIRST = 0.05
"""Share of the unit of each unknown by which it is changed first, to see how much depends on it."""

NEAR_UNITS = 1e-3
"""Units by which they are changed to measure the curvature."""

FAR_UNITS = 1e5
"""Units beyond which a cost that falls still is taken to fall without end."""

SMALLEST_RADIUS = 1e-10
"""Radius of the trust region, in units, below which nothing moves."""

IDLE = 1e-9
"""Relative slope and change of the cost below which it does not depend on an unknown."""

NOISE = 1e-10
"""Relative difference of costs that two solutions may have for nothing."""

AGREEMENT = 0.05
"""Relative difference of the curvatures that costs and slopes tell, beyond which neither is believed."""


def minimum_from(trials: Trials, here: Trial) -> tuple[Trial, Curvature] | Solution:
    """From a trial down to where the minimum cost is least, and its curvature there; or no answer."""
    form = _first_form(trials, here)
    for _ in range(DEPARTURES):
        descended = _descended(trials, here, form)
        if isinstance(descended, Solution):
            return descended
        here = descended
        if here.residual > STATIONARY:
            return here, Curvature(math.nan)
        form, believed = _form(trials, here)
        here = _polished(trials, here, form)
        least, direction = softest(form, STILL * here.size)
        if not believed or not least < -FLAT:
            return here, Curvature(least if believed else math.nan)
        beside = [trials(here.at + sign * share * direction) for share in (0.1, 0.5) for sign in (1.0, -1.0)]
        lower = [one for one in beside if one is not None and one.cost < here.cost]
        if not lower:
            break
        here = min(lower, key=lambda one: one.cost)
    return here, Curvature(least)


def _descended(trials: Trials, here: Trial, form: Array) -> Trial | Solution:
    """The trust region's way down."""
    radius, start = 1.0, here.at
    for _ in range(ITERATIONS):
        if here.residual <= SETTLED_SLOPE or radius < SMALLEST_RADIUS:
            break
        step = _step(form, here.slope, radius)
        new = trials(here.at + step)
        length = float(np.linalg.norm(step))
        if new is None:
            radius = length / 4.0
            continue
        form = _updated(form, step, new.slope - here.slope)
        change, expected = new.cost - here.cost, float(here.slope @ step + step @ form @ step / 2.0)
        drowned = abs(change) <= NOISE * here.size
        if new.residual < here.residual if drowned else change < 0.0:
            if not drowned and length > 0.8 * radius and change < 0.5 * expected:
                radius *= 2.5
            here = new
            if float(np.abs(here.at - start).max()) > FAR_UNITS:
                message = f"the cost decreases without bound; it is {here.cost:.4g} with {trials.values(here.at)}"
                return without_minimiser(here.solution, f"{message}; give numbers, or weigh them in the cost")
        elif drowned:
            break
        else:
            radius = length / 4.0
    return here


def _first_form(trials: Trials, here: Trial) -> Array:
    """Second derivatives by first differences, and what depends on nothing refused."""
    count = len(here.at)
    form, idle = np.diag(np.maximum(np.abs(here.slope), NOISE * here.size)), []
    for k, axis in enumerate(np.eye(count)):
        for step in (FIRST, -FIRST):
            beside = trials(here.at + step * axis)
            if beside is not None:
                form[:, k] = (beside.slope - here.slope) / step
                most = max(abs(here.slope[k]), abs(beside.slope[k]), abs(beside.cost - here.cost))
                still = most <= IDLE * here.size
                idle += [trials.unknowns[k]] if still else []
                break
    for unknown in idle:
        reason = "neither the cost nor the conditions at the end depend on it; give it a number"
        raise BadInput(f'{trials.instance.called}: {unknown.key}: "free", but {reason}')
    return np.asarray((form + form.T) / 2.0)


def _form(trials: Trials, here: Trial) -> tuple[Array, bool]:
    """Second derivatives, and whether they are believed.

    Neighbouring extremals tell those by initial states. Others are central differences of slopes, which are believed if
    costs tell the same.
    """
    exact = second_derivative(replace(here.solution, instance=replace(here.solution.instance, free=trials.unknowns)))
    if exact is not None:
        return exact * np.outer(trials.unit, trials.unit), True
    count = len(here.at)
    form, by_costs = np.zeros((count, count)), np.zeros(count)
    for k, axis in enumerate(np.eye(count)):
        ahead, behind = trials(here.at + NEAR_UNITS * axis), trials(here.at - NEAR_UNITS * axis)
        if ahead is None or behind is None:
            return np.eye(count), False
        form[:, k] = (ahead.slope - behind.slope) / (2.0 * NEAR_UNITS)
        by_costs[k] = (ahead.cost - 2.0 * here.cost + behind.cost) / NEAR_UNITS**2
    own = np.diag(form)
    blurred = 4.0 * NOISE * here.size / NEAR_UNITS**2
    believed = bool((np.abs(by_costs - own) <= AGREEMENT * np.abs(own) + blurred).all())
    return (form + form.T) / 2.0, believed


def _polished(trials: Trials, here: Trial, form: Array) -> Trial:
    """Newton's method with the form that was measured."""
    for _ in range(POLISHING):
        if here.residual <= SETTLED_SLOPE or softest(form, STILL * here.size)[0] <= FLAT:
            break
        new = trials(here.at - np.linalg.solve(form, here.slope))
        if new is None or not new.residual < here.residual:
            break
        here = new
    return here


def _step(form: Array, slopes: Array, radius: float) -> Array:
    """The least of the quadratic model within the trust region."""
    values, axes = np.linalg.eigh(form)
    along = axes.T @ slopes
    if values[0] > 0.0:
        newton = -along / values
        if np.linalg.norm(newton) <= radius:
            return np.asarray(axes @ newton)

    def length(shift: float) -> float:
        return float(np.linalg.norm(along / (values + shift)))

    low = max(0.0, -float(values[0])) * (1.0 + 1e-12) + 1e-300
    high = low + max(float(np.linalg.norm(along)) / radius, 1e-300)
    for _ in range(200):
        middle = (low + high) / 2.0
        low, high = (middle, high) if length(middle) > radius else (low, middle)
    found = -along / (values + high)
    size = float(np.linalg.norm(found))
    return np.asarray(axes @ found) * min(1.0, radius / size if size > 0.0 else 1.0)


def _updated(form: Array, step: Array, change: Array) -> Array:
    """The symmetric rank-one update, which knows of negative curvature."""
    missing = change - form @ step
    weight = float(missing @ step)
    if abs(weight) <= 1e-8 * float(np.linalg.norm(missing) * np.linalg.norm(step)):
        return form
    return np.asarray(form + np.outer(missing, missing) / weight)


def met_beside(trials: Trials, here: Trial) -> str | None:
    """What is met where the slope of the minimum cost does not vanish and no step down is found; ``None``: nothing."""
    length = max(float(np.linalg.norm(here.slope)), 1e-300)
    beside = [trials(here.at + sign * NEAR_UNITS * here.slope / length) for sign in (1.0, -1.0)]
    if beside[1] is None:
        return "falls towards the edge of what has an answer,"
    if all(one is None or one.cost > here.cost for one in beside):
        return "has a corner, where costates are not unique,"
    return None
