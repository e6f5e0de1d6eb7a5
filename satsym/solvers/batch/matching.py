"""Newton's linear equations for the nodes of many shooting problems: segments that meet, given ends.

All nodes follow from the initial costates (condensing), so that a system as small as the boundary is left (Bock and
Plitt, A Multiple Shooting Algorithm for Direct Solution of Optimal Control Problems, 1984).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.solvers.batch.condensing import Condensing
from satsym.solvers.batch.corners import inverses


@dataclass(frozen=True, eq=False)
class Matching:
    """The equations of M problems, linearised."""

    transition: Array
    """Ends of segments by their beginnings, shape (2n, 2n, N, M)."""
    field: Array
    """Nodes by initial costates in their units, and perhaps by something else, shape (2n, n or more, N+1, M)."""
    inverse: Array
    """Initial costates by what is missing at the end, in units, shape (n, n, M); not finite where nothing decides."""
    units: Array
    """Units of states and costates, shape (2n,)."""
    condense: Condensing

    @classmethod
    def of(cls, transition: Array, units: Array, condense: Condensing) -> Matching:
        """The equations with these transitions."""
        field = condense(transition, _unity(units, transition.shape[3]), None)
        return cls(transition, field, _inverse(field, units), units, condense)

    def only(self, chosen: NDArray[np.intp]) -> Matching:
        """Some of them."""
        if len(chosen) == self.inverse.shape[2]:
            return self
        transition, field, inverse = (rows[..., chosen] for rows in (self.transition, self.field, self.inverse))
        return Matching(transition, field, inverse, self.units, self.condense)

    def correction(self, start: Array, gaps: Array, missing: Array) -> Array:
        """By how much nodes move for segments to meet and end as they should, shape (2n, N+1, M).

        Parameters
        ----------
        start
            Where the first should be, less where it is, shape (n, M).
        gaps
            Where each segment ends, less where the next one begins, shape (2n, N, M).
        missing
            Where the last should end, less the last node, shape (n, M).
        """
        begun = np.concatenate([start, np.zeros_like(start)])
        return self._closed(self.condense(self.transition, begun[:, None], gaps)[:, 0], missing)

    def _closed(self, found: Array, missing: Array) -> Array:
        """Corrections without initial costates, with those that are missing for the end, in place."""
        wanted = (missing - found[: len(missing), -1]) / self.units[: len(missing), None]
        self.condense.combine(self.field, (self.inverse * wanted).sum(axis=1), found)
        return found


def corrected(
    transition: Array, units: Array, condense: Condensing, start: Array, gaps: Array, missing: Array
) -> Array:
    """What :meth:`Matching.correction` says where it is asked for once, with one look at the transitions."""
    begun = np.concatenate([start, np.zeros_like(start)])
    found = condense(transition, np.concatenate([_unity(units, transition.shape[3]), begun[:, None]], axis=1), gaps)
    inverse = _inverse(found[:, :-1], units)
    return Matching(transition, found, inverse, units, condense)._closed(found[:, -1].copy(), missing)


def _unity(units: Array, count: int) -> Array:
    """Each initial costate in its unit, shape (2n, n, M)."""
    rows, n = len(units), len(units) // 2
    found = np.zeros((rows, n, count))
    found[np.arange(n, rows), np.arange(n)] = units[n:, None]
    return found


def _inverse(field: Array, units: Array) -> Array:
    n = field.shape[1]
    reached = (field[:n, :, -1] / units[:n, None, None]).transpose(2, 0, 1)
    return np.asarray(inverses(reached).transpose(1, 2, 0))
