"""The problem as a nonlinear program: states at nodes, controls constant between them, the implicit midpoint rule.

Nothing here is accurate; it shows where constraints are active. Derivatives are those of the generated functions, of
which the second ones are taken by complex steps.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.kernels.evaluation import COMPLEX_STEP
from satsym.solvers.collocation.scaling import final_argument

if TYPE_CHECKING:
    from scipy.sparse import csc_matrix


@dataclass(frozen=True, eq=False)
class Point:
    """Where the program stands, with its multipliers."""

    x: Array
    """States at the nodes, shape (n, N + 1)."""
    u: Array
    """Controls between them, shape (m, N)."""
    duration: float
    y: Array
    """Multipliers of the midpoint rule, shape (n, N): costates at the midpoints."""
    v: Array
    """Of the conditions at the end."""
    s: Array
    z: Array
    """Slacks of the constraints at the nodes after the first, and their multipliers, shape (h, N)."""

    def moved(self, dw: Array, dy: Array, dv: Array, length: float) -> Point:
        """After a step in states, controls and duration, shapes as those of the program's vector."""
        n, m, count = len(self.x), len(self.u), self.u.shape[1]
        x, u = self.x.copy(), self.u + length * dw[n * count : (n + m) * count].reshape(count, m).T
        x[:, 1:] += length * dw[: n * count].reshape(count, n).T
        duration = self.duration + length * float(dw[(n + m) * count]) if len(dw) > (n + m) * count else self.duration
        return Point(x, u, duration, self.y + length * dy, self.v + length * dv, self.s, self.z)


@dataclass(frozen=True, eq=False)
class Program:
    """Values and derivatives of all functions of the program."""

    instance: Instance
    intervals: int

    @cached_property
    def kept(self) -> Array:
        """Which constraints are looked at, shape (h, N): not at an end where given states decide them."""
        model, (x, given) = self.instance.model, self._target()
        gradient = np.array(model.path_gradient(self.final_time(self.guessed), x, self.p)).reshape(-1, len(x))
        table = np.ones((len(gradient), self.intervals))
        table[~(np.abs(gradient) * (given == 0.0)).any(axis=1), -1] = 0.0
        return table

    @cached_property
    def guessed(self) -> float:
        """A duration to begin with."""
        one = self.instance
        end = one.tf if one.tf is not None else one.tf_guess if one.tf_guess is not None else one.t0 + 1.0
        return end - one.t0

    @property
    def p(self) -> tuple[float, ...]:
        """Parameters."""
        return self.instance.parameters

    @property
    def free_time(self) -> bool:
        """Whether the duration is to be found."""
        return self.instance.tf is None

    @cached_property
    def final(self) -> tuple[float, ...]:
        """Choices and targets at the end."""
        return final_argument(self.instance)

    def final_time(self, duration: float) -> float:
        """The end of a duration."""
        return self.instance.t0 + duration

    def _target(self) -> tuple[tuple[float, ...], Array]:
        """The final state as far as it is given, and which states are."""
        n = len(self.instance.initial)
        given = np.array(self.final[:n]) + np.array(self.final[n : 2 * n])
        return tuple(np.where(given > 0.0, self.target(self.guessed), self.instance.initial).tolist()), given

    def target(self, duration: float | complex) -> Array:
        """Where states are to end that are given or on the reference."""
        one, n = self.instance, len(self.instance.initial)
        on_reference, target = np.array(self.final[n : 2 * n]), np.array(self.final[2 * n :])
        if not on_reference.any():
            return target
        curve = one.model.reference_batch(np.array([one.t0 + duration]), self.p)[:, 0]
        return np.asarray(np.where(on_reference > 0.0, curve, target))

    def times(self, duration: float | complex, middle: bool) -> Array:
        """Nodes after the first, or midpoints."""
        k = np.arange(self.intervals)
        return np.asarray(self.instance.t0 + duration * ((k + 0.5) if middle else (k + 1.0)) / self.intervals)

    def cost(self, at: Point) -> float:
        """What is minimised."""
        model, t = self.instance.model, self.times(at.duration, middle=True)
        running = np.broadcast_to(model.running_cost_batch(t, _middles(at.x), at.u, self.p), t.shape)
        end = tuple(at.x[:, -1].tolist())
        terminal = float(model.terminal_cost(self.final_time(at.duration), end, self.p))
        return float(running.sum() * at.duration / self.intervals) + terminal

    def gaps(self, at: Point, duration: complex | None = None) -> Array:
        """How far the midpoint rule is from holding, shape (n, N)."""
        lasting = at.duration if duration is None else duration
        t, h = self.times(lasting, middle=True), lasting / self.intervals
        f = self.instance.model.dynamics_batch(t, _middles(at.x), at.u, self.p)
        return np.asarray(at.x[:, :-1] + h * f - at.x[:, 1:])

    def constraints(self, at: Point, duration: complex | None = None) -> Array:
        """Constraints at the nodes after the first, shape (h, N)."""
        t = self.times(at.duration if duration is None else duration, middle=False)
        found = np.asarray(self.instance.model.path_constraints_batch(t, at.x[:, 1:], self.p))
        return np.broadcast_to(found, (len(found), self.intervals)) * self.kept

    def ends(self, at: Point, duration: complex | None = None) -> Array:
        """Conditions at the end: given states, then terminal constraints."""
        lasting = at.duration if duration is None else duration
        off = at.x[:, -1] - self.target(lasting)
        return np.concatenate([off[self._given], self._end_rows(at, lasting)[0]])

    @cached_property
    def _given(self) -> Array:
        return np.flatnonzero(self._target()[1])

    def _end_rows(self, at: Point, duration: complex) -> tuple[Array, Array, Array]:
        """Terminal constraints, their derivatives by the state, and S_x + nu' psi_x, all from the boundary kernel."""
        n, model = len(at.x), self.instance.model
        c = len(model.spec.multipliers)
        nu, t = tuple(at.v[len(at.v) - c :].tolist()), np.array([self.instance.t0 + duration])
        nothing, x, lam = (0.0,) * 3 * n, at.x[:, -1:].astype(complex), np.zeros((n, 1))
        bounds = self.instance.control_set.arguments
        rows = np.asarray(model.boundary_batch(t, x, lam, nu, self.p, bounds, nothing))[:, 0]
        slopes = np.asarray(model.boundary_jacobian_batch(t, x, lam, nu, self.p, bounds, nothing))
        table = slopes.reshape(len(rows), -1)
        plain = (lambda a: a) if isinstance(duration, complex) else np.real
        return plain(rows[n : n + c]), plain(table[n : n + c, :n]), plain(-rows[:n])

    def curvature_at_end(self, at: Point) -> Array:
        """Second derivatives of S + nu' psi by the state."""
        n, model = len(at.x), self.instance.model
        c = len(model.spec.multipliers)
        nu, x = tuple(at.v[len(at.v) - c :].tolist()), tuple(at.x[:, -1].tolist())
        arguments = nu, self.p, self.instance.control_set.arguments, (0.0,) * 3 * n
        table = np.array(model.boundary_jacobian(self.final_time(at.duration), x, (0.0,) * n, *arguments))
        return -table.reshape(n + c + 1, -1)[:n, :n]

    def slopes(self, at: Point) -> Slopes:
        """All derivatives at a point."""
        return Slopes.of(self, at)


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
        t, x = program.times(at.duration, middle=True), _middles(at.x)
        a, b = (np.asarray(f(t, x, at.u, p)) for f in (model.jacobian_x_batch, model.jacobian_u_batch))
        a, b = np.broadcast_to(a.reshape(n, n, -1), (n, n, count)), np.broadcast_to(b.reshape(n, m, -1), (n, m, count))
        h_x, h_u = _forces(program, t, x, at.u, at.y)
        second = _second(program, t, x, at.u, at.y)
        g_x = np.asarray(model.path_gradient_batch(program.times(at.duration, middle=False), at.x[:, 1:], p))
        g_x = np.broadcast_to(g_x.reshape(-1, n, g_x.shape[-1]), (len(at.s), n, count)) * program.kept[:, None]
        psi_x, s_x = program._end_rows(at, at.duration)[1:]
        size = (n + m) * count + program.free_time
        gradient = np.zeros(size)
        by_x, by_u = gradient[: n * count].reshape(count, n).T, gradient[n * count : (n + m) * count].reshape(count, m).T
        by_x += h / 2 * h_x - at.y
        by_x[:, :-1] += h / 2 * h_x[:, 1:] + at.y[:, 1:]
        by_x[:, -1] += s_x
        by_x[program._given, -1] += at.v[: len(program._given)]
        by_u += h * h_u
        blocks = _Blocks(n, m, count)
        blocks.lagrangian(h * second)
        blocks.last(program.curvature_at_end(at))
        blocks.constraint_curvature(_constraint_curvature(program, at))
        blocks.dynamics(h * a, h * b)
        blocks.ends(program._given, psi_x)
        blocks.constraints(g_x)
        if program.free_time:
            gradient[-1] = _by_duration(program, at, blocks)
        rows = n * count + len(program._given) + len(psi_x)
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
        for kept, one in zip((self.rows, self.columns, self.values), np.broadcast_arrays(rows, columns, values), strict=True):
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
        i, j, c = np.arange(n)[:, None, None], np.arange(n)[None, :, None], np.arange(self.m)[None, :, None]
        unit, row = np.eye(n)[:, :, None], k * n + np.arange(n)[:, None, None]
        self.equalities.add(row, self.state(j, k + 1), a / 2 - unit)
        self.equalities.add(row[..., 1:], self.state(j, k[1:]), a[..., 1:] / 2 + unit)
        self.equalities.add(row, self.control(c, k), b)
        del i

    def ends(self, given: Array, psi_x: Array) -> None:
        first, j = self.n * self.count, np.arange(self.n)[None, :]
        self.equalities.add(first + np.arange(len(given)), self.state(given, self.count), np.ones(len(given)))
        row = first + len(given) + np.arange(len(psi_x))[:, None]
        self.equalities.add(row, self.state(j, self.count), psi_x)

    def constraints(self, g_x: Array) -> None:
        """Gradients at nodes from 1 on, shape (h, n, N)."""
        j, node = np.arange(self.n)[None, :, None], np.arange(1, self.count + 1)
        row = np.arange(len(g_x))[:, None, None] * self.count + node - 1
        self.inequalities.add(row, self.state(j, node), g_x)


def _middles(x: Array) -> Array:
    return np.asarray((x[:, :-1] + x[:, 1:]) / 2)


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


def _constraint_curvature(program: Program, at: Point) -> Array:
    """Second derivatives of the constraints with their multipliers, shape (n, n, N)."""
    n, t = len(at.x), program.times(at.duration, middle=False)
    found = np.empty((n, n, len(t)))
    for j in range(n):
        moved = at.x[:, 1:].astype(complex)
        moved[j] += 1j * COMPLEX_STEP
        g_x = np.asarray(program.instance.model.path_gradient_batch(t, moved, program.p))
        g_x = np.broadcast_to(g_x.reshape(-1, n, g_x.shape[-1]), (len(at.z), n, len(t)))
        found[:, j] = np.imag((g_x * (at.z * program.kept)[:, None]).sum(axis=0)) / COMPLEX_STEP
    return (found + found.swapaxes(0, 1)) / 2


def _by_duration(program: Program, at: Point, blocks: _Blocks) -> float:
    """The Lagrangian by the duration; enters the derivatives of all conditions by it."""
    n, m, count, model, p = blocks.n, blocks.m, blocks.count, program.instance.model, program.p
    lasting = at.duration + 1j * COMPLEX_STEP
    t, x = program.times(lasting, middle=True), _middles(at.x)
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
