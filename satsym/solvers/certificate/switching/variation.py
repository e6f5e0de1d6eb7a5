"""The accessory problem along a switching extremal that was integrated again."""

from __future__ import annotations

from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.solution import Solution
from satsym.solvers.certificate.reintegration.flow import typical
from satsym.solvers.certificate.second_variation import Arc, Met, Quadratic, quadratic, units
from satsym.solvers.certificate.switching.integration import Integration, Span
from satsym.solvers.certificate.switching.replay import Piece, Replay
from satsym.solvers.switching.boundary import BoundaryField, off_boundary
from satsym.solvers.switching.field import NUDGE, Field
from satsym.solvers.switching.throttled import ThrottledField

PIECES, STEPS_PER_PIECE, FEWEST_STEPS = 20, 12, 4
"""On which changes of the continuous controls are constant, over all arcs; steps of the classical Runge-Kutta method in
each, and in an arc at least."""

SHIFT = 1e-4
"""Difference over which H by explicit time is differentiated once more, as a share of an arc."""

CHANGED = 0.5
"""Share of the least curvature by which it may change when twice as many pieces are taken."""


def curvature(solution: Solution, again: Replay, by: Integration) -> tuple[float, Quadratic]:
    """The smallest eigenvalue of the form on what keeps the end, and the form; the former is NaN if it is not resolved.

    Parameters
    ----------
    solution
        Whose arcs are saturated, on boundaries, or of throttled vectors.
    again
        The solution again.
    by
        How arcs are integrated.
    """
    coarse, fine = (form_of(solution, again, by, pieces) for pieces in (PIECES, 2 * PIECES))
    least, before = fine.curvature, coarse.curvature
    settled = least == before or abs(least - before) <= CHANGED * abs(least)
    return (least if settled else float("nan")), fine


def form_of(solution: Solution, again: Replay, by: Integration, pieces: int) -> Quadratic:
    """The second variation, with so many pieces over all arcs."""
    state, cost = units(solution, typical(solution)[0])
    arcs, before = list[Arc](), None
    for piece in again.pieces:
        on = piece.field.constraint if isinstance(piece.field, BoundaryField) else None
        entered = on if on is not None and on != before and arcs else None
        arcs.append(_arc(piece, entered, state, cost, pieces, by))
        before = on
    return quadratic(solution, arcs, state, cost)


def _arc(piece: Piece, entered: int | None, state: Array, cost: float, pieces: int, by: Integration) -> Arc:
    field, n, lasting = piece.field, piece.field.n, piece.end - piece.start
    met = dict[int, Met]()
    if entered is not None:
        _, slopes, moved = off_boundary(field.instance, entered, piece.start, piece.before.tolist())
        met[0] = Met(np.append(slopes[:n], moved)[None] * state)
    share = pieces * lasting / state[-1]
    count = int(np.ceil(share)) if isinstance(field, ThrottledField) else 0
    steps = count * STEPS_PER_PIECE if count else max(FEWEST_STEPS, int(np.ceil(share * STEPS_PER_PIECE)))
    times = np.linspace(piece.start, piece.end, 2 * steps + 1) if lasting else np.array([piece.start])
    z, slopes, twice = piece.before[:, None], np.zeros((len(times), 2 * n, 2 * n + 1)), np.zeros(len(times))
    if lasting:
        span = Span(field, piece.start, piece.end, piece.before)
        z = by.solved(lambda t, y: field.rates(t, y.tolist()), span, piece.before, by.sizes, t_eval=times).y
        each = zip(times.tolist(), z.T.tolist(), strict=True)
        slopes[:, :, :-1] = np.stack([field.linearised(t, y)[1] for t, y in each])
        if not field.model.spec.autonomous:
            slopes[:, :, -1] = _drift(field, times, z).T
            before, after = (_by_time(field, times + k * SHIFT * lasting, z) for k in (-1.0, 1.0))
            twice = (after - before) / (2.0 * SHIFT * lasting)
    by_time = _by_time(field, times, z), twice
    return Arc.of(times, slopes, field.along(times, z)[1], by_time, state, cost, count, met)


def _by_time(field: Field, times: Array, z: Array) -> Array:
    """H by explicit time, shape (N,)."""
    if field.model.spec.autonomous:
        return np.zeros(len(times))
    ahead = times + 1j * NUDGE  # where a boundary moves, so does the control that keeps to it
    u = field.controls(ahead, z.astype(complex)) if isinstance(field, BoundaryField) else field.along(times, z)[0]
    value = field.model.hamiltonian_batch(ahead, z[: field.n], u, z[field.n :], field.p)
    return np.asarray(np.broadcast_to(np.imag(value), times.shape) / NUDGE)


def _drift(field: Field, times: Array, z: Array) -> Array:
    """The rates of states and costates by explicit time, shape (2n, N)."""
    if isinstance(field, ThrottledField):
        return np.array([field.drift(t, y) for t, y in zip(times.tolist(), z.T.tolist(), strict=True)]).T
    ahead: tuple[Any, Any] = times + 1j * NUDGE, z.astype(complex)
    return np.asarray(np.imag(field.along(*ahead)[1]) / NUDGE)
