"""A regularised path: the program by a primal-dual interior-point method, its barrier weighed less and less.

Waechter and Biegler, Mathematical Programming 106, 2006, in short: slacks, steps to the boundary, a filter, and
curvature added where steps would not descend. Where no step is accepted slacks are opened anew, which lets go of the
multipliers that grew as these closed too early: on the way past an obstacle, say, from a path through its middle.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from satsym.arrays import Array
from satsym.solvers.constrained.regularised.slopes import Slopes
from satsym.solvers.constrained.regularised.stagewise import Factors
from satsym.solvers.constrained.regularised.transcription import Point, Program, Step
from satsym.solvers.constrained.regularised.units import Units
from satsym.solvers.iteration import Limits

TO_BOUNDARY = 0.995
"""Share of the way to where a slack or a multiplier would vanish."""

FIRST, LAST = 100.0, 1e-9
"""The first and the last weight of the barrier, relative to the size of costs of an interval. What is weighed less at
first comes too close to boundaries too early, and stays there."""

STEPS = 100
"""Linear systems at most."""

OPENED, NARROWER, REOPENED = 0.1, 0.5, 8
"""Least slack with which one begins, relative to the largest value of its constraint, the share of it that each later
opening has, and how many of these there are."""

CURVED, MOST_CURVED = 1e-4, 1e8
"""Curvature that is added first where the Lagrangian is not convex, and at most, relative to the sizes of what it is
added to."""

MORE, LESS = 8.0, 3.0
"""Factor by which it grows until the Lagrangian is convex, and by which it may be less at the next step."""


@dataclass(frozen=True, eq=False)
class Path:
    """What came of it."""

    at: Point
    cost: float
    solved: bool
    violation: float
    """Of all conditions, at most."""
    passed: tuple[tuple[float, float], ...]
    """Cost, and how far conditions are from holding, step by step."""


def regularised(program: Program, start: Point, worth: float, limits: Limits) -> Path:
    """Follow the barrier's path from a point to where it hardly weighs.

    Parameters
    ----------
    start
        Whose slacks are set here.
    worth
        The size of costs.
    """
    unit, units = max(abs(worth), 1e-12) / program.intervals, Units.of(program, start)
    g = program.constraints(start)
    room = np.abs(g).max(axis=1, keepdims=True)
    at = replace(start, s=np.maximum(-g, OPENED * np.where(room > 0.0, room, units.g)))
    weight, at = FIRST * unit, replace(at, z=FIRST * unit / at.s)
    filtered, curved, reopened = list[tuple[float, float]](), 0.0, 0
    passed: list[tuple[float, float]] = []
    for _ in range(STEPS):
        slopes = Slopes.of(program, at)
        error, violation = _error(program, at, slopes, weight, unit, units)
        while error < 10.0 * weight / unit and weight > LAST * unit:
            weight, filtered = max(LAST * unit, min(0.2 * weight, unit * (weight / unit) ** 1.5)), []
            error, violation = _error(program, at, slopes, weight, unit, units)
        passed.append((program.cost(at), error))
        if error < 10.0 * LAST and weight <= LAST * unit:
            return Path(at, program.cost(at), True, violation, tuple(passed))
        if limits.expired:
            break
        moved = _stepped(program, at, slopes, weight, filtered, curved, units)
        limits.spend(program.intervals)
        if moved is not None:
            at, curved = moved
        elif reopened < REOPENED:
            reopened += 1
            at, filtered = _reopened(program, at, weight, OPENED * NARROWER**reopened), []
        else:
            break
    return Path(at, program.cost(at), False, _violation(program, at, units), tuple(passed))


def _reopened(program: Program, at: Point, weight: float, share: float) -> Point:
    """The same path with slacks of at least this share of constraints' largest values, multipliers to match."""
    g = program.constraints(at)
    s = np.maximum(np.maximum(-g, at.s), share * np.abs(g).max(axis=1, keepdims=True))
    return replace(at, s=s, z=weight / s, y=0.0 * at.y)


def _error(
    program: Program, at: Point, slopes: Slopes, weight: float, unit: float, units: Units
) -> tuple[float, float]:
    """How far the conditions of the barrier's problem are from holding, relative, and the violation of constraints."""
    balance, own = (units.converted(one) for one in (slopes.pushed(at.z * program.kept), slopes.gradient))
    balances, owns = (
        max(np.abs(one.x).max(), np.abs(one.u).max(initial=0.0), abs(one.duration)) for one in (balance, own)
    )
    violation = _violation(program, at, units)
    complementary = float((np.abs(at.s * at.z - weight) * program.kept).max(initial=0.0)) / unit
    worth = max(unit * program.intervals, owns, np.abs(at.y * units.x[:, None]).max())
    return max(float(balances / worth), violation, complementary), violation


def _violation(program: Program, at: Point, units: Units) -> float:
    """Largest gap of the motion, the end and the slacks, relative to sizes of states and constraints."""
    slack = (program.constraints(at) + at.s) * program.kept
    gaps, ends = np.abs(program.gaps(at) / units.x[:, None]), np.abs(program.ends(at) / units.ends)
    return float(max(gaps.max(), ends.max(initial=0.0), np.abs(slack / units.g).max(initial=0.0)))


def _stepped(
    program: Program,
    at: Point,
    slopes: Slopes,
    weight: float,
    filtered: list[tuple[float, float]],
    last: float,
    units: Units,
) -> tuple[Point, float] | None:
    """The next point with the curvature that was added, given the last that was; ``None`` where none is accepted."""
    here, kept = _measures(program, at, weight, units), program.kept > 0.0
    for curved in _curvatures(last):
        direction = _direction(program, at, slopes, weight, curved, units)
        if direction is None:
            continue
        step, ds, dz = direction
        length, dual = _room(at.s[kept], ds[kept]), _room(at.z[kept], dz[kept])
        for _ in range(25):
            there = at.moved(step, length)
            there = replace(there, s=at.s + length * ds, z=np.maximum(at.z + dual * dz, 1e-300))
            found = _measures(program, there, weight, units)
            if there.duration > 0.0 and _accepted(found, [*filtered, here]):
                filtered.append((here[0] * (1.0 - 1e-5), here[1] - 1e-5 * here[0]))
                return _safe(there, weight), curved or last
            length /= 2.0
    return None


def _curvatures(last: float) -> Iterator[float]:
    """What is added to the curvature: nothing, then more and more (Waechter and Biegler, algorithm IC)."""
    yield 0.0
    curved = max(CURVED, last / LESS)
    while curved < MOST_CURVED:
        yield curved
        curved *= MORE


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


def _measures(program: Program, at: Point, weight: float, units: Units) -> tuple[float, float]:
    """Violation in all, and cost with the barrier."""
    with np.errstate(all="ignore"):
        slack = (program.constraints(at) + at.s) * program.kept / units.g
        gaps, ends = program.gaps(at) / units.x[:, None], program.ends(at) / units.ends
        whole = np.abs(gaps).sum() + np.abs(ends).sum() + np.abs(slack).sum()
        return float(whole), program.cost(at) - weight * float((np.log(at.s) * program.kept).sum())


def _room(values: Array, change: Array) -> float:
    """How much of a change keeps values positive, at most all of it."""
    falling = change < 0.0
    return min(1.0, TO_BOUNDARY * float((-values[falling] / change[falling]).min(initial=np.inf)))


def _direction(
    program: Program, at: Point, slopes: Slopes, weight: float, curved: float, units: Units
) -> tuple[Step, Array, Array] | None:
    """Newton's step, of the slacks and their multipliers too; ``None`` where it need not descend."""
    kept, s, z = program.kept, at.s, at.z
    off = (program.constraints(at) + s) * kept
    pushed = slopes.pushed((weight / s + z / s * off) * kept)
    stiff, own = units.scaled(*slopes.stiffened(z / s * kept))
    try:
        factors = Factors.of(stiff, own, curved)
        if not factors.convex:
            return None
        step = units.converted(factors.step(stiff, units.converted(pushed)))
    except np.linalg.LinAlgError:
        return None
    change = slopes.change(step)
    ds = np.where(kept > 0.0, -off - change, 0.0)
    dz = np.where(kept > 0.0, weight / s - z + z / s * (off + change), 0.0)
    return step, ds, dz
