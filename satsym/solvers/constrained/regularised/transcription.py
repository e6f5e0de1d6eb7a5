"""The problem as a nonlinear program: states at nodes, controls constant between them, the implicit midpoint rule.

Nothing here is accurate; it shows where constraints are active. Derivatives are those of the generated functions, of
which the second ones are taken by complex steps.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.collocation.scaling import final_argument
from satsym.solvers.constrained.arcs import depends, values


@dataclass(frozen=True, eq=False)
class Step:
    """By how much all that is unknown changes, slacks and their multipliers apart; or what belongs to each of it."""

    x: Array
    """States at nodes after the first, shape (n, N)."""
    u: Array
    """Controls, shape (m, N)."""
    duration: float
    y: Array
    v: Array

    @property
    def middles(self) -> Array:
        """Change of states at midpoints, shape (n, N); the first node stays where it is."""
        return middles(np.column_stack([np.zeros(len(self.x)), self.x]))


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
    """Slacks of the constraints, and their multipliers, shape (h, N): at the nodes after the first, of constraints that
    hold a control at midpoints."""

    def moved(self, step: Step, length: float) -> Point:
        """After a step of this length in all but slacks and their multipliers."""
        x = self.x.copy()
        x[:, 1:] += length * step.x
        u, y, v = self.u + length * step.u, self.y + length * step.y, self.v + length * step.v
        return Point(x, u, self.duration + length * step.duration, y, v, self.s, self.z)


@dataclass(frozen=True, eq=False)
class Program:
    """Values and derivatives of all functions of the program."""

    instance: Instance
    intervals: int
    eased: Array | float = 0.0
    """By how much constraints may be positive, shape (h, 1)."""

    @cached_property
    def kept(self) -> Array:
        """Which constraints are looked at, shape (h, N).

        Not at an end where given states decide them, and no bound that is infinite.
        """
        (x, given), end = self._target(), np.array([self.final_time(self.guessed)])
        table = np.ones((len(self.holding), self.intervals))
        table[~(self.holding | (depends(self.instance) & (given == 0.0)).any(axis=1)), -1] = 0.0
        u = np.zeros((len(self.instance.model.spec.controls), 1))
        bounds = self.instance.control_set.arguments
        found = self.instance.model.path_constraints_batch(end, np.array(x)[:, None], u, self.p, bounds)
        table[np.isinf(np.broadcast_to(np.asarray(found), (len(table), 1))[:, 0])] = 0.0
        return table

    @cached_property
    def holding(self) -> NDArray[np.bool_]:
        """Which constraints hold a control, shape (h,)."""
        return np.array([one.order == 0 for one in self.instance.model.spec.path_constraints])

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
        running = np.broadcast_to(model.running_cost_batch(t, middles(at.x), at.u, self.p), t.shape)
        end = tuple(at.x[:, -1].tolist())
        terminal = float(model.terminal_cost(self.final_time(at.duration), end, self.p))
        return float(running.sum() * at.duration / self.intervals) + terminal

    def gaps(self, at: Point, duration: complex | None = None) -> Array:
        """How far the midpoint rule is from holding, shape (n, N)."""
        lasting = at.duration if duration is None else duration
        t, h = self.times(lasting, middle=True), lasting / self.intervals
        f = self.instance.model.dynamics_batch(t, middles(at.x), at.u, self.p)
        return np.asarray(at.x[:, :-1] + h * f - at.x[:, 1:])

    def constraints(self, at: Point, duration: complex | None = None) -> Array:
        """Constraints at the nodes after the first, or at midpoints where they hold a control, shape (h, N)."""
        one, lasting = self.instance, at.duration if duration is None else duration
        found = values(one, self.times(lasting, middle=False), at.x[:, 1:], at.u)
        if self.holding.any():
            held = values(one, self.times(lasting, middle=True), middles(at.x), at.u)
            found = np.where(self.holding[:, None], held, found)
        return np.asarray((found - self.eased) * self.kept)

    def ends(self, at: Point, duration: complex | None = None) -> Array:
        """Conditions at the end: given states, then terminal constraints."""
        lasting = at.duration if duration is None else duration
        off = at.x[:, -1] - self.target(lasting)
        return np.concatenate([off[self.given], self.end_rows(at, lasting)[0]])

    @cached_property
    def given(self) -> NDArray[np.intp]:
        """Which states are given at the end, or on the reference."""
        return np.flatnonzero(self._target()[1])

    def end_rows(self, at: Point, duration: complex) -> tuple[Array, Array, Array]:
        """Terminal constraints, their derivatives by the state, and S_x + nu' psi_x, all from the boundary kernel."""
        n, model = len(at.x), self.instance.model
        c = len(model.spec.multipliers)
        nu, t = tuple(at.v[len(at.v) - c :].tolist()), np.array([self.instance.t0 + duration])
        nothing, x, lam = (0.0,) * 3 * n, at.x[:, -1:], np.zeros((n, 1))
        bounds = self.instance.control_set.arguments
        rows = np.asarray(model.boundary_batch(t, x, lam, nu, self.p, bounds, nothing))[:, 0]
        slopes = np.asarray(model.boundary_jacobian_batch(np.real(t), x, lam, nu, self.p, bounds, nothing))
        table = slopes.reshape(len(rows), -1)
        return rows[n : n + c], table[n : n + c, :n], -rows[:n]

    def curvature_at_end(self, at: Point) -> Array:
        """Second derivatives of S + nu' psi by the state; by arrays, as laws may have no numbers without costates."""
        n, model = len(at.x), self.instance.model
        c = len(model.spec.multipliers)
        nu, end = tuple(at.v[len(at.v) - c :].tolist()), np.array([self.final_time(at.duration)])
        arguments = nu, self.p, self.instance.control_set.arguments, (0.0,) * 3 * n
        table = np.asarray(model.boundary_jacobian_batch(end, at.x[:, -1:], np.zeros((n, 1)), *arguments))
        return -table.reshape(n + c + 1, -1)[:n, :n]


def middles(x: Array) -> Array:
    """Means of neighbouring columns."""
    return np.asarray((x[:, :-1] + x[:, 1:]) / 2)
