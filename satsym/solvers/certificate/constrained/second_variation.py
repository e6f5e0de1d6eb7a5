"""The second variation with the active arcs held: whether it is positive for all variations that keep to these.

Variations of the control are constant between nodes of a mesh, those of the state follow by the linearised motion. They
keep to given ends, to g_x dx = 0 along boundary arcs and at touch points, to g_x dx + g_u du = 0 while a constraint is
active that holds a control. To the form along the way a touch point of
order two adds - zeta (d/dt g_x dx)^2 / g'' with g'' < 0 (Bonnans and Hermant, SIAM J. Control Optim. 46, 2007): where
it moves with the variation, the constraint is harder to keep. Boundary arcs and junctions, the end among them where a
constraint pushes there, add the curvature of g times its multiplier. A final time that is free varies by itself, with
the states on beyond the end as they would move: that is in the form of the end, and holds where the motion ends on no
boundary.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.kernels.evaluation import COMPLEX_STEP
from satsym.solution import Solution
from satsym.solvers.certificate.constrained.moving_times import Moving
from satsym.solvers.certificate.constrained.replay import Replay
from satsym.solvers.certificate.end_form import end_form
from satsym.solvers.certificate.reintegration.flow import unit_sizes
from satsym.solvers.constrained.active import control, multipliers
from satsym.solvers.constrained.arcs import effects, gradient, holds_control
from satsym.solvers.constrained.structure import FREE, Active, within

MESH = 160
"""Intervals."""


def curvature(solution: Solution, again: Replay) -> float:
    """Least eigenvalue of the form over that of H_uu alone, and of a final time that varies by its unit."""
    instance, n, free_time = solution.instance, len(solution.x), solution.instance.tf is None
    times, which, ends = _mesh(solution, again)
    middles, h = (times[1:] + times[:-1]) / 2, np.diff(times)
    z = _values(again, middles)
    a, b, u, second, weight = _along(solution, middles, z, which)
    moves, inputs, solved = _transitions(a, b, h)
    m, count = b.shape[2], len(h)
    points = Moving(solution, again)
    size = m * count + len(points.arcs) + free_time
    moving = slice(m * count, m * count + len(points.arcs))
    shift, pace = points.shifts(middles), np.diff(points.shifts(times), axis=1) / h
    drives = points.drives(middles, z[:n], u, shift, pace)
    mixed, twice = points.mixed(middles, z[:n], u, z[n:], shift, pace)
    form, pure = np.zeros((size, size)), np.zeros((size, size))
    state, ties, met = np.zeros((n, size)), [], dict(zip(ends, _met_at_ends(solution, again), strict=False))
    for k in range(count):
        moved = np.zeros((m, size))
        moved[:, m * k : m * (k + 1)] = np.eye(m)
        after = moves[k] @ state + inputs[k] @ moved
        after[:, moving] += solved[k] @ drives[..., k].T
        both = np.vstack([(state + after) / 2, moved])
        form += h[k] * both.T @ second[k] @ both
        beside = h[k] * mixed[..., k] @ both
        form[moving] += beside
        form[:, moving] += beside.T
        form[moving, moving] += h[k] * twice[..., k]
        held = [each for each in which[k] if holds_control(instance, each)]
        ties += [_held(solution, which[k], each, middles[k : k + 1], z[:, k : k + 1]) @ both for each in held]
        pure += h[k] * moved.T @ weight[k] @ moved
        state = after
        at = times[k + 1 : k + 2]
        states = (each for each in which[k] if each not in held)
        ties += [gradient(instance, each, at, _values(again, at)[:n])[:, 0] @ state for each in states]
        for one in met.get(k + 1, ()):
            ties.append(one.gradient @ state)
            form += state.T @ (one.factor * np.outer(one.rate, one.rate) + one.curved) @ state
        for place, arc in enumerate(points.arcs):
            if ends[arc] == k + 1:
                kept, curved = points.passed(place)
                total = np.vstack([state, np.eye(size)[moving.start + place]])
                ties += list(kept @ total)
                form += total.T @ curved @ total
    unit = unit_sizes(solution)
    after = np.column_stack([solution.lam[:, :-1], again.end[n:]])  # multipliers at the end are those after its jump
    end = end_form(replace(solution, lam=after), unit)
    scaled = state / unit[:n, None]
    if free_time:
        scaled = np.vstack([scaled, np.eye(size)[-1]])
        pure[-1, -1] = unit[0] * unit[n]
    pure[moving, moving] += np.eye(len(points.arcs)) * unit[0] * unit[n]
    form += scaled.T @ end.form @ scaled * unit[0] * unit[n]
    ties += list(end.ties @ scaled)
    return _least(form, pure, np.array(ties).reshape(-1, size))


def _least(form: Array, pure: Array, ties: Array) -> float:
    """Least generalised eigenvalue on what keeps the ties: infinite where nothing does, NaN where numbers fail."""
    from scipy.linalg import LinAlgError, eigh

    if not np.isfinite(form).all():  # a constraint is crossed at its touch point
        return float("nan")
    rows = ties / np.maximum(np.abs(ties).max(axis=1, keepdims=True), 1e-300)
    _, strengths, kept = np.linalg.svd(rows)
    basis = kept[int((strengths > 1e-9 * strengths.max(initial=0.0)).sum()) :].T
    if not basis.size:
        return float("inf")
    kept_form, kept_pure = basis.T @ form @ basis, basis.T @ pure @ basis
    try:
        return float(eigh(kept_form, kept_pure, eigvals_only=True, subset_by_index=[0, 0])[0])
    except LinAlgError:  # controls are not weighed by squares that are positive
        return float("nan")


def _held(solution: Solution, active: Active, constraint: int, t: Array, z: Array) -> Array:
    """g_x and g_u of a constraint that holds a control, in one row."""
    instance, x = solution.instance, z[: len(solution.x)]
    u = control(instance, active, t, z)
    return np.concatenate([gradient(instance, constraint, t, x, u), effects(instance, t, x, u)[constraint]])[:, 0]


def _mesh(solution: Solution, again: Replay) -> tuple[Array, list[Active], list[int]]:
    """Times with all events among them, what is active on each interval, and after how many each arc ends."""
    whole = float(solution.times[-1] - solution.times[0])
    times, which, ends = [np.array([solution.times[0]])], list[Active](), list[int]()
    for piece in again.pieces:
        a, b = piece.times[0], piece.times[-1]
        count = max(4, int(np.ceil(MESH * (b - a) / whole)))
        times.append(np.linspace(a, b, count + 1)[1:])
        which += [piece.active] * count
        ends.append(len(which))
    return np.concatenate(times), which, ends


def _values(again: Replay, times: Array) -> Array:
    """States and costates by lines between the dense places of the replay."""
    known = np.concatenate([piece.times for piece in again.pieces])
    rows = np.concatenate([piece.dense for piece in again.pieces], axis=1)
    return np.array([np.interp(times, known, row) for row in rows])


def _along(
    solution: Solution, t: Array, z: Array, which: list[Active]
) -> tuple[Array, Array, Array, list[Array], list[Array]]:
    """Jacobians of the motion, controls, second derivatives of H + eta g by state and control, and H_uu, in between."""
    instance, n = solution.instance, len(solution.x)
    model, p, x, lam = instance.model, instance.parameters, z[:n], z[n:]
    m, count = len(model.spec.controls), len(t)
    u, eta = np.empty((m, count)), np.zeros((len(model.spec.path_constraints), count))
    for active in set(which):
        here = np.array([one == active for one in which])
        u[:, here] = control(instance, active, t[here], z[:, here])
        for k, row in zip(active, multipliers(instance, active, t[here], z[:, here]), strict=True):
            eta[k, here] = row
    a = np.broadcast_to(np.asarray(model.jacobian_x_batch(t, x, u, p)).reshape(n, n, -1), (n, n, count))
    b = np.broadcast_to(np.asarray(model.jacobian_u_batch(t, x, u, p)).reshape(n, m, -1), (n, m, count))

    def slopes(y: Array) -> Array:
        by_x = -np.asarray(model.costate_rate_batch(t, y[:n], y[n:], lam, p))
        by_u = np.asarray(model.stationarity_batch(t, y[:n], y[n:], lam, p))
        return np.concatenate([np.broadcast_to(by_x, x.shape), np.broadcast_to(by_u, u.shape)])

    table = _slopes(slopes, np.concatenate([x, u]))
    for k in {one for active in which for one in active}:

        def pushes(y: Array, k: int = k) -> Array:
            by_x = gradient(instance, k, t, y[:n], y[n:])
            return np.concatenate([by_x, np.broadcast_to(effects(instance, t, y[:n], y[n:])[k], u.shape)])

        table += _slopes(pushes, np.concatenate([x, u])) * eta[k]
    second = list(np.moveaxis((table + table.swapaxes(0, 1)) / 2, -1, 0))
    return np.moveaxis(a, -1, 0), np.moveaxis(b, -1, 0), u, second, [one[n:, n:] for one in second]


def _transitions(a: Array, b: Array, h: Array) -> tuple[list[Array], list[Array], list[Array]]:
    """The midpoint rule's step of the linearised motion: by states, by controls, and by what is added to rates."""
    moves, inputs, solved = [], [], []
    for one, push, step in zip(a, b, h, strict=True):
        unit = np.eye(len(one))
        inverse = np.linalg.inv(unit - step / 2 * one)
        moves.append(inverse @ (unit + step / 2 * one))
        inputs.append(inverse @ (step * push))
        solved.append(step * inverse)
    return moves, inputs, solved


@dataclass(frozen=True, eq=False)
class Met:
    """A junction: g_x, the derivative of the rate of g, what multiplies its square, and zeta times g_xx."""

    gradient: Array
    rate: Array
    factor: float
    curved: Array


def _met_at_ends(solution: Solution, again: Replay) -> list[list[Met]]:
    """What is met where each arc ends; at the end of the motion, which stays where it is, what pushes there."""
    instance, spec = solution.instance, solution.instance.model.spec.path_constraints
    names = [one.name for one in spec]
    found = list[list[Met]]()
    for group, piece, jumps in zip(within(solution), again.pieces, again.jumps, strict=False):
        at, touched = (piece.times[-1:], piece.z[:, -1:]), {e.name for e in group if e.kind == "touch"}
        # what holds a control is kept by its control alone
        own = {names.index(event.name) for event in group if event.kind != "interior"}
        own |= {k for k in jumps if k < len(spec)}
        states = sorted(k for k in own if spec[k].order > 0)
        found.append([_met(instance, k, *at, jumps.get(k, 0.0), names[k] in touched) for k in states])
    end = again.pieces[-1].times[-1:], again.end[:, None]
    found.append([_met(instance, k, *end, zeta, touches=False) for k, zeta in again.pressed.items()])
    return found


def _met(instance: Instance, constraint: int, t: Array, z: Array, zeta: float, touches: bool) -> Met:
    """The junction of a constraint at a time, with states and costates before it."""
    model, p, n = instance.model, instance.parameters, len(instance.initial)
    x, factor = z[:n], 0.0
    u = control(instance, FREE, t, z)

    def rates(y: Array) -> Array:
        return np.asarray(model.path_rates_batch(t, y, u.astype(y.dtype), p)).reshape(-1, 2, 1)[constraint]

    if touches:
        second = float(rates(x)[1, 0])
        factor = -zeta / second if second < 0.0 else -np.inf
    rate = _slopes(lambda y: rates(y)[:1], x)[0, :, 0]
    curved = _slopes(lambda y: gradient(instance, constraint, t, y), x)[..., 0]
    return Met(gradient(instance, constraint, t, x)[:, 0], rate, factor, zeta * curved)


def _slopes(function: Callable[[Array], Array], at: Array) -> Array:
    """Derivatives by every component, shape (rows, d, N)."""
    columns = []
    for j in range(len(at)):
        moved = at.astype(complex)
        moved[j] += 1j * COMPLEX_STEP
        columns.append(np.imag(function(moved)) / COMPLEX_STEP)
    return np.stack(columns, axis=1)
