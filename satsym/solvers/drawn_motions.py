"""Motions that meet: extremals that are drawn from the initial state onwards, and from the end backwards in time.

Where one from the start comes close to one to the end, at the same time, the two are almost a motion from end to end,
and no control does either part for less: from these one starts where others fail. Where motions swing, only those
arrive that push at the right times, as costates do; and what is unstable onwards is stable backwards.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from satsym.arrays import Array
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.scaling import straight

STEPS = 200
"""Of each motion, by the classical Runge-Kutta method."""

DRAWN, SIZES = 512, (-1.5, 4.0)
"""Extremals that are drawn on each side, and decimal logarithms between which the sizes of their costates lie."""

ROUNDS, CHILDREN, PARENTS, NEAR = (0.3, 0.1), 256, 48, 0.15
"""Relative changes of costates by which further ones are drawn, how many each time, and about how many pairs: the
cheapest whose gaps are below that."""

TIMES, NEIGHBOURS = 16, 4
"""At which they may meet, and how many of the nearest of the other side are looked at."""

RANGE = (10.0, 90.0)
"""Percentiles between which states range: what is close is so relative to that."""

CLOSE, FEWEST, MOST = 0.05, 64, 2000
"""Gaps that are small, pairs that are looked at if none is, and at most."""

KEPT, APART, SHOWN = 4, 0.4, 21
"""Motions that are kept, how far they are from each other, and at how many times that is looked at."""


@dataclass(frozen=True, eq=False)
class Motion:
    """Two extremals that nearly meet."""

    control: Array
    """At the nodes, shape (m, STEPS + 1)."""
    states: Array
    """Scaled, at the same, shape (n, STEPS + 1); the gap is spread over both parts."""
    meeting: int
    """The node of the gap."""
    gap: float
    """Between them, relative to what states range over."""
    cost: float
    """Of both, scaled."""

    def path(self, tau: Array) -> Array:
        """Scaled states at times tau in [0, 1], shape (n, M)."""
        nodes = np.linspace(0.0, 1.0, self.states.shape[1])
        return np.array([np.interp(tau, nodes, row) for row in self.states])


@dataclass(frozen=True, eq=False)
class Bundle:
    """Extremals through one state, or one end."""

    z: Array
    """Scaled states and costates at the nodes in order of time, shape (STEPS + 1, 2n, S)."""
    costs: Array
    """Up to the nodes, or from there to the end, shape (STEPS + 1, S); infinite once the motion has left its domain."""

    def joined(self, other: Bundle) -> Bundle:
        """With others."""
        return Bundle(np.concatenate([self.z, other.z], axis=2), np.concatenate([self.costs, other.costs], axis=1))


def motions(problem: TwoPoint, rng: np.random.Generator, *, cheapest: bool = False) -> list[Motion]:
    """Different motions that nearly meet; none where nothing is asked of the end.

    Parameters
    ----------
    problem
        With its bounds, and a given duration.
    cheapest
        Whether the cheapest are kept, rather than those with the smallest gaps.
    """
    if problem.free_time or not (problem.fixed.any() or problem.unknowns):
        return []
    with np.errstate(all="ignore"):
        field = _drawn(problem, rng)
        pairs = field.cheapest(CLOSE, FEWEST) if cheapest else field.pairs
        return field.different(pairs)


def _drawn(problem: TwoPoint, rng: np.random.Generator) -> _Field:
    """Extremals of any direction, then others about those that nearly meet."""
    onwards = from_start(problem, _costates(problem, rng))
    if problem.unknowns:
        return _Field(problem, onwards, onwards)
    found = _Field(problem, onwards, to_end(problem, onwards, _costates(problem, rng), rng))
    for size in ROUNDS:
        parents = found.cheapest(NEAR, PARENTS)[:PARENTS]
        if not len(parents):
            break
        found = found.beside(parents, size, rng)
    return found


def _costates(problem: TwoPoint, rng: np.random.Generator) -> Array:
    """Of any direction, and of sizes of many orders."""
    found = rng.standard_normal((problem.states, DRAWN))
    return np.asarray(found / np.linalg.norm(found, axis=0) * 10.0 ** rng.uniform(*SIZES, DRAWN))


def from_start(problem: TwoPoint, costates: Array, steps: int = STEPS) -> Bundle:
    """Extremals from the initial state with these costates, shape (n, S), for the whole duration."""
    start = np.repeat(problem.initial[:, None], costates.shape[1], axis=1)
    return simulated(problem, np.concatenate([start, costates]), problem.duration, steps)


def to_end(problem: TwoPoint, onwards: Bundle, costates: Array, rng: np.random.Generator, steps: int = STEPS) -> Bundle:
    """To the end; where a final state is free it is that of a motion from the start, and transversality holds."""
    n, free, reached = problem.states, ~problem.fixed, np.flatnonzero(np.isfinite(onwards.costs[-1]))
    count = costates.shape[1]
    end, terminal = np.repeat(straight(problem)[:, 1:], count, axis=1), np.zeros(count)
    if free.any() and len(reached):
        end[free] = onwards.z[-1][:n, rng.choice(reached, count)][free]
        for k, z in enumerate(np.concatenate([end, costates]).T):
            costates[free, k] -= problem.boundary(z, problem.theta)[:n][free]
            terminal[k] = problem.terminal_cost(z, problem.theta)
    found = simulated(problem, np.concatenate([end, costates]), -problem.duration, steps)
    return Bundle(found.z, found.costs + terminal)


def simulated(problem: TwoPoint, z: Array, lasting: float, steps: int) -> Bundle:
    """Extremals through states and costates, shape (2n, S), for so long; back from the end where that is negative."""
    backwards, theta = lasting < 0.0, problem.theta
    tau = lasting / problem.duration * np.linspace(0.0, 1.0, 2 * steps + 1) + backwards
    times, h = np.repeat(tau[:, None], z.shape[1], axis=1), lasting / steps
    found = [z]
    for first, middle, last in zip(times[:-2:2], times[1::2], times[2::2], strict=True):
        f1 = problem.rates(first, z, theta)
        f2 = problem.rates(middle, z + h / 2.0 * f1, theta)
        f3 = problem.rates(middle, z + h / 2.0 * f2, theta)
        z = z + h / 6.0 * (f1 + 2.0 * (f2 + f3) + problem.rates(last, z + h * f3, theta))
        found.append(z)
    nodes = np.array(found)
    flat = nodes.transpose(1, 0, 2).reshape(len(z), -1)
    running = problem.running_cost(times[::2].ravel(), flat, theta).reshape(len(nodes), -1)
    costs = np.zeros_like(running)
    costs[1:] = abs(h) * np.cumsum((running[1:] + running[:-1]) / 2.0, axis=0)
    inside = np.isfinite(nodes).all(axis=1) & (nodes[:, list(problem.positive)] > 0.0).all(axis=1)
    costs[~np.logical_and.accumulate(inside & np.isfinite(costs), axis=0)] = np.inf
    return Bundle(nodes[::-1], costs[::-1]) if backwards else Bundle(nodes, costs)


@dataclass(frozen=True, eq=False)
class _Field:
    """Extremals of both sides. A pair of them is a row: node, one from the start, one to the end, gap and cost."""

    problem: TwoPoint
    onwards: Bundle
    backwards: Bundle

    def beside(self, pairs: Array, size: float, rng: np.random.Generator) -> _Field:
        """With others about these pairs, so far away relative to their costates."""
        problem, n = self.problem, self.problem.states
        of = pairs[rng.integers(len(pairs), size=CHILDREN)].astype(int)
        first, last = self.onwards.z[0][n:, of[:, 1]], self.backwards.z[-1][n:, of[:, 2]]
        changed = [
            one + size * np.linalg.norm(one, axis=0) * rng.standard_normal(one.shape) / np.sqrt(n)
            for one in (first, last)
        ]
        onwards = from_start(problem, changed[0])
        backwards = to_end(problem, onwards, changed[1], rng)
        return _Field(problem, self.onwards.joined(onwards), self.backwards.joined(backwards))

    @cached_property
    def unit(self) -> Array:
        """What the states range over on the side where that is less, shape (n, 1)."""
        n, ranges = self.problem.states, []
        for side in (self.onwards, self.backwards):
            seen = [side.z[node][:n, np.isfinite(side.costs[node])] for node in self.nodes]
            low, high = np.percentile(np.concatenate(seen, axis=1), RANGE, axis=1)
            ranges.append(np.where(high > low, high - low, np.inf))
        least = np.min(ranges, axis=0)
        return np.asarray(np.where(np.isfinite(least), least, 1.0)[:, None])

    @property
    def nodes(self) -> list[int]:
        """Where motions may meet, or arrive."""
        return [int(node) for node in np.linspace(0, STEPS, TIMES + 1)[1:]]

    @cached_property
    def pairs(self) -> Array:
        """Those with the smallest gaps first, shape (P, 5)."""
        found = self._arrivals if self.problem.unknowns else self._meetings
        return np.asarray(found[np.argsort(found[:, 3])])

    def cheapest(self, gap: float, fewest: int) -> Array:
        """Those with gaps below that, or the closest so many, the cheapest first."""
        found = self.pairs[: max(fewest, int(np.searchsorted(self.pairs[:, 3], gap)))]
        return np.asarray(found[np.argsort(found[:, 4])])

    @property
    def _meetings(self) -> Array:
        """Pairs that are close at a node."""
        from scipy.spatial import cKDTree

        n, found = self.problem.states, [np.zeros((0, 5))]
        for node in self.nodes:
            here, there = self.onwards.costs[node], self.backwards.costs[node]
            first, second = np.flatnonzero(np.isfinite(here)), np.flatnonzero(np.isfinite(there))
            near = min(NEIGHBOURS, len(second))
            if not (len(first) and near):
                continue
            tree = cKDTree((self.backwards.z[node][:n, second] / self.unit).T)
            gaps, places = tree.query((self.onwards.z[node][:n, first] / self.unit).T, k=np.arange(1, near + 1))
            met = np.isfinite(gaps)  # else so far apart that their distance overflows
            one, other = np.broadcast_to(first[:, None], met.shape)[met], second[places[met]]
            found.append(np.column_stack([np.full(len(one), node), one, other, gaps[met], here[one] + there[other]]))
        return np.concatenate(found)

    @property
    def _arrivals(self) -> Array:
        """Motions from the start with themselves, by how much they miss what ties the end."""
        problem, found = self.problem, [np.zeros((0, 5))]
        n, costs = problem.states, self.onwards.costs[-1]
        for k in np.flatnonzero(np.isfinite(costs)).tolist():
            z = self.onwards.z[-1][:, k]
            residual = problem.boundary(z, problem.theta)
            missed = np.abs(np.append(residual[:n][problem.fixed], residual[n:])).max()
            found.append(np.array([[STEPS, k, k, missed, costs[k] + problem.terminal_cost(z, problem.theta)]]))
        pairs = np.concatenate(found)
        return np.asarray(pairs[np.isfinite(pairs).all(axis=1)])

    def different(self, pairs: Array) -> list[Motion]:
        """The first pairs that are not close to one before."""
        kept: list[Motion] = []
        for row in pairs[:MOST]:
            motion = self._joined(*row[:3].astype(int).tolist(), gap=float(row[3]), cost=float(row[4]))
            apart = (np.abs(motion.states - other.states) / self.unit for other in kept)
            if all(one[:, :: STEPS // (SHOWN - 1)].max() >= APART for one in apart):
                kept.append(motion)
            if len(kept) == KEPT:
                break
        return kept

    def _joined(self, node: int, one: int, other: int, *, gap: float, cost: float) -> Motion:
        problem, n, tau = self.problem, self.problem.states, np.linspace(0.0, 1.0, STEPS + 1)
        before, after = self.onwards.z[: node + 1, :, one], self.backwards.z[node:, :, other]
        jump = (after[0] - before[-1])[:n, None]
        z = np.concatenate([before, after[1:]]).T
        ahead = tau <= tau[node]
        halves = np.where(ahead, tau / tau[node], (tau - 1.0) / max(1.0 - tau[node], tau[1])) / 2.0
        states = z[:n] + jump * (halves if node < STEPS else tau)
        return Motion(problem.control(tau, z, problem.theta), states, node, gap, cost)
