"""Test whether a problem is convex, so that an extremal is the unique global minimum.

Linear dynamics, and quadratic costs and constraints with constant weights, were established when the model was derived;
the signs of the second derivatives, which depend on the parameters, remain to be tested.
"""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.kernels.evaluation import COMPLEX_STEP
from satsym.solvers.constrained.arcs import effects, gradients

ROUNDING = 1e-12
"""Largest magnitude of a negative eigenvalue, relative to the largest eigenvalue, that counts as rounding."""


def convex(instance: Instance) -> bool:
    """Return whether an instance is convex; ``False`` if it is not of linear-quadratic form or its final time is free.

    Second derivatives of such problems are constant, so that they are evaluated at the initial state.
    """
    spec = instance.model.spec
    kinds = {spec.control_set, *(part.kind for part in spec.control_parts)}
    if spec.switching or not spec.linear_quadratic or kinds & {"annulus", "angle"}:
        return False
    if instance.tf is None or "reference" in instance.final.values() or instance.solver.free_angles:
        return False
    t, x = np.array([instance.t0]), np.array(instance.initial)[:, None]
    u = np.zeros((len(instance.model.spec.controls), 1))
    model, p, none = instance.model, instance.parameters, np.zeros_like(x)

    def slopes(y: Array) -> Array:
        by_x = -np.asarray(model.costate_rate_batch(t, y[: len(x)], y[len(x) :], none, p))
        by_u = np.asarray(model.stationarity_batch(t, y[: len(x)], y[len(x) :], none, p))
        return np.concatenate([np.broadcast_to(by_x, x.shape), np.broadcast_to(by_u, u.shape)])

    running = _second(slopes, np.concatenate([x, u]))
    inner = np.linalg.eigvalsh(running[:, len(x) :, len(x) :])
    strict = bool(len(u) and (inner[:, 0] > 0.0).all())
    end = np.array([instance.tf])
    final = _second(lambda y: np.asarray(model.terminal_gradient_batch(end, y, p)).reshape(len(x), -1), x)
    tables = [running, final]
    for k in range(len(model.spec.path_constraints)):

        def pushes(y: Array, k: int = k) -> Array:
            x_and_u = y[: len(x)], y[len(x) :]
            return np.concatenate([slopes_by(instance, t, *x_and_u)[k] for slopes_by in (gradients, effects)])

        tables.append(_second(pushes, np.concatenate([x, u])))
    return strict and all(map(_never_negative, tables))


def _second(slopes: object, at: Array) -> Array:
    """Return derivatives of a gradient with respect to its argument, shape (N, d, d)."""
    columns = []
    for j in range(len(at)):
        moved = at.astype(complex)
        moved[j] += 1j * COMPLEX_STEP
        columns.append(np.imag(slopes(moved)) / COMPLEX_STEP)  # type: ignore[operator]
    found = np.stack([np.broadcast_to(c, at.shape) for c in columns], axis=1).transpose(2, 0, 1)
    return np.asarray((found + found.swapaxes(1, 2)) / 2)


def _never_negative(tables: Array) -> bool:
    values = np.linalg.eigvalsh(tables)
    return bool((values[:, 0] >= -ROUNDING * np.maximum(np.abs(values).max(axis=1), 1e-300)).all())
