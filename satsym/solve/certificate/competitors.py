"""Competitors: feasible controls that might be cheaper. The certificate names each kind it has tried.

Each gives a margin: how much dearer the cheapest competitor is, relative to the cost; negative where one is cheaper.
"""

from __future__ import annotations

import random
import time
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.grid import Grid, interleave
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solve import control_set
from satsym.solve.certificate.conditions import final_argument
from satsym.solve.iteration import Limits

Array = NDArray[np.floating[Any]]

STEPS = 200
"""RK4 steps with which neighbours are compared, on the same grid as the solution itself."""

NEIGHBOURS, WAVES = 8, 6
AMPLITUDE = 0.05
"""Of a neighbour's departure from the control, relative to the largest control."""

CORRECTIONS = 12
MISSED = 1e-9
"""Relative miss of the end up to which a neighbour counts as feasible."""

EARLIER = (0.6, 0.8, 0.95)
"""Shares of the duration after which a competitor has arrived, and coasts."""

SECONDS = 10.0


def neighbours(solution: Solution) -> float:
    """Feasible neighbours: random smooth changes of the control, corrected until the end is met again."""
    instance = solution.instance
    grid = Grid.uniform(float(solution.times[0]), float(solution.times[-1]), STEPS)
    times = interleave(grid.nodes, grid.midpoints)
    u = np.array([np.interp(times, solution.times, row) for row in solution.u])
    size = float(np.abs(u).max())
    if size == 0.0:
        size = 1.0
    shapes = list(_shapes(instance, times, u))
    fixed = np.flatnonzero(np.array(final_argument(solution)[: len(instance.initial)]) + _following(solution) > 0.0)
    scale = np.maximum(np.abs(solution.x).max(axis=1), 1e-300)[fixed]

    def flown(control: Array) -> tuple[float, Array]:
        x, _, running = instance.model.forward(
            grid.nodes, instance.initial, control[:, ::2], control[:, 1::2], instance.parameters
        )
        terminal = instance.model.terminal_cost(grid.tf, tuple(x[:, -1].tolist()), instance.parameters)
        return running + terminal, x[fixed, -1] / scale

    cost, end = flown(u)
    nudge = 1e-4 * size
    response = np.stack([(flown(u + nudge * shape)[1] - end) / nudge for shape in shapes], axis=1)
    rng = random.Random("neighbours")
    cheapest = float("inf")
    for _ in range(NEIGHBOURS):
        slopes = response
        tried: Array = np.zeros(0)
        weights = np.array([rng.gauss(0.0, 1.0) for _ in shapes])
        weights *= AMPLITUDE * size / max(1.0, float(np.linalg.norm(weights)))
        found, miss = float("inf"), float("inf")
        for _ in range(CORRECTIONS):
            change = sum((w * s for w, s in zip(weights, shapes, strict=True)), np.zeros_like(u))
            found, reached = flown(control_set.project(instance, u + change))
            gap = reached - end
            miss = float(np.abs(gap).max(initial=0.0))
            if miss <= MISSED or not np.isfinite(miss):
                break
            if len(tried):  # Broyden: the response as the last correction found it
                slopes = slopes + np.outer(gap, tried) / float(tried @ tried)
            tried = -np.linalg.lstsq(slopes, gap, rcond=None)[0]
            weights = weights + tried
        if miss <= MISSED:
            cheapest = min(cheapest, found)
    return _margin(cheapest, cost)


def other_starts(solution: Solution) -> float:
    """The minimum to which a path of easier problems leads, where that is another way than the solution came."""
    from satsym.solve.collocation.cold_start import along_problems
    from satsym.solve.collocation.scaling import two_point

    instance = solution.instance
    if instance.tf is None or _bounded(instance):
        return float("inf")
    problem = two_point(instance, instance.tf - instance.t0).widened(float("inf"))
    with np.errstate(all="ignore"):
        found = along_problems(problem, Limits(200, time.perf_counter() + SECONDS))
    if found is None or not found.minimum:
        return float("inf")
    return _margin(found.cost * problem.scale.cost, solution.objective, coarse=1e-6)


def earlier_arrivals(solution: Solution) -> float:
    """Arriving earlier on the reference, and coasting on it: possible where the whole end is on it."""
    from satsym.solve.collocation.cold_start import cold_start
    from satsym.solve.collocation.scaling import two_point

    instance = solution.instance
    if instance.tf is None or not _on_reference(solution) or _bounded(instance):
        return float("inf")
    cheapest = float("inf")
    for share in EARLIER:
        tf = instance.t0 + share * (instance.tf - instance.t0)
        sooner = replace(instance, tf=tf, final=dict.fromkeys(instance.model.spec.state_names, "reference"))
        problem = two_point(sooner, tf - instance.t0)
        with np.errstate(all="ignore"):
            start = cold_start(problem, Limits(100, time.perf_counter() + SECONDS))
        if start.way != "none":
            cheapest = min(cheapest, start.found.cost * problem.scale.cost)
    return _margin(cheapest, solution.objective, coarse=1e-6)


def _shapes(instance: Instance, times: Array, u: Array) -> Iterator[Array]:
    """Smooth changes of one control each, which vanish where a bound holds it."""
    share = (times - times[0]) / (times[-1] - times[0])
    room = _room(instance, u)
    for i in range(len(u)):
        for wave in range(WAVES):
            shape = np.zeros_like(u)
            shape[i] = np.cos(np.pi * wave * share) * room[i]
            yield shape


def _room(instance: Instance, u: Array) -> Array:
    """One where a control is far from its bounds, zero on them, shape (m, M)."""
    size = max(float(np.abs(u).max()), 1e-300)
    distance = control_set.excess(instance, u)
    kind = instance.model.spec.control_set
    if kind == "box":
        m = len(u)
        distance = np.minimum(np.abs(distance[:m]), np.abs(distance[m:]))
    elif kind == "ball":
        distance = np.broadcast_to(np.abs(distance), u.shape)
    else:
        return np.ones_like(u)
    return np.clip(distance / (2.0 * AMPLITUDE * size), 0.0, 1.0)


def _following(solution: Solution) -> Array:
    n = len(solution.instance.initial)
    return np.array(final_argument(solution)[n : 2 * n])


def _on_reference(solution: Solution) -> bool:
    """Whether the whole final state is the reference's, and coasting on it is admissible."""
    instance, spec = solution.instance, solution.instance.model.spec
    if not spec.has_reference or instance.final.keys() != set(spec.state_names):
        return False
    curve = np.array(instance.model.reference(float(solution.times[-1]), instance.parameters))
    none = np.zeros((len(spec.controls), 1))
    there = np.allclose(solution.x[:, -1], curve, rtol=1e-9, atol=1e-12)
    return bool(there and (control_set.project(instance, none) == none).all())


def _bounded(instance: Instance) -> bool:
    return bool(np.isfinite(instance.bounds).any())


def _margin(competitor: float, cost: float, coarse: float = 0.0) -> float:
    """How much dearer a competitor is, relative to the cost; differences below ``coarse`` are its own error."""
    if not np.isfinite(competitor):
        return float("inf")
    margin = (competitor - cost) / max(abs(cost), 1e-300)
    return 0.0 if abs(margin) < coarse else margin
