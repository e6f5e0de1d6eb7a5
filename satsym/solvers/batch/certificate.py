"""Certificate of many extremals with given boundary values, except the comparison with competing extremals.

The conditions are the same as for a single solution. They are evaluated along flows from the initial costates and from
each node to the next. An extremal for which a condition is not clear is left to the certificate of single solutions.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.kernels import Kernels
from satsym.solution import Certificate, Solution
from satsym.solvers.batch.corners import CLEAR_PIVOT, inverses, positive
from satsym.solvers.batch.many import Many
from satsym.solvers.batch.newton import Nodes
from satsym.solvers.certificate.conditions import CANCELLED, COST, DEFECT, DRIFT, RESIDUAL, STATIONARY
from satsym.solvers.certificate.jacobi import TURN, followed
from satsym.solvers.certificate.kernel_consistency import with_kernels_examined
from satsym.solvers.certificate.reintegration.flow import FAINT_COSTATE, NEGLIGIBLE, ROUNDED, TOLERANCE
from satsym.solvers.certificate.reintegration.node_defect import FINE
from satsym.solvers.certificate.reintegration.segments import TURN as QUARTER
from satsym.solvers.certificate.reintegration.segments import balanced
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.scaling import straight
from satsym.solvers.simulation.extrapolation import SUBSTEPS, leap
from satsym.status import Status, Verdict

PARTS = (2, 4, 8)
"""Numbers of steps for each segment, tried in turn until the errors of the flow are small enough."""

UNDRIVEN, VARIATIONS = 4, 5
"""Numbers of columns of the extrapolation table for the uncontrolled motion, and for derivatives."""

PLACES = 9
"""Number of points at which kernels are tested for contradictions."""

ROUGH = 0.01
"""Largest relative error of the derivatives for which the corner test counts as clear."""

FOLLOWED = 1e-4
"""Largest relative error of the transition matrices for which phases are followed from segment to segment."""

HALVINGS = 4
"""Largest number of times that segments are halved."""

WHOLE = 0.9 * 2.0 * np.pi
"""Largest rotation of a phase within a segment, below a full turn, so that no segment has a conjugate point itself."""


@dataclass(frozen=True, eq=False)
class Sizes:
    """Reference magnitudes of states and costates for relative errors, as in ``typical`` of the certificate's flow."""

    state: Array
    largest: Array
    """Largest magnitudes of states and costates along the motion, shapes (n, M)."""
    unit: Array
    """Units of the scaled problem, shape (2n, 1)."""

    @classmethod
    def of(cls, many: Many, z: Array) -> Sizes:
        """Return the reference magnitudes of solutions with values z at the nodes."""
        n, unit, largest = many.states, many.units[:, None], np.abs(z).max(axis=1)
        return cls(np.maximum(largest[:n], NEGLIGIBLE * unit[:n]), largest[n:], unit)

    def costate(self, faint: float) -> Array:
        """Return reference magnitudes of costates, which are at least the fraction `faint` of their unit."""
        product = (self.state * self.largest).max(axis=0)
        found = np.maximum(self.largest, faint * self.unit[len(self.state) :])
        return np.asarray(np.maximum(found, NEGLIGIBLE * product / self.state))

    def both(self, faint: float) -> Array:
        """Return reference magnitudes of states and costates, shape (2n, M)."""
        return np.concatenate([self.state, self.costate(faint)])


def minima(many: Many, nodes: Nodes) -> NDArray[np.bool_]:
    """Return which extremals are clearly strict local minima (verdict ``local minimum``), shape (M,)."""
    found = np.zeros(many.count, dtype=bool)
    chosen = np.flatnonzero(nodes.solved)
    if not len(chosen):
        return found
    with np.errstate(all="ignore"):
        some, z = many.only(chosen), np.ascontiguousarray(nodes.z[:, :, chosen])
        sizes = Sizes.of(some, z)
        clear = _along_flow(some, z, nodes.cost[chosen], sizes)
        clear &= _from_nodes(some, z, sizes)
        clear &= _stationary(some, z)
        clear &= _without_conjugate_points(some, z)
        clear &= _kernels_agree(some.problem)
    found[chosen] = clear
    return found


def _along_flow(many: Many, z: Array, cost: Array, sizes: Sizes) -> NDArray[np.bool_]:
    """Return whether the flow from the initial costates passes the nodes and ends correctly, with constant H.

    The integral of the running cost must also agree with the stated cost.
    """
    n, faint = many.states, sizes.both(FAINT_COSTATE)
    scale = np.concatenate([faint, (faint[:n] * faint[n:]).sum(axis=0)[None]])
    start = np.concatenate([many.initial, z[n:, 0], np.zeros((1, many.count))])
    for parts in PARTS:
        values, error = _flow(many, start, scale, parts)
        if (error <= TOLERANCE).all():
            break
    stations = values[::parts]
    defect = (np.abs(stations[:, :-1].swapaxes(0, 1) - z) / faint[:, None]).max(axis=(0, 1))
    end, flow_cost = stations[-1, :n], stations[-1, -1]
    state, without = sizes.state, _undriven(many, sizes)
    moved = np.minimum((np.abs(end - without) / state).max(axis=0), 1.0)
    rows = np.maximum(state * moved, np.minimum(state, NEGLIGIBLE * sizes.unit[:n]))
    residual = (np.abs(end - many.end) / rows).max(axis=0)
    products = (state * sizes.costate(ROUNDED)).sum(axis=0)
    off_cost = np.abs(flow_cost - cost) / np.maximum(np.maximum(np.abs(flow_cost), CANCELLED * products), 1e-300)
    clear = (error <= TOLERANCE) & (residual <= RESIDUAL) & (defect <= DEFECT) & (off_cost <= COST)
    positive_states = list(many.problem.positive)
    clear &= (values[:, positive_states] > 0.0).all(axis=(0, 1))
    return np.asarray(clear & (_drift(many, stations[:, :-1]) <= DRIFT))


def _flow(many: Many, start: Array, scale: Array, parts: int) -> tuple[Array, Array]:
    """Return values at the ends of parts of segments, shape (K, 2n + 1, M), and the largest relative error, (M,)."""
    values, now, worst = [start], start, np.zeros(many.count)
    for begin, width in zip(many.times[:-1], np.diff(many.times, axis=0), strict=True):
        h = np.zeros(many.count) + width / parts
        for part in range(parts):
            now, error = many.motion.leap(begin + part * h, now, h, many.given, len(SUBSTEPS))
            worst = np.maximum(worst, (error / np.maximum(scale, np.abs(now))).max(axis=0))
            values.append(now)
    return np.array(values), np.where(np.isfinite(worst), worst, np.inf)


def _undriven(many: Many, sizes: Sizes) -> Array:
    """Return approximate final states of the uncontrolled motions, shape (n, M)."""
    model, p = many.instance.model, tuple(many.parameters)
    none, now = np.zeros((len(model.spec.controls), many.count)), many.initial
    times = np.concatenate([many.times[:-1:2], many.times[-1:]])  # only its size matters
    for begin, width in zip(times[:-1], np.diff(times, axis=0), strict=True):
        t, h = np.zeros(many.count) + begin, np.zeros(many.count) + width
        now = leap(lambda t, x: np.asarray(model.dynamics_batch(t, x, none, p)), t, now, h, UNDRIVEN)
    # what is not finite is far away
    return np.where(np.isfinite(now), now, many.end + sizes.state)


def _drift(many: Many, stations: Array) -> Array:
    """Return the largest change of the Hamiltonian along stations (K, 2n, M), relative to its terms.

    Zero if H depends on t.
    """
    if not many.instance.model.spec.autonomous:
        return np.zeros(many.count)
    n, model = many.states, many.instance.model
    t, x, lam, u, p = _flat(many, stations.swapaxes(0, 1))
    h = np.broadcast_to(model.hamiltonian_batch(t, x, u, lam, p), t.shape).reshape(-1, many.count)
    rates = np.abs(lam * np.asarray(model.dynamics_batch(t, x, u, p))).reshape(n, -1, many.count)
    terms = np.maximum(rates.sum(axis=0).max(axis=0), np.abs(h).max(axis=0))
    return np.asarray(np.abs(h - h[0]).max(axis=0) / np.maximum(terms, 1e-300))


def _flat(many: Many, z: Array) -> tuple[Array, Array, Array, Array, tuple[Array, ...]]:
    """Return times, states, costates, controls by the control law, and parameters at all nodes, one column for each."""
    n, count = many.states, z.shape[1]
    flat, t = z.reshape(len(z), -1), many.at_nodes(slice(None))
    p, bounds = many.arguments(count)
    u = np.asarray(many.instance.model.control_law_batch(t, flat[:n], flat[n:], p, bounds))
    return t, flat[:n], flat[n:], u, p


def _from_nodes(many: Many, z: Array, sizes: Sizes) -> NDArray[np.bool_]:
    """Return whether the canonical equations lead from each node to the next one."""
    t, start, h, p = many.segments(z)
    ends, scale = (
        np.ascontiguousarray(z[:, 1:]).reshape(len(z), -1),
        np.tile(sizes.both(FAINT_COSTATE), len(many.mesh) - 1),
    )
    for parts in PARTS:
        now, error = np.concatenate([start, np.zeros((1, len(t)))]), np.zeros(len(t))
        for part in range(parts):
            now, off = many.motion.leap(t + part * h / parts, now, h / parts, p, len(SUBSTEPS) - 2)
            error = np.maximum(error, (off[:-1] / scale).max(axis=0))
        if (error <= FINE).all():
            break
    missed = (np.abs(now[:-1] - ends) / scale).max(axis=0)
    return np.asarray(((missed <= DEFECT) & (error <= FINE)).reshape(-1, many.count).all(axis=0))


def _stationary(many: Many, z: Array) -> NDArray[np.bool_]:
    """Return whether the Hamiltonian is stationary in the controls at all nodes, with a strict minimum."""
    t, x, lam, u, p = _flat(many, z)
    model, m = many.instance.model, len(u)
    slope = np.asarray(model.stationarity_batch(t, x, u, lam, p)).reshape(m, -1, many.count)
    hessian = np.asarray(model.control_hessian_batch(t, x, u, lam, p)).reshape(m, m, -1, many.count)
    large = (np.abs(hessian) * np.abs(u).reshape(1, m, -1, many.count)).sum(axis=1).max(axis=(0, 1))
    if many.bounded:
        slope = _uphill(many, u.reshape(slope.shape), slope, hessian)
    off = np.abs(slope).max(axis=(0, 1)) / np.maximum(large, 1e-300)
    least = np.linalg.eigvalsh(hessian.transpose(2, 3, 0, 1))[..., 0].min(axis=0)
    return np.asarray(((off <= STATIONARY) | (large == 0.0)) & (least > 0.0))


def _uphill(many: Many, u: Array, slope: Array, hessian: Array) -> Array:
    """Return the projected gradient of H with respect to the controls, shape (m, N+1, M), which vanishes at a minimum.

    Components that point out of the bounds of active controls are removed.
    """
    steepness = np.maximum(np.einsum("iikm->km", np.abs(hessian)), 1e-300)
    moved = u - slope / steepness
    if many.problem.control_set.kind == "ball":
        moved = moved * np.minimum(many.radius / np.maximum(np.linalg.norm(moved, axis=0), 1e-300), 1.0)
    else:
        moved = np.minimum(np.maximum(moved, many.lower[:, None]), many.upper[:, None])
    return np.asarray((u - moved) * steepness)


def _without_conjugate_points(many: Many, z: Array, halvings: int = HALVINGS) -> NDArray[np.bool_]:
    """Return which extremals clearly have no conjugate point; segments with a large rotation of phases are halved."""
    scale = _balanced(many, z)
    if many.bounded:
        free = replace(many, bounded=False)  # where a bound is met rates change, at most to what they are without
        turning = np.sqrt(many.states) * np.maximum(_turning(many, z, scale), _turning(free, z, scale))
        judged, short = _phases_clear, turning < QUARTER
    else:
        judged, short = _corners_positive, _turning(many, z, scale) < WHOLE
    found, near, far = np.zeros(many.count, dtype=bool), np.flatnonzero(short), np.flatnonzero(~short)
    if len(near):
        found[near] = judged(many.only(near), z[:, :, near], scale)
    if len(far) and halvings:
        found[far] = _without_conjugate_points(*_halved(many.only(far), z[:, :, far]), halvings - 1)
    return found


def _halved(many: Many, z: Array) -> tuple[Many, Array]:
    """Return the problems on a mesh with twice as many segments, and the values at its nodes."""
    t, start, h, p = many.segments(z)
    costing = np.concatenate([start, np.zeros((1, len(t)))])
    middles = many.motion.leap(t, costing, h / 2.0, p, len(SUBSTEPS))[0][:-1]
    found = np.empty((len(z), 2 * len(many.mesh) - 1, many.count))
    found[:, ::2], found[:, 1::2] = z, middles.reshape(len(z), -1, many.count)
    mesh = np.empty((found.shape[1], many.mesh.shape[1]))
    mesh[::2], mesh[1::2] = many.mesh, (many.mesh[1:] + many.mesh[:-1]) / 2.0
    return replace(many, mesh=mesh), found


def _varied(many: Many, z: Array, scale: Array) -> tuple[Array, Array]:
    """Return the transition matrices of the segments, and their errors, shapes (2n, 2n, N, M)."""
    rows, ratio = len(z), (scale / scale[:, None])[:, :, None, None]
    _, transition, off = many.motion.leap_varied(*many.segments(z), VARIATIONS)
    whole, wrong = (one.reshape(rows, rows, -1, many.count) * ratio for one in (transition, off))
    return whole, wrong


def _phases_clear(many: Many, z: Array, scale: Array) -> NDArray[np.bool_]:
    """Return whether no phase comes near a full turn; used where controls are at bounds and the corner test fails."""
    whole, wrong = _varied(many, z, scale)
    found = np.asarray(wrong.max(axis=(0, 1, 2)) <= FOLLOWED * np.abs(whole).max(axis=(0, 1, 2)))
    for k in np.flatnonzero(found):
        phases = followed(whole[..., k].transpose(2, 0, 1))
        found[k] = phases is not None and bool((phases.values < (1.0 - CLEAR_PIVOT) * TURN).all())
    return found


def _corners_positive(many: Many, z: Array, scale: Array) -> NDArray[np.bool_]:
    """Return whether broken extremals with corners at the nodes clearly cost more."""
    n, (whole, wrong) = many.states, _varied(many, z, scale)
    across, doubt = (one[:n, n:].transpose(3, 2, 0, 1) for one in (whole, wrong))
    inverse = inverses(across)
    error = (np.abs(inverse) @ doubt).max(axis=(1, 2, 3))
    return np.asarray((error < ROUGH) & positive(whole, inverse))


def _balanced(many: Many, z: Array) -> Array:
    """Return units, from the first solution, in which transition matrices are symplectic and phases rotate slowly."""
    first = many.only(np.arange(1))
    return balanced(many.units, np.abs(_slopes(first, z[:, :, :1])).max(axis=(2, 3)), many.problem.duration)


def _slopes(many: Many, z: Array) -> Array:
    """Return the Jacobians of the canonical equations at the nodes, shape (2n, 2n, N+1, M)."""
    t, x, lam, _, p = _flat(many, z)
    table = many.instance.model.canonical_jacobian_batch(t, x, lam, p, many.arguments(z.shape[1])[1])
    return np.asarray(table).reshape(len(z), len(z), -1, many.count)


def _turning(many: Many, z: Array, scale: Array) -> Array:
    """Return an upper bound of the rotation of phases within a segment, shape (M,)."""
    slopes = _slopes(many, z) * (scale / scale[:, None])[:, :, None, None]
    rates = 2.0 * np.sqrt(np.einsum("ijkm,ijkm->km", slopes, slopes))
    return np.asarray((np.maximum(rates[1:], rates[:-1]) * np.diff(many.times, axis=0)).max(axis=0))


def _kernels_agree(problem: TwoPoint) -> bool:
    """Return whether the kernels of a model agree with each other near the line from initial to final state.

    The result is computed once for each model, because contradicting kernels contradict each other everywhere.
    """
    model = problem.instance.model
    if model not in _AGREE:
        states, unit = straight(problem), problem.scale.both
        tau = np.linspace(0.0, 1.0, PLACES)
        x = (states[:, :1] + (states[:, 1:] - states[:, :1]) * tau) * unit[: len(states)]
        lam = unit[len(states) :] * np.cos(np.arange(len(states))[:, None] + tau)
        t, p = problem.instance.t0 + problem.duration * tau, problem.instance.parameters
        u = np.asarray(model.control_law_batch(t, x, lam, p, problem.control_set.arguments))
        answer = Solution(problem.instance, "shooting", Status.CONVERGED, "", 0.0, t, x, u, lam, (), 0, (), 0.0)
        blank = Certificate(Verdict.LOCAL_MINIMUM, 0.0, 0.0, 0.0, None, 0.0, None, ())
        _AGREE[model] = with_kernels_examined(blank, answer).verdict is Verdict.LOCAL_MINIMUM
    return _AGREE[model]


_AGREE: WeakKeyDictionary[Kernels, bool] = WeakKeyDictionary()
"""Model -> whether its kernels agree with each other."""
