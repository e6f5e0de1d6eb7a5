"""The second variation of a bang-bang extremal in its switching times and its final time.

With the levels given, a control is its switching times. The Hessian of the Lagrangian in these, on the kernel of the
derivatives of what is given at the end, is positive where the extremal, if it switches strictly, is a strict strong
local minimum (Agrachev, Stefani and Zezza, Strong optimality for a bang-bang trajectory, SIAM Journal on Control and
Optimization 41, 2002; Osmolovskii and Maurer, Applications to Regular and Bang-Bang Control, 2012).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers.certificate.switching.replay import Replay
from satsym.solvers.collocation.scaling import final_argument

RANK = 1e-9
"""Smallest singular value, relative to the largest, of a derivative that counts."""

ALONG = 1.0 - 1e-6
"""Least cosine between directions that are the same."""


@dataclass(frozen=True, eq=False)
class Variation:
    """First and second derivatives in the times."""

    hessian: Array
    """Of the Lagrangian, shape (P, P), in units of time that make its diagonal entries comparable."""
    constraints: Array
    """What is given at the end by the times, shape (c, P)."""
    asymmetry: float
    """Of the Hessian, relative: zero but for errors of integration."""

    @property
    def kernel(self) -> Array:
        """Directions in which the end stays as given, shape (P, k)."""
        if not self.constraints.size:
            return np.eye(self.hessian.shape[0])
        scaled = self.constraints / np.maximum(np.abs(self.constraints).max(axis=1, keepdims=True), 1e-300)
        _, values, rows = np.linalg.svd(scaled)
        rank = int((values > RANK * max(float(values.max(initial=0.0)), 1e-300)).sum())
        return np.asarray(rows[rank:].T)

    @property
    def curvature(self) -> float:
        """Smallest eigenvalue on that kernel, relative; infinite where the end fixes all times."""
        reduced = self._reduced
        return float(np.linalg.eigvalsh(reduced).min()) if reduced.size else float("inf")

    @property
    def _reduced(self) -> Array:
        """The Hessian on that kernel, relative to its largest entry."""
        size = 2.0 * max(float(np.abs(self.hessian).max(initial=0.0)), 1e-300)
        return np.asarray(self.kernel.T @ (self.hessian + self.hessian.T) @ self.kernel / size)

    def flat_by_shift(self, flat: float) -> bool:
        """Whether it vanishes where all times are later by as much, in that direction and no other."""
        return flat_along(self._reduced, self.kernel.T @ np.ones(len(self.hessian)), flat)


def flat_along(form: Array, direction: Array, flat: float) -> bool:
    """Whether a form, shape (k, k), vanishes along a direction, shape (k,), and is positive across it.

    Parameters
    ----------
    flat
        Up to which an eigenvalue counts as zero.
    """
    if not form.size:
        return False
    values, axes = np.linalg.eigh(form)
    along = abs(float(axes[:, 0] @ direction)) / max(float(np.linalg.norm(direction)), 1e-300)
    return bool(abs(values[0]) <= flat and (values[1:] > flat).all() and along > ALONG)


def variation(instance: Instance, again: Replay) -> Variation | None:
    """The derivatives; ``None`` where the costates at the end do not determine those at the start."""
    n, free_time = len(instance.initial), instance.tf is None
    switches = [piece for piece in again.pieces if piece.switched is not None]
    count = len(switches) + free_time
    total = np.zeros((2 * n, n + count))
    total[n:, :n] = np.eye(n)
    rows, begun = [], None
    for k, piece in enumerate(again.pieces):
        total = total.copy()
        if begun is not None:
            total[:, begun] -= piece.field.rates(piece.start, piece.before.tolist())
        total = piece.transition @ total
        begun = n + k if piece.switched is not None or free_time else None
        if begun is not None:
            total[:, begun] += piece.field.rates(piece.end, piece.after.tolist())
        if piece.switched is not None:
            rows.append(_jump_row(again, k, total, n + k))
    slopes, last_row = _end(instance, again, total, free_time)
    fixed = np.array(final_argument(instance)).reshape(3, -1)[:2].any(axis=0)
    adjoint = slopes[:n].copy()
    adjoint[fixed] = total[n:][fixed]
    try:
        by_times = -np.linalg.solve(adjoint[:, :n], adjoint[:, n:])
    except np.linalg.LinAlgError:
        return None
    if free_time:
        rows.append(last_row)
    table = np.array(rows).reshape(count, n + count)
    hessian = table[:, n:] + table[:, :n] @ by_times
    constraints = slopes[:n][fixed] if fixed.any() else np.zeros((0, n + count))
    extra = slopes[n : len(slopes)]
    constraints = np.concatenate([constraints, extra])
    by = constraints[:, n:] + constraints[:, :n] @ by_times
    size = max(float(np.abs(hessian).max(initial=0.0)), 1e-300)
    return Variation(hessian, by, float(np.abs(hessian - hessian.T).max(initial=0.0) / size))


def _jump_row(again: Replay, k: int, total: Array, column: int) -> Array:
    """The derivative of the jump of H at a switch, which is that of the cost by its time, by all unknowns."""
    before, after = again.pieces[k], again.pieces[k + 1]
    control, t, z = before.switched, before.end, before.after.tolist()
    assert control is not None
    u, v = before.field.control(t, z)[control], after.field.control(t, z)[control]
    by_weight, weight_rate = before.field.weight_gradient(t, z, control)
    _, rate = before.field.switching(t, z, control)
    gradient = (u - v) * before.field.gradient(t, z, control) + (abs(u) - abs(v)) * by_weight
    row = gradient @ total
    row[column] += (u - v) * rate + (abs(u) - abs(v)) * weight_rate - gradient @ np.array(before.field.rates(t, z))
    return np.asarray(row)


def _end(instance: Instance, again: Replay, total: Array, free_time: bool) -> tuple[Array, Array]:
    """Rows of the generated boundary function by costates and times: of states and constraints, and of the time."""
    n, last = len(instance.initial), again.pieces[-1]
    model, z, t = instance.model, last.after.tolist(), last.end
    u = last.field.control(t, z)
    c = len(model.spec.multipliers)
    kept = instance.control_set.saturated(u).arguments
    arguments = (t, tuple(z[:n]), tuple(z[n:]), (0.0,) * c, instance.parameters, kept, final_argument(instance))
    by = np.array(model.boundary_jacobian(*arguments)).reshape(n + c + 1, -1)
    slopes = by[:, : 2 * n] @ total
    if free_time:
        slopes[:, -1] += by[:, -1]
    return slopes[:-1], slopes[-1]


DRAWN = 200
"""States at which convexity is looked at, around those of the solution."""

ROUNDING = 1e-12
"""Largest relative violation that is none."""


def convex(solution: Solution) -> bool:
    """Whether all states that were drawn show that the problem is convex along an extremal, a global minimum then.

    With the Hamiltonian convex in states and controls, a convex terminal cost and given or free final states, no
    admissible motion is cheaper. With singular arcs that satisfy the strict generalised Legendre-Clebsch condition and
    strict bounds elsewhere, none costs the same either (Mangasarian, Sufficient conditions for the optimal control of
    nonlinear systems, SIAM Journal on Control 4, 1966). It is only asked where the final time is given.
    """
    instance, model = solution.instance, solution.instance.model
    if instance.tf is None or model.spec.multipliers or "reference" in instance.final.values():
        return False
    rng, p, n = np.random.default_rng(0), instance.parameters, len(instance.initial)
    nodes = rng.integers(0, len(solution.times), DRAWN)
    t, lam = solution.times[nodes], solution.lam[:, nodes]
    size = np.abs(solution.x).max(axis=1, keepdims=True) + 1e-300
    x = solution.x[:, nodes] + size * rng.uniform(-2.0, 2.0, (n, DRAWN))
    u = rng.uniform(*instance.control_set.box, (len(solution.u), DRAWN))
    hessian = -model.extremal_jacobian_batch(t, x, u, lam, p)[n:, :n].transpose(2, 0, 1)
    scaled = hessian * (size * size.T)
    least = float(np.linalg.eigvalsh(scaled + scaled.transpose(0, 2, 1)).min())
    # What a control does to the rates of the costates is the mixed derivative; a weight of |u| must not vary either.
    still = model.costate_rate_batch(t, x, np.zeros_like(u), lam, p)
    moved = model.costate_rate_batch(t, x, u, lam, p)
    largest = max(float(np.abs(scaled).max()), float(np.abs(still * size).max()), 1e-300)
    mixed = float(np.abs((moved - still) * size).max())
    return least >= -ROUNDING * largest and mixed <= ROUNDING * largest and _convex_end(solution, x, size)


def _convex_end(solution: Solution, x: Array, size: Array) -> bool:
    """Whether the gradient of the terminal cost grows along every line between states that were drawn."""
    model, p, tf = solution.instance.model, solution.instance.parameters, float(solution.times[-1])
    slopes = np.array([model.terminal_gradient(tf, tuple(column), p) for column in x.T.tolist()]).T
    growth = (np.diff(slopes, axis=1) * np.diff(x, axis=1)).sum(axis=0)
    return bool(growth.min() >= -ROUNDING * max(float(np.abs(slopes * size).max()), 1e-300))
