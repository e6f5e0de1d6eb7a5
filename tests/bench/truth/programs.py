"""Least fuel and least time of linear motions by linear programs; controls are constant between nodes.

The discretisation is exact, so that what a program finds arrives. The nodes are drawn together where the control
changes until its cost settles.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import linprog

from tests.bench.truth.answer import Answer, Truth
from tests.bench.truth.case import Case
from tests.bench.truth.linear import Linear, linear

STEPS, SPLIT, ROUNDS = 160, 6, 5
ARRIVES = 1e-9
SCAN, HALVINGS, LONGEST = 70, 34, 60.0


def least_fuel(case: Case) -> Answer:
    """The least integral of |u| (one control) in a given time."""
    assert case.tf is not None
    motion, duration = linear(case), case.tf - case.t0
    nodes = np.linspace(0.0, duration, STEPS + 1)
    costs: list[float] = []
    for _ in range(ROUNDS):
        u = _cheapest(motion, nodes)
        if u is None:
            if _missed(motion, nodes)[0] > 1e-6:
                return _apart(motion, duration)
            break
        costs.append(float(np.abs(u) @ np.diff(nodes)))
        nodes = _refined(nodes, u, motion)
    if not costs:
        return Answer(Truth.UNKNOWN, None, "feasible by a hair or not at all", duration)
    how = (
        f"linear programs on {len(nodes) - 1} steps, the last refinement gained {costs[-2] - costs[-1]:.0e}"
        if len(costs) > 1
        else "one linear program"
    )
    return Answer(Truth.REACHED, costs[-1], how, duration)


def minimum_time(case: Case) -> Answer:
    """The first time at which controls arrive: looked for on a grid, and then by halving."""
    motion = linear(case)
    before = 0.0
    for duration in np.geomspace(0.05, LONGEST, SCAN):
        missed, _ = _missed(motion, np.linspace(0.0, duration, STEPS + 1))
        if missed < ARRIVES:
            break
        before = float(duration)
    else:
        return Answer(Truth.UNKNOWN, None, f"no control arrives within {LONGEST:g}", None)
    after, nodes = float(duration), np.linspace(0.0, 1.0, STEPS + 1)
    for begin in (before, None):
        after = _halved(motion, nodes, after * (1.0 - 1e-3) if begin is None else begin, after)
        for _ in range(2):
            nodes = _refined(nodes, _missed(motion, nodes * after)[1], motion)
    again = _halved(motion, nodes, after * (1.0 - 1e-3), after)
    how = f"linear programs on {len(nodes) - 1} steps, the last refinement gained {after - again:.0e}"
    return Answer(Truth.REACHED, again, how, again)


def _halved(motion: Linear, nodes: np.ndarray, before: float, after: float) -> float:
    for _ in range(HALVINGS):
        middle = (before + after) / 2.0
        if _missed(motion, nodes * middle)[0] < ARRIVES:
            after = middle
        else:
            before = middle
        if after - before < 1e-10 * after:
            break
    return after


def _cheapest(motion: Linear, nodes: np.ndarray) -> np.ndarray | None:
    effects = motion.steps(nodes)[:, :, 0]
    width, low, high = np.diff(nodes), float(motion.low[0]), float(motion.high[0])
    size = np.abs(effects).sum(axis=1)
    count = len(width)
    found = linprog(
        np.concatenate([width, width]),
        A_eq=np.hstack([effects, -effects]) / size[:, None],
        b_eq=motion.gap(nodes[-1]) / size,
        bounds=[(max(low, 0.0), max(high, 0.0))] * count + [(max(-high, 0.0), max(-low, 0.0))] * count,
        method="highs-ds",
        options={"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10},
    )
    return found.x[:count] - found.x[count:] if found.status == 0 else None


def _missed(motion: Linear, nodes: np.ndarray) -> tuple[float, np.ndarray]:
    """The least largest miss, relative to what full thrust does; and the control."""
    effects = motion.steps(nodes)[:, :, 0]
    low, high = float(motion.low[0]), float(motion.high[0])
    size = np.abs(effects).sum(axis=1) * max(abs(low), abs(high))
    rows = effects / size[:, None]
    gap, one = motion.gap(nodes[-1]) / size, -np.ones((len(size), 1))
    found = linprog(
        np.append(np.zeros(rows.shape[1]), 1.0),
        A_ub=np.vstack([np.hstack([rows, one]), np.hstack([-rows, one])]),
        b_ub=np.concatenate([gap, -gap]),
        bounds=[(low, high)] * rows.shape[1] + [(0.0, None)],
        method="highs-ds",
        options={"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10},
    )
    return (float(found.fun), found.x[:-1]) if found.status == 0 else (np.inf, np.zeros(rows.shape[1]))


def _refined(nodes: np.ndarray, u: np.ndarray, motion: Linear) -> np.ndarray:
    """Split the steps on which the control is at no bound and not zero, and their neighbours."""
    levels = np.array([float(motion.low[0]), 0.0, float(motion.high[0])])
    between = np.abs(u[:, None] - levels).min(axis=1) > 1e-7
    jumps = np.flatnonzero(np.abs(np.diff(u)) > 1e-7)
    marked = between.copy()
    marked[jumps], marked[jumps + 1] = True, True
    if marked.sum() > 40:
        return nodes
    pieces = [
        np.linspace(a, b, SPLIT + 1)[:-1] if m else np.array([a])
        for a, b, m in zip(nodes, nodes[1:], marked, strict=False)
    ]
    return np.append(np.concatenate(pieces), nodes[-1])


def _apart(motion: Linear, duration: float) -> Answer:
    """A proof that no control at all arrives: a direction in which the end lies beyond what full thrust does."""
    effects, _ = motion.effect(duration, 4000)
    h, d = duration / 4000, motion.gap(duration)
    rows = effects[:, :, 0].T
    size = np.abs(rows).sum(axis=1) * h
    low, high = float(motion.low[0]), float(motion.high[0])
    best = -np.inf
    for nu in _directions(len(d)):
        s = (nu / size) @ rows
        best = max(best, float((nu / size) @ d) - h * float(np.where(s > 0.0, s * high, s * low).sum()))
    nu, surplus = _steepest(rows, size, d, h, (low, high))
    if max(best, surplus) > 1e-7:
        return Answer(Truth.INFEASIBLE, None, f"a direction separates the end by {max(best, surplus):.1e}", duration)
    return Answer(Truth.UNKNOWN, None, "feasible by a hair or not at all", duration)


def _directions(n: int) -> np.ndarray:
    drawn = np.random.default_rng(0).normal(size=(400, n))
    return np.asarray(drawn / np.linalg.norm(drawn, axis=1)[:, None])


def _steepest(
    rows: np.ndarray, size: np.ndarray, d: np.ndarray, h: float, bounds: tuple[float, float]
) -> tuple[np.ndarray, float]:
    """The direction of greatest surplus, by a linear program with the surplus of each step as a variable."""
    n, count = rows.shape
    low, high = bounds
    scaled = (rows / size[:, None]).T[:: max(1, count // 400)]
    factor = h * count / len(scaled)
    # maximise nu'd - sum of r_k, r_k >= s_k high, r_k >= s_k low, |nu| <= 1
    found = linprog(
        np.concatenate([-d / size, np.full(len(scaled), factor)]),
        A_ub=np.vstack(
            [np.hstack([scaled * high, -np.eye(len(scaled))]), np.hstack([scaled * low, -np.eye(len(scaled))])]
        ),
        b_ub=np.zeros(2 * len(scaled)),
        bounds=[(-1.0, 1.0)] * n + [(None, None)] * len(scaled),
        method="highs-ds",
    )
    nu = found.x[:n] if found.status == 0 else np.zeros(n)
    s = (nu / size) @ rows
    return nu, float((nu / size) @ d) - h * float(np.where(s > 0.0, s * high, s * low).sum())
