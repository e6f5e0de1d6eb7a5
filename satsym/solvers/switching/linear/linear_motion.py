"""Linear motions x' = A x + B u + c with constant coefficients, integrated in steps of equal length.

The states that controls in a box can reach form a convex set, so that results about its points are global.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance

DRAWN = 24
"""Number of random points at which coefficients are compared."""

EQUAL_COEFFICIENTS = 1e-12
"""Relative difference of coefficients that counts as rounding."""

TERMS = 18
"""Number of terms of the exponential series for arguments below one half."""


@dataclass(frozen=True, eq=False)
class LinearMotion:
    """Coefficients of a motion, and of a running cost ``rate + slope'u + weight'|u|``."""

    states: Array
    controls: Array
    drift: Array
    """A, B and c, shapes (n, n), (n, m) and (n,)."""
    rate: float
    """Cost per unit of time; NaN if the cost has another form."""
    slope: Array
    weight: Array
    """Weights of the controls and of their magnitudes in the cost, shape (m,)."""

    @property
    def priced(self) -> bool:
        """Return whether the cost is a sum of time, controls and their magnitudes with constant weights."""
        return bool(np.isfinite(self.rate))

    def step(self, length: float) -> tuple[Array, Array, Array]:
        """Return the effects of the states, of the controls and of the drift over one step of given length."""
        n, m = self.controls.shape
        table = np.zeros((n + m + 1, n + m + 1))
        table[:n] = np.concatenate([self.states, self.controls, self.drift[:, None]], axis=1)
        found = exponential(length * table)[:n]
        return found[:, :n], found[:, n:-1], found[:, -1]

    def powers(self, length: float, count: int) -> Array:
        """Return the state transition matrices of 0, 1, ... count steps, shape (count + 1, n, n)."""
        one = self.step(length)[0]
        found = np.eye(len(one))[None]
        leap = one
        while len(found) <= count:
            found = np.concatenate([found, leap @ found])
            leap = leap @ leap
        return np.asarray(found[: count + 1])


def exponential(matrix: Array) -> Array:
    """Return the exponential of one or several matrices, by scaling, a series, and squaring."""
    size = float(np.abs(matrix).sum(axis=-2).max(initial=0.0))
    if not np.isfinite(size):
        raise ArithmeticError("coefficients are not finite")
    halvings = max(0, int(np.ceil(np.log2(max(size, 1e-300)))) + 1)
    small = matrix / 2.0**halvings
    term = found = np.broadcast_to(np.eye(matrix.shape[-1]), matrix.shape)
    for k in range(1, TERMS):
        term = term @ small / k
        found = found + term
    for _ in range(halvings):
        found = found @ found
    return np.asarray(found)


def linear_motion(instance: Instance) -> LinearMotion | None:
    """Return the coefficients of an instance's motion; ``None`` if they vary or a control is not in a box."""
    model, p, n, m = instance.model, instance.parameters, len(instance.initial), len(instance.lower)
    bounded = np.isfinite(instance.lower).all() and np.isfinite(instance.upper).all()
    spec = model.spec
    if not spec.autonomous or spec.moving_magnitudes or spec.multipliers or spec.control_set != "box" or not bounded:
        return None
    rng = np.random.default_rng(0)
    given = [abs(v) if isinstance(v, float | int) else 0.0 for v in map(instance.final.get, model.spec.state_names)]
    sizes = np.maximum(np.abs(instance.initial), np.array(given))
    sizes = np.where(sizes > 0.0, sizes, max(float(sizes.max(initial=0.0)), 1.0))[:, None]
    x = sizes * rng.normal(size=(n, DRAWN)) * 10.0 ** rng.uniform(-1.0, 2.0, DRAWN)
    low, high = instance.control_set.box
    u, t = rng.uniform(low, high, (m, DRAWN)), np.full(DRAWN, instance.t0)
    by_x = np.broadcast_to(model.jacobian_x_batch(t, x, u, p), (n, n, DRAWN))
    by_u = np.broadcast_to(model.jacobian_u_batch(t, x, u, p), (n, m, DRAWN))
    if not (_constant(by_x) and _constant(by_u)):
        return None
    drift = np.array(model.dynamics(instance.t0, (0.0,) * n, (0.0,) * m, p))
    rate, slope, weight = _cost(instance, t, x, u)
    return LinearMotion(by_x[:, :, 0].copy(), by_u[:, :, 0].copy(), drift, rate, slope, weight)


def _cost(instance: Instance, t: Array, x: Array, u: Array) -> tuple[float, Array, Array]:
    """Return the coefficients of the running cost; the first is NaN for other costs or a terminal cost."""
    model, p = instance.model, instance.parameters
    if not model.spec.switching:
        return float("nan"), np.zeros(len(u)), np.zeros(len(u))
    none = np.zeros_like(x)
    slope = np.broadcast_to(model.switching_function_batch(t, x, none, p), u.shape)
    weight = np.broadcast_to(model.magnitude_weight_batch(t, x, none, p), u.shape)
    idle = np.broadcast_to(model.running_cost_batch(t, x, np.zeros_like(u), p), t.shape)
    plain = _constant(slope) and _constant(weight) and _constant(idle) and not model.spec.has_terminal_cost
    return (float(idle[0]) if plain else float("nan")), slope[:, 0].copy(), weight[:, 0].copy()


def _constant(values: Array) -> bool:
    """Return whether values are constant along the last axis, up to rounding."""
    spread = np.abs(values - values[..., :1]).max(initial=0.0)
    return bool(np.isfinite(values).all() and spread <= EQUAL_COEFFICIENTS * np.abs(values).max(initial=0.0))
