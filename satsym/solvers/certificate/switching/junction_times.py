"""The second variation in switching and junction times where arcs at bounds and on boundaries follow each other.

With the order of arcs given, and on boundaries the control that keeps to them, a motion is the times at which they
meet. Where the Hessian of the Lagrangian in these is positive along all that keeps the end and the entries on their
boundaries, an extremal that switches strictly, and is strictly pressed against its boundaries, is a strict strong local
minimum (Maurer and Vossen, Sufficient conditions and sensitivity analysis for optimal bang-bang control problems with
state constraints, System Modeling and Optimization, 2009). Derivatives are taken of the motion itself, costates aside.
"""

from __future__ import annotations

from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.certificate.switching.replay import Replay
from satsym.solvers.simulation.extrapolation import leap
from satsym.solvers.switching.boundaries import values
from satsym.solvers.switching.boundary import BoundaryField
from satsym.solvers.switching.field import NUDGE, Field

STEPS = 8
"""Of an arc."""

SHIFT = 1e-3
"""Difference over which gradients are differentiated once more, as a share of the shortest arc."""

PLACES, WEIGHTS = np.array([-2.0, -1.0, 1.0, 2.0]), np.array([1.0, -8.0, 8.0, -1.0]) / 12.0
"""Of a central difference of fourth order."""

RANK = 1e-9
"""Smallest singular value, relative to the largest, of a derivative that counts."""


def curvature(instance: Instance, again: Replay) -> float:
    """The least eigenvalue of the Hessian on what is kept, relative to its largest entry.

    Infinite where what is kept fixes all times; NaN where the end is more than given states.
    """
    if (found := reduced(instance, again)) is None:
        return float("nan")
    return float(np.linalg.eigvalsh(found[0]).min() / found[1]) if found[0].size else float("inf")


def reduced(instance: Instance, again: Replay) -> tuple[Array, float] | None:
    """The Hessian on what is kept, and its largest entry; ``None`` where the end is more than given states."""
    if instance.model.spec.multipliers or any(isinstance(v, str) for v in instance.final.values()):
        return None
    inner = [piece.end for piece in again.pieces[:-1]]
    times = np.array([*inner, *([again.pieces[-1].end] if instance.tf is None else [])])
    if not len(times):
        return np.zeros((0, 0)), 1.0
    unit = min(b - a for a, b in pairwise([instance.t0, *inner, again.pieces[-1].end]))
    shifts = SHIFT * unit * PLACES[:, None, None] * np.eye(len(times))
    near = times + np.concatenate([np.zeros((1, len(times))), shifts.reshape(-1, len(times))])
    slopes = _gradients(instance, [piece.field for piece in again.pieces], near.T)
    cost, kept = slopes[0, :, 0], slopes[1:, :, 0]
    if not len(kept):
        kept = np.zeros((1, len(times)))
    multipliers = -np.linalg.lstsq(kept.T, cost, rcond=RANK)[0]
    lagrangian = slopes[0] + np.einsum("c,cpk->pk", multipliers, slopes[1:] if len(slopes) > 1 else 0.0 * slopes[:1])
    hessian = np.einsum("k,pkj->pj", WEIGHTS, lagrangian[:, 1:].reshape(len(times), 4, -1)) / (SHIFT * unit)
    _, sizes, rows = np.linalg.svd(kept / np.maximum(np.abs(kept).max(axis=1, keepdims=True), 1e-300))
    kernel = rows[int((sizes > RANK * sizes.max(initial=1e-300)).sum()) :].T
    return kernel.T @ (hessian + hessian.T) @ kernel / 2.0, max(float(np.abs(hessian).max()), 1e-300)


def _gradients(instance: Instance, fields: list[Field], times: Array) -> Array:
    """Derivatives of the cost and of what is kept by times, shape (1 + c, P, K), at times (P, K)."""
    count, many = times.shape
    moved = times[:, None, :] + 1j * NUDGE * np.eye(count)[:, :, None]
    found = _flown(instance, fields, moved.reshape(count, -1))
    return np.asarray(np.imag(found).reshape(-1, count, many) / NUDGE)


def _flown(instance: Instance, fields: list[Field], times: NDArray[Any]) -> NDArray[Any]:
    """The cost, constraints where their boundaries are entered, and given final states, at times (P, N)."""
    n, many = len(instance.initial), times.shape[1]
    y = np.repeat(np.append(instance.initial, 0.0).astype(complex)[:, None], many, axis=1)
    begin, kept, before = np.full(many, instance.t0, dtype=complex), [], None
    for k, field in enumerate(fields):
        end = times[k] if k < len(times) else np.full(many, instance.tf, dtype=complex)
        boundary = field.constraint if isinstance(field, BoundaryField) else None
        if boundary is not None and boundary != before and k:
            kept.append(values(instance, begin, y[:n])[boundary])
        h, before = (end - begin) / STEPS, boundary
        for step in range(STEPS):
            y = leap(partial(_rates, field), begin + step * h, y, h)
        begin = end
    p, model = instance.parameters, instance.model
    cost = y[n] + model.terminal_cost_batch(begin, y[:n], p)
    given = [y[k] for k, name in enumerate(model.spec.state_names) if name in instance.final]
    return np.array([cost, *kept, *given])


def _rates(field: Field, t: NDArray[Any], y: NDArray[Any]) -> NDArray[Any]:
    """Rates of states and the running cost, shape (n + 1, N); no costate has a part in them."""
    x, none = y[: field.n], np.zeros_like(y[: field.n])
    u = np.repeat(np.array(field.saturated)[:, None], y.shape[1], axis=1)
    if isinstance(field, BoundaryField):
        u = field.controls(t, np.concatenate([x, none]))
    found = np.empty_like(y)
    found[: field.n] = field.model.dynamics_batch(t, x, u, field.p)
    found[field.n] = field.model.running_cost_batch(t, x, u, field.p)
    return found
