"""The second variation where vectors are throttled: in the lengths of arcs, and in what turns within them.

With the norms kept on each arc a control is the lengths of its arcs and the continuous controls on them. Stretched to a
fixed length each arc is a smooth problem with a parameter, so that nothing jumps: to the integral of the accessory
problem a change of the length adds its share of the rates, and of H_x. Where this form is positive on what keeps the
end, the extremal, if it switches strictly and Legendre's condition is strict on its arcs, is a strict strong local
minimum (Osmolovskii and Maurer, Applications to Regular and Bang-Bang Control, 2012, chapters 6 and 7).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.solution import Solution
from satsym.solvers.certificate.end_form import fixed_states, multipliers
from satsym.solvers.certificate.jacobi import kernel
from satsym.solvers.certificate.reintegration.flow import typical
from satsym.solvers.certificate.switching.integration import Integration, Span
from satsym.solvers.certificate.switching.replay import Piece, Replay
from satsym.solvers.certificate.switching.variation import flat_along
from satsym.solvers.collocation.scaling import final_argument
from satsym.solvers.switching.field import NUDGE
from satsym.solvers.switching.throttled import ThrottledField

PIECES, STEPS = 20, 240
"""On which changes of the continuous controls are constant, over all arcs; and steps of the classical Runge-Kutta
method over all."""

SHIFT = 1e-4
"""Difference over which H by explicit time is differentiated once more, as a share of an arc."""

CHANGED = 0.5
"""Share of the least curvature by which it may change when twice as many pieces are taken."""


@dataclass(frozen=True, eq=False)
class _Along:
    """An arc at the ends and in the middle of each of its steps, shapes (2 K + 1, ...), in units of states and time.

    Changes follow x' = motion x + push w + f / T dT and cost (x' restoring x + w'w) / 2 + H_x x / T dT.
    """

    lasting: float
    motion: Array
    push: Array
    restoring: Array
    rates: Array
    slope: Array


def curvature(solution: Solution, again: Replay, by: Integration) -> float:
    """The smallest eigenvalue of the form on what keeps the end, in units of its diagonal; NaN if it is not resolved.

    Parameters
    ----------
    solution
        With throttled vectors.
    again
        The solution again.
    by
        How arcs are integrated.
    """
    coarse, fine = (_least(solution, again, by, pieces) for pieces in (PIECES, 2 * PIECES))
    return fine if abs(fine - coarse) <= CHANGED * abs(fine) else float("nan")


def _least(solution: Solution, again: Replay, by: Integration, most: int) -> float:
    form, ties, _ = quadratic(solution, again, by, most)
    return _smallest(form, ties, len(again.pieces))


def quadratic(solution: Solution, again: Replay, by: Integration, most: int) -> tuple[Array, Array, float]:
    """The form, rows that vanish where the end is kept, and the unit of the cost.

    Changes are first those of the lengths of arcs, in units of the duration.
    """
    pieces, lasting = again.pieces, float(solution.times[-1] - solution.times[0])
    state = typical(solution)[0]
    cost = max(float((state * np.abs(solution.lam).max(axis=1)).sum()), 1e-300)
    state = np.append(state, lasting)  # time is a state
    n = len(state)
    counts = [int(np.ceil(most * (piece.end - piece.start) / lasting)) for piece in pieces]
    total = len(pieces) + n * sum(counts)
    own = len(pieces)
    form: Array = np.zeros((total, total))
    x: Array = np.zeros((n, total))
    for k, (piece, count) in enumerate(zip(pieces, counts, strict=True)):
        column = np.zeros(total)
        column[k] = lasting
        if not count:
            jump, slope = _at_once(piece, state, cost)
            form += np.outer(column, slope @ (x + 0.5 * np.outer(jump, column)))
            x = x + np.outer(jump, column)
            continue
        along = _along(piece, state, cost, count * (STEPS // most), by)
        form, x = _added(along, form, x, column / along.lasting, own, count)
        own += n * count
    duration = np.zeros(total)
    duration[: len(pieces)] = lasting
    ties = _ended(solution, form, x, duration, state, cost)
    return (form + form.T) / 2.0, ties, cost


def _of(piece: Piece) -> ThrottledField:
    assert isinstance(piece.field, ThrottledField)
    return piece.field


def _at_once(piece: Piece, state: Array, cost: float) -> tuple[Array, Array]:
    """Rates and H_x of an arc of no length."""
    times, z = np.array([piece.start]), piece.before[:, None]
    rates, slope = _rates(_of(piece), times, z, state, cost)
    return rates[0], slope[0]


def _rates(field: ThrottledField, times: Array, z: Array, state: Array, cost: float) -> tuple[Array, Array]:
    """Rates of states and time, and H by these, shapes (N, n + 1)."""
    n, (u, rates) = field.n, field.along(times, z)
    by_time = _by_time(field, times, z, u)
    every = np.concatenate([rates[:n], np.ones((1, len(times)))]) / state[:, None]
    return every.T, (np.concatenate([-rates[n:], by_time[None]]) * state[:, None] / cost).T


def _by_time(field: ThrottledField, times: Array, z: Array, u: Array) -> Array:
    """H by explicit time, shape (N,)."""
    if field.model.spec.autonomous:
        return np.zeros(len(times))
    ahead = times + 1j * NUDGE
    value = field.model.hamiltonian_batch(ahead, z[: field.n], u, z[field.n :], field.p)
    return np.asarray(np.imag(value) / NUDGE)


def _along(piece: Piece, state: Array, cost: float, steps: int, by: Integration) -> _Along:
    field, n, lasting = _of(piece), piece.field.n, piece.end - piece.start
    times = np.linspace(piece.start, piece.end, 2 * steps + 1)
    span = Span(field, piece.start, piece.end, piece.before)
    z = by.solved(lambda t, y: field.rates(t, y.tolist()), span, piece.before, by.sizes, t_eval=times).y
    each = list(zip(times.tolist(), z.T.tolist(), strict=True))
    slopes = np.stack([field.linearised(t, y)[1] for t, y in each])
    motion, follow, restoring = np.zeros((3, len(times), n + 1, n + 1))
    motion[:, :n, :n], follow[:, :n, :n], restoring[:, :n, :n] = (
        slopes[:, :n, :n],
        -slopes[:, :n, n:],
        -slopes[:, n:, :n],
    )
    if not field.model.spec.autonomous:
        drift = np.array([field.drift(t, y) for t, y in each])
        motion[:, :n, n], restoring[:, :n, n], restoring[:, n, :n] = drift[:, :n], -drift[:, n:], -drift[:, n:]
        step = SHIFT * lasting
        beside = [_by_time(field, times + k, z, field.along(times + k, z)[0]) for k in (-step, step)]
        restoring[:, n, n] = (beside[1] - beside[0]) / (2.0 * step)
    follow = follow / state[:, None] / state * cost
    values, axes = np.linalg.eigh((follow + follow.transpose(0, 2, 1)) / 2.0)
    push = (axes * np.sqrt(np.maximum(values, 0.0))[:, None, :]) @ axes.transpose(0, 2, 1)
    restoring, motion = restoring * state[:, None] * state / cost, motion * state / state[:, None]
    return _Along(lasting, motion, push, restoring, *_rates(field, times, z, state, cost))


def _added(along: _Along, form: Array, x: Array, share: Array, own: int, count: int) -> tuple[Array, Array]:
    """The form with what an arc adds, and the states at its end, by all changes.

    Parameters
    ----------
    share
        The change of the arc's length, relative to it, by all changes.
    own, count
        First of the columns of its continuous controls, and pieces on which these are constant.
    """
    steps, n = (len(along.motion) - 1) // 2, len(x)
    h = along.lasting / steps
    per = steps // count
    for k in range(steps):
        first = own + n * (k // per)
        w = np.zeros_like(x)
        w[:, first : first + n] = np.eye(n)

        def rate(at: int, y: Array, w: Array = w) -> Array:
            return along.motion[at] @ y + along.push[at] @ w + np.outer(along.rates[at], share)

        def integrand(at: int, y: Array) -> Array:
            return y.T @ along.restoring[at] @ y / 2.0 + np.outer(share, along.slope[at] @ y)

        a, b, c = 2 * k, 2 * k + 1, 2 * k + 2
        f1 = rate(a, x)
        f2 = rate(b, x + h / 2.0 * f1)
        f3 = rate(b, x + h / 2.0 * f2)
        f4 = rate(c, x + h * f3)
        after = x + h / 6.0 * (f1 + 2.0 * (f2 + f3) + f4)
        middle = (x + after) / 2.0 + h / 8.0 * (f1 - rate(c, after))
        form = form + h / 6.0 * (integrand(a, x) + 4.0 * integrand(b, middle) + integrand(c, after))
        form[first : first + n, first : first + n] += h / 2.0 * np.eye(n)
        x = after
    return form, x


def _ended(solution: Solution, form: Array, x: Array, duration: Array, state: Array, cost: float) -> Array:
    """Adds to the form what the end does, and returns the rows that vanish."""
    instance, n = solution.instance, len(solution.x)
    tf, end, lam = float(solution.times[-1]), tuple(solution.x[:, -1].tolist()), tuple(solution.lam[:, -1].tolist())
    nu, _ = multipliers(instance, tf, end, lam)
    table = instance.model.boundary_jacobian(
        tf, end, lam, nu, instance.parameters, instance.control_set.arguments, final_argument(instance)
    )
    slopes = np.array(table).reshape(n + len(nu) + 1, -1)
    fixed = fixed_states(instance)
    both = np.concatenate([(state[:, None] * x)[:n], duration[None]])
    by = np.column_stack([slopes[:, :n], slopes[:, -1]])
    curved = np.zeros((n + 1, n + 1))
    curved[:n][~fixed] = -by[:n][~fixed]
    curved[n, :n], curved[n, n] = curved[:n, n], by[-1, -1]
    form += both.T @ curved @ both / (2.0 * cost)
    ties = np.concatenate([by[:n][fixed], by[n:-1]]) @ both
    return ties if instance.tf is None else np.concatenate([ties, duration[None]])


def flat_by_shift(solution: Solution, again: Replay, by: Integration, flat: float) -> bool:
    """Whether the form vanishes where all happens later, in that direction and no other."""
    form, ties, _ = quadratic(solution, again, by, 2 * PIECES)
    size, free = _kept(form, ties, len(again.pieces))
    later = np.zeros(len(form))
    later[0] = 1.0
    if solution.instance.tf is not None:  # what begins with a longer arc ends with a shorter one
        later[len(again.pieces) - 1] -= 1.0
    return flat_along(free.T @ (form / size / size[:, None]) @ free, free.T @ (later * size), flat)


def _smallest(form: Array, ties: Array, lengths: int) -> float:
    """The least eigenvalue where the ties vanish, relative to the diagonal of changes on arcs, and of all lengths."""
    size, free = _kept(form, ties, lengths)
    return float(np.linalg.eigvalsh(free.T @ (form / size / size[:, None]) @ free).min()) if free.shape[1] else np.inf


def _kept(form: Array, ties: Array, lengths: int) -> tuple[Array, Array]:
    """Units of the changes, and directions in these in which the ties vanish, as columns."""
    size = np.sqrt(np.abs(np.diag(form)))
    size[:lengths] = max(size[:lengths].max(), 1e-300)
    size[lengths:] = np.maximum(size[lengths:], 1e-6 * size[lengths:].max(initial=0.0) + 1e-300)
    return size, kernel(ties / size / np.maximum(np.abs(ties / size).max(axis=1, keepdims=True), 1e-300))
