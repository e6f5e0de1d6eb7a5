"""Newton's method for the multi-point problem of a structure, on meshes refined until the solution converges."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.collocation.gauss import STAGES, scheme
from satsym.solvers.constrained.active import control
from satsym.solvers.constrained.arcs import Arcs, gradient
from satsym.solvers.constrained.equations import System
from satsym.solvers.constrained.structure import Structure
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits

ACCURATE = 1e-12
"""Size of a Newton step, relative to the scales of the unknowns, at which the iteration has converged."""

SETTLED_SOLUTION = 1e-10
"""Relative change of times, cost and initial costates between two meshes at which refinement ends."""

ONCE, SEPARATION = 1e-4, 5e-3
"""Fraction of the duration below which two junctions of an initial guess coincide, and by which they are then
separated."""

ITERATIONS, HALVINGS = 25, 6
DENSITY, MESHES = 24, 4
"""Number of intervals over the whole duration at first, and maximum number of times that it is doubled."""


def begun(instance: Instance, structure: Structure, near: tuple[Array, Array, Array], end: float) -> Arcs:
    """Return initial unknowns of a structure from times (N,), values (2n, N) there, and terminal multipliers."""
    times, table, nu = near
    junctions = structure.junctions(instance)
    inner = _apart([one.time for one in junctions], end - instance.t0)
    edges = [instance.t0, *inner, end]
    intervals = tuple(max(4, int(np.ceil(DENSITY * abs(b - a) / (end - instance.t0)))) for a, b in pairwise(edges))
    parts: list[Array] = []
    for arc, ((a, b), k) in enumerate(zip(pairwise(edges), intervals, strict=True)):
        places = _places(k)
        if 0 < arc < len(junctions) and _at_once(junctions[arc - 1].time, junctions[arc].time, end - instance.t0):
            left = parts[-1].reshape(len(parts[-1]) // len(table), -1)[-1].copy()
            for which, zeta in junctions[arc - 1].jumps:
                t, x = np.array([a]), left[: len(left) // 2, None]
                left[len(left) // 2 :] -= zeta * gradient(instance, which, t, x)[:, 0]
            parts.append(np.tile(left, len(places)))
            continue
        inside = (times > min(a, b)) & (times < max(a, b))
        known = times[inside] if inside.sum() > 1 else times
        rows = table[:, inside] if inside.sum() > 1 else table
        parts.append(np.array([np.interp(a + (b - a) * places, known, row) for row in rows]).T.ravel())
    jumps = [guess for one in junctions for _, guess in one.jumps]
    arcs = Arcs(instance, structure, intervals, np.concatenate([*parts, inner, [end] if instance.tf is None else []]))
    return replace(arcs, unknown=np.concatenate([arcs.unknown, jumps, nu, np.zeros(len(arcs.pressed))]))


def solved(arcs: Arcs, limits: Limits) -> Arcs | None:
    """Return the extremal of a structure, on meshes doubled until times and cost converge, or ``None``."""
    found = converged(arcs, limits)
    for _ in range(MESHES):
        if found is None:
            return None
        finer = converged(_refined(found), limits)
        if finer is not None and _distance(found, finer) < SETTLED_SOLUTION:
            return finer
        found = finer
    return None


def from_arcs(arcs: Arcs, structure: Structure) -> Arcs:
    """Return initial unknowns of another structure from the extremal of a given one."""
    tables = [arcs.stages(k) for k in range(len(arcs.intervals))]
    times = np.concatenate([t.ravel() for t, _ in tables])
    rows = np.concatenate([z.reshape(-1, 2 * arcs.n) for _, z in tables]).T
    order = np.argsort(times, kind="stable")
    rest = arcs.rest
    nu = arcs.unknown[rest.nu : rest.nu + rest.constraints]
    found = begun(arcs.instance, structure, (times[order], rows[:, order], nu), arcs.end)
    return replace(found, passed=arcs.passed)


def _at_once(one: float, other: float, lasting: float) -> bool:
    """Return whether two junctions of an initial guess coincide."""
    return other - one < ONCE * lasting


def _apart(times: list[float], lasting: float) -> list[float]:
    """Return times in order, with coinciding ones separated, since an arc of no length does not determine its end."""
    groups: list[list[float]] = []
    for time in times:
        if groups and _at_once(groups[-1][-1], time, lasting):
            groups[-1].append(time)
        else:
            groups.append([time])
    return [
        time + SEPARATION * lasting * (place - (len(group) - 1) / 2)
        for group in groups
        for place, time in enumerate(group)
    ]


def cost(arcs: Arcs) -> float:
    """Return the cost: the running cost by Gauss quadrature plus the terminal cost."""
    one, n, total = arcs.instance, arcs.n, 0.0
    for arc, k in enumerate(arcs.intervals):
        t, z = arcs.stages(arc)[0].ravel(), arcs.stages(arc)[1].reshape(-1, 2 * n).T
        u = control(one, arcs.active[arc], t, z)
        running = np.broadcast_to(one.model.running_cost_batch(t, z[:n], u, one.parameters), t.shape)
        weights = np.tile(scheme(STAGES).weights, k) * (arcs.times[arc + 1] - arcs.times[arc]) / k
        total += float(running @ weights)
    end = tuple(arcs.node(len(arcs.intervals) - 1, -1)[:n].tolist())
    return total + float(one.model.terminal_cost(arcs.end, end, one.parameters))


def _cost_or_none(arcs: Arcs) -> float:
    """Return the cost during an iteration; NaN if it cannot be computed."""
    found = tried(lambda: cost(arcs))
    return float("nan") if found is None else found


def _places(intervals: int) -> Array:
    """Return the fractions of an arc at which values are stored."""
    own = np.concatenate([[0.0], scheme(STAGES).nodes])
    return np.append(((np.arange(intervals)[:, None] + own) / intervals).ravel(), 1.0)


def converged(arcs: Arcs, limits: Limits) -> Arcs | None:
    """Return the solution by Newton's method, with steps halved until simplified steps decrease; else ``None``."""
    from scipy.sparse.linalg import splu

    for _ in range(ITERATIONS):
        if limits.expired:
            return None
        limits.spend(sum(arcs.intervals) * STAGES)
        try:
            system = System(arcs)
            inverse = splu(system.jacobian)
        except (RuntimeError, ValueError, np.linalg.LinAlgError):  # LinAlgError: constraints that are not independent
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
        arcs = replace(there, passed=(*arcs.passed, (_cost_or_none(there), whole)))
        if length == 1.0 and again < ACCURATE:
            return arcs
    return None


def _sizes(arcs: Arcs) -> Array:
    """Return the scales of all unknowns."""
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
    """Return the arcs on twice as many intervals."""
    parts: list[Array] = []
    for k, count in enumerate(arcs.intervals):
        a, b = arcs.times[k : k + 2]
        parts.append(arcs.at(k, a + (b - a) * _places(2 * count)).T.ravel())
    rest = arcs.unknown[arcs.places[-1] :]
    return replace(arcs, intervals=tuple(2 * k for k in arcs.intervals), unknown=np.concatenate([*parts, rest]))


def _distance(one: Arcs, other: Arcs) -> float:
    """Return the largest relative change of times, cost and initial costates."""
    lasting = abs(other.end - other.instance.t0)
    changed = abs(cost(one) - cost(other)) / max(abs(cost(other)), 1e-300)
    first, again = (each.node(0, 0)[each.n :] for each in (one, other))
    begun = float(np.abs(first - again).max() / max(np.abs(again).max(), 1e-300))
    return max(float(np.abs(one.times - other.times).max()) / lasting, changed, begun)
