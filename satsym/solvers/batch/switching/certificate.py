"""Certificate of many time-optimal extremals, except the comparison with competing extremals.

The conditions are those of :mod:`satsym.solvers.certificate.switching.conditions` for a single extremal: the flow from
the initial costates, by an integrator that the solver does not use; the Hamiltonian and its minimum at many times;
strict switches; and the second variation in the switching times. An extremal for which a condition is not clear is left
to the certificate of single extremals.
"""

from __future__ import annotations

from dataclasses import dataclass
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array, distinct
from satsym.kernels import Kernels
from satsym.solution import Certificate, Solution
from satsym.solvers.batch.switching.arrivals import Arrivals, stated
from satsym.solvers.certificate.conditions import DRIFT, RESIDUAL
from satsym.solvers.certificate.jacobi import INDEPENDENT
from satsym.solvers.certificate.kernel_consistency import with_kernels_examined
from satsym.solvers.certificate.reintegration.flow import NEGLIGIBLE, TOLERANCE
from satsym.solvers.certificate.switching.conditions import CLOSE_TO_SWITCH, CURVED, STRICT, TIMES
from satsym.solvers.certificate.switching.end_switches import AT_SWITCH
from satsym.solvers.simulation.extrapolation import leap_and_error
from satsym.status import Status, Verdict

PARTS = (1, 2, 4, 8)
"""Numbers of steps for each arc, tried in turn until the errors of the flow are small enough."""

PLACES = np.array([1e-3, 0.02, 0.06, 0.12, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.88, 0.94, 0.98, 1.0 - 1e-3])
"""Positions within an arc, as fractions, at which the Hamiltonian and switching functions are evaluated."""


@dataclass(frozen=True, eq=False)
class _Flow:
    """Extremals integrated arc by arc; arcs of zero length follow after the last arc."""

    begins: Array
    lengths: Array
    """Initial times and lengths of the arcs, shapes (K, M)."""
    u: Array
    """Controls on each arc, shape (K, m, M)."""
    values: Array
    """States, costates, and derivatives of the states with respect to switching times, shape (K + 1, 2n + n S, M).

    The first index is the beginning of each arc, and finally the end of the motion.
    """
    error: Array
    """Largest relative error of the integration, shape (M,)."""


@dataclass(frozen=True, eq=False)
class _Many:
    """Extremals as columns, with the functions that their integration needs."""

    found: Arrivals

    @property
    def model(self) -> Kernels:
        return self.found.instances[0].model

    def parameters(self, times: int = 1) -> tuple[Array, ...]:
        """Return the parameters of all instances, one array for each parameter, repeated for a number of times."""
        rows = np.array([one.parameters for one in self.found.instances]).reshape(len(self.found.instances), -1)
        return tuple(np.tile(rows.T, times))

    def rates(self, u: Array, p: tuple[Array, ...], t: Array, y: Array) -> Array:
        """Return the time derivatives of states, costates and derivatives of the states."""
        n, model = len(self.found.costates), self.model
        x, lam = y[:n], y[n : 2 * n]
        rows = [model.dynamics_batch(t, x, u, p), model.costate_rate_batch(t, x, u, lam, p)]
        rows = [np.broadcast_to(each, x.shape) for each in rows]
        if len(y) > 2 * n:
            slopes = np.broadcast_to(model.jacobian_x_batch(t, x, u, p), (n, n, len(t)))
            rows.append(np.einsum("ijk,cjk->cik", slopes, y[2 * n :].reshape(-1, n, len(t))).reshape(-1, len(t)))
        return np.concatenate(rows)


def minima(found: Arrivals) -> NDArray[np.bool_]:
    """Return which extremals are clearly strict local minima (verdict ``local minimum``), shape (M,)."""
    fine = np.zeros(len(found.instances), dtype=bool)
    chosen = np.flatnonzero(found.solved)
    if len(chosen):
        with np.errstate(all="ignore"):
            own = found.only(chosen)
            flow = _flow(own)
            clear = (flow.error <= TOLERANCE) & _ended(own, flow) & _switching(own, flow) & _curved(own, flow)
        fine[chosen] = clear & _kernels_agree(own, flow)
    return fine


def _flow(found: Arrivals) -> _Flow:
    """Integrate the arcs from initial states, costates and switching times; the conditions are checked afterwards."""
    many, (n, count) = _Many(found), found.costates.shape
    initial = np.array([one.initial for one in found.instances]).T
    start = np.array([one.t0 for one in found.instances])
    edges = np.concatenate([start[None], found.times, (start + found.durations)[None]])
    low, high = (np.array([getattr(one, side) for one in found.instances]).T for side in ("lower", "upper"))
    p, switches = many.parameters(), len(found.times)
    sigma = np.broadcast_to(many.model.switching_function_batch(start, initial, found.costates, p), low.shape)
    u = np.where(sigma > 0.0, low, high)
    y = np.concatenate([initial, found.costates, np.zeros((n * switches, count))])
    values, controls, error = [y], [], np.zeros(count)
    for k in range(switches + 1):
        begin, length = edges[k], edges[k + 1] - edges[k]
        controls.append(u)
        y, off = _along(many, u, p, begin, length, y)
        error = np.maximum(error, off)
        if k < switches:
            which = np.arange(len(low))[:, None] == found.controls[k]
            before = many.model.dynamics_batch(edges[k + 1], y[:n], u, p)
            u = np.where(which, low + high - u, u)
            jump = before - many.model.dynamics_batch(edges[k + 1], y[:n], u, p)
            y[2 * n + k * n : 2 * n + (k + 1) * n] = jump
        values.append(y)
    return _Flow(edges[:-1], np.diff(edges, axis=0), np.array(controls), np.array(values), error)


def _along(many: _Many, u: Array, p: tuple[Array, ...], t: Array, h: Array, y: Array) -> tuple[Array, Array]:
    """Return the values at the end of an arc, and the largest relative error, shape (M,)."""
    for parts in PARTS:
        now, worst = y, np.zeros(len(t))
        for part in range(parts):
            step = h / parts
            now, off = leap_and_error(lambda t, y: many.rates(u, p, t, y), t + part * step, now, step)
            n = len(many.found.costates)
            sizes = np.maximum(np.maximum(np.abs(now), np.abs(y)), 1e-300)
            groups = (slice(0, n), slice(n, 2 * n), slice(2 * n, None))
            for group in groups:
                if len(off[group]):
                    worst = np.maximum(worst, off[group].max(axis=0) / sizes[group].max(axis=0))
        if (worst <= TOLERANCE).all():
            break
    return now, np.where(np.isfinite(worst), worst, np.inf)


def _ended(found: Arrivals, flow: _Flow) -> NDArray[np.bool_]:
    """Return whether the motion reaches its final state, and the Hamiltonian satisfies the condition of a free time."""
    many, n = _Many(found), len(found.costates)
    x, lam = flow.values[:, :n], flow.values[:, n : 2 * n]
    tf = flow.begins[-1] + flow.lengths[-1]
    _, on_reference, target = stated(found.instances).swapaxes(1, 2)
    p = many.parameters()
    slip = _slip(many, tf, p)
    if on_reference.any():
        target = np.where(on_reference > 0.0, many.model.reference_batch(tf, p), target)
    middle = np.array([0.5 * (np.array(one.lower) + one.upper) for one in found.instances]).T
    undriven, _ = leap_and_error(
        lambda t, y: np.broadcast_to(many.model.dynamics_batch(t, y, np.zeros_like(middle), p), y.shape),
        flow.begins[0],
        x[0],
        found.durations,
        4,
    )
    sizes = np.maximum(np.abs(x).max(axis=0), 1e-300)
    moved = np.minimum(np.nan_to_num(np.abs(x[-1] - undriven) / sizes, nan=1.0).max(axis=0), 1.0)
    residual = (np.abs(x[-1] - target) / np.maximum(sizes * moved, NEGLIGIBLE * sizes)).max(axis=0)
    rates = many.model.dynamics_batch(tf, x[-1], flow.u[-1], p)
    h = many.model.hamiltonian_batch(tf, x[-1], flow.u[-1], lam[-1], p) - (lam[-1] * slip).sum(axis=0)
    terms = np.maximum(np.abs(lam[-1] * rates).sum(axis=0), np.abs(lam[-1] * slip).sum(axis=0))
    precise = RESIDUAL if not on_reference.any() else 10.0 * RESIDUAL  # the reference's rate is a difference
    return np.asarray((residual <= RESIDUAL) & (np.abs(h) <= precise * np.maximum(terms, 1e-300)))


def _slip(many: _Many, tf: Array, p: tuple[Array, ...]) -> Array:
    """Return the time derivative of a final state that is on the reference, shape (n, M)."""
    _, on_reference, target = stated(many.found.instances).swapaxes(1, 2)
    if not on_reference.any():
        return np.zeros_like(target)
    step = 1e-6 * np.maximum(np.abs(tf), 1.0)
    before, after = (np.broadcast_to(many.model.reference_batch(t, p), target.shape) for t in (tf - step, tf + step))
    return np.where(on_reference > 0.0, (after - before) / (2.0 * step), 0.0)


def _switching(found: Arrivals, flow: _Flow) -> NDArray[np.bool_]:
    """Return whether switching functions have simple zeros at switches and correct signs elsewhere, with constant H."""
    many, n, lasting = _Many(found), len(found.costates), found.durations
    arcs, count = flow.lengths.shape
    t, sigma, h, terms = _looked_at(many, flow)
    size = np.maximum(np.abs(sigma).max(axis=(0, 1)), 1e-300)
    u, bounds = (
        flow.u[:, None],
        [np.array([getattr(one, side) for one in found.instances]).T for side in ("lower", "upper")],
    )
    low, high = bounds
    right = np.where(u < 0.5 * (low + high), sigma > 0.0, sigma < 0.0) | (low == high)
    real = flow.lengths > 0.0
    fine = (right.all(axis=(1, 2)) | ~real).all(axis=0) & (low < high).all(axis=0)
    away = np.full((*t.shape[:2], len(low), count), True)
    last = np.broadcast_to(flow.begins[0], (len(low), count)).copy()
    p, gaps = many.parameters(), np.full(count, np.inf)
    for k in range(arcs - 1):
        on = found.controls[k] >= 0
        edge, z = found.times[k], flow.values[k + 1]
        x, lam = z[:n], z[n : 2 * n]
        which = (np.arange(len(low))[:, None] == found.controls[k]) & on
        own = np.broadcast_to(many.model.switching_function_batch(edge, x, lam, p), low.shape)
        rate = np.broadcast_to(many.model.switching_rate_batch(edge, x, flow.u[k], lam, p), low.shape)
        strict = (np.abs(own) <= TIMES * lasting * np.abs(rate)) & (np.abs(rate) * lasting > STRICT * size)
        fine &= (strict | ~which).all(axis=0)
        gaps = np.minimum(gaps, np.where(which, edge - last, np.inf).min(axis=0))
        last = np.where(which, edge, last)
        away &= ~which | (np.abs(t - edge)[:, :, None] > CLOSE_TO_SWITCH * lasting)
    gaps = np.minimum(gaps, (flow.begins[0] + lasting - last).min(axis=0))
    for t, z in ((flow.begins[0], flow.values[0]), (flow.begins[-1] + flow.lengths[-1], flow.values[-1])):
        beside = np.abs(many.model.switching_function_batch(t, z[:n], z[n : 2 * n], p)) * (high - low)
        fine &= (np.broadcast_to(beside, low.shape) > AT_SWITCH * size).all(axis=0)  # a switch is not there itself
    away &= real[:, None, None]
    distance = np.where(away, np.abs(sigma) / size, np.inf).min(axis=(0, 1, 2))
    drift = np.abs(h).max(axis=(0, 1)) <= DRIFT * np.maximum(terms.max(axis=(0, 1)), 1e-300)
    return np.asarray(fine & (gaps > STRICT * lasting) & (distance > STRICT) & drift & _within(many, flow))


def _looked_at(many: _Many, flow: _Flow) -> tuple[Array, Array, Array, Array]:
    """Return times (K, L, M), switching functions (K, L, m, M), change of H and size of its terms within arcs.

    Switching functions are multiplied by the width of the bounds; H and its terms have shape (K, L, M).
    """
    n, (arcs, count) = len(many.found.costates), flow.lengths.shape
    m, each = flow.u.shape[1], len(PLACES)
    begins = np.repeat(flow.begins[:, None], each, axis=1)
    lengths = flow.lengths[:, None] * PLACES[:, None]
    u = np.repeat(flow.u[:, None], each, axis=1).transpose(2, 0, 1, 3).reshape(m, -1)
    y = np.repeat(flow.values[:-1, None, : 2 * n], each, axis=1).transpose(2, 0, 1, 3).reshape(2 * n, -1)
    t, step, p = begins.ravel(), lengths.ravel(), many.parameters(arcs * each)
    for part in range(PARTS[1]):
        half = step / PARTS[1]
        y, _ = leap_and_error(lambda t, y: many.rates(u, p, t, y), t + part * half, y, half)
    t, shape = t + step, (arcs, each, count)
    x, lam = y[:n], y[n:]
    sigma = np.broadcast_to(many.model.switching_function_batch(t, x, lam, p), (m, len(t)))
    h = np.broadcast_to(many.model.hamiltonian_batch(t, x, u, lam, p), t.shape).reshape(shape)
    rates = np.abs(lam * many.model.dynamics_batch(t, x, u, p)).sum(axis=0).reshape(shape)
    width = np.array([np.array(one.upper) - one.lower for one in many.found.instances]).T
    signs = sigma.reshape(m, *shape).transpose(1, 2, 0, 3) * width
    first = h[:1, :1]
    return t.reshape(shape), signs, np.where(flow.lengths[:, None] > 0.0, h - first, 0.0), rates


def _within(many: _Many, flow: _Flow) -> NDArray[np.bool_]:
    """Return whether all states that must be positive are positive, shape (M,)."""
    names, n = many.model.spec.states, len(many.found.costates)
    places = [i for i, one in enumerate(names) if one.positive]
    return np.asarray((flow.values[:, :n][:, places] > 0.0).all(axis=(0, 1)))


def _curved(found: Arrivals, flow: _Flow) -> NDArray[np.bool_]:
    """Return whether the second variation is positive for all changes of the times that keep the final state.

    The costates of a linear motion do not depend on the switching times. The Hessian of the Lagrangian with respect to
    the times, for fixed final costates, therefore has the rates of the jumps of H on its diagonal, the same rates with
    opposite sign in the row and column of the final time, and one more entry for the final time itself.
    """
    n, count = found.costates.shape
    many, last, switches = _Many(found), flow.values[-1], (found.controls >= 0).sum(axis=0)
    tf, p = flow.begins[-1] + flow.lengths[-1], many.parameters()
    x, lam, u = last[:n], last[n : 2 * n], flow.u[-1]
    approach = np.broadcast_to(many.model.dynamics_batch(tf, x, u, p), (n, count)) - _slip(many, tf, p)
    fall = -(np.broadcast_to(many.model.costate_rate_batch(tf, x, u, lam, p), (n, count)) * approach).sum(axis=0)
    by_times, rates = last[2 * n :].reshape(-1, n, count), _jump_rates(found, flow)
    moved = np.maximum(np.abs(by_times).max(axis=0, initial=0.0), np.abs(approach)) * found.durations
    sizes = np.maximum(np.maximum(np.abs(flow.values[:, :n]).max(axis=0), moved), 1e-300)
    fine = np.zeros(count, dtype=bool)
    for used in distinct(switches).tolist():
        own = np.flatnonzero(switches == used)
        by = np.concatenate([by_times[:used, :, own], approach[None, :, own]]).transpose(2, 1, 0)
        hessian = np.zeros((len(own), used + 1, used + 1))
        places = np.arange(used)
        hessian[:, places, places] = rates[:used, own].T
        hessian[:, places, used] = hessian[:, used, places] = -rates[:used, own].T
        hessian[:, used, used] = fall[own]
        fine[own] = positive_across(by * found.durations[own, None, None] / sizes.T[own, :, None], hessian)
    return fine


def positive_across(by: Array, hessian: Array) -> NDArray[np.bool_]:
    """Return whether quadratic forms (K, P, P) are positive on the null spaces of linear maps (K, n, P)."""
    finite = np.asarray(np.isfinite(by).all(axis=(1, 2)) & np.isfinite(hessian).all(axis=(1, 2)))
    by, hessian = (np.where(finite[:, None, None], table, 0.0) for table in (by, hessian))
    _, values, rows = np.linalg.svd(by)
    fine: NDArray[np.bool_] = np.asarray(finite & (values[:, -1] > INDEPENDENT * values[:, 0]))
    if rows.shape[1] > values.shape[1]:
        free = rows[:, values.shape[1] :]
        form = free @ hessian @ free.swapaxes(1, 2)
        size = np.maximum(np.abs(hessian).max(axis=(1, 2)), 1e-300)
        fine &= np.linalg.eigvalsh(form)[:, 0] > CURVED * size
    return fine


def _jump_rates(found: Arrivals, flow: _Flow) -> Array:
    """Return the rates of change of the jumps of H at the switching times, shape (S, M).

    Arbitrary for unused entries.
    """
    many, n, count = _Many(found), len(found.costates), found.costates.shape[1]
    rates, p = np.empty(found.times.shape), many.parameters()
    for k, which in enumerate(found.controls):
        z, u, v = flow.values[k + 1], flow.u[k], flow.u[k + 1]
        rate = many.model.switching_rate_batch(found.times[k], z[:n], u, z[n : 2 * n], p)
        rates[k] = (np.broadcast_to(rate, u.shape) * (u - v))[which, np.arange(count)]
    return rates


def _kernels_agree(found: Arrivals, flow: _Flow) -> bool:
    """Return whether the kernels of a model agree with each other near the first extremal.

    Computed once for each model.
    """
    model, n = found.instances[0].model, len(found.costates)
    if model not in _AGREE:
        z, times = flow.values[:, : 2 * n, 0].T, np.append(flow.begins[:, 0], flow.begins[-1, 0] + flow.lengths[-1, 0])
        u = np.append(flow.u[:, :, 0], flow.u[-1:, :, 0], axis=0).T
        one = found.instances[0]
        answer = Solution(one, "bang-bang", Status.CONVERGED, "", 0.0, times, z[:n], u, z[n:], (), 0, (), 0.0)
        blank = Certificate(Verdict.LOCAL_MINIMUM, 0.0, 0.0, 0.0, None, 0.0, None, ())
        _AGREE[model] = with_kernels_examined(blank, answer).verdict is Verdict.LOCAL_MINIMUM
    return _AGREE[model]


_AGREE: WeakKeyDictionary[Kernels, bool] = WeakKeyDictionary()
"""Model -> whether its kernels agree with each other."""
