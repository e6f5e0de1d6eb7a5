"""Whether the initial costates of an answer are the only ones that belong to it.

Others would differ by a solution of the adjoint equation that vanishes against everything that conditions of optimality
look at: against what each admissible change of a control does to the state, against the jump of its rate where a
control jumps, against the state's rate where the final time is free, and in the final states that are free. Costates
are unique if these directions, carried back to the initial time, span the space of states. Where ends are stated by
equations, or behind a boundary of a path constraint, costates have freedoms of their own. What comes after that is left
out, so that costates that are unique may not be counted as such, but never the other way round.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from satsym.control_set import ControlSet
    from satsym.solution import Solution

Array = NDArray[np.float64]

SPANNED = 1e-6
"""Share of the largest singular value of the directions, each of length one, from which they span one more."""

AT = 1e-6
"""Share of its size within which a control is at a bound."""

SEEN = 200
"""About as many nodes are looked at: those in between add no direction."""

ON_THE_WAY = ("entry", "exit", "touch", "interior")
"""Events at which costates may jump, or their equation is another."""


def unique(solution: Solution) -> bool:
    """Whether the initial costates are the only ones, as far as it shows in the directions above."""
    rows = np.abs(solution.x).max(axis=1)
    found = np.array(list(_directions(solution))).reshape(-1, len(rows)).T / np.where(rows > 0.0, rows, 1.0)[:, None]
    sizes = np.linalg.norm(found, axis=0)
    found = found[:, np.isfinite(sizes) & (sizes > 0.0)]
    if found.shape[1] < len(rows):
        return False
    values = np.linalg.svd(found / np.linalg.norm(found, axis=0), compute_uv=False)
    return bool(values[-1] > SPANNED * values[0])


def _directions(solution: Solution) -> Iterator[Array]:
    """Changes of the initial state to which the costates are known to be orthogonal, but for a known number."""
    case, t, x, u = solution.instance, solution.times, solution.x, solution.u
    model, p = case.model, case.parameters
    first = min((event.t for event in solution.events if event.kind in ON_THE_WAY), default=math.inf)
    back = _carried_back(solution)
    jumps = {k for k in range(len(t) - 1) if t[k] == t[k + 1]}
    with np.errstate(all="ignore"):
        for k in sorted({*range(0, len(t), max(1, len(t) // SEEN)), *jumps}):
            at = float(t[k]), x[:, k].tolist()
            if t[k] >= first:
                break
            if k in jumps:
                rates = [np.array(model.dynamics(*at, u[:, i].tolist(), p)) for i in (k, k + 1)]
                yield back[k] @ (rates[1] - rates[0])
                continue
            changes = list(_changes(case.control_set, u[:, k], model.spec.switching))
            if changes:  # where there is none a magnitude may vanish, which has no derivative
                effect = np.array(model.jacobian_u(*at, u[:, k].tolist(), p), dtype=float).reshape(len(x), -1)
                yield from ((back[k] @ effect) @ change for change in changes)
        if case.tf is None and "reference" not in case.final.values():
            yield from _rates(solution, back, first == math.inf)
    if first == math.inf and not model.spec.multipliers:
        free = [name not in case.final and name not in case.ranges for name in model.spec.state_names]
        yield from back[-1].T[free]


def _rates(solution: Solution, back: Array, whole: bool) -> Iterator[Array]:
    """The rate of the state where a free final time makes H known: at the end, or all the way where no time counts."""
    case = solution.instance
    spec, k = case.model.spec, 0 if case.model.spec.autonomous else -1
    if spec.autonomous or (whole and not spec.multipliers):
        at = float(solution.times[k]), solution.x[:, k].tolist(), solution.u[:, k].tolist()
        yield back[k] @ np.array(case.model.dynamics(*at, case.parameters))


def _carried_back(solution: Solution) -> Array:
    """From a change of the state at each node to that of the initial state which leads there, shape (N+1, n, n)."""
    from scipy.linalg import expm

    case, t, n = solution.instance, solution.times, len(solution.x)
    slopes = case.model.jacobian_x_batch(t, solution.x, solution.u, case.parameters)
    slopes = np.broadcast_to(np.asarray(slopes, dtype=float), (n, n, len(t))).transpose(2, 0, 1)
    found = [np.eye(n)]
    with np.errstate(all="ignore"):
        steps = expm(-np.diff(t)[:, None, None] * (slopes[:-1] + slopes[1:]) / 2.0)
        for step in steps:
            found.append(found[-1] @ step)
    return np.array(found)


def _changes(allowed: ControlSet, u: Array, switched: bool) -> Iterator[Array]:
    """Changes of a control that may be made either way, and to which H is stationary; ``switched`` if it may jump."""
    if allowed.kind == "product":
        for places, part in allowed.parts:
            for change in _changes(part, u[list(places)], switched or part.throttled):
                whole = np.zeros(len(u))
                whole[list(places)] = change
                yield whole
        return
    axes = np.eye(len(u))
    if allowed.kind == "box":
        yield from axes[_within(allowed, u, switched)]
    elif allowed.kind in ("ball", "annulus") or (allowed.kind == "angle" and len(u) > 1):
        norm = float(np.linalg.norm(u))
        least = AT * (allowed.radius if math.isfinite(allowed.radius) else 0.0)
        if norm <= least and (switched or allowed.directed or allowed.throttled):
            return
        full = norm >= allowed.radius - least or allowed.directed or (norm <= allowed.inner + least and norm > least)
        yield from _across(u / norm) if full and norm > 0.0 else axes
    else:
        yield from axes


def _within(allowed: ControlSet, u: Array, switched: bool) -> NDArray[np.bool_]:
    """Which controls of a box are at no bound; nor at zero, where their magnitudes may cost."""
    lower, upper = np.array(allowed.lower), np.array(allowed.upper)
    with np.errstate(all="ignore"):
        width = np.where(np.isfinite(upper - lower), upper - lower, np.abs(u))
    inside = (u > lower + AT * width) & (u < upper - AT * width)
    if switched:
        return np.asarray(inside & (np.abs(u) > AT * width))
    return np.asarray(inside | (~np.isfinite(lower + upper) & (u == 0.0)))


def _across(direction: Array) -> Array:
    """Unit vectors, row by row, at right angles to one."""
    return np.asarray(np.linalg.svd(direction[None, :])[2][1:])
