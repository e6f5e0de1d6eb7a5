"""Which states of a model are places, and which their rates: what may be drawn against each other. Draws nothing."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from satsym.arrays import Array
from satsym.kernels import Kernels
from satsym.spec import Variable

NEAR, EXACT = 0.1, 1e-12
"""How far from the trajectory rates are compared, relative to the sizes of states, and how exactly."""
_NAME = re.compile(r"(?:|[pqrs]_?|pos_?)([xyz])")


def pairs(model: Kernels, times: Array, x: Array, u: Array, p: Sequence[float]) -> list[tuple[int, int]]:
    """States with those that are their rates: the motions in one degree of freedom each.

    Rates are compared beside the trajectory, for on it states may agree that are not the same.
    """
    known = np.isfinite(x).all(axis=0) & np.isfinite(u).all(axis=0)
    if not known.any():
        return []
    times, x, u = times[known], x[:, known], u[:, known]
    sizes = np.abs(x).max(axis=1, initial=0.0, keepdims=True)
    beside = x + NEAR * np.where(sizes > 0.0, sizes, 1.0) * np.random.default_rng(0).uniform(-1.0, 1.0, x.shape)
    with np.errstate(all="ignore"):
        rates = model.dynamics_batch(times, beside, u, p)
    found = []
    for i, own in enumerate(rates):
        same = (j for j, row in enumerate(beside) if j != i and np.allclose(own, row, rtol=EXACT, atol=0.0))
        if (j := next(same, None)) is not None:
            found.append((i, j))
    return found


def polar(states: Sequence[Variable]) -> tuple[int, int] | None:
    """The states that are a distance and an angle about the origin, by their names; or none."""
    named = {state.symbol: i for i, state in enumerate(states)}
    distance = next((named[name] for name in ("r", "rho") if name in named), None)
    angle = next((named[name] for name in ("theta", "phi") if name in named), None)
    if distance is None or angle is None or states[angle].kind != "angle" or states[angle].unit not in ("1", "rad"):
        return None
    return distance, angle


def places(states: Sequence[Variable], rated: Sequence[tuple[int, int]]) -> tuple[int, ...]:
    """Two or three states that are the components of a position, by their names or because all have rates; or none."""
    named = {match[1]: i for i, state in enumerate(states) if (match := _NAME.fullmatch(state.symbol))}
    by_rate = tuple(i for i, _ in rated)
    for found in (tuple(named[axis] for axis in "xyz" if axis in named), by_rate):
        if len(found) in (2, 3) and len({states[i].unit for i in found}) == 1 and states[found[0]].kind == "real":
            angular = "rad" in states[found[0]].unit or "deg" in states[found[0]].unit
            if not angular:
                return found
    return ()


def level(
    model: Kernels, times: Array, x: Array, u: Array, p: Sequence[float], found: Sequence[int]
) -> tuple[int, ...]:
    """Two coordinates in the order in which they are drawn: across first what the motion does not depend on.

    Of a satellite near a circular orbit that is the distance along the track, of a body that falls the way it goes.
    """
    known = np.isfinite(x).all(axis=0) & np.isfinite(u).all(axis=0)
    if len(found) != 2 or not known.any():
        return tuple(found)
    times, x, u = times[known], x[:, known], u[:, known]
    with np.errstate(all="ignore"):
        rates = model.dynamics_batch(times, x, u, p)

        def matters(i: int) -> bool:
            moved = x.copy()
            moved[i] += NEAR * (np.abs(x[i]).max() or 1.0)
            return not np.allclose(model.dynamics_batch(times, moved, u, p), rates, rtol=EXACT, atol=0.0)

        first, second = found
        return (second, first) if matters(first) and not matters(second) else (first, second)
