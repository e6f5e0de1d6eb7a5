"""The canonical flow, integrated again from the initial state and costates of a solution."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.solution import Solution
from satsym.solve.collocation.curve import SMALL
from satsym.solve.collocation.scaling import two_point
from satsym.solve.integrate import NotFinite, integrate

Array = NDArray[np.floating[Any]]

TOLERANCE = 1e-13
"""Error of a step, relative to the size of each component."""

NEGLIGIBLE = 1e-3
"""Share of its unit, or of the largest product with its partner, at which something small counts."""

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
    cost
        Of the whole motion, the terminal cost included.
    """

    times: Array
    x: Array
    lam: Array
    field: Array
    cost: float


def flow(solution: Solution) -> Flow | None:
    """Integrate from the initial state and costates; ``None`` where the flow is not finite."""
    instance, model = solution.instance, solution.instance.model
    n, p, bounds = len(instance.initial), instance.parameters, instance.bounds
    start, end = float(solution.times[0]), float(solution.times[-1])
    kinks = [t for times in solution.switching_times for t in times if start < t < end]
    stations = np.unique(np.concatenate([np.linspace(start, end, STATIONS + 1), kinks]))
    sizes = np.concatenate(typical(solution))
    by_costates = np.concatenate([np.zeros((n, n)), np.eye(n)])

    def rates(t: float, y: Array) -> Array:
        x, lam = tuple(y[:n].tolist()), tuple(y[n : 2 * n].tolist())
        slopes = np.array(model.canonical_jacobian(t, x, lam, p, bounds)).reshape(2 * n, 2 * n)
        neighbours = slopes @ y[2 * n : -1].reshape(2 * n, n)
        cost = model.running_cost(t, x, model.control_law(t, x, lam, p, bounds), p)
        return np.concatenate([model.canonical(t, x, lam, p, bounds), neighbours.ravel(), [cost]])

    values = np.concatenate([instance.initial, solution.lam[:, 0], by_costates.ravel(), [0.0]])
    # The field may grow without bound; what matters is its direction, so its own size is what errors are held to.
    fields = np.full(2 * n * n, 1e-3) * np.outer(sizes, 1.0 / sizes[n:]).ravel()
    scale = np.concatenate([sizes, fields, [sizes[:n] @ sizes[n:]]])
    found = [values]
    try:
        for piece in integrate(rates, stations, values, TOLERANCE, scale):
            found.append(piece.end)
    except (NotFinite, ZeroDivisionError, OverflowError, ValueError):
        return None
    table = np.array(found)
    x, lam, field = table[:, :n].T, table[:, n : 2 * n].T, table[:, 2 * n : -1].reshape(-1, 2 * n, n)
    cost = float(table[-1, -1]) + float(model.terminal_cost(end, tuple(x[:, -1].tolist()), p))
    return Flow(stations, x, lam, field, cost)


def typical(solution: Solution) -> tuple[Array, Array]:
    """Sizes to which errors of states and costates are held, shapes (n,).

    Each its largest magnitude along the way, but what is far below its unit counts as a share of that: states are
    rounded, and what they move is no better. A costate also counts as a share of what the largest product of state
    and costate makes of it.
    """
    unit = two_point(solution.instance, float(solution.times[-1] - solution.times[0])).scale.both[:, 0]
    n = len(solution.x)
    state = np.maximum(np.abs(solution.x).max(axis=1), NEGLIGIBLE * unit[:n])
    costate = np.abs(solution.lam).max(axis=1)
    product = float((state * costate).max())
    return state, np.maximum(np.maximum(costate, SMALL * unit[n:]), NEGLIGIBLE * product / state)
