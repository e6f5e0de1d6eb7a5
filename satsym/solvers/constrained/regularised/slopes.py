"""Derivatives of the program: first ones by generated functions, second ones by complex steps, stage by stage.

A stage is an interval with the node at which it ends. What the motion, the cost and constraints that hold a control
add depends on the state at the midpoint and on the control; the rest on the state at the node.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.kernels.evaluation import COMPLEX_STEP
from satsym.solvers.constrained.arcs import effects, gradients
from satsym.solvers.constrained.regularised.transcription import Point, Program, Step, middles


@dataclass(frozen=True, eq=False)
class ByDuration:
    """Derivatives by a duration that is to be found."""

    state: Array
    control: Array
    nodes: Array
    """Mixed second derivatives of the Lagrangian: by states at midpoints, controls, and states at nodes after the
    first; shapes (n, N), (m, N), (n, N)."""
    gaps: Array
    ends: Array
    constraints: Array
    """Of the conditions, shapes (n, N), (conditions at the end,) and (h, N)."""


@dataclass(frozen=True, eq=False)
class Slopes:
    """Gradient and second derivatives of the Lagrangian without the slacks' part, Jacobians of all conditions."""

    gradient: Step
    """Its ``y`` and ``v`` are the conditions themselves: gaps of the motion, and what is missed at the end."""
    between: Array
    """Second derivatives by state and control at midpoints, shape (N, n + m, n + m)."""
    nodes: Array
    """By states at the nodes after the first, shape (N, n, n)."""
    a: Array
    b: Array
    """Derivatives of the rates times the length of an interval, shapes (N, n, n) and (N, n, m)."""
    ends: Array
    """Of the conditions at the end by the last state, shape (conditions, n)."""
    g_x: Array
    g_u: Array
    """Of constraints, shapes (h, n, N) and (h, m, N)."""
    holding: NDArray[np.bool_]
    """Which constraints hold a control and depend on midpoints, shape (h,)."""
    timed: ByDuration | None
    """None where the duration is given."""

    @classmethod
    def of(cls, program: Program, at: Point) -> Slopes:
        """At a point."""
        n, m, count = len(at.x), len(at.u), program.intervals
        model, p, h = program.instance.model, program.p, at.duration / count
        t, x = program.times(at.duration, middle=True), middles(at.x)
        a, b = (np.asarray(f(t, x, at.u, p)) for f in (model.jacobian_x_batch, model.jacobian_u_batch))
        a, b = np.broadcast_to(a.reshape(n, n, -1), (n, n, count)), np.broadcast_to(b.reshape(n, m, -1), (n, m, count))
        h_x, h_u = _forces(program, t, x, at.u, at.y)
        psi_x, s_x = program.end_rows(at, at.duration)[1:]
        by_x = h / 2 * h_x - at.y
        by_x[:, :-1] += h / 2 * h_x[:, 1:] + at.y[:, 1:]
        by_x[:, -1] += s_x
        by_x[program.given, -1] += at.v[: len(program.given)]
        at_nodes, held = _constraint_curvature(program, at)
        at_nodes[..., -1] += program.curvature_at_end(at)
        timed, by_duration = _by_duration(program, at) if program.free_time else (None, 0.0)
        g_x, g_u = constraint_slopes(program, at)
        return cls(
            Step(by_x, h * h_u, by_duration, program.gaps(at), program.ends(at)),
            np.moveaxis(h * _second(program, t, x, at.u, at.y) + held, -1, 0),
            np.moveaxis(at_nodes, -1, 0),
            np.moveaxis(h * a, -1, 0),
            np.moveaxis(h * b, -1, 0),
            np.concatenate([np.eye(n)[program.given], psi_x]),
            g_x,
            g_u,
            program.holding,
            timed,
        )

    def pushed(self, weights: Array) -> Step:
        """The gradient with constraints in it, each with a weight, shape (h, N)."""
        at_nodes, between = (
            np.einsum("hnk,hk->nk", self.g_x[which], weights[which]) for which in (~self.holding, self.holding)
        )
        by_x = self.gradient.x + at_nodes + between / 2
        by_x[:, :-1] += between[:, 1:] / 2
        by_u = self.gradient.u + np.einsum("hmk,hk->mk", self.g_u, weights)
        passing = 0.0 if self.timed is None else float((self.timed.constraints * weights).sum())
        return replace(self.gradient, x=by_x, u=by_u, duration=self.gradient.duration + passing)

    def change(self, step: Step) -> Array:
        """Of all constraints by a step, shape (h, N)."""
        at_nodes, between = (np.einsum("hnk,nk->hk", self.g_x, x) for x in (step.x, step.middles))
        found = np.where(self.holding[:, None], between, at_nodes) + np.einsum("hmk,mk->hk", self.g_u, step.u)
        return np.asarray(found if self.timed is None else found + self.timed.constraints * step.duration)

    def stiffened(self, weights: Array) -> tuple[Slopes, float]:
        """With squares of linearised constraints in the Lagrangian, each times a weight, shape (h, N).

        Besides what they add to the second derivative by the duration.
        """
        both, held = np.concatenate([self.g_x, self.g_u], axis=1), self.holding[:, None]
        between = self.between + np.einsum("hik,hjk,hk->kij", both, both, weights * held)
        nodes = self.nodes + np.einsum("hik,hjk,hk->kij", self.g_x, self.g_x, weights * ~held)
        if self.timed is None:
            return replace(self, between=between, nodes=nodes), 0.0
        passing, n = weights * self.timed.constraints, self.g_x.shape[1]
        mixed = np.einsum("hik,hk->ik", both, passing * held)
        timed = replace(
            self.timed,
            state=self.timed.state + mixed[:n],
            control=self.timed.control + mixed[n:],
            nodes=np.einsum("hik,hk->ik", self.g_x, passing * ~held),
        )
        return replace(self, between=between, nodes=nodes, timed=timed), float((passing * self.timed.constraints).sum())


def constraint_slopes(program: Program, at: Point) -> tuple[Array, Array]:
    """Gradients of constraints by states and controls, shapes (h, n, N) and (h, m, N)."""
    t, x = program.times(at.duration, middle=False), at.x[:, 1:]
    by_x, holding = gradients(program.instance, t, x, at.u), program.holding[:, None, None]
    by_u = np.zeros((len(holding), len(at.u), program.intervals))
    if holding.any():
        t, x = program.times(at.duration, middle=True), middles(at.x)
        by_x = np.where(holding, gradients(program.instance, t, x, at.u), by_x)
        by_u = np.where(holding, effects(program.instance, t, x, at.u), by_u)
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
    linear = model.spec.switching
    by_u = np.asarray(model.switching_function_batch(t, x, y, p) if linear else model.stationarity_batch(t, x, u, y, p))
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
    both = np.concatenate([middles(at.x), at.u])
    for j in range(n + m if len(holding) else 0):
        moved = _moved(both, j)
        slopes = (of(one, between, moved[:n], moved[n:])[program.holding] for of in (gradients, effects))
        held[:, j] = np.imag(np.concatenate([(slope * holding).sum(axis=0) for slope in slopes])) / COMPLEX_STEP
    return (curved + curved.swapaxes(0, 1)) / 2, (held + held.swapaxes(0, 1)) / 2


def _moved(x: Array, component: int) -> NDArray[Any]:
    """By a complex step in one component."""
    moved = x.astype(complex)
    moved[component] += 1j * COMPLEX_STEP
    return moved


def _by_duration(program: Program, at: Point) -> tuple[ByDuration, float]:
    """Derivatives by the duration, and the Lagrangian's own."""
    count, model, p = program.intervals, program.instance.model, program.p
    lasting = at.duration + 1j * COMPLEX_STEP
    t, x = program.times(lasting, middle=True), middles(at.x)
    whole = np.broadcast_to(model.hamiltonian_batch(t, x, at.u, at.y, p), t.shape) * lasting / count
    end = np.array([program.instance.t0 + lasting])
    terminal = np.asarray(model.terminal_cost_batch(end, at.x[:, -1:].astype(complex), p)).sum()
    h_x, h_u = (np.imag(f * lasting / count) / COMPLEX_STEP for f in _forces(program, t, x, at.u, at.y))
    gaps, ends, passing = (
        np.imag(f(at, lasting)) / COMPLEX_STEP for f in (program.gaps, program.ends, program.constraints)
    )
    found = ByDuration(h_x, h_u, np.zeros_like(h_x), gaps, ends, passing)
    return found, float(np.imag(whole.sum() + terminal) / COMPLEX_STEP + at.v @ ends)
