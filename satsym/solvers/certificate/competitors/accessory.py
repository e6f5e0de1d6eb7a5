"""The second variation as a matrix: what small changes of the control on short pieces make of the cost.

The accessory problem has the linearised motion, the second derivatives of H and the form at the end (Bryson and Ho,
Applied Optimal Control, 6.3). On controls that are constant on pieces it is a quadratic form in finitely many numbers;
where that has a negative eigenvalue, so has the second variation itself. It knows nothing of conjugate times.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import gcd

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.grid import Grid, interleave
from satsym.lapack import lapack
from satsym.solution import Solution
from satsym.solvers.certificate.end_form import end_form
from satsym.solvers.certificate.jacobi import kernel
from satsym.solvers.certificate.reintegration.flow import unit_sizes

PIECES = 50
"""On which the control's change is constant."""

LEFT = 1e-3
"""Share of a piece, or of the largest response of a control, below which a bound leaves nothing of a direction."""

NUDGE = 1e-6
"""Relative change of states and costates that shows how the control law follows them."""

INDEPENDENT = 1e-3
"""Least determinant of products of directions that are far from dependent."""

DROWNED = 1e-8
"""Share of the least weight of a control's change that rounding of the form may come to."""


@dataclass(frozen=True, eq=False)
class Accessory:
    """The second variation on pieces."""

    form: Array
    """In the controls' changes, normed so that these alone would give the unit matrix, and the change of a free final
    time in units of the duration, shape (P, P)."""
    ties: Array
    """Rows that vanish where the end is as given, shape (c, P)."""
    sizes: Array
    """Of the boundary residuals that these ties are about, shape (c,)."""
    duration: Array
    """Change of the final time by the former, shape (P,)."""
    linear: _Linear
    course: _Course
    """The accessory problem at nodes and midpoints of the grid, and what the changes do there."""

    @property
    def smallest(self) -> tuple[float, Array]:
        """The least eigenvalue where the end is kept, and its direction, shape (P,); infinite without any."""
        free = kernel(self.ties)
        if not free.shape[1]:
            return float("inf"), np.zeros(len(self.form))
        form = free.T @ self.form @ free
        values, vectors, *_, failed = lapack().dsyevr(form, range="I", il=1, iu=1)
        if failed or not np.isfinite(form).all():
            return float("nan"), np.zeros(len(self.form))
        return float(values[0]), free @ vectors[:, 0]

    def along(self, directions: Array) -> Along:
        """What some directions do, shape (P, k)."""
        own = directions[: len(self.course.cost)]
        followed = self.linear.feedback @ self.course.states(own)
        controls = (followed + self.linear.direct @ self.course.weights(own)).transpose(1, 0, 2)
        return Along(self.ties @ directions, controls, self.duration @ directions)


@dataclass(frozen=True, eq=False)
class Along:
    """What k directions of changes do, which is all that is asked of those that are combinations of them."""

    ties: Array
    """To what ties the end, shape (c, k)."""
    controls: Array
    """To the controls at nodes and midpoints of the grid, shape (m, 2 N + 1, k)."""
    duration: Array
    """To the final time, shape (k,)."""


def accessory(solution: Solution, grid: Grid) -> Accessory | None:
    """The second variation of a solution.

    Parameters
    ----------
    solution
        Whose.
    grid
        On which the linearised motion is integrated.

    Returns
    -------
    Accessory
        ``None`` where numbers fail, or motions part so quickly that rounding drowns the form.
    """
    times = interleave(grid.nodes, grid.midpoints)
    z = np.array([np.interp(times, solution.times, row) for row in np.concatenate([solution.x, solution.lam])])
    linear = _Linear.of(solution, times, z)
    if linear is None:
        return None
    course = _Course.of(linear, grid)
    arrived, inside = course.begun[-1], course.cost
    (n, pieces), free_time = arrived.shape, int(solution.instance.tf is None)
    arriving = np.zeros((n + free_time, pieces + free_time))
    arriving[:n, :pieces], arriving[n:, pieces:] = arrived, np.eye(free_time)
    end = end_form(solution, linear.scale)
    form = arriving.T @ end.form @ arriving
    form[:pieces, :pieces] += inside + np.eye(pieces)
    largest = max(np.abs(inside).max(initial=0.0), (np.abs(end.form) @ arriving**2).max(initial=0.0))
    if not largest * np.finfo(float).eps < DROWNED:
        return None
    duration = np.append(np.zeros(pieces), np.full(free_time, grid.tf - grid.t0))
    return Accessory(form, end.ties @ arriving, end.sizes, duration, linear, course)


@dataclass(frozen=True, eq=False)
class _Linear:
    """The accessory problem at M times: x' = motion x + push w, costs (x' restoring x + w'w) / 2, in scaled states.

    Controls change by feedback x + direct w; effective projects on those w that bounds leave.
    """

    scale: Array
    motion: Array
    push: Array
    restoring: Array
    feedback: Array
    direct: Array
    effective: Array

    @classmethod
    def of(cls, solution: Solution, t: Array, z: Array) -> _Linear | None:
        instance, n = solution.instance, len(z) // 2
        model, p, bounds = instance.model, instance.parameters, instance.control_set.arguments
        scale = unit_sizes(solution)
        slopes = model.canonical_jacobian_batch(t, z[:n], z[n:], p, bounds).transpose(2, 0, 1)
        slopes = slopes * (scale / scale[:, None])
        law = _law_slopes(solution, t, z, scale)
        u = model.control_law_batch(t, z[:n], z[n:], p, bounds)
        by_control = model.jacobian_u_batch(t, z[:n], u, p).transpose(2, 0, 1) / scale[:n, None]
        if not (np.isfinite(slopes).all() and np.isfinite(law).all() and np.isfinite(by_control).all()):
            return None
        # The law follows the costates as -K B', with the inverse K of H_uu where no bound holds, and zero elsewhere.
        inverse = -law[:, :, n:] @ _pseudoinverses(by_control.transpose(0, 2, 1))
        size = np.sqrt(np.maximum(np.einsum("kii->ki", inverse).max(axis=0), 0.0))[:, None]
        size[size == 0.0] = 1.0
        values, axes = _principal((inverse + inverse.transpose(0, 2, 1)) / (2.0 * size * size.T))
        root = (axes * np.sqrt(np.maximum(values, 0.0))[:, None, :]) @ axes.transpose(0, 2, 1)
        effective = (axes * (values > LEFT)[:, None, :]) @ axes.transpose(0, 2, 1)
        restoring = -(slopes[:, n:, :n] + slopes[:, n:, :n].transpose(0, 2, 1)) / 2.0
        return cls(
            scale, slopes[:, :n, :n], by_control * size.T @ root, restoring, law[:, :, :n], size * root, effective
        )


def _law_slopes(solution: Solution, t: Array, z: Array, scale: Array) -> Array:
    """The control law by scaled states and costates, by differences, shape (M, m, 2n)."""
    instance, n = solution.instance, len(z) // 2
    size = np.maximum(np.abs(z).max(axis=1), NUDGE * scale)
    change = NUDGE * size[:, None] * np.concatenate([np.eye(2 * n), -np.eye(2 * n)], axis=1)
    moved = (z[:, None] + change[:, :, None]).reshape(2 * n, -1)
    p, bounds = instance.parameters, instance.control_set.arguments
    law = np.asarray(instance.model.control_law_batch(np.tile(t, 4 * n), moved[:n], moved[n:], p, bounds))
    ahead, behind = np.split(law.reshape(len(law), 4 * n, len(t)), 2, axis=1)
    found: Array = (ahead - behind).transpose(2, 0, 1) * (scale / (2.0 * NUDGE * size))
    return found


def _diagonal(matrices: Array) -> Array | None:
    """Of a stack of matrices of which all are diagonal, shape (M, m): so they are where no control acts on another."""
    found = np.einsum("kii->ki", matrices)
    return found if np.count_nonzero(matrices) == np.count_nonzero(found) else None


def _principal(symmetric: Array) -> tuple[Array, Array]:
    """Eigenvalues and axes of a stack of symmetric matrices, those of diagonal ones in their own order."""
    diagonal = _diagonal(symmetric)
    if diagonal is not None:
        return diagonal, np.broadcast_to(np.eye(diagonal.shape[1]), symmetric.shape)
    values, axes = np.linalg.eigh(symmetric)
    return values, axes


def _pseudoinverses(matrices: Array) -> Array:
    """Of a stack of matrices, shape (M, m, n), to (M, n, m)."""
    size = np.linalg.norm(matrices, axis=2, keepdims=True)
    unit = matrices / np.where(size > 0.0, size, 1.0)
    across = unit @ unit.transpose(0, 2, 1)
    diagonal = _diagonal(across)
    if diagonal is not None and diagonal.all():  # controls act at right angles
        return np.asarray(unit.transpose(0, 2, 1) / (diagonal[:, None] * size.transpose(0, 2, 1)))
    if (np.linalg.det(across) > INDEPENDENT).all():
        return np.asarray(np.linalg.solve(across, unit).transpose(0, 2, 1) / size.transpose(0, 2, 1))
    return np.linalg.pinv(matrices)


@dataclass(frozen=True, eq=False)
class _Course:
    """What P changes do over time; each is constant on its piece and costs half its square."""

    begun: Array
    """States where each piece begins, and at the end, by the changes, shape (pieces + 1, n, P)."""
    cost: Array
    """What states cost by the changes, shape (P, P)."""
    shapes: Array
    """Of the controls on each piece, shape (pieces, m, P)."""
    place: Array
    """Where nodes and midpoints lie among the middles of the pieces, from zero to the last, shape (2N+1,)."""
    within: Array
    """States at nodes by those where their piece begins and by its controls, shape (pieces, r, n + m, n + m)."""
    between: Array
    """States at midpoints by those at the node before and by the controls, shape (N, n, n + m)."""

    @classmethod
    def of(cls, linear: _Linear, grid: Grid) -> _Course:
        """By the classical Runge-Kutta method and, for the midpoints, Hermite's interpolation.

        The latter is as linear in states and changes at the beginning of a step as its end is. All steps of a piece
        are taken together before anything is said of what the changes do, which are many.
        """
        n, pieces = linear.motion.shape[1], gcd(grid.steps, PIECES)
        edges = np.arange(0, grid.steps + 1, grid.steps // pieces)
        shapes, steps = _shapes(linear, grid, edges), _steps(linear, grid)
        both, h = np.concatenate([linear.motion, linear.push], axis=2), grid.widths[:, None, None]
        between = (np.eye(n, steps.shape[2]) + steps[:, :n]) / 2.0 + h / 8.0 * (both[:-2:2] - both[2::2] @ steps)
        costs = between.transpose(0, 2, 1) @ (linear.restoring[1::2] * grid.midpoint_weights[:, None, None]) @ between
        at_nodes = linear.restoring[::2] * grid.node_weights[:, None, None]
        costs[:, :n, :n] += at_nodes[:-1]

        whole, within = np.repeat(np.eye(steps.shape[2])[None], pieces, axis=0), []
        cost = np.zeros_like(whole)
        shape = (pieces, -1, *steps.shape[1:])
        for step, own in zip(*(one.reshape(shape).swapaxes(0, 1) for one in (steps, costs)), strict=True):
            within.append(whole)
            cost += whole.transpose(0, 2, 1) @ own @ whole
            whole = step @ whole
        driven, begun = whole[:, :n, n:] @ shapes, np.zeros((pieces + 1, n, shapes.shape[2]))
        for k, carried in enumerate(whole[:, :n, :n]):
            np.matmul(carried, begun[k], out=begun[k + 1])
            begun[k + 1] += driven[k]
        given = np.concatenate([begun[:-1], shapes], axis=1)
        weighed = (cost @ given).reshape(pieces * given.shape[1], given.shape[2])
        inside = given.reshape(weighed.shape).T @ weighed + begun[-1].T @ at_nodes[-1] @ begun[-1]
        times, middles = interleave(grid.nodes, grid.midpoints), (grid.nodes[edges[1:]] + grid.nodes[edges[:-1]]) / 2.0
        place = np.interp(times, middles, np.arange(len(middles)))
        return cls(begun, inside, shapes, place, np.stack(within, axis=1), between)

    def states(self, changes: Array) -> Array:
        """What changes, shape (P, k), do to the states at nodes and midpoints, shape (2N+1, n, k)."""
        n = self.begun.shape[1]
        begun, own = self.begun @ changes, self.shapes @ changes
        given = np.concatenate([begun[:-1], own], axis=1)
        nodes = (self.within @ given[:, None]).reshape(len(self.between), -1, changes.shape[1])
        found = np.empty((2 * len(nodes) + 1, n, changes.shape[1]))
        found[:-1:2], found[1::2], found[-1] = nodes[:, :n], self.between @ nodes, begun[-1]
        return found

    def weights(self, changes: Array) -> Array:
        """Changes, shape (P, k), as they are simulated, shape (2N+1, m, k).

        They go linearly from the middle of a piece to that of the next.
        """
        own, last = self.shapes @ changes, len(self.shapes) - 1
        before = np.minimum(self.place.astype(int), max(last - 1, 0))
        share = (self.place - before)[:, None, None]
        return np.asarray((1.0 - share) * own[before] + share * own[np.minimum(before + 1, last)])


def _shapes(linear: _Linear, grid: Grid, edges: NDArray[np.intp]) -> Array:
    """What the changes are on each piece, shape (pieces, m, P): of what bounds leave there of the controls."""
    m, reach = linear.push.shape[2], linear.effective
    steps = (reach[:-2:2] + 4.0 * reach[1::2] + reach[2::2]) * (grid.widths[:, None, None] / 6.0)
    fractions = np.add.reduceat(steps, edges[:-1], axis=0)
    values, axes = np.linalg.eigh(fractions)
    kept = values > LEFT * (grid.nodes[edges[1:]] - grid.nodes[edges[:-1]])[:, None]
    unit = axes / np.sqrt(np.where(kept, values, 1.0))[:, None, :]
    found = np.zeros((len(fractions), m, len(fractions), m))
    every = np.arange(len(fractions))
    found[every, :, every, :] = unit
    return found.reshape(len(fractions), m, -1)[:, :, kept.ravel()]


def _steps(linear: _Linear, grid: Grid) -> Array:
    """States at the ends of steps by states and controls at their beginnings, the latter kept, (N, n+m, n+m)."""
    n, m = linear.push.shape[1:]
    both = np.zeros((len(linear.motion), n + m, n + m))
    both[:, :n, :n], both[:, :n, n:] = linear.motion, linear.push
    first, middle, last, h = both[:-2:2], both[1::2], both[2::2], grid.widths[:, None, None]
    one = first
    two = middle + middle @ one * (h / 2.0)
    three = middle + middle @ two * (h / 2.0)
    four = last + last @ three * h
    found: Array = np.eye(n + m) + h / 6.0 * (one + 2.0 * (two + three) + four)
    return found
