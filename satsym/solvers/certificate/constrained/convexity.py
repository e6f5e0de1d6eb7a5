"""Whether a problem with path constraints is convex, so that an extremal is the one global minimum.

The motion is linear and costs and constraints are quadratic, as was proved when they were derived; left to look at are
the signs of the second derivatives, which depend on the parameters and on time.
"""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.kernels.evaluation import COMPLEX_STEP
from satsym.solution import Solution

ROUNDING = 1e-12
"""Share of the largest eigenvalue by which the least may be negative."""

LOOKED_AT = 65
"""Times."""


def convex(solution: Solution) -> bool:
    """Whether it is; what is not of that form, or ends at a free time, is not."""
    instance = solution.instance
    if not instance.model.spec.linear_quadratic or instance.tf is None or "reference" in instance.final.values():
        return False
    chosen = np.linspace(0, len(solution.times) - 1, LOOKED_AT).astype(int)
    t, x, u = solution.times[chosen], solution.x[:, chosen], solution.u[:, chosen]
    model, p, none = instance.model, instance.parameters, np.zeros((len(x), len(chosen)))

    def slopes(y: Array) -> Array:
        by_x = -np.asarray(model.costate_rate_batch(t, y[: len(x)], y[len(x) :], none, p))
        by_u = np.asarray(model.stationarity_batch(t, y[: len(x)], y[len(x) :], none, p))
        return np.concatenate([np.broadcast_to(by_x, x.shape), np.broadcast_to(by_u, u.shape)])

    running = _second(slopes, np.concatenate([x, u]))
    inner = np.linalg.eigvalsh(running[:, len(x) :, len(x) :])
    strict = bool(len(u) and (inner[:, 0] > 0.0).all())
    end = t[-1:]
    final = _second(lambda y: np.asarray(model.terminal_gradient_batch(end, y, p)).reshape(len(x), -1), x[:, -1:])
    tables = [running, final]
    for k in range(len(model.spec.path_constraints)):
        tables.append(
            _second(lambda y, k=k: np.asarray(model.path_gradient_batch(t, y, p)).reshape(-1, *y.shape)[k], x)
        )
    return strict and all(map(_never_negative, tables))


def _second(slopes: object, at: Array) -> Array:
    """Derivatives of slopes by their argument, shape (N, d, d)."""
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
