"""Integration of the canonical equations for many columns at once, compiled or by NumPy."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any, Protocol

import numpy as np

from satsym.arrays import Array
from satsym.kernels import Kernels
from satsym.kernels.batch import canonical, compiling
from satsym.solvers.shooting.runge_kutta import tableau
from satsym.solvers.simulation.extrapolation import leap_and_error

BLOCK = 1024
"""Number of columns that NumPy processes at a time, so that the arrays fit into the processor's cache."""


class Motion(Protocol):
    """Integrator with arguments t and step h of shape (K,), states and costates z (2n, K), and parameters p (k, K).

    Results refer to the end of the step: states and costates, the integral of the running cost if requested, and the
    derivatives with respect to the initial values, shape (2n, 2n, K).
    """

    def rough(self, t: Array, z: Array, h: Array, p: Array, parts: int) -> tuple[Array, Array]:
        """Return the final values, shape (2n, K), after `parts` steps of order four, and their derivatives."""

    def accurate(self, t: Array, z: Array, h: Array, p: Array, parts: int) -> Array:
        """Return the final values and the cost, shape (2n + 1, K), after `parts` steps of order eight."""

    def leap(self, t: Array, z: Array, h: Array, p: Array, columns: int) -> tuple[Array, Array]:
        """Return the result and errors of one extrapolated step, shapes (2n + 1, K), with the cost in the last row."""

    def leap_varied(self, t: Array, z: Array, h: Array, p: Array, columns: int) -> tuple[Array, Array, Array]:
        """Return the result of one extrapolated step, its derivatives, and the errors of the derivatives."""


@lru_cache(maxsize=16)
def motion(kernels: Kernels, bounds: tuple[float, ...] | None, compiled: bool) -> Motion:
    """Return the integrator of a model.

    Parameters
    ----------
    kernels
        The model.
    bounds
        Bounds as an argument of the model's functions; ``None`` if bounds follow the parameters as rows, which only the
        NumPy integrator supports.
    compiled
        Whether to use compiled code; compilation takes half a minute, once for each model.
    """
    return _Compiled(kernels, bounds) if compiled and bounds is not None else _OnArrays(kernels, bounds)


class _Compiled:
    """Integrator of extremals by compiled code."""

    def __init__(self, kernels: Kernels, bounds: tuple[float, ...]) -> None:
        a, b, c = tableau()
        method = a.tolist(), b.tolist(), c.tolist()
        text = canonical.text(kernels.spec, compiling.module_text(kernels), bounds, method)
        self._functions = compiling.compiled(kernels.spec.name, text)
        self._rows = 2 * len(kernels.spec.states)
        with compiling.alone(kernels.spec.name):
            self._call_each(len(kernels.spec.parameters))

    def _call_each(self, parameters: int) -> None:
        """Call each function once, so that all of them are compiled or read from the cache."""
        one, z, p = np.ones(1), np.ones((self._rows, 1)), np.ones((parameters, 1))
        self.rough(one, z, one, p, 1)
        self.accurate(one, z, one, p, 1)
        self.leap(one, _costing(z), one, p, 2)
        self.leap_varied(one, z, one, p, 2)

    def rough(self, t: Array, z: Array, h: Array, p: Array, parts: int) -> tuple[Array, Array]:
        rows = self._rows
        ends, transition = np.empty((rows, len(t))), np.empty((rows * rows, len(t)))
        self._functions["rough"](t, z, h, p, parts, ends, transition)
        return ends, transition.reshape(rows, rows, -1)

    def accurate(self, t: Array, z: Array, h: Array, p: Array, parts: int) -> Array:
        ends = np.empty((self._rows + 1, len(t)))
        self._functions["accurate"](t, _costing(z), h, p, parts, ends)
        return ends

    def leap(self, t: Array, z: Array, h: Array, p: Array, columns: int) -> tuple[Array, Array]:
        ends, off = np.empty_like(z), np.empty_like(z)
        self._functions["leap_costing"](t, z, h, p, columns, ends, off)
        return ends, off

    def leap_varied(self, t: Array, z: Array, h: Array, p: Array, columns: int) -> tuple[Array, Array, Array]:
        rows, count = self._rows, len(t)
        ends, off = np.empty((rows, count)), np.empty((rows, count))
        whole, wrong = np.empty((rows * rows, count)), np.empty((rows * rows, count))
        self._functions["leap_varied"](t, z, h, p, columns, ends, whole, off, wrong)
        return ends, whole.reshape(rows, rows, -1), wrong.reshape(rows, rows, -1)


def _costing(z: Array) -> Array:
    """Return states and costates with an additional row for the accumulated cost, which starts at zero."""
    return np.concatenate([z, np.zeros((1, z.shape[1]))])


class _OnArrays:
    """Integrator of extremals by the batch form of kernels, in blocks of columns."""

    def __init__(self, kernels: Kernels, bounds: tuple[float, ...] | None) -> None:
        self._kernels, self._bounds, self._n = kernels, bounds, len(kernels.spec.states)

    def _arguments(self, p: Array) -> tuple[tuple[Array, ...], tuple[Any, ...]]:
        """Return parameters and bounds from the rows of p."""
        count = len(self._kernels.spec.parameters)
        return tuple(p[:count]), tuple(p[count:]) if self._bounds is None else self._bounds

    def _rates(self, p: Array) -> Callable[[Any, Array], Array]:
        """Return the right-hand side of states and costates."""
        model, n, (own, bounds) = self._kernels, self._n, self._arguments(p)
        return lambda t, z: np.asarray(model.canonical_batch(t, z[:n], z[n:], own, bounds))

    def _costing(self, p: Array) -> Callable[[Any, Array], Array]:
        """Return the right-hand side of states, costates and cost."""
        model, n, (own, bounds) = self._kernels, self._n, self._arguments(p)

        def rates(t: Any, y: Array) -> Array:
            found, x, lam = np.empty_like(y), y[:n], y[n : 2 * n]
            model.canonical_batch(t, x, lam, own, bounds, out=found[: 2 * n])
            found[2 * n] = model.running_cost_batch(t, x, model.control_law_batch(t, x, lam, own, bounds), own)
            return found

        return rates

    def _varied(self, p: Array) -> Callable[[Any, Array], Array]:
        """Return the right-hand side of states, costates and their derivatives with respect to the initial values."""
        model, n, (own, bounds) = self._kernels, self._n, self._arguments(p)
        rows = 2 * n

        def rates(t: Any, y: Array) -> Array:
            found, x, lam = np.empty_like(y), y[:n], y[n:rows]
            model.canonical_batch(t, x, lam, own, bounds, out=found[:rows])
            slopes = np.asarray(model.canonical_jacobian_batch(t, x, lam, own, bounds))
            given, varied = y[rows:].reshape(rows, rows, -1), found[rows:].reshape(rows, rows, -1)
            for i in range(rows):
                self._row(slopes[i], given, varied[i])
            return found

        return rates

    @staticmethod
    def _row(slopes: Array, given: Array, out: Array) -> None:
        """Compute one row of a product of matrices, in place.

        Entries of `slopes` that are zero in all columns are skipped.
        """
        out[:] = 0.0
        for k, slope in enumerate(slopes):
            if slope.any():
                out += slope * given[k]

    def rough(self, t: Array, z: Array, h: Array, p: Array, parts: int) -> tuple[Array, Array]:
        rows, found = len(z), np.empty((len(z) + len(z) ** 2, len(t)))
        for own in _blocks(len(t)):
            now, width = np.concatenate([z[:, own], _unity(rows, len(t[own]))]), h[own] / parts
            for part in range(parts):
                now = _classical(self._varied(p[:, own]), t[own] + part * width, now, width)
            found[:, own] = now
        return found[:rows], found[rows:].reshape(rows, rows, -1)

    def accurate(self, t: Array, z: Array, h: Array, p: Array, parts: int) -> Array:
        found = np.empty((len(z) + 1, len(t)))
        for own in _blocks(len(t)):
            rates, now, width = self._costing(p[:, own]), _costing(z[:, own]), h[own] / parts
            for part in range(parts):
                now = _eighth(rates, t[own] + part * width, now, width)
            found[:, own] = now
        return found

    def leap(self, t: Array, z: Array, h: Array, p: Array, columns: int) -> tuple[Array, Array]:
        found, off = np.empty_like(z), np.empty_like(z)
        for own in _blocks(len(t)):
            found[:, own], off[:, own] = leap_and_error(self._costing(p[:, own]), t[own], z[:, own], h[own], columns)
        return found, off

    def leap_varied(self, t: Array, z: Array, h: Array, p: Array, columns: int) -> tuple[Array, Array, Array]:
        rows = len(z)
        found, off = (np.empty((rows + rows * rows, len(t))) for _ in range(2))
        for own in _blocks(len(t)):
            start = np.concatenate([z[:, own], _unity(rows, len(t[own]))])
            found[:, own], off[:, own] = leap_and_error(self._varied(p[:, own]), t[own], start, h[own], columns)
        return found[:rows], found[rows:].reshape(rows, rows, -1), off[rows:].reshape(rows, rows, -1)


def _blocks(count: int) -> list[slice]:
    return [slice(at, min(at + BLOCK, count)) for at in range(0, count, BLOCK)]


def _unity(rows: int, count: int) -> Array:
    return np.repeat(np.eye(rows).reshape(-1, 1), count, axis=1)


def _classical(rates: Callable[[Any, Array], Array], t: Array, y: Array, h: Array) -> Array:
    """Return the result of one step of the classical Runge-Kutta method."""
    one = rates(t, y)
    two = rates(t + h / 2.0, y + (h / 2.0) * one)
    three = rates(t + h / 2.0, y + (h / 2.0) * two)
    four = rates(t + h, y + h * three)
    return np.asarray(y + (h / 6.0) * (one + 2.0 * (two + three) + four))


def _eighth(rates: Callable[[Any, Array], Array], t: Array, y: Array, h: Array) -> Array:
    """Return the result of one step of order eight by Dormand and Prince, without stages of zero weight."""
    a, b, c = tableau()
    stages: list[Array] = []
    for i, row in enumerate(a):
        inner = y
        if i:
            inner = _combined(row[:i], stages)
            inner *= h
            inner += y
        stages.append(rates(t + c[i] * h, inner))
    found = _combined(b, stages)
    found *= h
    found += y
    return found


def _combined(weights: Array, stages: list[Array]) -> Array:
    found = np.zeros_like(stages[0])
    part = np.empty_like(found)
    for weight, stage in zip(weights, stages, strict=False):
        if weight:
            np.multiply(stage, weight, out=part)
            found += part
    return found
