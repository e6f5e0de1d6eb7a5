"""Newton's method on the multi-point problem of a structure, and meshes on which its answer no longer changes."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.collocation.gauss import STAGES, scheme
from satsym.solvers.constrained.arcs import Arcs
from satsym.solvers.constrained.equations import System
from satsym.solvers.constrained.structure import Structure
from satsym.solvers.constrained.transcription import Point, Program
from satsym.solvers.iteration import Limits

ACCURATE = 1e-12
"""Size of Newton's step at which it ends, relative to the sizes of what is unknown."""

SETTLED = 1e-10
"""Change of times, cost and initial costates from one mesh to the next that is none."""

ITERATIONS, HALVINGS = 25, 6
DENSITY, MESHES = 24, 4
"""Intervals over the whole duration at first, and how often they are doubled."""


def begun(instance: Instance, structure: Structure, near: tuple[Array, Array, Array], end: float) -> Arcs:
    """The unknowns of a structure from a path: times (N,), values (2n, N) at these, and multipliers at the end."""
    times, table, nu = near
    inner = [one.time for one in structure.junctions(instance)]
    edges = [instance.t0, *inner, end]
    intervals = tuple(max(4, int(np.ceil(DENSITY * abs(b - a) / (end - instance.t0)))) for a, b in _pairs(edges))
    parts = []
    for (a, b), k in zip(_pairs(edges), intervals, strict=True):
        places = _places(k)
        inside = (times > min(a, b)) & (times < max(a, b))
        known = times[inside] if inside.sum() > 1 else times
        rows = table[:, inside] if inside.sum() > 1 else table
        parts.append(np.array([np.interp(a + (b - a) * places, known, row) for row in rows]).T.ravel())
    jumps = [one.jump for one in structure.junctions(instance) if one.jump is not None]
    arcs = Arcs(instance, structure, intervals, np.concatenate([*parts, inner, [end] if instance.tf is None else []]))
    pushed = [0.0] if arcs.pressed else []
    return replace(arcs, unknown=np.concatenate([arcs.unknown, jumps, nu, pushed]))


def solved(arcs: Arcs, limits: Limits) -> Arcs | None:
    """The extremal of a structure, on meshes that are doubled until times and cost settle; ``None`` without one."""
    found = _converged(arcs, limits)
    for _ in range(MESHES):
        if found is None:
            return None
        finer = _converged(_refined(found), limits)
        if finer is not None and _distance(found, finer) < SETTLED:
            return finer
        found = finer
    return None


def from_path(program: Program, at: Point, structure: Structure) -> Arcs:
    """The unknowns of a structure from a regularised path."""
    one, lasting = program.instance, at.duration
    middles = np.real(program.times(lasting, middle=True))
    table = np.concatenate([(at.x[:, :-1] + at.x[:, 1:]) / 2, at.y])
    c = len(one.model.spec.multipliers)
    return begun(one, structure, (middles, table, at.v[len(at.v) - c :]), one.t0 + lasting)


def from_arcs(arcs: Arcs, structure: Structure) -> Arcs:
    """The unknowns of another structure from the extremal of one."""
    tables = [arcs.stages(k) for k in range(len(arcs.intervals))]
    times = np.concatenate([t.ravel() for t, _ in tables])
    rows = np.concatenate([z.reshape(-1, 2 * arcs.n) for _, z in tables]).T
    order = np.argsort(times, kind="stable")
    rest = arcs.rest
    nu = arcs.unknown[rest.nu : rest.nu + rest.constraints]
    return begun(arcs.instance, structure, (times[order], rows[:, order], nu), arcs.end)


def _pairs(edges: list[float]) -> list[tuple[float, float]]:
    return list(pairwise(edges))


def _places(intervals: int) -> Array:
    """Shares of an arc at which there are values."""
    own = np.concatenate([[0.0], scheme(STAGES).nodes])
    return np.append(((np.arange(intervals)[:, None] + own) / intervals).ravel(), 1.0)


def _converged(arcs: Arcs, limits: Limits) -> Arcs | None:
    """Newton's method, its steps halved until the next simplified one is shorter."""
    from scipy.sparse.linalg import splu

    for _ in range(ITERATIONS):
        if limits.expired:
            return None
        system = System(arcs)
        limits.spend(sum(arcs.intervals) * STAGES)
        try:
            inverse = splu(system.jacobian)
        except (RuntimeError, ValueError):
            return None
        size = _sizes(arcs)
        step = inverse.solve(system.residual)
        if not np.isfinite(step).all():
            return None
        whole = float(np.abs(step / size).max())
        length = 1.0
        for _ in range(HALVINGS):
            there = replace(arcs, unknown=arcs.unknown - length * step)
            again = float(np.abs(inverse.solve(System(there, sloped=False).residual) / size).max())
            if again <= (1.0 - length / 4.0) * whole or (length == 1.0 and again < ACCURATE):
                break
            length /= 2.0
        else:
            return arcs if whole < np.sqrt(ACCURATE) * 1e-3 else None
        arcs = there
        if length == 1.0 and again < ACCURATE:
            return arcs
    return None


def _sizes(arcs: Arcs) -> Array:
    """What each unknown is measured by."""
    n, lasting = arcs.n, arcs.end - arcs.instance.t0
    rows = np.concatenate([arcs.nodes(k) for k in range(len(arcs.intervals))])
    size = np.abs(rows).max(axis=0)
    for half in (slice(0, n), slice(n, 2 * n)):
        size[half] = np.maximum(size[half], 1e-3 * max(float(size[half].max()), 1e-300))
    rest = np.full(arcs.rest.size - arcs.places[-1], max(float(size[n:].max()), 1e-300))
    rest[: len(arcs.junctions) + (arcs.rest.end is not None)] = lasting
    others = np.maximum(np.abs(arcs.unknown[arcs.places[-1] :]), rest)
    return np.concatenate([np.tile(size, len(rows)), others])


def _refined(arcs: Arcs) -> Arcs:
    """On twice as many intervals."""
    parts = []
    for k, count in enumerate(arcs.intervals):
        a, b = arcs.times[k : k + 2]
        parts.append(arcs.at(k, a + (b - a) * _places(2 * count)).T.ravel())
    rest = arcs.unknown[arcs.places[-1] :]
    return Arcs(arcs.instance, arcs.structure, tuple(2 * k for k in arcs.intervals), np.concatenate([*parts, rest]))


def _distance(one: Arcs, other: Arcs) -> float:
    """Largest change of times, of the cost and of the initial costates, each relative to its size."""
    lasting = abs(other.end - other.instance.t0)
    cost = abs(one.cost() - other.cost()) / max(abs(other.cost()), 1e-300)
    first, again = (each.node(0, 0)[each.n :] for each in (one, other))
    begun = float(np.abs(first - again).max() / max(np.abs(again).max(), 1e-300))
    return max(float(np.abs(one.times - other.times).max()) / lasting, cost, begun)
