"""A body on a line: its instances, its least time by another route, and the generated functions of its curve."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from hypothesis import strategies as st

from satsym import instance
from satsym.instance import Instance

LINE = instance.load("double-integrator-time")
SPEED = st.floats(-3.0, 3.0)
BOUNDS = st.tuples(st.floats(-3.0, -0.2), st.floats(0.2, 3.0))


def case(
    start: tuple[float, float] = (1.0, 0.0),
    end: tuple[float, float] = (0.0, 0.0),
    bounds: tuple[float, float] = (-1.0, 1.0),
    deadband: float = 1e-3,
    tf: float | None = None,
) -> Instance:
    """A body on a line."""
    final = dict(zip(("q", "q_dot"), end, strict=True))
    low, high = bounds
    return replace(LINE, initial=start, final=final, lower=(low,), upper=(high,), deadband=deadband, tf=tf)


def least(start: tuple[float, float], end: tuple[float, float], bounds: tuple[float, float]) -> tuple[float, float]:
    """Least time and the first control, of all pairs of arcs: by the rate at which they join.

    v^2 - 2 u q is constant along an arc under u; the two constants give the square of the rate w in between.
    """
    (q, v), (q_f, v_f), found = start, end, []
    for first, last in (bounds, bounds[::-1]):
        square = (q_f - q + v * v / (2 * first) - v_f * v_f / (2 * last)) / (1 / (2 * first) - 1 / (2 * last))
        for w in (math.sqrt(square), -math.sqrt(square)) if square >= 0.0 else ():
            times = (w - v) / first, (v_f - w) / last
            if min(times) >= -1e-12:
                found.append((sum(times), first if times[0] > 1e-12 else last))
    return min(found)


def generated(function: str, start: tuple[float, float], of: Instance) -> Any:
    final = (1.0, 1.0, 0.0, 0.0, *map(float, of.final.values()))  # type: ignore[arg-type]
    return getattr(of.model, function)(0.0, start, of.parameters, of.control_set.arguments, final)
