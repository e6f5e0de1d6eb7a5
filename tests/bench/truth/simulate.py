"""The control of an independent answer, simulated again to 1e-12: what it costs and where it ends."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.integrate import DOP853

from tests.bench.truth.case import Case
from tests.bench.truth.collocate import NODES, POINTS, Found
from tests.bench.truth.physics import MODELS

EXACT = 1e-12
NEAR = 5e-4
"""A miss whose worth is below that share of the cost is taken off to first order; what is left is its square."""


@dataclass(frozen=True)
class Confirmed:
    """A cost that a simulation confirms.

    Attributes
    ----------
    cost
        Of the simulated control, and of what is left to the goal, to first order.
    missed
        Largest distance from the goal, relative to the size of the state.
    worth
        What that is worth relative to the cost.
    """

    cost: float
    missed: float
    worth: float


def confirmed(case: Case, found: Found) -> Confirmed | None:
    """Simulate the control, cut to its bounds; ``None`` where it does not arrive."""
    physics = MODELS[case.model]
    p = physics.given(case.parameters)
    y = np.array([case.initial[name] for name in physics.states] + [0.0])
    for values, a, b in zip(found.controls, found.edges[:-1], found.edges[1:], strict=True):
        ended = _through(case, p, y, case.t0 + a * found.duration, (b - a) * found.duration, values)
        if ended is None:
            return None
        y = ended
    x, tf = y[:-1], case.t0 + found.duration
    cost = y[-1] + physics.terminal(math, tf, x, p)
    gap = np.where(np.isnan(found.goal), 0.0, found.goal - x)
    for end in physics.ends(math, tf, x, p):
        if abs(end) > 1e-7:
            return None
    missed = float((np.abs(gap) / np.maximum(1.0, np.abs(x))).max())
    worth = float(found.slope @ gap)
    size = max(abs(cost), 1e-300)
    if not math.isfinite(cost) or missed > 1e-3 or abs(worth) > NEAR * size:
        return None
    return Confirmed(float(cost + worth), missed, abs(worth) / size)


def _through(
    case: Case, p: tuple[float, ...], y: np.ndarray, begun: float, h: float, values: np.ndarray
) -> np.ndarray | None:
    """State and cost at the end of one interval."""
    physics = MODELS[case.model]
    bounds = [case.bounds.get(name, (-math.inf, math.inf)) for name in physics.controls]
    polynomials = np.polyfit(NODES, values, POINTS - 1).T.tolist()

    def control(fraction: float) -> list[float]:
        u = []
        for (a, b, c, d), (low, high) in zip(polynomials, bounds, strict=True):
            u.append(min(max(((a * fraction + b) * fraction + c) * fraction + d, low), high))
        if case.max_norm is not None:
            size = math.hypot(*u)
            if size > case.max_norm:
                u = [each * case.max_norm / size for each in u]
        return u

    def rate(t: float, y: np.ndarray) -> list[float]:
        x, u = y.tolist(), control((t - begun) / h)
        return [*physics.rate(math, t, x, u, p), physics.running(math, t, x, u, p)]

    solver = DOP853(rate, begun, y, begun + h, rtol=EXACT, atol=EXACT)
    try:
        while solver.status == "running":
            if solver.step() is not None or solver.nfev > 20000:
                return None
    except (ZeroDivisionError, OverflowError, ValueError):
        return None
    return solver.y if solver.status == "finished" else None
