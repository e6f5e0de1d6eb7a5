"""Jumps of the control along a solution, found again from the control law, and their positions between nodes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from satsym.arrays import Array
from satsym.solution import Solution
from satsym.solvers.control.jumps import Jump, Saltation, jumps, saltation

LEFT = 1e-6
"""Smallest change of the control, relative to its largest magnitude, that counts as a jump."""

CLOSE_NODES = 1e-8
"""Largest distance, relative to the duration, of the nodes on both sides of a jump whose time counts as known."""


@dataclass(frozen=True, eq=False)
class Passage:
    """A jump of the control between two nodes."""

    jump: Jump
    node: int
    """Index of the node before the jump."""
    located: bool
    """Whether the nodes on both sides are so close that the time of the jump is known, or the jump is at the final
    time."""
    last: bool
    """Whether the jump is at the final time."""

    def saltation(self, solution: Solution, unit: Array) -> Saltation:
        """Return the saltation matrix, in units whose products of state and costate are all the same."""
        n, pair = len(solution.x), slice(self.node, self.node + 2)
        z = np.concatenate([solution.x, solution.lam])[:, pair]
        share = (self.jump.time - solution.times[self.node]) / float(np.diff(solution.times[pair])[0])
        between = z[:, 0] + share * (z[:, 1] - z[:, 0])
        return saltation(solution.instance, self.jump.time, between, self.jump, unit, float(unit[0] * unit[n]))


@lru_cache(maxsize=256)
def passages(solution: Solution) -> tuple[Passage, ...]:
    """Return all jumps of the control at continuous states and costates.

    The tuple is empty if H has a single minimiser for every control.
    """
    instance, model = solution.instance, solution.instance.model
    if not model.spec.stationary:
        return ()
    n, t, z = len(solution.x), solution.times, np.concatenate([solution.x, solution.lam])

    def law(times: Array) -> Array:
        at = np.array([np.interp(times, t, row) for row in z])
        return np.asarray(
            model.control_law_batch(times, at[:n], at[n:], instance.parameters, instance.control_set.arguments)
        )

    found = []
    for jump in jumps(law, t, LEFT):
        node = int(np.searchsorted(t, jump.time)) - 1
        near = CLOSE_NODES * float(t[-1] - t[0])
        last = bool(t[-1] - jump.time <= near)
        found.append(Passage(jump, node, last or bool(t[node + 1] - t[node] <= near), last))
    return tuple(found)
