"""Derivatives of the program: first ones by generated functions, second ones by complex steps, as sparse matrices."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.kernels.evaluation import COMPLEX_STEP
from satsym.solvers.constrained.arcs import effects, gradients
from satsym.solvers.constrained.transcription import Point, Program, middles

if TYPE_CHECKING:
    from scipy.sparse import csc_matrix


@dataclass(frozen=True, eq=False)
class Slopes:
    """Gradient of the Lagrangian without the slacks' part, its second derivatives, Jacobians of all conditions."""

    gradient: Array
    hessian: csc_matrix
    equalities: csc_matrix
    inequalities: csc_matrix

    @classmethod
    def of(cls, program: Program, at: Point) -> Slopes:
        """At a point."""
        n, m, count = len(at.x), len(at.u), program.intervals
        model, p, h = program.instance.model, program.p, at.duration / count
        t, x = program.times(at.duration, middle=True), middles(at.x)
        a, b = (np.asarray(f(t, x, at.u, p)) for f in (model.jacobian_x_batch, model.jacobian_u_batch))
        a, b = np.broadcast_to(a.reshape(n, n, -1), (n, n, count)), np.broadcast_to(b.reshape(n, m, -1), (n, m, count))
        h_x, h_u = _forces(program, t, x, at.u, at.y)
        second = _second(program, t, x, at.u, at.y)
        g_x, g_u = constraint_slopes(program, at)
        psi_x, s_x = program.end_rows(at, at.duration)[1:]
        size = (n + m) * count + program.free_time
        gradient = np.zeros(size)
        by_x, by_u = (
            gradient[: n * count].reshape(count, n).T,
            gradient[n * count : (n + m) * count].reshape(count, m).T,
        )
        by_x += h / 2 * h_x - at.y
        by_x[:, :-1] += h / 2 * h_x[:, 1:] + at.y[:, 1:]
        by_x[:, -1] += s_x
        by_x[program.given, -1] += at.v[: len(program.given)]
        by_u += h * h_u
        blocks = _Blocks(n, m, count)
        curved, held = _constraint_curvature(program, at)
        blocks.lagrangian(h * second + held)
        blocks.last(program.curvature_at_end(at))
        blocks.constraint_curvature(curved)
        blocks.dynamics(h * a, h * b)
        blocks.ends(program.given, psi_x)
        blocks.constraints(g_x, g_u, program.holding)
        if program.free_time:
            gradient[-1] = _by_duration(program, at, blocks)
        rows = n * count + len(program.given) + len(psi_x)
        return cls(
            gradient,
            blocks.hessian.matrix((size, size)),
            blocks.equalities.matrix((rows, size)),
            blocks.inequalities.matrix((len(at.s) * count, size)),
        )


class _Entries:
    """Entries of a sparse matrix, gathered block by block."""

    def __init__(self) -> None:
        self.rows: list[Array] = []
        self.columns: list[Array] = []
        self.values: list[Array] = []

    def add(self, rows: Any, columns: Any, values: Any) -> None:
        for kept, one in zip(
            (self.rows, self.columns, self.values), np.broadcast_arrays(rows, columns, values), strict=True
        ):
            kept.append(one.ravel())

    def matrix(self, shape: tuple[int, int]) -> csc_matrix:
        from scipy.sparse import csc_matrix

        if not self.rows:
            return csc_matrix(shape)
        places = np.concatenate(self.rows), np.concatenate(self.columns)
        return csc_matrix((np.concatenate(self.values), places), shape=shape)


class _Blocks:
    """Where blocks of an interval or a node stand: states node by node after the first, then controls."""

    def __init__(self, n: int, m: int, count: int) -> None:
        self.n, self.m, self.count = n, m, count
        self.hessian, self.equalities, self.inequalities = _Entries(), _Entries(), _Entries()

    def state(self, i: Any, node: Any) -> Any:
        """Place of a state at a node from 1 on."""
        return (node - 1) * self.n + i

    def control(self, i: Any, interval: Any) -> Any:
        """Place of a control."""
        return self.n * self.count + interval * self.m + i

    def lagrangian(self, second: Array) -> None:
        """Second derivatives by state and control at midpoints, shape (n + m, n + m, N)."""
        n, m, k = self.n, self.m, np.arange(self.count)
        i, j = np.arange(n)[:, None, None], np.arange(n)[None, :, None]
        a, b = np.arange(m)[:, None, None], np.arange(m)[None, :, None]
        self.hessian.add(self.control(a, k), self.control(b, k), second[n:, n:])
        for left in (0, 1):
            inside = k[k + left > 0]
            mixed = second[:n, n:][..., inside] / 2
            self.hessian.add(self.state(i, inside + left), self.control(b, inside), mixed)
            self.hessian.add(self.control(b, inside), self.state(i, inside + left), mixed)
            for right in (0, 1):
                both = k[(k + left > 0) & (k + right > 0)]
                self.hessian.add(self.state(i, both + left), self.state(j, both + right), second[:n, :n][..., both] / 4)

    def last(self, curvature: Array) -> None:
        i, j = np.arange(self.n)[:, None], np.arange(self.n)[None, :]
        self.hessian.add(self.state(i, self.count), self.state(j, self.count), curvature)

    def constraint_curvature(self, curvature: Array) -> None:
        """Of all constraints with their multipliers at nodes from 1 on, shape (n, n, N)."""
        i, j = np.arange(self.n)[:, None, None], np.arange(self.n)[None, :, None]
        node = np.arange(1, self.count + 1)
        self.hessian.add(self.state(i, node), self.state(j, node), curvature)

    def dynamics(self, a: Array, b: Array) -> None:
        """Derivatives of the rates times the step, shapes (n, n, N) and (n, m, N)."""
        n, k = self.n, np.arange(self.count)
        j, c = np.arange(n)[None, :, None], np.arange(self.m)[None, :, None]
        unit, row = np.eye(n)[:, :, None], k * n + np.arange(n)[:, None, None]
        self.equalities.add(row, self.state(j, k + 1), a / 2 - unit)
        self.equalities.add(row[..., 1:], self.state(j, k[1:]), a[..., 1:] / 2 + unit)
        self.equalities.add(row, self.control(c, k), b)

    def ends(self, given: NDArray[np.intp], psi_x: Array) -> None:
        first, j = self.n * self.count, np.arange(self.n)[None, :]
        self.equalities.add(first + np.arange(len(given)), self.state(given, self.count), np.ones(len(given)))
        row = first + len(given) + np.arange(len(psi_x))[:, None]
        self.equalities.add(row, self.state(j, self.count), psi_x)

    def constraints(self, g_x: Array, g_u: Array, holding: NDArray[np.bool_]) -> None:
        """Gradients, shapes (h, n, N) and (h, m, N), at nodes from 1 on, or at midpoints where they hold a control."""
        j, c, node = np.arange(self.n)[None, :, None], np.arange(self.m)[None, :, None], np.arange(1, self.count + 1)
        row = np.arange(len(g_x))[:, None, None] * self.count + node - 1
        at_nodes, between = np.flatnonzero(~holding), np.flatnonzero(holding)
        self.inequalities.add(row[at_nodes], self.state(j, node), g_x[at_nodes])
        self.inequalities.add(row[between], self.state(j, node), g_x[between] / 2)
        self.inequalities.add(row[between][..., 1:], self.state(j, node[:-1]), g_x[between][..., 1:] / 2)
        self.inequalities.add(row[between], self.control(c, node - 1), g_u[between])


def constraint_slopes(program: Program, at: Point) -> tuple[Array, Array]:
    """Gradients of constraints by states and controls, shapes (h, n, N) and (h, m, N)."""
    t, x = program.times(at.duration, middle=False), at.x[:, 1:]
    by_x, holding = gradients(program.instance, t, x, at.u), program.holding[:, None, None]
    by_u = np.zeros((len(holding), len(at.u), program.intervals))
    if holding.any():
        t, x = program.times(at.duration, middle=True), middles(at.x)
        by_x = np.where(holding, gradients(program.instance, t, x, at.u), by_x)
        by_u = np.where(holding, effects(program.instance, t, x), by_u)
    return by_x * program.kept[:, None], by_u * program.kept[:, None]


def rooms(program: Program, at: Point) -> Array:
    """What each constraint is measured by, shape (h, 1): itself or, where these are larger, its terms."""
    g_x, g_u = constraint_slopes(program, at)
    terms = (np.abs(g_x) * np.abs(at.x[:, 1:])).sum(axis=1) + (np.abs(g_u) * np.abs(at.u)).sum(axis=1)
    found = np.maximum(np.abs(program.constraints(at)), terms).max(axis=1, keepdims=True)
    return np.where(found > 0.0, found, 1.0)


def _forces(program: Program, t: Array, x: Array, u: Array, y: Array) -> tuple[Array, Array]:
    """H_x and H_u at midpoints."""
    model, p = program.instance.model, program.p
    by_x = -np.asarray(model.costate_rate_batch(t, x, u, y, p))
    by_u = np.asarray(model.stationarity_batch(t, x, u, y, p))
    return np.broadcast_to(by_x, x.shape), np.broadcast_to(by_u, u.shape)


def _second(program: Program, t: Array, x: Array, u: Array, y: Array) -> Array:
    """Second derivatives of H by state and control, shape (n + m, n + m, N)."""
    n, m = len(x), len(u)
    found = np.empty((n + m, n + m, len(t)))
    for j in range(n + m):
        moved = np.concatenate([x, u]).astype(complex)
        moved[j] += 1j * COMPLEX_STEP
        found[:, j] = np.imag(np.concatenate(_forces(program, t, moved[:n], moved[n:], y))) / COMPLEX_STEP
    return (found + found.swapaxes(0, 1)) / 2


def _constraint_curvature(program: Program, at: Point) -> tuple[Array, Array]:
    """Second derivatives of constraints with their multipliers: at nodes (n, n, N), at midpoints (n + m, n + m, N)."""
    n, m, one, weights = len(at.x), len(at.u), program.instance, (at.z * program.kept)[:, None]
    curved, held = np.zeros((n, n, program.intervals)), np.zeros((n + m, n + m, program.intervals))
    nodes, between = (program.times(at.duration, middle) for middle in (False, True))
    own, holding = weights[~program.holding], weights[program.holding]
    for j in range(n if len(own) else 0):
        by_x = gradients(one, nodes, _moved(at.x[:, 1:], j), at.u)[~program.holding]
        curved[:, j] = np.imag((by_x * own).sum(axis=0)) / COMPLEX_STEP
    for j in range(n if len(holding) else 0):
        x = _moved(middles(at.x), j)
        by_x, by_u = (f[program.holding] for f in (gradients(one, between, x, at.u), effects(one, between, x)))
        held[:n, j] = np.imag((by_x * holding).sum(axis=0)) / COMPLEX_STEP
        held[n:, j] = held[j, n:] = np.imag((by_u * holding).sum(axis=0)) / COMPLEX_STEP
    return (curved + curved.swapaxes(0, 1)) / 2, (held + held.swapaxes(0, 1)) / 2


def _moved(x: Array, component: int) -> NDArray[Any]:
    """By a complex step in one component."""
    moved = x.astype(complex)
    moved[component] += 1j * COMPLEX_STEP
    return moved


def _by_duration(program: Program, at: Point, blocks: _Blocks) -> float:
    """The Lagrangian by the duration; enters the derivatives of all conditions by it."""
    n, m, count, model, p = blocks.n, blocks.m, blocks.count, program.instance.model, program.p
    lasting = at.duration + 1j * COMPLEX_STEP
    t, x = program.times(lasting, middle=True), middles(at.x)
    last = (n + m) * count
    whole = np.broadcast_to(model.hamiltonian_batch(t, x, at.u, at.y, p), t.shape) * lasting / count
    end = np.array([program.instance.t0 + lasting])
    terminal = np.asarray(model.terminal_cost_batch(end, at.x[:, -1:].astype(complex), p)).sum()
    h_x, h_u = (np.imag(f * lasting / count) / COMPLEX_STEP for f in _forces(program, t, x, at.u, at.y))
    k, i, c = np.arange(count), np.arange(n)[:, None], np.arange(m)[:, None]
    for rows, values in (
        (blocks.state(i, k + 1), h_x / 2),
        (blocks.state(i, k[1:]), h_x[:, 1:] / 2),
        (blocks.control(c, k), h_u),
    ):
        blocks.hessian.add(rows, last, values)
        blocks.hessian.add(last, rows, values)
    gaps = np.imag(program.gaps(at, lasting)) / COMPLEX_STEP
    blocks.equalities.add(k * n + i, last, gaps)
    ends = np.imag(program.ends(at, lasting)) / COMPLEX_STEP
    blocks.equalities.add(n * count + np.arange(len(ends)), last, ends)
    passing = np.imag(program.constraints(at, lasting)) / COMPLEX_STEP
    blocks.inequalities.add(np.arange(passing.size), last, passing.ravel())
    return float(np.imag(whole.sum() + terminal) / COMPLEX_STEP + at.v @ ends)
