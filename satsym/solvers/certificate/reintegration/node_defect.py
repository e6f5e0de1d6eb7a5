"""How far the canonical equations, begun at each node of a solution, end from the next one.

The flow from the initial costates says nothing of nodes that are no stations of it, so that a single wrong one would go
unseen; from node to node each of them is the end of one short integration and the beginning of another.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.solution import Solution
from satsym.solvers.certificate.reintegration.flow import FAINT_COSTATE, typical
from satsym.solvers.simulation.extrapolation import SUBSTEPS, leap, leap_and_error

FINE = 1e-10
"""Error of an integration, relative, that shows nothing in a defect."""

EASY = 3
"""Columns of the extrapolation table that are enough between most nodes."""

MOST_PARTS = 256
"""Into which what lies between two nodes is taken where that does not suffice."""

Parameters = tuple[Any, ...]
"""What a model is given, each a number, or an array with one for each column."""
Rates = Callable[[Array, Array, Parameters], Array]


@dataclass(frozen=True, eq=False)
class Stretches:
    """What lies between neighbouring nodes, of one solution or of many."""

    begins: Array
    lasting: Array
    """Times, shape (K,)."""
    start: Array
    end: Array
    """States and costates at the two nodes, shape (2n, K)."""
    sizes: Array
    """To which errors of these are held, shape (2n, K)."""
    parameters: Parameters
    """What the model is given."""

    def only(self, chosen: NDArray[np.intp]) -> Stretches:
        """Some of them."""
        p = tuple(one if np.ndim(one) == 0 else np.asarray(one)[chosen] for one in self.parameters)
        columns = (self.start[:, chosen], self.end[:, chosen], self.sizes[:, chosen])
        return Stretches(self.begins[chosen], self.lasting[chosen], *columns, p)


def missed(rates: Rates, stretches: Stretches) -> Array:
    """By how much each next node is missed, relative to the sizes, shape (K,); infinite where that is not finite.

    Parameters
    ----------
    rates
        Function of times (K,), states and costates (2n, K), and parameters.
    """
    found, error = _ended(rates, stretches, 1, EASY)
    parts = 1
    while parts <= MOST_PARTS and (rough := np.flatnonzero(~(error <= FINE))).size:
        found[rough], error[rough] = _ended(rates, stretches.only(rough), parts, len(SUBSTEPS))
        parts *= 4
    return np.where(np.isfinite(found), found, np.inf)


def _ended(rates: Rates, stretches: Stretches, parts: int, columns: int) -> tuple[Array, Array]:
    """Distances from the next nodes, and errors of the integration, relative, shapes (K,)."""
    h, now, error = stretches.lasting / parts, stretches.start, np.zeros_like(stretches.start)
    for k in range(parts):
        now, own = leap_and_error(
            lambda t, z: rates(t, z, stretches.parameters), stretches.begins + k * h, now, h, columns
        )
        error = np.maximum(error, own)
    apart = np.abs(now - stretches.end)
    return (apart / stretches.sizes).max(axis=0), (error / stretches.sizes).max(axis=0)


def node_defect(solution: Solution) -> float:
    """The largest of a solution's nodes, relative to the sizes of its states and costates."""
    instance, n, times = solution.instance, len(solution.x), solution.times

    def rates(t: Array, z: Array, p: Parameters) -> Array:
        found = np.empty_like(z)
        instance.model.canonical_batch(t, z[:n], z[n:], p, instance.control_set.arguments, out=found)
        return found

    found = stretches(solution)
    begins, start = found.begins.copy(), found.start.copy()
    for corner in sorted(t for own in solution.switching_times for t in own if times[0] < t < times[-1]):
        k = [int(np.searchsorted(times, corner, side="right")) - 1]
        start[:, k] = leap(lambda t, z: rates(t, z, found.parameters), begins[k], start[:, k], corner - begins[k])
        begins[k] = corner
    found = replace(found, begins=begins, lasting=times[1:] - begins, start=start)
    return float(missed(rates, found).max())


def stretches(solution: Solution) -> Stretches:
    """What lies between the nodes of a solution."""
    z, sizes = np.concatenate([solution.x, solution.lam]), np.concatenate(typical(solution, FAINT_COSTATE))
    columns = np.repeat(sizes[:, None], len(solution.times) - 1, axis=1)
    begins, lasting = solution.times[:-1], np.diff(solution.times)
    return Stretches(begins, lasting, z[:, :-1], z[:, 1:], columns, solution.instance.parameters)


def joined(parts: Sequence[Stretches]) -> Stretches:
    """Put the stretches of several solutions one after the other."""
    table = np.concatenate([np.repeat([one.parameters], len(one.begins), axis=0) for one in parts])
    begins, lasting, start, end, sizes = (
        np.concatenate([getattr(one, name) for one in parts], axis=-1)
        for name in ("begins", "lasting", "start", "end", "sizes")
    )
    return Stretches(begins, lasting, start, end, sizes, tuple(table.T.copy()))
