"""Simulation of many motions of one model at once, with one column of arrays for each motion.

NumPy evaluates the generated batch form on blocks of columns, with reused buffers. Compiled kernels run the generated
scalar form instead, as the inner loop over the columns of a block, which the compiler turns into vector instructions.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from satsym.arrays import Array
from satsym.kernels import Kernels
from satsym.kernels.batch.factored import Unsuited
from satsym.kernels.batch.runge_kutta import BLOCK, OnTape
from satsym.kernels.blocks import block_step, pairs
from satsym.kernels.plain import weights
from satsym.status import BadInput
from satsym.wording import shown, suggestion

METHODS = ("RK4", "symplectic")

COMPILED_BLOCK = 512
"""Number of columns that compiled code processes at a time; without overhead of calls, fewer than NumPy needs."""


def simulate(
    kernels: Kernels,
    times: ArrayLike,
    x0: ArrayLike,
    p: Sequence[ArrayLike],
    steps: int,
    u: ArrayLike | None = None,
    method: str = "RK4",
) -> Array:
    """Return the states of many motions at given times, with equal steps between successive times.

    Parameters
    ----------
    kernels
        Kernels of the model; ``kernels.compiled()`` for compiled code, whose first use takes the time of compilation.
    times
        Times at which states are returned, shape (K,), the first being that of ``x0``. They may decrease.
    x0
        Initial states, shape (n, N).
    p
        Parameters, in the model's order; each a number or an array of shape (N,).
    steps
        Number of steps between successive times.
    u
        Constant controls, shape (m,) or (m, N); zero by default.
    method
        One of :data:`METHODS`. ``"symplectic"`` is a composition of kicks and drifts of sixth order with twelve
        evaluations in a step, for separable uncontrolled models.

    Returns
    -------
    array of shape (n, K, N)
        The states; nan or inf after a singularity.

    Raises
    ------
    BadInput
        For arrays of other shapes, numbers that are not finite, no step, or a method that the model does not support.
    """
    nodes, start, parameters, controls = _checked(kernels, times, x0, p, u)
    if steps < 1:
        raise BadInput(f"steps: {steps}; use at least one step between two times")
    if method not in METHODS:
        raise BadInput(f"method: {shown(method)}; {suggestion(method, METHODS)}")
    count, symplectic, compiled = start.shape[1], method == "symplectic", kernels.backend == "numba"
    if symplectic:
        kernels.require_separable()
        if controls.any():
            raise BadInput(
                f"u: the symplectic method supports uncontrolled motions only; use RK4 for {kernels.spec.name}"
            )
    if compiled:
        advance, block = block_step(kernels, symplectic), COMPILED_BLOCK
    else:
        stepping = _Kicks(kernels) if symplectic else _runge_kutta(kernels)
        advance, block = stepping.advance, stepping.block
    x = np.empty((len(start), len(nodes), count))
    with np.errstate(all="ignore"):
        for begin in range(0, count, block):
            part = slice(begin, begin + block)
            y = start[:, part].copy()
            given = [np.ascontiguousarray(rows[:, part]) for rows in (controls, parameters)]
            x[:, 0, part] = y
            for k in range(1, len(nodes)):
                advance(nodes[k - 1], (nodes[k] - nodes[k - 1]) / steps, steps, y, *given)
                x[:, k, part] = y
    return x


def _checked(
    kernels: Kernels, times: ArrayLike, x0: ArrayLike, p: Sequence[ArrayLike], u: ArrayLike | None
) -> tuple[Array, Array, Array, Array]:
    """Return times, initial states, parameters and controls as arrays, with one column for each motion."""
    spec = kernels.spec
    nodes, start = np.asarray(times, float), np.asarray(x0, float)
    if nodes.ndim != 1 or not len(nodes):
        raise BadInput(f"times: has shape {nodes.shape}; give a list of times")
    if start.ndim != 2 or len(start) != len(spec.states):
        raise BadInput(f"x0: has shape {start.shape}; give a row for each of the {len(spec.states)} states")
    parameters = _rows("p", p, len(spec.parameters), start.shape[1])
    idle = np.zeros(len(spec.controls)) if u is None else u
    controls = _rows("u", idle, len(spec.controls), start.shape[1])
    for name, rows in (("times", nodes), ("x0", start), ("p", parameters), ("u", controls)):
        if not np.isfinite(rows).all():
            raise BadInput(f"{name}: not finite; give numbers")
    return nodes, start, parameters, controls


@lru_cache(maxsize=32)
def _runge_kutta(kernels: Kernels) -> OnTape | _RungeKutta:
    """Return an RK4 integrator, on an operation tape if that is possible; it is created once for each model."""
    try:
        return OnTape(kernels)
    except (Unsuited, BadInput):
        return _RungeKutta(kernels)


class _RungeKutta:
    """RK4 integrator with the generated batch form and buffers for one size of block."""

    block = BLOCK

    def __init__(self, kernels: Kernels) -> None:
        self.dynamics = kernels.functions["dynamics_batch"]
        self.slope: Array = np.empty((0, 0))
        self.stage = self.total = self.slope

    def advance(self, t: float, h: float, steps: int, y: Array, u: Array, p: Array) -> None:
        """Advance y by a number of steps of size h from t, in place."""
        if self.slope.shape != y.shape:
            self.slope, self.stage, self.total = (np.empty(y.shape) for _ in range(3))
        slope, stage, total, f, parameters = self.slope, self.stage, self.total, self.dynamics, tuple(p)
        for i in range(steps):
            now = t + i * h
            f(now, y, u, parameters, out=total)
            np.multiply(total, 0.5 * h, out=stage)
            for fraction in (0.5, 1.0):  # the second and third slopes; each leads on from the start
                stage += y
                f(now + 0.5 * h, stage, u, parameters, out=slope)
                np.multiply(slope, 2.0, out=stage)
                total += stage
                np.multiply(slope, fraction * h, out=stage)
            stage += y
            f(now + h, stage, u, parameters, out=slope)
            total += slope
            total *= h / 6.0
            y += total


class _Kicks:
    """Symplectic integrator of kicks and drifts with the generated batch form."""

    block = BLOCK

    def __init__(self, kernels: Kernels) -> None:
        self.dynamics = kernels.functions["dynamics_batch"]
        self.coordinates, self.velocities = np.array(pairs(kernels.spec)).T
        kicks, drifts = weights()
        self.weights = tuple(zip(kicks, [*drifts, 0.0], strict=True))

    def advance(self, t: float, h: float, steps: int, y: Array, u: Array, p: Array) -> None:
        """Advance y by a number of steps of size h, in place."""
        slope, q, v, parameters = np.empty(y.shape), self.coordinates, self.velocities, tuple(p)
        for _ in range(steps):
            for kick, drift in self.weights:
                self.dynamics(t, y, u, parameters, out=slope)
                y[v] += (kick * h) * slope[v]
                y[q] += (drift * h) * y[v]


def _rows(name: str, values: ArrayLike | Sequence[ArrayLike], count: int, columns: int) -> Array:
    """Return one row for each component, shape (count, columns)."""
    if isinstance(values, np.ndarray) and values.dtype == float and values.shape == (count, columns):
        return values
    try:
        rows = [np.broadcast_to(np.asarray(row, float), columns) for row in values]  # type: ignore[union-attr]
    except (TypeError, ValueError):
        raise BadInput(f"{name}: each component must be a number or an array of {columns}") from None
    if len(rows) != count:
        raise BadInput(f"{name}: {len(rows)} components; the model has {count}")
    return np.array(rows).reshape(count, columns)
