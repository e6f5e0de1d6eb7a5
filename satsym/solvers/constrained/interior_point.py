"""A regularised path: the program by a primal-dual interior-point method, its barrier weighed less and less.

Waechter and Biegler, Mathematical Programming 106, 2006, in short: slacks, steps to the boundary, a filter, and
curvature added where steps would not descend.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from satsym.arrays import Array
from satsym.solvers.constrained.slopes import Slopes, rooms
from satsym.solvers.constrained.transcription import Point, Program
from satsym.solvers.iteration import Limits

TO_BOUNDARY = 0.995
"""Share of the way to where a slack or a multiplier would vanish."""

LAST = 1e-9
"""The last weight of the barrier, relative to the first."""

STEPS = 60
"""Linear systems at most."""

CURVED = (0.0, 1e-6, 1e-4, 1e-2, 1.0, 1e2, 1e4)
"""Curvature that is added where a step would not descend, relative to the sizes of what it is added to."""


@dataclass(frozen=True, eq=False)
class Path:
    """What came of it."""

    at: Point
    cost: float
    solved: bool
    violation: float
    """Of all conditions, at most."""
    steps: int


def regularised(program: Program, start: Point, worth: float, limits: Limits) -> Path:
    """Follow the barrier's path from a point to where it hardly weighs.

    Parameters
    ----------
    start
        Whose slacks are set here.
    worth
        The size of costs.
    """
    g = program.constraints(start)
    room = np.abs(g).max(axis=1, keepdims=True)
    room = np.where(room > 0.0, room, rooms(program, start))
    at = replace(start, s=np.maximum(-g, 0.1 * room))
    first = max(abs(worth), 1e-12) / program.intervals
    weight, at = first, replace(at, z=first / at.s)
    filtered: list[tuple[float, float]] = []
    for step in range(STEPS):
        slopes = Slopes.of(program, at)
        error, violation = _error(program, at, slopes, weight, first)
        while error < 10.0 * weight / first and weight > LAST * first:
            weight, filtered = max(LAST * first, min(0.2 * weight, first * (weight / first) ** 1.5)), []
            error, violation = _error(program, at, slopes, weight, first)
        if error < 10.0 * LAST and weight <= LAST * first:
            return Path(at, program.cost(at), True, violation, step)
        if limits.expired:
            break
        moved = _stepped(program, at, slopes, weight, filtered)
        limits.spend(program.intervals)
        if moved is None:
            break
        at = moved
    return Path(at, program.cost(at), False, _violation(program, at), STEPS)


def _error(program: Program, at: Point, slopes: Slopes, weight: float, first: float) -> tuple[float, float]:
    """How far the conditions of the barrier's problem are from holding, relative, and the violation of constraints."""
    balance = slopes.gradient + slopes.inequalities.T @ (at.z * program.kept).ravel()
    size = max(1.0, float(np.abs(slopes.gradient).max()), float(np.abs(at.y).max()))
    violation = _violation(program, at)
    complementary = float((np.abs(at.s * at.z - weight) * program.kept).max(initial=0.0)) / first
    return max(float(np.abs(balance).max()) / size, violation, complementary), violation


def _violation(program: Program, at: Point) -> float:
    """Largest gap of the motion, the end and the slacks, relative to sizes of states and constraints."""
    size = np.abs(at.x).max(axis=1, keepdims=True) + 1e-300
    size = np.maximum(size, 1e-3 * size.max())
    slack = (program.constraints(at) + at.s) * program.kept
    parts = [np.abs(program.gaps(at) / size).max(), np.abs(program.ends(at)).max(initial=0.0) / size.max()]
    return float(max(*parts, np.abs(slack / rooms(program, at)).max(initial=0.0)))


def _stepped(
    program: Program, at: Point, slopes: Slopes, weight: float, filtered: list[tuple[float, float]]
) -> Point | None:
    """The next point; ``None`` where no step is accepted."""
    for curved in CURVED:
        direction = _direction(program, at, slopes, weight, curved)
        if direction is None:
            continue
        dw, dy, dv, ds, dz = direction
        kept = program.kept > 0.0
        primal, dual = _room(at.s[kept], ds[kept]), _room(at.z[kept], dz[kept])
        here = _measures(program, at, weight)
        length = primal
        for _ in range(25):
            there = at.moved(dw, dy, dv, length)
            there = replace(there, s=at.s + length * ds, z=np.maximum(at.z + dual * dz, 1e-300))
            found = _measures(program, there, weight)
            if there.duration > 0.0 and _accepted(found, [*filtered, here]):
                filtered.append((here[0] * (1.0 - 1e-5), here[1] - 1e-5 * here[0]))
                return _safe(there, weight)
            length /= 2.0
    return None


def _safe(at: Point, weight: float) -> Point:
    """With multipliers that are not far from what the slacks say."""
    low, high = weight / at.s * 1e-10, weight / at.s * 1e10
    return replace(at, z=np.clip(at.z, low, high))


def _accepted(found: tuple[float, float], others: list[tuple[float, float]]) -> bool:
    """Whether it is less violated or cheaper than each of them."""
    if not np.isfinite(found).all():
        return False
    tiny = 1e-13
    return all(
        v <= w * (1.0 - 1e-5) or v <= tiny or c <= d - 1e-5 * w for (v, c), (w, d) in ((found, o) for o in others)
    )


def _measures(program: Program, at: Point, weight: float) -> tuple[float, float]:
    """Violation in all, and cost with the barrier."""
    with np.errstate(all="ignore"):
        slack = (program.constraints(at) + at.s) * program.kept
        whole = np.abs(program.gaps(at)).sum() + np.abs(program.ends(at)).sum() + np.abs(slack).sum()
        return float(whole), program.cost(at) - weight * float((np.log(at.s) * program.kept).sum())


def _room(values: Array, change: Array) -> float:
    """How much of a change keeps values positive, at most all of it."""
    falling = change < 0.0
    return min(1.0, TO_BOUNDARY * float((-values[falling] / change[falling]).min(initial=np.inf)))


def _direction(
    program: Program, at: Point, slopes: Slopes, weight: float, curved: float
) -> tuple[Array, Array, Array, Array, Array] | None:
    """Newton's step; ``None`` where it would not descend, or the equations are singular."""
    from scipy.sparse import bmat, diags
    from scipy.sparse.linalg import splu

    kept, g_w = program.kept.ravel(), slopes.inequalities
    s, z = at.s.ravel(), at.z.ravel()
    off = (program.constraints(at).ravel() + s) * kept
    pull = (weight / s + z / s * off) * kept
    stiff = g_w.T @ diags(z / s * kept) @ g_w
    own = slopes.hessian + stiff
    size = np.maximum(np.abs(own.diagonal()), 1e-8 * np.abs(own.diagonal()).max())
    own = own + diags(curved * size)
    c = slopes.equalities
    matrix = bmat([[own, c.T], [c, None]], format="csc")
    rows = np.concatenate([program.gaps(at).T.ravel(), program.ends(at)])
    try:
        found = splu(matrix).solve(-np.concatenate([slopes.gradient + g_w.T @ pull, rows]))
    except RuntimeError:
        return None
    dw, dl = found[: len(size)], found[len(size) :]
    if not np.isfinite(found).all() or dw @ (own @ dw) < 1e-10 * (dw * size) @ dw:
        return None
    n, count = len(at.x), program.intervals
    change = g_w @ dw
    ds = np.where(kept > 0.0, -off - change, 0.0)
    dz = np.where(kept > 0.0, weight / s - z + z / s * (off + change), 0.0)
    dy = dl[: n * count].reshape(count, n).T
    return dw, dy, dl[n * count :], ds.reshape(at.s.shape), dz.reshape(at.z.shape)
