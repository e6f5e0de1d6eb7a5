"""The second variation of an extremal in exact arcs, and whether its smallest eigenvalue is resolved."""

from __future__ import annotations

from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.solution import Solution
from satsym.solvers.certificate.reintegration.flow import typical
from satsym.solvers.certificate.second_variation import Arc, Met, Quadratic, quadratic, units
from satsym.solvers.certificate.switching import singular
from satsym.solvers.certificate.switching.integration import Integration, Span
from satsym.solvers.certificate.switching.replay import Piece, Replay
from satsym.solvers.switching.boundary import BoundaryField, off_boundary
from satsym.solvers.switching.field import NUDGE, Field
from satsym.solvers.switching.throttled import ThrottledField

PIECES, MOST_PIECES, STEPS_PER_PIECE, FEWEST_STEPS = 20, 160, 12, 4
"""First and maximum number of pieces, over all arcs, on which variations of the continuous controls are constant.
Number of classical Runge-Kutta steps in each piece, and minimum number in an arc."""

SHIFT = 1e-4
"""Step of the finite difference of H_t with respect to time, as a fraction of the length of an arc."""

CHANGED = 0.5
"""Largest change of the minimum curvature, relative, when the number of pieces is doubled. With a larger change the
number is doubled again; at its maximum the second variation counts as not resolved."""


def curvature(solution: Solution, again: Replay, by: Integration) -> tuple[float, Quadratic]:
    """Return the smallest eigenvalue of the second variation under the end conditions, and the form.

    Parameters
    ----------
    solution
        Extremal whose arcs are saturated, singular, on boundaries, or of throttled vectors.
    again
        The repeated integration of the solution.
    by
        Integration of the arcs.
    """
    fine, pieces = form_of(solution, again, by, PIECES), PIECES
    least, settled = fine.curvature, False
    while not settled and pieces < MOST_PIECES:
        before, pieces = least, 2 * pieces
        fine = form_of(solution, again, by, pieces)
        least = fine.curvature
        settled = least == before or abs(least - before) <= CHANGED * abs(least)
    return (least if settled else float("nan")), fine


def form_of(solution: Solution, again: Replay, by: Integration, pieces: int) -> Quadratic:
    """Return the second variation, with a given number of pieces over all arcs."""
    state, cost = units(solution, typical(solution)[0])
    arcs, before = list[Arc](), None
    for place, piece in enumerate(again.pieces):
        if piece.field.singular is not None:
            arcs.append(singular.arc(again, place, state, cost, pieces, by))
            before = None
            continue
        on = piece.field.constraint if isinstance(piece.field, BoundaryField) else None
        entered = on if on is not None and on != before and arcs else None
        arcs.append(_arc(piece, entered, state, cost, pieces, by))
        before = on
    return quadratic(solution, arcs, state, cost, singular.groups(again))


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
    """Return the partial derivative of H with respect to explicit time, shape (N,)."""
    if field.model.spec.autonomous:
        return np.zeros(len(times))
    ahead = times + 1j * NUDGE  # where a boundary moves, so does the control that keeps to it
    u = field.controls(ahead, z.astype(complex)) if isinstance(field, BoundaryField) else field.along(times, z)[0]
    value = field.model.hamiltonian_batch(ahead, z[: field.n], u, z[field.n :], field.p)
    return np.asarray(np.broadcast_to(np.imag(value), times.shape) / NUDGE)


def _drift(field: Field, times: Array, z: Array) -> Array:
    """Return the derivatives of the rates of states and costates with respect to explicit time, shape (2n, N)."""
    if isinstance(field, ThrottledField):
        return np.array([field.drift(t, y) for t, y in zip(times.tolist(), z.T.tolist(), strict=True)]).T
    ahead: tuple[Any, Any] = times + 1j * NUDGE, z.astype(complex)
    return np.asarray(np.imag(field.along(*ahead)[1]) / NUDGE)
