"""Newton's method for the nodes of many shooting problems; each problem is removed when it has converged or failed.

Steps of low order with exact derivatives are used first. Steps of high order follow, with the last of these derivatives
kept fixed; their error is estimated by Richardson's rule from twice as many steps.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array, distinct
from satsym.solvers.batch.condensing import Condensing
from satsym.solvers.batch.corners import inverses
from satsym.solvers.batch.many import Many
from satsym.solvers.collocation.curve import SMALL_COSTATE
from satsym.solvers.shooting.runge_kutta import ORDER

NEAR_CORRECTION = 1e-2
"""Size of a correction with low order below which the corrections with high order follow."""

MOST_ROUGH, MOST_ACCURATE = 8, 12
"""Largest numbers of corrections with steps of low order, and of high order."""

SHRINK = 0.5
"""Factor by which each correction must be smaller than the one before; otherwise the problem has not converged."""

COARSE = 1e-6
"""Size of a correction below which the number of steps is doubled to estimate the error."""

FEWEST_PARTS, MOST_PARTS = 2, 32
"""Smallest and largest number of steps of high order in a segment."""

ROUNDING = 1e-11
"""Size below which a correction that no longer shrinks is attributed to rounding."""


class Outcome(Enum):
    """How the solution of a problem ended."""

    SOLVED = "solved"
    NO_CONVERGENCE = "corrections do not shrink"
    LEFT_DOMAIN = "left the domain"
    INACCURATE = "steps too long"
    BOUNDS = "bounds are met"


@dataclass(frozen=True, eq=False)
class Nodes:
    """Result of Newton's method for M problems."""

    z: Array
    """States and costates at the nodes, shape (2n, N+1, M)."""
    cost: Array
    """Integral of the running cost, shape (M,)."""
    error: Array
    """Estimate of the largest error, relative to the magnitudes of states and costates, shape (M,)."""
    outcome: NDArray[np.object_]
    """The :class:`Outcome` of each problem, shape (M,)."""

    @property
    def solved(self) -> NDArray[np.bool_]:
        """Whether each problem is solved, shape (M,)."""
        return np.asarray(self.outcome == Outcome.SOLVED)

    def only(self, chosen: NDArray[np.intp]) -> Nodes:
        """Return the results of the problems with the given indices."""
        z, cost, error = (rows[..., chosen] for rows in (self.z, self.cost, self.error))
        return Nodes(z, cost, error, self.outcome[chosen])


def rough(many: Many, start: Array) -> tuple[Array, NDArray[np.object_]]:
    """Improve an initial guess of each problem until it is near an extremal; return nodes and outcomes, shape (M,).

    Parameters
    ----------
    many
        The problems.
    start
        Initial guess of the values at the nodes, shape (2n, N+1, M).
    """
    z, outcome = start.copy(), np.full(many.count, Outcome.SOLVED, dtype=object)
    on, before = np.arange(many.count), np.full(many.count, np.inf)
    for _ in range(MOST_ROUGH):
        own, at = many.only(on), _columns(on, many.count)
        now = z[:, :, at]
        reached, transition = _rough(own, now, 1)
        step = _corrected(transition, many.units, many.condense, *_missing(own, now, reached))
        now = z[:, :, at] = now + step
        size, positive = _size(many, step, now), _positive(many, now)
        outcome[on[~positive]] = Outcome.LEFT_DOMAIN
        outcome[on[positive & ~(size < before[on])]] = Outcome.NO_CONVERGENCE
        before[on] = SHRINK * size
        on = on[positive & (size >= NEAR_CORRECTION) & (outcome[on] == Outcome.SOLVED)]
        if not len(on):
            break
    outcome[on] = Outcome.NO_CONVERGENCE
    return z, outcome


def accurate(many: Many, z: Array, outcome: NDArray[np.object_], aim: float) -> Nodes:
    """Improve nodes near an extremal to a required accuracy; other problems keep their outcome.

    Parameters
    ----------
    many
        The problems.
    z, outcome
        Values at the nodes, shape (2n, N+1, M), and outcomes, ``SOLVED`` for problems near an extremal, shape (M,).
    aim
        Largest relative error.
    """
    z, outcome = z.copy(), outcome.copy()
    cost, error = np.full(many.count, np.nan), np.full(many.count, np.inf)
    before, shown = np.full(many.count, np.inf), np.full(many.count, np.inf)
    parts, on = np.full(many.count, FEWEST_PARTS), np.flatnonzero(outcome == Outcome.SOLVED)
    matching = _Matching.of(transitions(many, z), many.units, many.condense)
    for _ in range(MOST_ACCURATE):
        for count in distinct(parts[on]).tolist():
            own = on[parts[on] == count]
            some, at = many.only(own), _columns(own, many.count)
            now = z[:, :, at]
            reached = some.motion.accurate(*some.segments(now), count).reshape(len(z) + 1, -1, len(own))
            step = matching.only(own).correction(*_missing(some, now, reached[:-1]))
            now = z[:, :, at] = now + step
            cost[own] = reached[-1].sum(axis=0)
            size, fresh = _size(many, step, now), np.isinf(shown[own]) & (count > FEWEST_PARTS)
            shown[own] = np.where(fresh, size / (2**ORDER - 1), shown[own])
            going_on = (size < SHRINK * before[own]) | fresh | (size < ROUNDING)
            outcome[own[~(going_on & _positive(many, now))]] = Outcome.NO_CONVERGENCE
            ahead = size * np.where(np.isfinite(before[own]), np.minimum(size / before[own], 1.0), 1.0)
            error[own] = np.where(fresh, np.inf, np.maximum(shown[own], np.where(size < ROUNDING, 0.0, ahead)))
            error[own] = np.where(fresh & (size < COARSE), np.maximum(shown[own], size * before[own]), error[own])
            before[own] = size
            finer = (size < COARSE) & (np.isinf(shown[own]) | (shown[own] > aim))
            parts[own[finer]] *= 2
            shown[own[finer]] = np.inf
        outcome[on[parts[on] > MOST_PARTS]] = Outcome.INACCURATE
        on = on[(outcome[on] == Outcome.SOLVED) & ~(error[on] <= aim)]
        if not len(on):
            break
    outcome[on] = Outcome.NO_CONVERGENCE
    return Nodes(z, cost, error, outcome)


def transitions(many: Many, z: Array) -> Array:
    """Return the transition matrices of all segments, by steps of low order, shape (2n, 2n, N, M)."""
    return _rough(many, z, 2)[1]


def _rough(many: Many, z: Array, parts: int) -> tuple[Array, Array]:
    ends, transition = many.motion.rough(*many.segments(z), parts)
    shape = (len(many.mesh) - 1, many.count)
    return ends.reshape(len(z), *shape), transition.reshape(len(z), len(z), *shape)


def _columns(chosen: NDArray[np.intp], count: int) -> NDArray[np.intp] | slice:
    """Return the chosen columns as an index, or as a slice, which copies nothing, if all columns are chosen."""
    return slice(None) if len(chosen) == count else chosen


def _missing(many: Many, z: Array, reached: Array) -> tuple[Array, Array, Array]:
    """Return the residuals at the initial time, at the ends of segments, and at the final time."""
    n = many.states
    return many.initial - z[:n, 0], reached - z[:, 1:], many.end - z[:n, -1]


def _size(many: Many, step: Array, z: Array) -> Array:
    """Return the size of a correction, shape (M,).

    States are relative to their magnitude (at least one unit), costates to theirs.
    """
    n, units = many.states, many.units[:, None]
    moved, there = (np.abs(rows).max(axis=1) / units for rows in (step, z))
    states = moved[:n].max(axis=0) / np.maximum(there[:n].max(axis=0), 1.0)
    costates = moved[n:].max(axis=0) / np.maximum(there[n:].max(axis=0), SMALL_COSTATE)
    found = np.maximum(states, costates)
    return np.where(np.isfinite(found), found, np.inf)


def _positive(many: Many, z: Array) -> NDArray[np.bool_]:
    """Return whether all states that must be positive are positive, shape (M,)."""
    return np.asarray((z[list(many.problem.positive)] > 0.0).all(axis=(0, 1)))


@dataclass(frozen=True, eq=False)
class _Matching:
    """Linearised equations of M shooting problems: continuity between segments, and the boundary conditions.

    All nodes are expressed by the initial costates (condensing), so that only a system of the size of the boundary
    conditions remains (Bock and Plitt, A Multiple Shooting Algorithm for Direct Solution of Optimal Control Problems,
    1984).
    """

    transition: Array
    """Transition matrices of the segments, shape (2n, 2n, N, M)."""
    field: Array
    """Derivatives of the nodes with respect to the scaled initial costates, possibly with further columns.

    The shape is (2n, n or more, N+1, M).
    """
    inverse: Array
    """Derivatives of the scaled initial costates with respect to the final residual, shape (n, n, M); not finite if
    singular."""
    units: Array
    """Units of states and costates, shape (2n,)."""
    condense: Condensing

    @classmethod
    def of(cls, transition: Array, units: Array, condense: Condensing) -> _Matching:
        """Return the equations with given transition matrices."""
        field = condense(transition, _unity(units, transition.shape[3]), None)
        return cls(transition, field, _inverse(field, units), units, condense)

    def only(self, chosen: NDArray[np.intp]) -> _Matching:
        """Return the equations of the problems with the given indices."""
        if len(chosen) == self.inverse.shape[2]:
            return self
        transition, field, inverse = (rows[..., chosen] for rows in (self.transition, self.field, self.inverse))
        return _Matching(transition, field, inverse, self.units, self.condense)

    def correction(self, start: Array, gaps: Array, missing: Array) -> Array:
        """Return the correction of the nodes that solves the linearised equations, shape (2n, N+1, M).

        Parameters
        ----------
        start
            Required initial state minus the state at the first node, shape (n, M).
        gaps
            End of each segment minus the next node, shape (2n, N, M).
        missing
            Required final state minus the state at the last node, shape (n, M).
        """
        begun = np.concatenate([start, np.zeros_like(start)])
        return self._closed(self.condense(self.transition, begun[:, None], gaps)[:, 0], missing)

    def _closed(self, found: Array, missing: Array) -> Array:
        """Return corrections completed, in place, by the initial costates that satisfy the final conditions."""
        wanted = (missing - found[: len(missing), -1]) / self.units[: len(missing), None]
        self.condense.combine(self.field, (self.inverse * wanted).sum(axis=1), found)
        return found


def _corrected(
    transition: Array, units: Array, condense: Condensing, start: Array, gaps: Array, missing: Array
) -> Array:
    """Return the correction of :meth:`_Matching.correction` in one pass over the transition matrices."""
    begun = np.concatenate([start, np.zeros_like(start)])
    found = condense(transition, np.concatenate([_unity(units, transition.shape[3]), begun[:, None]], axis=1), gaps)
    inverse = _inverse(found[:, :-1], units)
    return _Matching(transition, found, inverse, units, condense)._closed(found[:, -1].copy(), missing)


def _unity(units: Array, count: int) -> Array:
    """Return columns with one initial costate each, in its unit, shape (2n, n, M)."""
    rows, n = len(units), len(units) // 2
    found = np.zeros((rows, n, count))
    found[np.arange(n, rows), np.arange(n)] = units[n:, None]
    return found


def _inverse(field: Array, units: Array) -> Array:
    n = field.shape[1]
    reached = (field[:n, :, -1] / units[:n, None, None]).transpose(2, 0, 1)
    return np.asarray(inverses(reached).transpose(1, 2, 0))
