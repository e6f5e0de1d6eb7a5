"""Jumps of the control along a solution, looked for again in its law, and where they lie between its nodes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from satsym.arrays import Array
from satsym.solution import Solution
from satsym.solvers.control.jumps import Jump, Saltation, jumps, saltation

LEFT = 1e-6
"""Share of the largest control by which it jumps."""

CLOSE_NODES = 1e-8
"""Share of the duration within which the nodes on both sides of a jump that is located lie."""


@dataclass(frozen=True, eq=False)
class Passage:
    """A jump of the control between two nodes."""

    jump: Jump
    node: int
    """The one before it."""
    located: bool
    """Whether both are so close that it is known when the control jumps, or it does so at the very end."""
    last: bool
    """Whether nothing comes after it."""

    def saltation(self, solution: Solution, unit: Array) -> Saltation:
        """How neighbouring extremals pass it, in units of states and costates whose products are all the same."""
        n, pair = len(solution.x), slice(self.node, self.node + 2)
        z = np.concatenate([solution.x, solution.lam])[:, pair]
        share = (self.jump.time - solution.times[self.node]) / float(np.diff(solution.times[pair])[0])
        between = z[:, 0] + share * (z[:, 1] - z[:, 0])
        return saltation(solution.instance, self.jump.time, between, self.jump, unit, float(unit[0] * unit[n]))


@lru_cache(maxsize=256)
def passages(solution: Solution) -> tuple[Passage, ...]:
    """All jumps of the control while states and costates go on; none where every control has one minimiser of H."""
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
