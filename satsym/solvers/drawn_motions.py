"""Bundles of extremals that are drawn from the initial state onwards, and from the end backwards in time.

Where one from the start comes close to one to the end, the two are almost a motion from end to end, and no control does
either part for less. Where motions swing, only those arrive that push at the right times, as costates do; and what is
unstable onwards is stable backwards.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.scaling import straight


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


def from_start(problem: TwoPoint, costates: Array, steps: int) -> Bundle:
    """Extremals from the initial state with these costates, shape (n, S), for the whole duration."""
    start = np.repeat(problem.initial[:, None], costates.shape[1], axis=1)
    return simulated(problem, np.concatenate([start, costates]), problem.duration, steps)


def to_end(problem: TwoPoint, onwards: Bundle, costates: Array, rng: np.random.Generator, steps: int) -> Bundle:
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
