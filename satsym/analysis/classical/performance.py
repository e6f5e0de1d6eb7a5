"""How well a state follows a step of its command: when it is there, how far it goes beyond, when it stays."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from satsym.arrays import Array

SETTLING_BAND = 0.02
"""Share of the step that the error keeps below once the motion counts as settled."""


def performance(
    times: Array, x: Callable[[Array], Array], follows: int, before: float, command: float
) -> dict[str, float]:
    """When a state first reaches its command, how far it goes beyond, and when it has settled, from the first node on.

    Parameters
    ----------
    times
        Nodes, shape (M,).
    x
        States (n, K) at times, shape (K,).
    follows
        Place of the state.
    before, command
        Its values before and after the step.
    """
    from scipy.optimize import minimize_scalar

    step = command - before
    if not step:
        return {}

    def fraction(t: Array) -> Array:
        found: Array = (x(t)[follows] - before) / step
        return found

    def at_time(t: float) -> float:
        return float(fraction(np.array([t]))[0])

    at = fraction(times)
    reached, off = np.flatnonzero(at >= 1.0), np.flatnonzero(np.abs(at - 1.0) > SETTLING_BAND)
    top, after = int(at.argmax()), int(off[-1]) + 1 if len(off) else 0
    highest = float(at.max())
    if 0 < top < len(at) - 1:
        near = times[top - 1], times[top + 1]
        found = minimize_scalar(lambda t: -at_time(t), bounds=near, method="bounded", options={"xatol": 1e-9 * near[1]})
        highest = max(highest, -float(found.fun))
    first = _crossing(times, lambda t: at_time(t) - 1.0, int(reached[0])) if len(reached) else math.nan
    settled = _crossing(times, lambda t: abs(at_time(t) - 1.0) - SETTLING_BAND, after) if after < len(at) else math.nan
    return {"first_reached": first, "settling_time": settled, "overshoot": max(highest - 1.0, 0.0)}


def _crossing(times: Array, value: Callable[[float], float], after: int) -> float:
    """The time, from the first node on, at which a function of time changes its sign just before a node."""
    from scipy.optimize import brentq

    if after == 0:
        return 0.0
    a, b = times[after - 1], times[after]
    if value(a) * value(b) > 0.0:  # it only just reaches the node
        return float(b - times[0])
    return float(brentq(value, a, b, xtol=1e-12 * max(abs(b), 1.0)) - times[0])
