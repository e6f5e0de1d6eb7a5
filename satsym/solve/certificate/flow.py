"""The canonical flow, integrated again from the initial state and costates of a solution."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.solution import Solution
from satsym.solve.integrate import NotFinite, integrate

Array = NDArray[np.floating[Any]]

TOLERANCE = 1e-13
"""Error of a step, relative to the size of each component."""

STATIONS = 64
"""Times at which the flow is compared with the solver's trajectory and looked at for conjugate times."""


@dataclass(frozen=True, eq=False)
class Flow:
    """States, costates and the field of neighbouring extremals from the same initial state.

    Attributes
    ----------
    times
        Stations, shape (K,), switching times among them.
    x, lam
        States and costates there, shapes (n, K).
    field
        Their derivatives by the initial costates, shape (K, 2n, n).
    """

    times: Array
    x: Array
    lam: Array
    field: Array


def flow(solution: Solution) -> Flow | None:
    """Integrate from the initial state and costates; ``None`` where the flow is not finite."""
    instance, model = solution.instance, solution.instance.model
    n, p, bounds = len(instance.initial), instance.parameters, instance.bounds
    start, end = float(solution.times[0]), float(solution.times[-1])
    kinks = [t for times in solution.switching_times for t in times if start < t < end]
    stations = np.unique(np.concatenate([np.linspace(start, end, STATIONS + 1), kinks]))
    sizes = np.concatenate([_sizes(solution.x), _sizes(solution.lam)])
    by_costates = np.concatenate([np.zeros((n, n)), np.eye(n)])

    def rates(t: float, y: Array) -> Array:
        x, lam = tuple(y[:n].tolist()), tuple(y[n : 2 * n].tolist())
        slopes = np.array(model.canonical_jacobian(t, x, lam, p, bounds)).reshape(2 * n, 2 * n)
        neighbours = slopes @ y[2 * n :].reshape(2 * n, n)
        return np.concatenate([model.canonical(t, x, lam, p, bounds), neighbours.ravel()])

    values = np.concatenate([instance.initial, solution.lam[:, 0], by_costates.ravel()])
    # The field may grow without bound; what matters is its direction, so its own size is what errors are held to.
    scale = np.concatenate([sizes, np.full(2 * n * n, 1e-3) * np.outer(sizes, 1.0 / sizes[n:]).ravel()])
    found = [values]
    try:
        for piece in integrate(rates, stations, values, TOLERANCE, scale):
            found.append(piece.end)
    except (NotFinite, ZeroDivisionError, OverflowError, ValueError):
        return None
    table = np.array(found)
    return Flow(stations, table[:, :n].T, table[:, n : 2 * n].T, table[:, 2 * n :].reshape(-1, 2 * n, n))


def _sizes(rows: Array) -> Array:
    """Largest magnitude of each row; of a row of zeros, the largest of all, or one."""
    own = np.abs(rows).max(axis=1)
    spare = own.max() if own.any() else 1.0
    return np.where(own > 0.0, own, spare)
