"""Shooting arcs compiled with numba: integration, variational equations and corners, from scalar functions.

The code is compiled once for each model, which takes seconds. A step in which a control meets or leaves a bound ends
exactly at that time, so that nodes may lie anywhere.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.kernels import Kernels
from satsym.solvers.shooting.runge_kutta import tableau

Numbers = tuple[float, ...]
Compiled = Callable[..., Any]

LOCATING = 60
"""Largest number of secant steps to a corner."""

LAST_DIGITS = 1e-15
"""Tolerance of the time of a corner, as a fraction of the integration step."""


@lru_cache(maxsize=16)
def integrator(model: Kernels, varied: bool) -> Compiled:
    """Return ``(times, nodes, steps, p, bounds) -> ends, cost, transition`` of a model, compiled at its first call.

    All arguments and results are in the model's units: times and nodes, shapes (N+1,) and (N+1, 2n); the ends of arcs,
    shape (N, 2n); the integral of the running cost over all arcs; and, with `varied`, the transition matrices, shape
    (N, 2n, 2n).
    """
    rows = 2 * len(model.spec.states)
    columns = rows if varied else 0
    width = 1 + columns
    bounds_count, distance = _distance(model, width)
    advanced, met = _stepper(model, columns), _meeting(model)

    # In w, states, costates and the integral of the running cost are the first column, variations the others.
    @njit()
    def integrated(start: float, end: float, steps: int, w: Array, p: Numbers, bounds: Numbers) -> Array:
        """Integrate one arc; a step in which a bound is met or left is divided at that time."""
        sides, bare = np.empty(bounds_count), np.empty(rows + 1)
        for bound in range(bounds_count):
            sides[bound] = np.sign(distance(bound, start, w, p, bounds))
        t = start
        for step in range(steps):
            stop = start + (end - start) * (step + 1) / steps
            while t < stop:
                for i in range(rows + 1):
                    bare[i] = w[i * width]
                h, first = stop - t, -1
                for bound in range(bounds_count):
                    if np.isfinite(bounds[bound]):
                        until = met(bound, sides[bound], t, h, bare, p, bounds)
                        if until < h:
                            h, first = until, bound
                w = advanced(t, h, w, p, bounds)
                t = stop if first < 0 else t + h
                if first >= 0:
                    sides[first] = -sides[first]
        return w

    @njit()
    def arcs(times: Array, nodes: Array, steps: int, p: Numbers, bounds: Numbers) -> tuple[Array, float, Array]:
        count, cost = len(times) - 1, 0.0
        ends, transition = np.empty((count, rows)), np.empty((count, rows, columns))
        for i in range(count):
            w = np.zeros((rows + 1) * width)
            for j in range(rows):
                w[j * width] = nodes[i, j]
                if columns:
                    w[j * width + 1 + j] = 1.0
            w = integrated(times[i], times[i + 1], steps, w, p, bounds)
            for j in range(rows):
                ends[i, j] = w[j * width]
                for k in range(columns):
                    transition[i, j, k] = w[j * width + 1 + k]
            cost += w[rows * width]
        return ends, cost, transition

    return arcs


@lru_cache(maxsize=16)
def _stepper(model: Kernels, columns: int) -> Compiled:
    """Return ``(t, h, w, p, bounds) -> w`` for one step with a number of variations, which is fixed for fast loops."""
    a, b, c = tableau()
    n, stages, width = len(model.spec.states), len(b), 1 + columns
    rows = 2 * n
    size, vector = (rows + 1) * width, packed(n)
    canonical, slopes, law, running = (
        model.functions[name] for name in ("canonical", "canonical_jacobian", "control_law", "running_cost")
    )

    @njit()
    def slope(t: float, w: Array, p: Numbers, bounds: Numbers, dw: Array) -> None:
        x, lam = vector(w, 0, width), vector(w, n * width, width)
        rates = canonical(t, x, lam, p, bounds)
        dw[rows * width] = running(t, x, law(t, x, lam, p, bounds), p)
        for i in range(rows):
            dw[i * width] = rates[i]
        if columns:
            entries = slopes(t, x, lam, p, bounds)
            for i in range(rows):
                row = i * width
                for k in range(1, width):
                    dw[row + k] = 0.0
                for j in range(rows):
                    entry = entries[rows * i + j]
                    if entry != 0.0:
                        for k in range(1, width):
                            dw[row + k] += entry * w[j * width + k]

    # Loops over elements throughout: array expressions are no faster here and take numba much longer to compile.
    @njit()
    def advanced(t: float, h: float, w: Array, p: Numbers, bounds: Numbers) -> Array:
        inner, dw = np.empty(size), np.zeros((stages, size))
        for q in range(stages + 1):
            for i in range(size):
                inner[i] = w[i]
            for j in range(q):
                weight = h * (a[q, j] if q < stages else b[j])
                if weight != 0.0:
                    for i in range(size):
                        inner[i] += weight * dw[j, i]
            if q < stages:
                slope(t + c[q] * h, inner, p, bounds, dw[q])
        return inner

    return advanced


@lru_cache(maxsize=16)
def _meeting(model: Kernels) -> Compiled:
    """Return ``(bound, side, t, h, w, p, bounds) -> h``, the part of a step before a distance changes sign."""
    (_, distance), advanced = _distance(model, 1), _stepper(model, 0)

    @njit()
    def met(bound: int, side: float, t: float, h: float, w: Array, p: Numbers, bounds: Numbers) -> float:
        high, at_high = h, distance(bound, t + h, advanced(t, h, w, p, bounds), p, bounds)
        if not at_high * side < 0.0:
            return h
        low, at_low = 0.0, distance(bound, t, w, p, bounds)
        if not at_low * side > 0.0:
            return 0.0
        for _ in range(LOCATING):  # secants that keep the zero enclosed (the Illinois method)
            between = high - at_high * (high - low) / (at_high - at_low)
            moved = abs(between - high)
            value = distance(bound, t + between, advanced(t, between, w, p, bounds), p, bounds)
            if value * at_high < 0.0:
                low, at_low = high, at_high
            else:
                at_low /= 2.0
            high, at_high = between, value
            if value == 0.0 or moved <= LAST_DIGITS * h:
                break
        return high

    return met


def _distance(model: Kernels, width: int) -> tuple[int, Compiled]:
    """Return the number of bounds, and ``(bound, t, w, p, bounds)``, one row of ``ControlSet.excess``."""
    law, n, m = model.functions["control_law"], len(model.spec.states), len(model.spec.controls)
    vector, infinity = packed(n), float("inf")
    free = (-infinity,) * m + (infinity,) * m

    def in_box(bound: int, t: float, w: Array, p: Numbers, bounds: Numbers) -> float:
        return law(t, vector(w, 0, width), vector(w, n * width, width), p, free)[bound % m] - bounds[bound]

    def in_ball(bound: int, t: float, w: Array, p: Numbers, bounds: Numbers) -> float:
        squares = 0.0
        for u in law(t, vector(w, 0, width), vector(w, n * width, width), p, (infinity,)):
            squares += u * u
        return np.sqrt(squares) - bounds[bound]

    def unlimited(bound: int, t: float, w: Array, p: Numbers, bounds: Numbers) -> float:
        return infinity

    count, function = {"box": (2 * m, in_box), "ball": (1, in_ball)}.get(str(model.spec.control_set), (0, unlimited))
    return count, njit()(function)


@lru_cache
def packed(count: int) -> Compiled:
    """Return ``(array, first, stride) -> tuple`` of `count` elements, since generated functions unpack tuples."""

    def none(array: Array, first: int, stride: int) -> Numbers:
        return ()

    def more(array: Array, first: int, stride: int) -> Numbers:
        return (array[first],) + rest(array, first + stride, stride)  # noqa: RUF005 - numba cannot unpack

    rest = packed(count - 1) if count else none
    return njit()(more if count else none)


def njit() -> Compiled:
    """Return the compiling decorator; divisions by zero give infinities as for arrays."""
    import numba

    return numba.njit(error_model="numpy")
